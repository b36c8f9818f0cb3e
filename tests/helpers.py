"""Shared by the tests: engines with a closed-form solution, and one cycle at given settings."""

import dataclasses
import math
import re
from pathlib import Path

import numpy as np

from saleg import BounceChamber, Engine, Translator, sweep
from saleg.engine.start import CompressedCharge
from saleg.laws import ConstantGamma, LinearLoad, LinearSprings, ViscousFriction
from saleg.laws.control.base import LoadControl
from saleg.simulation.course import Course
from saleg.simulation.initial_state import prepare
from saleg.simulation.settings import Detail, Settings

#: The project, and the tables of the dissertation.
ROOT = Path(__file__).resolve().parent.parent
TABLES = ROOT / "src" / "saleg" / "thesis" / "data"
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language, text=README):
    """Code blocks of a language in a page of Markdown."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)


def bounce_engine(
    *, mass=2.0, stiffness=0.0, pressure=1e5, gamma=1.4, bore=0.06, length=0.1, position=-0.8
):
    """Two adiabatic gas springs and linear springs; no load, no friction, starts at rest."""
    chamber = BounceChamber(
        bore=bore,
        half_stroke=length,
        pressure=pressure,
        gas_properties=ConstantGamma(value=gamma),
    )
    return Engine.mirrored(
        Translator(mass=mass),
        chamber,
        springs=LinearSprings(stiffness=stiffness),
        friction=ViscousFriction(0.0),
        alternator=LinearLoad(load_constant=0.0, regulator_gain=0.0),
        start=CompressedCharge(position=position, burning=0.0),
    )


def single_piston(base, *, mass=2.4, length=0.15, pressure=4e5, bore=0.064, cylinder=None, **load):
    """The cylinder of the base case opposite an adiabatic bounce chamber."""
    return Engine(
        translator=Translator(mass=mass),
        left=base.left if cylinder is None else cylinder,
        right=BounceChamber(bore=bore, half_stroke=length, pressure=pressure),
        springs=LinearSprings(stiffness=20e3),
        alternator=LinearLoad(**{"load_constant": 30.0, **load}),
    )


def strokes_from_start(engine, count=2, **settings):
    """The first strokes of an engine and the state after them."""
    state = prepare(engine)
    asked, detail = Settings(10.0, **settings), Detail(peaks=2, last_stroke=float(count))
    return Course(engine, state, asked, detail=detail).finish(), state


def cycle_figures(engine, **settings):
    """Figures of the first cycle that depend on all of the model."""
    run, state = strokes_from_start(engine, 2, **settings)
    assert len(run.strokes) == 2
    strokes = run.strokes
    return np.array(
        [
            run.duration,
            state.y[0],
            strokes["x_end"][0],
            strokes["electrical_energy"].sum(),
            strokes["heat_lost"].sum(),
            state.y[2],
        ]
    )


def area(bore):
    return math.pi * bore**2 / 4.0


#: Inputs of a sweep of six designs.
SMALL_SWEEP = {"bore": [0.060, 0.062, 0.064], "egr": [0.1, 0.2]}


def swept_line(name, low, high, count=25):
    """A sweep of one input around the base case."""
    return sweep.run(sweep.grid({name: np.linspace(low, high, count)}))


def rises(values):
    return bool((np.diff(values) > 0.0).all())


def falls(values):
    return bool((np.diff(values) < 0.0).all())


def border(table, name):
    """Where the largest multiplier passes one, by linear interpolation in its logarithm."""
    x, y = table[name].to_numpy(), np.log(table.largest_multiplier.to_numpy())
    at = np.flatnonzero(np.sign(y[1:]) != np.sign(y[:-1]))
    assert len(at) == 1
    i = at[0]
    return x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i])


def compiled_method(law, method):
    """A method of a law as the kernel has it, of the arguments after ``self``."""
    import math

    import numba
    import numpy as np

    from saleg.compiler.records import record_of
    from saleg.compiler.slot_text import methods_text

    names = {"math": math, "np": np, "inline": numba.njit(error_model="numpy")}
    base = next(kind for kind in type(law).__mro__ if "slot" in vars(kind))
    exec("\n".join(methods_text(type(law), method, "one", base, names)), names)
    record = np.zeros(1, record_of(law))[0]
    for name in record.dtype.names:
        record[name] = getattr(law, name, 0.0)
    return lambda *arguments: names[f"one_{method}"](record, *arguments)


@dataclasses.dataclass(frozen=True)
class Asserting(LoadControl):
    """Fails by an assertion after a while; in a test file pytest would have written it anew."""

    def weight(self, memory, signals):
        assert signals.t < 0.1
        return 1.0
