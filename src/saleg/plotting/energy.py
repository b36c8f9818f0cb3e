"""Energy flows of a cycle, and a pie of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from saleg.errors import AxesError
from saleg.plotting.cycle import NoCycle, titled
from saleg.plotting.docstrings import documented
from saleg.plotting.overlay import sign
from saleg.plotting.style import ALTERNATOR_COLOUR, FRICTION_COLOUR, axes_or_new
from saleg.simulation.performance import EnergyBalance
from saleg.simulation.run import Run, is_orbit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from saleg.plotting.figure import ShownAxes
    from saleg.steady.state import SteadyState

#: Share of the fuel energy below which a flow is not drawn.
VISIBLE = 1e-3
#: Share of the fuel energy that may be left over in a balance that is drawn.
MAX_RESIDUAL = 0.01

FLOW_COLOURS = {
    "electrical output": ALTERNATOR_COLOUR,
    "alternator loss": "#7CC7B2",
    "friction": FRICTION_COLOUR,
    "exhaust": "#8A8F98",
    "heat transfer": "#CC6677",
    "unburnt fuel": "#B8A9C9",
    "stored energy": "#88B7D5",
    "stored fuel": "#C9BFA0",
    "port work": "#C0C4CA",
}


def energy_flows(balance: EnergyBalance) -> dict[str, float]:
    """Energy flows of a cycle by name [J]; what came from elsewhere than the fuel is negative.

    Parameters
    ----------
    balance : EnergyBalance

    Returns
    -------
    dict of str to float
        All terms of the balance. None is a difference: they add up to the fuel energy as well as
        the balance closes.
    """
    return {
        "electrical output": balance.electrical,
        "alternator loss": balance.alternator_loss,
        "friction": balance.friction,
        "mounts": balance.mounts,
        "exhaust": balance.exhaust,
        "heat transfer": balance.heat_transfer,
        "unburnt fuel": balance.unburnt,
        "stored energy": balance.stored,
        "stored fuel": balance.stored_fuel,
        "port work": -balance.port_work,
    }


def balance_of(run: Run | SteadyState) -> EnergyBalance:
    """The energy balance of the last full cycle, with fuel in it.

    Raises
    ------
    NoCycle
        If there is none, or if it does not close.
    """
    balance = run.energy
    if balance is None and isinstance(run, Run) and is_orbit(run):  # it ends as it began
        balance = EnergyBalance.between(run.strokes[-1], run.strokes)
    if balance is None:
        reason = "needs a full cycle and a stroke before it"
        raise NoCycle(f"no energy balance to draw: it {reason} ({run.message})")
    if balance.fuel <= 0.0:
        raise NoCycle("no energy balance to draw: the last full cycle had no fresh fuel")
    off = abs(balance.residual) / balance.fuel
    if not off <= MAX_RESIDUAL:
        raise NoCycle(
            f"no energy balance to draw: it is off by {100.0 * off:.2g} % of the fuel energy; "
            "try a smaller step or rtol"
        )
    return balance


def visible_flows(balance: EnergyBalance) -> dict[str, float]:
    """The flows that are large enough to be seen [J]."""
    least = VISIBLE * balance.fuel
    return {name: flow for name, flow in energy_flows(balance).items() if abs(flow) >= least}


def joules(energy: float) -> str:
    """An energy in words, to three digits or to the joule."""
    return f"{energy:.0f} J" if abs(energy) >= 100.0 else f"{energy:.3g} J"


def alone(ax: Axes) -> None:
    """Refuse axes on which something stands already: a balance shows one run.

    Raises
    ------
    AxesError
    """
    if ax.patches or ax.texts:
        raise AxesError("an energy balance shows one run: draw the other on axes of its own")


def named(title: str, label: str | None) -> str:
    """Title of a figure that shows one run alone, with the name of the run."""
    return f"{label}: {title[0].lower()}{title[1:]}" if label else title


@documented()
def energy_pie(run: Run, ax: Axes | None = None, *, label: str | None = None) -> ShownAxes:
    """Draw where the fuel's energy went in the last full cycle [%] (Figure 41 of the thesis).

    Raises
    ------
    NoCycle
        If the run completed no full cycle after its first stroke, if that had no fresh fuel or its
        balance does not close to 1 %, or if energy came from elsewhere than the fuel, which no pie
        can show.
    """
    balance = balance_of(run)
    flows = visible_flows(balance)
    gained = [name for name, flow in flows.items() if flow < 0.0]
    if gained:
        raise NoCycle(
            f"no pie can show a gain ({', '.join(gained)}): draw energy_sankey, or simulate until "
            "the engine runs steadily"
        )
    ax = axes_or_new(ax, 6.0, 4.0)
    alone(ax)
    wedges = ax.pie(
        list(flows.values()),
        colors=[FLOW_COLOURS[name] for name in flows],
        startangle=90.0,
        counterclock=False,
        wedgeprops={"edgecolor": "white", "linewidth": 1.2},
    )[0]
    # Names beside thin wedges would overprint each other.
    names = [f"{name} {100.0 * flow / balance.fuel:.1f} %" for name, flow in flows.items()]
    look: dict[str, Any] = {"fontsize": "small", "frameon": False, "loc": "center left"}
    ax.legend(wedges, names, bbox_to_anchor=(1.0, 0.5), **look)
    ax.set_anchor("E")  # beside the legend, which the layout makes room for, however wide the axes
    title = named(f"Fuel energy of a cycle: {joules(balance.fuel)}", label)
    ax.set_title(titled(run, title), fontsize="medium")
    sign(ax, run)
    return ax
