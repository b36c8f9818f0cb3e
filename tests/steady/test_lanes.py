"""Steady states of engines searched for side by side are those found one by one."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

import saleg
from agreement import assert_rows_agree
from breathing_engines import PORTS
from helpers import single_piston
from library_laws import LAWS
from saleg import Effort, Engine, laws
from saleg.engine.columns import rows_by_make
from saleg.laws import any_of, where
from saleg.laws.base import CHAMBER_SLOTS
from saleg.simulation.outcome import imbalance
from saleg.steady import lanes
from saleg.steady.many import Limits, searched, steady_rows

#: Measured from the begin of the run: another number of maps, another time. And the integral of the
#: magnitude of the force, which has a corner where the current changes its sign.
NOT_COMPARED = ("t", "ignition_time", "alternator_impulse")
FINE = 1e-9


@pytest.fixture
def at_once(monkeypatch):
    """Batches of any size are searched for side by side."""
    monkeypatch.setattr(lanes, "MANY", 1)
    monkeypatch.setattr(lanes, "WORTH_COMPILING", 1)


@dataclass(frozen=True)
class PatchyTransfer(laws.HeatTransfer):
    """Heat transfer of a user's that tells hot gas from cold."""

    hot: float = 900.0

    def coefficient(self, gas, charge):
        found, above = 300.0, gas.T - self.hot
        if any_of(above > 0.0):
            found = where(above > 0.0, 300.0 + 2e-4 * above**2, found)
        return found * where(gas.burning > 0.0, 1.5, 1.0)


@dataclass(frozen=True)
class FunctionsOfNumpy(laws.HeatTransfer):
    """Heat transfer of a user's by functions of numpy, and a power by a function of math."""

    def coefficient(self, gas, charge):
        warmth = gas.T / 1000.0
        rise = np.exp(-warmth) + np.log(1.0 + warmth) + np.arctan(warmth) + np.sin(warmth)
        return 200.0 * np.sqrt(rise) * math.pow(warmth, 0.3) * np.tanh(1.0 + warmth)


def uneven(base):
    """Other numbers on the left than on the right: whole cycles, of the laws of the base case."""
    changes = {"left.bore": 0.066, "right.equivalence_ratio": 0.45}
    return base.replace(**changes, **{"left.back_area": 2e-3, "left.back_pressure": 1e5})


def crossed(base):
    """Other laws on the left than on the right, the motored pressure and a current."""
    left = replace(base.left, heat_transfer=laws.Woschni(), heat_release=laws.DoubleWiebe())
    right = replace(base.right, heat_transfer=laws.Annand(), ignition=laws.SparkAtClearance())
    return replace(base, left=left, right=right, alternator=laws.CircuitAlternator())


def with_laws(base, *chosen):
    """The base case with other laws, those of a chamber on both sides."""
    for law in chosen:
        if law.slot in CHAMBER_SLOTS:
            left, right = (replace(side, **{law.slot: law}) for side in (base.left, base.right))
            base = replace(base, left=left, right=right)
        else:
            base = replace(base, **{law.slot: law})
    return base


def liftoff(base):
    """Springs that lift off, and much else."""
    return with_laws(
        base,
        laws.PreloadedSprings(stiffness=20e3, preload=500.0),
        laws.FluxProfile(load_constant=120.0),
        laws.RCMIgnitionPascal(),
        laws.Chang(),
        laws.ConstantGamma(),
    )


def breathing(base):
    """Ports on both sides, and a charged intake."""
    return base.replace(gas_exchange=PORTS, **{"intake.pressure": 1.4e5})


def breathing_on_one_side(base):
    """One cylinder with crankcase and leaking rings, before a tight gas spring."""
    cylinder = replace(
        breathing(base).left,
        supply=laws.Crankcase(volume_at_midpoint=6e-4, area=4e-3, reed=6e-4),
        leak=laws.RingLeak(gap=3e-7),
    )
    spring = saleg.BounceChamber(bore=0.064, half_stroke=0.1, pressure=2.5e5)
    return replace(single_piston(base), left=cylinder, right=spring)


def patchy(base):
    """A law of a user's."""
    return with_laws(base, PatchyTransfer())


def by_numpy(base):
    """Another."""
    return with_laws(base, FunctionsOfNumpy())


def variations(engine: Engine, count: int, spread: float = 0.03):
    """An engine with some numbers changed a little, in many ways."""
    rng = np.random.default_rng(5)
    paths = ("moving_mass", "bore", "equivalence_ratio", "intake.pressure")
    if not engine.is_mirrored:
        paths = ("moving_mass", "left.bore", "left.equivalence_ratio", "right.bore")
    for _ in range(count):
        changes = {
            path: engine.get(path) * rng.uniform(1.0 - spread, 1.0 + spread) for path in paths
        }
        yield engine.replace(**changes)


def orbits_of(engines, total, rtol=FINE):
    """Orbits of engines of one make, in a batch of so many."""
    (rows,) = rows_by_make(engines)
    (found,) = steady_rows(rows, rtol, Effort.THOROUGH, total)
    return found


def assert_lanes_agree(engines, but=NOT_COMPARED):
    """Engines searched for side by side have the orbits they have one by one; how many have one."""
    (rows,) = rows_by_make(engines)
    totals = len(engines), 0
    pairs = zip(*(steady_rows(rows, FINE, Effort.THOROUGH, total) for total in totals), strict=True)
    count = 0
    for found, wanted in pairs:
        np.testing.assert_array_equal(found.rows.places, wanted.rows.places)
        count += len(found.strokes)
        for side in range(2):
            rows, others = found.strokes[:, side], wanted.strokes[:, side]
            assert_rows_agree(rows, others, 1e-8, but=but)
        assert imbalance(found.strokes[:, 1], found.strokes).max() < 1e-8
        for name in ("x_dead_centre", "stroke"):
            begun, others = found.starts.engine[name], wanted.starts.engine[name]
            np.testing.assert_allclose(begun, others, rtol=1e-8)
    return count


def test_lanes_find_what_one_by_one_finds(base, at_once):
    assert assert_lanes_agree(list(variations(base, 500, spread=0.1))) > 490
    assert assert_lanes_agree(list(variations(uneven(base), 12))) == 12


def test_lanes_find_what_breathing_engines_do_one_by_one(base, at_once):
    engines = list(variations(breathing(base), 20))
    assert assert_lanes_agree(engines) == 20


def on_a_line(engine, count):
    """An engine with equivalence ratios one after the other."""
    paths = ["equivalence_ratio"] if engine.is_mirrored else ["right.equivalence_ratio"]
    least = 0.8 * engine.get(paths[0])
    return [engine.replace(**{paths[0]: ratio}) for ratio in np.linspace(least, 1.2 * least, count)]


@pytest.mark.parametrize("choice", [lambda base: base, uneven], ids=["halves", "whole cycles"])
def test_rows_along_a_line_are_found_in_lanes_as_one_by_one(base, at_once, choice):
    engines = on_a_line(choice(base), 40)
    assert assert_lanes_agree(engines) == 40
    own = orbits_of(engines, 0).half_cycles.sum()
    assert orbits_of(engines, 40).half_cycles.sum() < 0.6 * own


@pytest.mark.long
@pytest.mark.parametrize("choice", [crossed, single_piston, liftoff, patchy, by_numpy])
def test_lanes_of_other_laws_too(base, at_once, choice):
    assert assert_lanes_agree(list(variations(choice(base), 12))) > 6


@pytest.mark.long
def test_lanes_of_single_piston_engines_that_breathe(base, at_once):
    engines = list(variations(breathing_on_one_side(base), 12))
    assert assert_lanes_agree(engines) > 6


@pytest.mark.long
@pytest.mark.parametrize(
    "law", [law for law in LAWS if not {"wall_temperature", "frame"} & {*law.states}], ids=repr
)
def test_lanes_of_every_law_of_the_library(base, at_once, law):
    engines = list(variations(with_laws(base, law), 12))
    assert_lanes_agree(engines)


def test_rows_do_not_depend_on_their_neighbours(base, at_once):
    engines = [*variations(base, 11), base.replace(equivalence_ratio=0.0), base.replace(bore=0.02)]
    table = saleg.steady_states(engines, workers=1)
    again = saleg.steady_states(engines[::-1], chunk=5, workers=2)[::-1].reset_index(drop=True)
    assert set(table.status) > {"steady"}
    for name in table:
        np.testing.assert_array_equal(table[name].to_numpy(), again[name].to_numpy(), err_msg=name)


@pytest.mark.parametrize("choice", [lambda base: base, breathing], ids=["plain", "breathing"])
def test_what_is_no_number_harms_no_other(base, at_once, choice):
    (rows,) = rows_by_make(list(variations(choice(base), 9)))
    limits = Limits(100, 100_000, 100.0)

    def spoil(states, ready):
        states.y[4] = np.nan

    whole = searched(rows, True, 1e-6, limits, 9)
    found = searched(rows, True, 1e-6, limits, 9, spoil)
    kept = whole.rows.places != 4
    assert 4 in whole.rows.places
    np.testing.assert_array_equal(found.rows.places, whole.rows.places[kept])
    np.testing.assert_array_equal(found.strokes, whole.strokes[kept])


def test_a_law_that_cannot_be_compiled_for_several_is_calculated_one_by_one(
    base, at_once, monkeypatch
):
    def refuse(*_):
        raise saleg.LawError("the law branches on the gas")

    monkeypatch.setattr(lanes, "address_of_steps", refuse)
    lanes._refused.cache_clear()
    engines = list(variations(base, 9))
    found, wanted = orbits_of(engines, 9, rtol=1e-6), orbits_of(engines, 0, rtol=1e-6)
    np.testing.assert_array_equal(found.strokes, wanted.strokes)
    lanes._refused.cache_clear()


def test_few_engines_never_wait_for_another_kernel(base, monkeypatch):
    monkeypatch.setattr(lanes, "kernel_of_lanes", None)  # not to be called
    assert len(orbits_of(list(variations(base, 3)), lanes.MANY - 1, rtol=1e-6).strokes) == 3


@pytest.mark.long
@pytest.mark.parametrize("choice", [variations, on_a_line])
def test_results_do_not_depend_on_the_width(base, at_once, monkeypatch, choice):
    engines = list(choice(base, 9))
    wanted = orbits_of(engines, 9, rtol=1e-6)
    monkeypatch.setattr(lanes.find_each, "__defaults__", (3,))
    found = orbits_of(engines, 9, rtol=1e-6)
    np.testing.assert_array_equal(found.strokes, wanted.strokes)


@pytest.mark.long
def test_a_user_is_told_once_that_a_law_branches(base, at_once):
    @dataclass(frozen=True)
    class Branching(laws.HeatTransfer):
        def coefficient(self, gas, charge):
            return 400.0 if gas.T > 900.0 else 300.0

    engines = list(variations(with_laws(base, Branching()), 9))
    with pytest.warns(RuntimeWarning, match="Branching are searched for one by one.*where"):
        found = orbits_of(engines, 9, rtol=1e-6)
    assert len(found.strokes) > 6
    assert len(orbits_of(engines, 9, rtol=1e-6).strokes) == len(found.strokes)
