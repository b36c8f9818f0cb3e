"""Pictures of a cycle that a report draws by itself: phase portrait, forces, energy flows."""

from __future__ import annotations

from saleg.display.svg import GREEN, LEFT, RIGHT, YELLOW, Curve, chart, picture, tag, text
from saleg.plotting.energy import FLOW_COLOURS, joules, visible_flows
from saleg.plotting.overview import settled_time
from saleg.plotting.translator import BEHIND, INERTIA, forces_on
from saleg.simulation.performance import EnergyBalance
from saleg.simulation.readable import readable
from saleg.simulation.run import Run

#: Colours that are read on white and on black.
FORCE_COLOURS = {
    "gas left": LEFT,
    "gas right": RIGHT,
    "springs": YELLOW,
    "alternator": GREEN,
    "friction": "#B08A5B",
    BEHIND: "#C476A0",
    INERTIA: "currentColor",
}
FORCE = readable("spring_force", "N", "force to the right")
POSITION, VELOCITY = readable("x", "m"), readable("v", "m/s")
STROKE, TIME = readable("stroke", "m"), readable("t", "s")
#: Size of a picture of energy flows [px]: height of the fuel, gap between ends, width of the bar.
FUEL, GAP, BAR = 170.0, 26.0, 8.0
WIDTH, START, END, TOP = 340.0, 20.0, 190.0, 12.0


def phase_portrait(orbit: Run) -> str:
    """Velocity over position of a cycle."""
    history = orbit.history_rows
    assert history is not None
    loop = Curve(POSITION.of(history["x"]), VELOCITY.of(history["v"]), GREEN)
    return chart("phase portrait", [loop], POSITION.label, VELOCITY.label)


def forces(orbit: Run) -> str:
    """Forces on the translator over a cycle."""
    history = orbit.history
    assert history is not None
    time = 1e3 * (history["t"] - history["t"].iloc[0]).to_numpy()
    curves = [
        Curve(time, FORCE.of(force), FORCE_COLOURS[name], name, dashed=name == INERTIA)
        for name, force in forces_on(orbit.engine, history).items()
    ]
    size = (340.0, 262.0)
    return chart(
        "forces on the translator", curves, "time in the cycle [ms]", FORCE.label, size=size
    )


def course(run: Run) -> str:
    """Stroke of every cycle of a run until it is settled."""
    cycles = run.cycles
    end = (cycles["t"] + cycles["period"]).to_numpy()
    shown = end <= settled_time(run)
    stroke = cycles["stroke"].to_numpy()[shown]
    curve = Curve(TIME.of(end[shown]), STROKE.of(stroke), LEFT, points=len(stroke) < 40)
    return chart("stroke of every cycle", [curve], TIME.label, STROKE.label)


def energy_flows(balance: EnergyBalance) -> str:
    """Sankey diagram: what comes in on the left, where it goes on the right."""
    flows = visible_flows(balance)
    sources = {name: -flow for name, flow in flows.items() if flow < 0.0}
    uses = {name: flow for name, flow in flows.items() if flow > 0.0}
    scale = FUEL / balance.fuel
    parts, low, end = [], TOP + 0.5 * GAP * (len(uses) - 1), TOP
    for name, flow in uses.items():
        height = scale * flow
        parts.append(_ribbon(low, end, height, FLOW_COLOURS[name], name))
        share = f"{joules(flow)}, {100.0 * flow / balance.fuel:.1f} %"
        middle = end + 0.5 * height
        parts.append(text(END + 8.0, middle - 2.0, name))
        parts.append(text(END + 8.0, middle + 11.0, share, fill_opacity=0.75))
        low, end = low + height, end + height + GAP
    low = TOP + 0.5 * GAP * (len(uses) - 1)
    middle = low + 0.5 * scale * balance.fuel
    turned = f"rotate(-90 {START - 6.0:g} {middle:.1f})"
    words, look = f"fuel {joules(balance.fuel)}", {"text_anchor": "middle", "transform": turned}
    parts.append(text(START - 6.0, middle, words, **look))
    for name, flow in {"fuel": balance.fuel, **sources}.items():
        height, colour = scale * flow, FLOW_COLOURS.get(name, "currentColor")
        parts.append(tag("rect", x=START, y=low, width=BAR, height=height, fill=colour))
        low += height
    for name, flow in sources.items():
        end += 14.0
        words = f"with {joules(flow)} from: {name}"
        parts.append(text(START, end - 4.0, words, fill=FLOW_COLOURS[name]))
    return picture(WIDTH, end, "energy flows of a cycle", *parts)


def _ribbon(start: float, end: float, height: float, colour: str, name: str) -> str:
    """A band from its upper edge on the left to that on the right."""
    x, half = START + BAR, 0.5 * (START + BAR + END)
    edge = (
        f"M{x:g} {start:.1f}C{half:g} {start:.1f} {half:g} {end:.1f} {END:g} {end:.1f}"
        f"V{end + height:.1f}"
        f"C{half:g} {end + height:.1f} {half:g} {start + height:.1f} {x:g} {start + height:.1f}Z"
    )
    return tag("path", tag("title", name), d=edge, fill=colour, fill_opacity=0.85)
