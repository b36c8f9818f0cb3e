"""Cards of an engine and of what a run or a steady state of it gives."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from saleg.display.drawing import drawing
from saleg.display.numbers import inputs, number
from saleg.display.page import card, column, details, figures, raised
from saleg.display.svg import LEFT, RIGHT, Curve, chart, picture, tag, text
from saleg.simulation.readable import readable
from saleg.simulation.report import describe_validity, figure_rows, scavenging_rows

if TYPE_CHECKING:
    from saleg.engine import Engine
    from saleg.simulation.performance import EnergyBalance, Performance
    from saleg.simulation.run import Run
    from saleg.steady.stability import Stability
    from saleg.steady.state import SteadyState

#: Figures that are shown at once; the others open on demand.
KEY = (
    "power",
    "efficiency",
    "stroke",
    "compression_ratio",
    "frequency",
    "peak_pressure",
    "peak_temperature",
    "fuel_energy_per_cycle",
    "moving_mass",
)
PRESSURE, VOLUME = readable("p", "Pa"), readable("V", "m^3")


def engine_card(engine: Engine) -> str:
    """Inputs, laws and a drawing of an engine."""
    laws = engine.laws
    if engine.is_mirrored:
        laws = {
            slot.removeprefix("left."): law for slot, law in laws.items() if "right." not in slot
        }
    numbers = [
        (slot.replace("_", " ").replace(".", " "), "", repr(law)) for slot, law in laws.items()
    ]
    sides = "both sides alike" if engine.is_mirrored else "left | right where they differ"
    parts = figures(inputs(engine)), column(drawing(engine), details("laws", figures(numbers)))
    note = "cylinders to scale; rod, springs and alternator schematic"
    return card(engine.name, f"engine, {sides}", *parts, notes=[note])


def performance_card(performance: Performance) -> str:
    """All figures of a cycle."""
    rows = list(figure_rows(performance).values())
    half = -(-len(rows) // 2)
    return card("performance over one cycle", "", figures(rows[:half]), figures(rows[half:]))


def run_card(run: Run) -> str:
    """How a run ended, its key figures and its p-V loops."""
    told = f"run of {number(run.duration)} s: {run.status} - {run.message}"
    notes = describe_validity(run.validity, run.performance)
    parts = _cycle(run.performance, run.orbit, exchanged=scavenging_rows(run.scavenging))
    return card(run.engine.name, told, *parts, notes=notes)


def steady_card(found: SteadyState, added: Iterable[tuple[str, str, str]] = ()) -> str:
    """What was found, its key figures, stability and p-V loops; rows of a design are added."""
    told = f"steady state: {found.status} - {found.message}"
    rows = [*added]
    if found.has_multipliers:
        rows.append(("stability", found.stability.kind, ""))
    notes = describe_validity(found.validity, found.performance)
    exchanged = scavenging_rows(found.scavenging)
    parts = _cycle(found.performance, found.orbit, rows, exchanged)
    return card(found.engine.name, told, *parts, notes=notes)


def balance_card(balance: EnergyBalance) -> str:
    """Terms of an energy balance, and their shares of the fuel energy as bars."""
    terms = balance.to_dict()
    rows = [
        (
            name.replace("_", " "),
            f"{energy:.1e}" if 0.0 < abs(energy) < 1e-3 else number(energy),
            "J",
        )
        for name, energy in terms.items()
    ]
    used = ("electrical", "friction", "heat_transfer", "exhaust", "unburnt")
    shares = {
        name.replace("_", " "): terms[name] / balance.fuel for name in used if balance.fuel > 0.0
    }
    shares |= {"alternator loss": balance.alternator_loss / balance.fuel} if shares else {}
    return card("energy balance of one cycle", "", figures(rows), bars(shares) if shares else "")


def stability_card(stability: Stability) -> str:
    """What the multipliers mean, and their places beside the unit circle."""
    largest = float(np.abs(stability.multipliers).max(initial=0.0))
    rows = [
        ("largest multiplier", number(largest), ""),
        ("time constant", number(stability.time_constant), "s"),
        (
            "beat period",
            "-" if math.isinf(stability.beat_period) else number(stability.beat_period),
            "s",
        ),
    ]
    multipliers = stability.multipliers[np.isfinite(stability.multipliers)]
    angle = np.linspace(0.0, 2.0 * math.pi, 73)
    circle = Curve(np.cos(angle), np.sin(angle), "currentColor")
    dots = Curve(multipliers.real, multipliers.imag, RIGHT, points=True)
    plane = chart("multipliers", [circle, dots], "real part", "imaginary part", size=(230.0, 206.0))
    told = "multipliers of the cycle, and the unit circle: inside it disturbances die away"
    return card(f"stability: {stability.kind}", told, figures(rows), plane)


def bars(shares: dict[str, float]) -> str:
    """Shares by name as bars."""
    width, row = 340.0, 20.0
    longest = max((abs(share) for share in shares.values()), default=1.0) or 1.0
    parts = []
    for place, (name, share) in enumerate(shares.items()):
        y, length = row * place, 150.0 * abs(share) / longest
        parts.append(text(118, y + 14, name, text_anchor="end"))
        parts.append(tag("rect", x=124, y=y + 4, width=length, height=12, fill=LEFT))
        parts.append(text(130 + length, y + 14, f"{100.0 * share:.1f} %"))
    return picture(width, row * len(shares) + 4, "shares", *parts)


def _cycle(
    performance: Performance,
    orbit: Run | None,
    added: Sequence[tuple[str, str, str]] = (),
    exchanged: Sequence[tuple[str, str, str]] = (),
) -> list[str]:
    """Key figures of a cycle with all others to open, and its p-V loops."""
    rows = figure_rows(performance)
    others = [row for name, row in rows.items() if name not in KEY]
    numbers = figures([*(rows[name] for name in KEY), *added])
    more = [details("all figures", figures(others))]
    more += [details("gas exchange", figures(exchanged))] if exchanged else []
    parts = [column(numbers, *more)]
    return parts if orbit is None else [*parts, pressure_loops(orbit)]


def pressure_loops(orbit: Run) -> str:
    """Pressure over volume of both chambers; where they coincide, one through the other's gaps."""
    history = orbit.history
    if history is None:
        return ""
    loops = [
        Curve(
            VOLUME.of(history[f"V_{side}"].to_numpy()),
            PRESSURE.of(history[f"p_{side}"].to_numpy()),
            colour,
            side,
            dashed=side == "right",
        )
        for side, colour in (("left", LEFT), ("right", RIGHT))
        if side in orbit.engine.gas_sides
    ]
    labels = raised(VOLUME.label), PRESSURE.label
    return chart(f"p-V loops of {orbit.engine.name}", loops, *labels, from_zero=True)
