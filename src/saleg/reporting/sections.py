"""Sections of a report, each HTML."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from html import escape

from saleg.display.cards import KEY, pressure_loops, stability_card
from saleg.display.drawing import drawing
from saleg.display.numbers import inputs, number, shown
from saleg.display.page import details, figures
from saleg.errors import SalegError
from saleg.plotting.cycle import NoCycle
from saleg.plotting.energy import balance_of
from saleg.reporting import charts
from saleg.reporting.subject import Subject
from saleg.simulation.nearest import NearestMachine
from saleg.simulation.readable import readable
from saleg.simulation.report import describe_exits, figure_rows, scavenging_rows
from saleg.simulation.run import Run
from saleg.studies.elasticities import elasticities

#: Colours of an elasticity of +1 and of -1, and the elasticity of the full colour.
MORE, LESS, FULL = "224, 116, 44", "43, 143, 214", 1.5


def sections(subject: Subject) -> Iterator[str]:
    """All sections of a report, in order."""
    yield head(subject)
    yield key_figures(subject)
    yield machine(subject)
    yield cycle(subject)
    yield gas_exchange(subject)
    yield stability(subject)
    yield sensitivity(subject)
    yield validity(subject)


def section(title: str, *parts: str) -> str:
    """A section with a title (text) and parts (HTML)."""
    return f"<section><h2>{escape(title)}</h2>{''.join(parts)}</section>"


def paragraph(words: str, kind: str = "") -> str:
    """A paragraph (text)."""
    return f'<p class="{kind}">{escape(words)}</p>' if kind else f"<p>{escape(words)}</p>"


def drawn(svg: str, caption: str, kind: str = "") -> str:
    """A picture with its caption (text)."""
    return f'<figure class="{kind}">{svg}<figcaption>{escape(caption)}</figcaption></figure>'


def head(subject: Subject) -> str:
    """Name of the engine, what was done, how it ended, and the settings."""
    result = subject.result
    what = f"run of {number(result.duration)} s" if isinstance(result, Run) else "steady state"
    settings = ", ".join(
        f"{name.replace('_', ' ')} {_setting(value)}"
        for name, value in subject.settings.items()
        if value is not None
    )
    told = [f"{what}: {subject.status} - {result.message}"]
    told += [f"settings: {settings}"] if settings else []
    lines = paragraph(told[0]) + "".join(paragraph(line, "faint") for line in told[1:])
    return f"<header><h1>{escape(subject.engine.name)}</h1>{lines}</header>"


def _setting(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)


def key_figures(subject: Subject) -> str:
    """Figures of the cycle, the key ones first."""
    rows = figure_rows(subject.performance)
    key = figures(rows[name] for name in KEY)
    others = figures(row for name, row in rows.items() if name not in KEY)
    return section("Key figures", f'<div class="grid">{key}{others}</div>')


def machine(subject: Subject) -> str:
    """Section, inputs and laws of the engine."""
    engine = subject.engine
    laws = [
        (slot.replace(".", " ").replace("_", " "), repr(law)) for slot, law in engine.laws.items()
    ]
    listed = "".join(f"<li>{escape(slot)}: {escape(law)}</li>" for slot, law in laws)
    note = "cylinders to scale, translator at its midpoint; rod, springs and alternator schematic"
    try:
        file = details("engine file", f"<pre>{escape(engine.to_toml())}</pre>")
    except SalegError:  # a law of the user's own that no file can name
        file = ""
    picture, numbers = drawn(drawing(engine), note, "wide"), figures(inputs(engine))
    return section("Engine", picture, numbers, details("laws", f"<ul>{listed}</ul>"), file)


def cycle(subject: Subject) -> str:
    """Pictures of the last cycle."""
    orbit = subject.orbit
    if orbit is None:
        return section("Cycle", paragraph(f"no full cycle to draw: {subject.result.message}"))
    pictures = [
        drawn(pressure_loops(orbit), "p-V diagram"),
        drawn(charts.phase_portrait(orbit), "phase portrait of the translator"),
        drawn(charts.forces(orbit), "forces on the translator, positive to the right"),
    ]
    try:
        flows = charts.energy_flows(balance_of(subject.result))
        pictures.append(drawn(flows, "energy flows of the cycle, in parts of the fuel energy"))
        missing = ""
    except NoCycle as error:
        missing = paragraph(str(error), "faint")
    if isinstance(subject.result, Run) and len(subject.result.cycles) > 1:
        pictures.append(
            drawn(
                charts.course(subject.result),
                "course of the run until it is settled: stroke of every cycle",
            )
        )
    return section("Cycle", f'<div class="grid pictures">{"".join(pictures)}</div>', missing)


def gas_exchange(subject: Subject) -> str:
    """Figures of the gas exchange; nothing for an engine through whose ports no gas flows."""
    rows = scavenging_rows(subject.result.scavenging)
    if not rows:
        return ""
    told = "left | right where the sides differ; masses over a charge at the state of the intake"
    return section("Gas exchange", figures(rows), paragraph(told, "faint"))


def stability(subject: Subject) -> str:
    """What becomes of small disturbances of the steady state."""
    steady = subject.steady
    if not steady.found or not steady.has_multipliers:
        return section("Stability", paragraph(f"no steady state to examine: {steady.message}"))
    of = paragraph("of the steady state of this engine", "faint") if subject.is_run else ""
    return section(
        "Stability", of, f'<figure class="small">{stability_card(steady.stability)}</figure>'
    )


def sensitivity(subject: Subject) -> str:
    """Elasticities of the main figures."""
    if not subject.steady.found:
        return section("Sensitivity", paragraph("no steady state to vary"))
    table = elasticities(subject.engine)
    names = [readable(str(name), "-").words for name in table.columns]
    heads = "".join(f"<th>{escape(name)}</th>" for name in ["", *names])
    rows = "".join(
        f"<tr><th>{escape(shown(str(path), '-', 0.0)[0])}</th>{''.join(map(_heat, values))}</tr>"
        for path, values in zip(table.index, table.to_numpy(dtype=float), strict=True)
    )
    told = (
        "change of a figure in percent where an input grows by one percent: from steady states "
        "with each input 1 % greater and 1 % smaller (temperatures are absolute)"
    )
    heat = f'<table class="heat"><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>'
    return section("Sensitivity", paragraph(told, "faint"), heat)


def _heat(value: float) -> str:
    """Cell of an elasticity, the stronger the more it is."""
    if math.isnan(value):
        return "<td>-</td>"
    depth = 0.75 * min(abs(value) / FULL, 1.0)
    colour = f"rgba({MORE if value > 0.0 else LESS}, {depth:.2f})"
    words = f"{value:+.2f}" if abs(value) >= 0.005 else "0.00"
    return f'<td style="background: {colour}">{words}</td>'


def validity(subject: Subject) -> str:
    """Where the engine, its laws and its figures leave what is known, and what supports them."""
    found = subject.result.validity
    figures_beyond = [
        str(one) if math.isnan(one.limit) else f"{one}: {one.reason}" for one in found.implausible
    ]
    parts = [
        listed("Laws outside their ranges", describe_exits(found.range_exits)),
        listed("Figures beyond what is built", figures_beyond),
        listed("Unusual numbers of the engine", map(str, subject.engine.unusual())),
    ]
    if not any(parts):
        parts = [paragraph("All laws were inside their ranges, and no figure is implausible.")]
    if found.nearest is not None and subject.performance.frequency > 0.0:
        parts.append(support(found.nearest))
    always = (
        "The gas is ideal with a charge of one zone. No measured trace stands behind these "
        "numbers; some constants were fitted to the tables of a dissertation (docs/validity.md)."
    )
    return section("Validity", *parts, paragraph(always, "faint"))


def support(nearest: NearestMachine) -> str:
    """What the nearest published machine supports, and our deviations from its results."""
    off = [
        f"{name}: {nearest.whose} is {100.0 * part:+.1f} % off"
        for name, part in nearest.deviations.items()
    ]
    told = f"Nearest is {nearest.name}, {nearest.kind}. "
    if nearest.differences:
        told += (
            f"This engine is not like it: {'; '.join(nearest.differences)}. It supports nothing."
        )
    else:
        told += f"It supports {', '.join(nearest.supported) or 'nothing'}."
    title = "Support by a published machine"
    return f"<h3>{title}</h3>" + paragraph(told) + listed("", off)


def listed(title: str, items: Iterable[str]) -> str:
    """Items (text) as a list under a title (text); nothing without items."""
    inside = "".join(f"<li>{escape(item)}</li>" for item in items)
    head = f"<h3>{escape(title)}</h3>" if title else ""
    return f"{head}<ul>{inside}</ul>" if inside else ""
