"""What matters in the model of the base case: the sensitivity studies of Chapter 3.

Run with ``python examples/06_sensitivity.py [FOLDER]``; without a folder the pictures are thrown
away. With docs/images it makes those of docs/sensitivity.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import saleg
from saleg import sensitivity
from saleg.plotting import new_figure
from saleg.plotting import sensitivity as figures
from saleg.thesis.tables import TABLE_5


def main(folder: Path) -> None:
    base = saleg.machines.thesis_base()
    fixed = sensitivity.fix_load(base)

    # Any number of any engine: one row per value, failures included.
    table = sensitivity.vary(base, "ignition.b", [8454.5, 12e3, 16909.0, 20e3])
    print(table[["value", "relative", "status", "compression_ratio", "power"]].to_string())
    assert table["status"].tolist() == ["idling", "steady", "steady", "steady"]

    heat_transfer(base, fixed, folder)
    ignition(base, folder)
    heat_release(base, folder)
    load(base, folder)

    friction = sensitivity.friction_laws(fixed).table
    change = friction["stroke"].iloc[1] / friction["stroke"].iloc[0] - 1.0
    print(f"constant instead of viscous friction: stroke {100.0 * change:+.3f} %")
    assert abs(change) < 1e-3


def heat_transfer(base: saleg.Engine, fixed: saleg.Engine, folder: Path) -> None:
    """Figures 43 to 45."""
    figure, axes = page()
    parameters = sensitivity.hohenberg_parameters(base)
    figures.trends(parameters, ("frequency", "heat_transfer_share"), axes[0])
    laws = sensitivity.heat_transfer_laws(fixed)
    figures.pressure_time(laws, axes[1, 0])
    figures.heat_flow_time(laws, axes[1, 1])
    figure.savefig(folder / "sensitivity_heat_transfer.png", dpi=80)


def ignition(base: saleg.Engine, folder: Path) -> None:
    """Figures 46 to 52."""
    figure, axes = page()
    A, b = base.get("ignition.A"), base.get("ignition.b")
    factors = (0.01, 0.1, 1.0, 10.0, 100.0)
    figures.pressure_volume(
        sensitivity.study(base, "ignition.A", [factor * A for factor in factors]), axes[0, 0]
    )
    factors = (0.45, 0.5, 0.6, 0.8, 1.0, 1.2)
    temperature = sensitivity.study(base, "ignition.b", [factor * b for factor in factors])
    figures.velocity_position(temperature, axes[0, 1])
    figures.pressure_volume(temperature, axes[1, 0])
    figures.pressure_volume(sensitivity.equivalence_ratios(base), axes[1, 1])
    figure.savefig(folder / "sensitivity_ignition.png", dpi=70)

    figure, axes = page(rows=1)
    figures.pressure_volume(sensitivity.ignition_laws(base), axes[0, 0])
    figures.pressure_volume(sensitivity.retained_gas(base), axes[0, 1])
    figure.savefig(folder / "sensitivity_rcm.png", dpi=80)

    panels = figures.trends(sensitivity.cfr_parameters(base))
    panels[0].figure.savefig(folder / "sensitivity_cfr.png", dpi=80)


def heat_release(base: saleg.Engine, folder: Path) -> None:
    """Figures 53 to 57, and Table 5."""
    durations = sensitivity.release_durations(base)
    profiles = sensitivity.release_profiles(base)
    figure, axes = page()
    figures.velocity_position(durations, axes[0, 0])
    figures.pressure_volume(durations, axes[0, 1])
    figures.release_rates(profiles, axes[1, 0])
    figures.pressure_volume(profiles, axes[1, 1])
    figure.savefig(folder / "sensitivity_release.png", dpi=66)

    panels = figures.trends(durations.table, logarithmic=True)
    panels[0].figure.savefig(folder / "sensitivity_durations.png", dpi=80)

    for name, row in profiles.table.set_index("value").iterrows():
        off = {figure: row[figure] / printed - 1.0 for figure, printed in TABLE_5[name].items()}
        print(f"{name:20}", *(f"{figure} {100.0 * dev:+.1f} %" for figure, dev in off.items()))
        assert max(map(abs, off.values())) < 0.045, off


def load(base: saleg.Engine, folder: Path) -> None:
    """Figures 58 and 59."""
    gains = sensitivity.regulator_gains(base)
    figure, axes = page()
    figures.regulator_gains(gains, axes[0])
    targets = sensitivity.target_strokes(base)
    figures.velocity_position(targets, axes[1, 0])
    figures.trends(targets.table, ["power"], [axes[1, 1]])
    figure.savefig(folder / "sensitivity_load.png", dpi=72)
    # Between gains of 13 and 14 the regulated engine loses its stability.
    assert gains.set_index("value")["stable"].loc[[13.0, 14.0]].tolist() == [True, False]


def page(rows: int = 2):
    figure = new_figure(width=10.5, height=4.0 * rows)
    return figure, figure.subplots(rows, 2, squeeze=False)


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1] if len(sys.argv) > 1 else scratch))
