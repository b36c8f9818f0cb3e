"""Slips in a user's own law: one error each, by law, method and name, nothing compiled."""

import dataclasses
import functools
import math

import numba
import numpy as np
import pytest

import saleg
from saleg import LawError
from saleg.compiler.compiled_engine import check_methods
from saleg.compiler.diagnosis import diagnosed
from saleg.laws import LinearLoad, LinearSprings, ViscousFriction
from saleg.simulation.faulty_law import fault_near
from saleg.simulation.initial_state import prepare

COUNT = 0.0
LIST = [1.0]


def speed_of(motion):
    return motion.speed


def pair(x):
    return x, x


def positive(x):
    if x > 0.0:
        return x


def starred(method):
    @functools.wraps(method)
    def doubled(*shown):
        return 2.0 * method(*shown)

    return doubled


def law(force):
    """A spring law with that method, called Own.force in errors."""
    kind = type("Own", (LinearSprings,), {"force": force, "__module__": __name__})
    return dataclasses.dataclass(frozen=True)(kind)()


def undefined(self, motion):
    return -nothing * motion.x  # noqa: F821


def attribute(self, motion):
    return -motion.position


def own_attribute(self, motion):
    return -self.stifness * motion.x


def missing(self):
    return 1.0


def too_many(self, motion, more):
    return 1.0


def importing(self, motion):
    import math

    return math.sin(motion.x)


def one_branch(self, motion):
    if motion.x < 1.0:
        return -motion.x


def bare(self, motion):
    if motion.x < 1.0:
        return
    return 1.0


def nothing_at_all(self, motion):
    _ = motion.x


def a_tuple(self, motion):
    return -motion.x, 1.0


def text(self, motion):
    return "stiff"


def assigning(self, motion):
    self.stiffness = 3.0
    return -self.stiffness * motion.x


def counting(self, motion):
    global COUNT
    COUNT += 1.0
    return -motion.x


def listing(self, motion):
    LIST.append(motion.x)
    return -motion.x


def trying(self, motion):
    try:
        return math.sqrt(motion.x)
    except ValueError:
        return 0.0


def helper_attribute(self, motion):
    return speed_of(motion)


def helper_tuple(self, motion):
    return pair(motion.x)


def helper_nothing(self, motion):
    return positive(motion.x)


def unknown_function(self, motion):
    return math.sinus(motion.x)


def failing(self, motion):
    return 1.0 / 0.0


def drawing(self, motion):
    return -np.random.random() * motion.x  # noqa: NPY002


def naming(self, motion):
    if (x := motion.x) > 0.0:
        return -x
    return -motion.x


def deleting(self, motion):
    x = motion.x
    del x
    return -motion.x


def gathering(self, motion):
    x, *_ = motion.x, 1.0, 2.0
    return -x


def looking_up(self, motion):
    return -{1: 2.0}[1] * motion.x


def in_a_set(self, motion):
    return -motion.x if motion.direction in {-1.0, 1.0} else 0.0


def in_a_list(self, motion):
    a = [1.0, 2.0]
    return -a[0] * motion.x


SLIPS = [
    (in_a_list, "uses a list; write a tuple"),
    (naming, "':='.*assign it on a line before"),
    (deleting, "deletes a name"),
    (gathering, "gathers values"),
    (looking_up, "uses a dictionary"),
    (in_a_set, "uses a set; write a tuple"),
    (drawing, "draws random numbers"),
    (undefined, "uses 'nothing', which is not defined"),
    (attribute, "uses 'motion.position'.*Motion has t, x, v"),
    (own_attribute, "uses 'self.stifness'.*stiffness"),
    (missing, r"must take \(self, motion\)"),
    (too_many, r"must take \(self, motion\)"),
    (importing, "imports a module inside.*math"),
    (one_branch, "returns nothing where a branch ends"),
    (bare, "returns nothing"),
    (nothing_at_all, "returns nothing"),
    (a_tuple, "returns a tuple"),
    (text, "uses the text 'stiff'"),
    (assigning, "assigns to 'self.stiffness'"),
    (counting, "global.*COUNT"),
    (listing, "uses 'LIST', a list"),
    (trying, "tries"),
    (lambda self, motion: -motion.x, "must be written with 'def'"),
    (starred(attribute), "must be a plain argument"),
    (functools.lru_cache(attribute), "is a _lru_cache_wrapper.*decorator"),
    (property(attribute), "is a property.*decorator"),
    (classmethod(attribute), "is a method.*decorator"),
    (staticmethod(missing), r"must take \(self, motion\)"),
    (helper_attribute, "no attribute 'speed'"),
    (helper_tuple, r"returns \(.*\); it must return a number"),
    (helper_nothing, "calls 'positive', which returns nothing"),
    (unknown_function, "no attribute 'sinus'"),
    (failing, "ZeroDivisionError"),
]


@pytest.mark.parametrize(("force", "said"), SLIPS, ids=lambda item: getattr(item, "__name__", ""))
def test_a_slip_is_named(base, force, said):
    engine = base.replace(springs=law(force))
    for call in (lambda: saleg.simulate(engine, 0.1), lambda: saleg.steady_state(engine)):
        with pytest.raises(saleg.SalegError, match=rf"(?s)Own\.force\b.*{said}"):
            call()


def test_nothing_is_refused_where_nothing_is_compiled(monkeypatch):
    def printing(self, motion):
        print(motion.x)
        return -motion.x

    with pytest.raises(LawError, match="built-in 'print'"):
        check_methods([law(printing)])
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    check_methods([law(printing)])


def test_laws_that_look_alike_are_allowed(base):
    def nested(self, motion):
        k = self.stiffness
        while True:
            for _ in range(3):
                if motion.x > 1.0:
                    break
            if k > 0.0:
                return -2.0 * k * motion.x
            k += 1.0

    assert prepare(base.replace(springs=law(nested))).y.any()


@dataclasses.dataclass(frozen=True)
class TwoPowers(LinearLoad):
    def electrical_power(self, load_weight, motion):
        return pair(motion.v)


@dataclasses.dataclass(frozen=True)
class Speedy(LinearLoad):
    def electrical_power(self, load_weight, motion):
        return speed_of(motion)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        (TwoPowers, r"TwoPowers\.electrical_power returns UniTuple.*a number"),
        (Speedy, r"Speedy\.electrical_power cannot be compiled: Unknown attribute 'speed'"),
    ],
)
def test_what_numba_cannot_compile_is_named(kind, said):
    with pytest.raises(LawError, match=said):
        raise LawError(diagnosed([(kind, ())], ValueError("all together")))


@dataclasses.dataclass(frozen=True)
class NanBeyond(LinearSprings):
    def force(self, motion):
        return -2.0 * self.stiffness * motion.x if motion.x <= 0.0 else math.nan


@dataclasses.dataclass(frozen=True)
class Seizing(ViscousFriction):
    def force(self, memory, motion):
        return motion.v if memory < 2.0 else math.inf


@dataclasses.dataclass(frozen=True)
class NanWeight(LinearLoad):
    def at_dead_centre(self, load_weight, stroke):
        return math.nan


def test_a_law_that_gives_nan_is_named(base):
    state = prepare(base)
    state.y[0], state.y[1] = -1e-9, 10.0  # the last good state before the midpoint
    assert fault_near(base, *state.records, state.y) == ""
    nan = base.replace(springs=NanBeyond())
    assert fault_near(nan, *state.records, state.y).startswith("NanBeyond.force returns nan at")
    state.records[0].load_weight = math.nan
    said = fault_near(base.replace(alternator=NanWeight()), *state.records, state.y)
    assert said == "NanWeight.at_dead_centre returned nan"


def test_the_memory_a_law_is_not_finite_at_is_named(base):
    state = prepare(base)
    state.records[0].friction_held = 3.0
    said = fault_near(base.replace(friction=Seizing()), *state.records, state.y)
    assert said.startswith("Seizing.force returns inf at memory = 3, t = 0, x = ")
