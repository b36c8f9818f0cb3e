"""Published machines beside ours: docs/machines.md, its picture, and our values for the package.

Run with ``python examples/machines/write_page.py``, which takes some minutes.
"""

import csv
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import saleg
from saleg import machines
from saleg.studies import compare_published, explain_published

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs" / "machines.md"
PICTURE = ROOT / "docs" / "images" / "machines.png"
OURS = ROOT / "src" / "saleg" / "machines" / "ours.csv"
#: Readable units of figures: factor, unit, digits.
UNITS = {
    "frequency": (1.0, "Hz"),
    "power": (1e-3, "kW"),
    "efficiency": (100.0, "%"),
    "compression_ratio": (1.0, ""),
    "stroke": (1e3, "mm"),
}
STIFFNESSES = (0.0, 2.9e3, 5.9e3, 8.8e3, 11.8e3, 14.7e3)
#: Ulsan with little heat and an early spark, so that its gas is soft: for the trend alone.
SOFT_GAS = {
    "combustion_efficiency": 0.3,
    "ignition.clearance": 8e-3,
    "alternator.load_constant": 30.0,
}
INTRODUCTION = """# Machines of others

Engines nobody here fitted: what their sources print is taken as it stands, what they leave open is
assumed from elsewhere and listed with its reason, and no number is tuned to a result except where
the table says so. `saleg list` names them; `saleg.machines.PUBLISHED` has all that stands on this
page.

```python
import saleg
from saleg.studies import compare_published

for row in compare_published(saleg.machines.PUBLISHED["wvu"]):
    print(row.result.label, row.result.value, row.ours, row.deviation)
print(saleg.steady_state(saleg.machines.wvu()).validity)
```

![Deviations from published results, and the springs of Ulsan](images/machines.png)

Orange on the right is Ulsan with 30 % of its fuel burnt, an earlier spark and a lighter load.

Which open quantity would explain a deviation is computed: each is taken through its range with all
else as assumed (`saleg.studies.explain_published`, which solves for four engines per quantity);
"range" is what becomes of our result meanwhile. A quantity explains a result that it brings to
within 2 % without making any other worse by more. Where none does, the table has the nearest that a
single quantity comes, and what that costs. What a published result was used to set is set anew each
time. This page is written by `examples/machines/write_page.py`.
"""


def main() -> None:
    found = {name: compare_published(machine) for name, machine in machines.PUBLISHED.items()}
    with OURS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("machine", "result", "ours"))
        for name, rows in found.items():
            writer.writerows((name, row.result.label, f"{row.ours:.6g}") for row in rows)
    curves = {"as assumed": trend({}), "soft gas": trend(SOFT_GAS)}
    draw(found, curves)
    parts = [INTRODUCTION]
    for name, machine in machines.PUBLISHED.items():
        parts += section(machine, found[name], explain_published(machine))
        parts += SPECIAL.get(name, lambda curves: [])(curves)
    PAGE.write_text("\n".join(parts), encoding="utf-8")


def section(machine, compared, explanations) -> list[str]:
    """A machine: source, what is given, results, what is open."""
    kind = "Measured" if machine.is_measured else "Simulated by its source"
    call = f"saleg.machines.{machine.engine.__name__}()"
    parts = [f"## {machine.title}\n", f"`{call}`. {kind}: {machine.source}. Given:\n"]
    parts += [f"- {text}" for text in machine.given]
    told = {one.result.label: one for one in explanations}
    parts += ["", "| result | published | ours | range | deviation | what would explain it |"]
    parts.append("|---|---|---|---|---|---|")
    for result, ours, off in compared:
        why, span = f"set by `{result.held_by}`", ""
        if not result.held_by:
            one = told[result.label]
            why = words(one, off)
            span = f"{shown(result, one.least)} to {shown(result, one.greatest)}"
        parts.append(
            f"| {result.label} | {shown(result, result.value)} | {shown(result, ours)} | {span} "
            f"| {percent(off)} | {why} |"
        )
    parts += ["", "| open quantity | assumed | range | why |", "|---|---|---|---|"]
    engine = machine.engine()
    for one in machine.open_quantities:
        span = f"{one.low:.4g} to {one.high:.4g}"
        parts.append(f"| `{one.path}` | {engine.get(one.path):.4g} | {span} | {one.why} |")
    return [*parts, ""]


def words(one, off) -> str:
    """What would explain a deviation."""
    if abs(off) <= 0.02:
        return "within 2 %"
    if one.explaining:
        return "any of " * (len(one.explaining) > 1) + ", ".join(map(at, one.explaining))
    if one.nearest is None:
        return "no single quantity brings it nearer"
    cause = one.nearest
    reached = "meets it" if abs(cause.deviation) <= 0.02 else f"leaves {percent(cause.deviation)}"
    off_by = f"is then off by {percent(cause.worst_deviation)}"
    cost = "no longer runs" if math.isnan(cause.worst_deviation) else off_by
    cost = f", but {cause.worst} {cost}" if cause.worst else ""
    return f"no single quantity; {at(cause)} {reached}{cost}"


def at(cause) -> str:
    """A quantity and its value."""
    return f"`{cause.path}` = {cause.value:.3g}"


def shown(result, value) -> str:
    """Value of a result in its readable unit."""
    if math.isnan(value):
        return "does not run"
    if result.over is not None:
        return f"{value:.3f}"
    factor, unit = UNITS[result.figure]
    return f"{factor * value:.4g} {unit}".strip()


def percent(share) -> str:
    return "" if math.isnan(share) else f"{100.0 * share:+.1f} %"


def trend(changes) -> list[tuple[float, float, float]]:
    """Frequency, efficiency and power of Ulsan over its springs; NaN where it does not run."""
    rows = []
    for stiffness in STIFFNESSES:
        state = saleg.steady_state(machines.ulsan(stiffness).replace(**changes))
        figures = state.performance
        known = (figures.frequency, figures.efficiency, figures.power)
        rows.append(known if state.found else (math.nan,) * 3)
    return rows


def springs(curves) -> list[str]:
    """The trend of Ulsan's springs, in words and numbers."""
    parts = [
        "### Its springs\n",
        "| spring [kN/m] | as assumed | with soft gas |",
        "|---|---|---|",
    ]
    for stiffness, *rows in zip(STIFFNESSES, *curves.values(), strict=True):
        parts.append(f"| {stiffness / 1e3:g} | {' | '.join(map(figures_of, rows))} |")
    assumed, soft = curves.values()
    stiff = (assumed[0][0] / 35.0) ** 2
    parts.append(
        "\nMeasured: 35 Hz and 6 % without springs, 47 Hz, 7.22 % and 25 % more power with "
        "14.7 kN/m. A mass of 0.8 kg that swings at 35 Hz on its gas swings at 46.4 Hz with a pair "
        "of 14.7 kN/m beside it, so the measured gas was about as stiff as the springs. Ours is "
        f"{stiff:.1f} times as stiff as assumed, and the springs change {change(assumed)}. With "
        "three quantities changed together (30 % of the fuel burns, spark at 8 mm, load 30 N s/m) "
        f"they change {change(soft)}: in the measured direction, by about half as much. But that "
        f"machine has an efficiency of {100.0 * soft[0][1]:.1f} % without springs: what the "
        "sources print does not settle it.\n"
    )
    return parts


def figures_of(row) -> str:
    """Frequency, efficiency and power as text."""
    if math.isnan(row[0]):
        return "does not run"
    return f"{row[0]:.1f} Hz, {100.0 * row[1]:.2f} %, {row[2]:.0f} W"


def change(rows) -> str:
    """What the stiffest springs do against none."""
    ratios = [last / first for first, last in zip(rows[0], rows[-1], strict=True)]
    if math.isnan(ratios[0]):
        return "whether it runs at all"
    names = ("frequency", "efficiency", "power")
    return ", ".join(f"{name} {percent(r - 1.0)}" for name, r in zip(names, ratios, strict=True))


def blower(_) -> list[str]:
    """Work of the charger that Newcastle's results may or may not contain."""
    state = saleg.steady_state(machines.newcastle())
    beside = saleg.Auxiliaries(charger_efficiency=0.6, electronics_efficiency=1.0)
    net = state.net_output(beside)
    return [
        f"A charger of 60 % from 1 bar takes {net.charging / 1e3:.1f} kW, which would leave "
        f"{net.net_power / 1e3:.1f} kW and {100.0 * net.net_efficiency:.1f} %; whether the "
        "published numbers contain it is not said.\n"
    ]


SPECIAL = {"ulsan": springs, "newcastle": blower}


def draw(found, curves) -> None:
    """Deviations of all results, and the springs of Ulsan."""
    fig, axes = plt.subplot_mosaic(
        [["all", "frequency"], ["all", "efficiency"]],
        figsize=(10.5, 6.0),
        width_ratios=(1.25, 1.0),
        layout="constrained",
    )
    deviations(axes["all"], found)
    for name, column, factor, unit, ends in (
        ("frequency", 0, 1.0, "Hz", (35.0, 47.0)),
        ("efficiency", 1, 100.0, "%", (6.0, 7.22)),
    ):
        ax = axes[name]
        ax.plot((0.0, 14.7), ends, "k--o", label="measured")
        for (label, rows), style in zip(curves.items(), ("o-", "s-"), strict=True):
            values = [factor * row[column] for row in rows]
            ax.plot([each / 1e3 for each in STIFFNESSES], values, style, label=f"ours, {label}")
        ax.set_ylabel(f"{name} [{unit}]")
        ax.set_ylim(0.0, None)
        ax.grid(alpha=0.3)
    axes["frequency"].set_title("Springs of Ulsan")
    axes["frequency"].legend(loc="lower right", fontsize=9)
    axes["efficiency"].set_xlabel("stiffness of one spring [kN/m]")
    fig.savefig(PICTURE, dpi=110)


def deviations(ax, found) -> None:
    """A bar for every published result."""
    colours = dict(zip(found, ("C0", "C1", "C2", "C4"), strict=True))
    rows = [
        (name, row)
        for name, compared in found.items()
        for row in compared
        if not row.result.held_by
    ][::-1]
    labels = [f"{name}: {short(row.result.label)}" for name, row in rows]
    values = [100.0 * row.deviation for _, row in rows]
    bars = ax.barh(labels, values, color=[colours[name] for name, _ in rows])
    ax.bar_label(bars, [f"{value:+.1f} %" for value in values], padding=4, fontsize=9)
    ax.axvline(0.0, color="k", linewidth=0.8)
    ax.margins(x=0.3)
    ax.set_xlabel("deviation from the published value [%]")
    ax.set_title("Published results")


def short(label: str) -> str:
    """Label of a result for a picture."""
    soft, stiff = " at springs.stiffness 0", " at springs.stiffness 14700"
    if " over that" in label:
        return f"{label.split(' at ')[0]}, stiff over none"
    return label.replace(stiff, ", stiff").replace(soft, ", no springs")


if __name__ == "__main__":
    main()
