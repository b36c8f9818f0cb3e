"""One test over all laws of a slot: a new law needs a line in LAWS of library_laws.py."""

import dataclasses
import itertools
import math

import numba
import numpy as np
import pytest

from library_laws import LAWS
from saleg import laws
from saleg.compiler.imported_text import NoSource
from saleg.compiler.records import numbers_of, record_of
from saleg.compiler.slot_text import methods_text
from saleg.compiler.source import Borrowed
from saleg.compiler.strength_reduction import EXPONENTIAL
from saleg.compiler.text import CHOICE
from saleg.kernel.logarithms import Logarithms
from saleg.laws import Charge, Gas, Motion, Parts, Stroke
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS, Law
from saleg.quantities import problems

GASES = [
    Gas(p, T, V, 0.7 * p, 0.03, 0.064, speed, 550.0, burning, -3.0, 1e9)
    for p, T, V, speed, burning in (
        (1e5, 300.0, 4e-4, 0.0, 0.0),
        (50e5, 1500.0, 1e-4, 5.0, 0.0),
        (200e5, 2700.0, 2e-5, 20.0, 1.0),
        (3e4, 180.0, 1e-6, 60.0, 0.0),
    )
]
PARTS = Parts(1.5e-5, 4.3e-4, 5.5e-5)
CHARGE = Charge(5e-4, 1.5e-5, 4.3e-4, 5.5e-5, 0.6, 1.05e5, 325.0, 4.3e-4, 5.8e-4)
MOTIONS = [
    Motion(0.1, x, v, d, i)
    for x, v, d, i in ((0.05, 3.0, 1.0, 2.0), (-0.08, -9.0, -1.0, -7.0), (0, 0, 1, 0.1))
]
STROKES = [
    Stroke(0.18, 0.0106, 0.2, 0.1, 0.0032, 1400.0, 3.4),
    Stroke(0.02, 0.1, 0.2, 0.1, 0.0032, 0.0, 0.001),
]
BASES = {**CHAMBER_SLOTS, **ENGINE_SLOTS}

#: Arguments each method is tried with.
ARGUMENTS = {
    "gamma": [(T,) for T in (150.0, 300.0, 1000.0, 2500.0, 3500.0)],
    "internal_energy": [(T,) for T in (150.0, 300.0, 1000.0, 2500.0, 3500.0)],
    "breakpoint": [()],
    "heat_capacity_of": [(T, PARTS) for T in (150.0, 300.0, 1000.0, 2500.0)],
    "energy_of": [(T, PARTS) for T in (150.0, 300.0, 1000.0, 2500.0)],
    "coefficient": [(gas, CHARGE) for gas in GASES],
    "duration": [(gas, CHARGE) for gas in GASES],
    "rate": [(gas, CHARGE) for gas in GASES],
    "burn_rate": [(u,) for u in (0.0, 0.1, 0.5, 1.0)],
    "burnt_fraction": [(u,) for u in (0.0, 0.1, 0.5, 1.0)],
    "charge": [(5e-4, 1e-6, 2e-4, 3e-4, 0.6, 17.5), (5e-4, 4e-5, 4e-4, 6e-5, 0.0, 17.5)],
    "areas": [(opening,) for opening in (-0.01, 0.0, 0.006, 0.03)],
    "exhaust": [()],
    "share": [(gas, CHARGE) for gas in GASES],
    "fresh_share": [(share,) for share in (-1e-9, 0.0, 0.4, 1.0)],
    "area": [(gas,) for gas in GASES],
    "beyond": [()],
    "fuel_state": [()],
    "volume": [(displacement,) for displacement in (-0.05, 0.0, 0.08)],
    "piston_area": [()],
    "inlet_area": [(rise,) for rise in (-1e3, 0.0, 1e3, 1e5)],
    "acceleration": [(force, 0.01, -2.0) for force in (-1e4, 0.0, 300.0)],
    "transmitted": [(force, 0.01, -2.0) for force in (-1e4, 0.0, 300.0)],
    "loss": [(v,) for v in (-2.0, 0.0, 0.5)],
    "fuel_factor": [(number, side) for number in (0.0, 1.0, 7.0) for side in (0.0, 1.0)],
    "delay_factor": [(number, side) for number in (0.0, 1.0, 7.0) for side in (0.0, 1.0)],
    "duration_factor": [(number, side) for number in (0.0, 1.0, 7.0) for side in (0.0, 1.0)],
    "temperature_rate": [(450.0, heat) for heat in (-20.0, 0.0, 800.0)],
    "energy": [(motion,) for motion in MOTIONS],
    "happens": [(number,) for number in (0.0, 1.0, 2.0, 7.0)],
    "lights_at_dead_centre": [(CHARGE,)],
    "current_rate": [(weight, motion) for weight in (0.0, 1.1) for motion in MOTIONS],
    "electrical_power": [(weight, motion) for weight in (0.0, 1.1) for motion in MOTIONS],
    "at_dead_centre": [(memory, stroke) for memory in (-1.0, 0.0, 9.0) for stroke in STROKES],
}


def arguments(law, method):
    if method == "force":
        memory = () if law.slot == "springs" else (1.05,)
        return [(*memory, motion) for motion in MOTIONS]
    if method == "next_breakpoint":
        if law.slot == "heat_release":
            return [(u,) for u in (-1e-9, 0.0, 0.3, 0.5, 1.0)]
        return [(x, direction) for x in (-0.1, 0.0, 0.02, 0.1) for direction in (1.0, -1.0)]
    if (law.slot, method) == ("frame", "energy"):
        return [(0.01, -2.0), (0.0, 0.0)]
    return ARGUMENTS[method]


CASES = [
    pytest.param(law, method, id=f"{type(law).__name__}.{method}")
    for law in LAWS
    for method in law.compiled
]


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (laws.DoubleWiebe(premixed_end=0.4, diffusion_start=0.1), [0.1, 0.4]),
        (laws.DoubleWiebe(), [0.3]),
        (laws.BurnProfile(times=(0.0, 0.2, 1.0), fractions=(0.0, 0.5, 1.0)), [0.0, 0.2]),
        (laws.Wiebe(), []),
    ],
)
def test_breakpoints_of_burn_rates(law, expected):
    found, u = [], -1e-9
    while (u := law.next_breakpoint(u)) < 1.0:
        found.append(u)
    assert found == expected


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (laws.ProgressiveSprings((0.0, 0.05), (3e4, 4e4)), [-0.05, 0.0, 0.05]),
        (laws.PreloadedSprings(stiffness=2e4, preload=1e3), [-0.05, 0.05]),
        (laws.PreloadedSprings(stiffness=0.0), []),
        (laws.EndStops(gap=0.09), [-0.09, 0.09]),
        (laws.OneSidedSprings(left_contact=0.02, right_contact=-0.03), [-0.03, 0.02]),
        (laws.AirSprings(), []),
        (laws.ForceMap(positions=(-0.02, 0.03), forces=(-1.0, 1.0) * 2), [-0.02, 0.03]),
        (laws.LinearSprings(), []),
        (laws.LinearLoad(), []),
    ],
)
def test_breakpoints_of_forces(law, expected):
    for direction, wanted in ((1.0, expected), (-1.0, expected[::-1])):
        found, x = [], -direction
        while abs(x := law.next_breakpoint(x, direction)) < 1.0:
            found.append(x)
        assert found == pytest.approx(wanted, abs=1e-15)


def test_every_exported_law_is_listed():
    exported = {
        item
        for item in vars(laws).values()
        if isinstance(item, type) and issubclass(item, Law) and dataclasses.is_dataclass(item)
    }
    exported = {item for item in exported if item.slot in BASES}  # a controller's: test_control.py
    assert {type(law) for law in LAWS} == exported


@pytest.mark.parametrize(
    "law", [law for law in LAWS if law.mirrors], ids=lambda law: type(law).__name__
)
def test_laws_that_mirror_are_odd(law):
    """What a class says of itself spares the search for steady states to try it out."""
    for motion in MOTIONS:
        seen = Motion(motion.t, -motion.x, -motion.v, -motion.direction, -motion.current)
        if law.slot == "frame":
            there, here = law.acceleration(3.0, motion.x, motion.v), (-3.0, seen.x, seen.v)
            assert law.acceleration(*here) == -there
            assert law.energy(*here[1:]) == law.energy(motion.x, motion.v)
            continue
        memory = () if law.slot == "springs" else (1.05,)
        assert law.force(*memory, seen) == -law.force(*memory, motion)


def compiled(law, method):
    """The method alone, compiled as the composer writes it, and the law's record."""
    names = {"math": math, "np": np, "inline": numba.njit(error_model="numpy")}
    text = "\n".join([CHOICE, *methods_text(type(law), method, "one", BASES[law.slot])])
    exec(text, names)
    record = np.array(numbers_of([law])).view(record_of(law))
    return names[f"one_{method}"], record[0]


@pytest.mark.parametrize(("law", "method"), CASES)
def test_python_face_equals_compiled_face(law, method):
    function, record = compiled(law, method)
    for given in arguments(law, method):
        expected = getattr(law, method)(*given)
        assert function(record, *given) == pytest.approx(expected, rel=1e-13, abs=1e-300)


EASED = [case for case in CASES if case.values[1] in BASES[case.values[0].slot].at_every_step]


@pytest.mark.parametrize(("law", "method"), EASED)
def test_eased_face_equals_python_face(law, method):
    """Merged powers and remembered factors change nothing but rounding."""
    names = {"math": math, "np": np, "inline": numba.njit(error_model="numpy")}
    names[EXPONENTIAL] = math.exp
    text = "\n".join([CHOICE, *methods_text(type(law), method, "one", BASES[law.slot], eases=True)])
    exec(text, names)
    record = np.array(numbers_of([law])).view(record_of(law))[0]
    for gas in GASES:
        constants = names[f"one_{method}_constants"](record, gas, CHARGE)
        logarithms = Logarithms(math.log(gas.p), math.log(gas.T), math.log(gas.V), *constants)
        found = names[f"one_{method}"](record, gas, CHARGE, logarithms)
        assert found == pytest.approx(getattr(law, method)(gas, CHARGE), rel=1e-12, abs=1e-300)


@pytest.mark.parametrize(("law", "method"), CASES)
def test_values_are_finite(law, method):
    """Infinite may be the next breakpoint alone, where none comes."""
    for given in arguments(law, method):
        value = getattr(law, method)(*given)
        none_comes = method == "next_breakpoint" and abs(value) == math.inf
        assert none_comes or np.isfinite(value).all()


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_every_field_has_a_unit_and_a_default_in_range(law):
    assert all(item.metadata["limits"].unit for item in dataclasses.fields(law))
    assert problems(law) == []
    assert problems(type(law)()) == []


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_every_law_says_where_it_comes_from(law):
    text = type(law).__doc__
    assert text
    for item in dataclasses.fields(law):
        assert item.name in text, f"{item.name} is not documented"


def of_slot(name):
    return pytest.mark.parametrize(
        "law", [law for law in LAWS if law.slot == name], ids=lambda law: type(law).__name__
    )


@of_slot("gas_properties")
def test_internal_energy_is_the_integral_of_heat_capacity(law):
    """Against scipy's adaptive quadrature, from either side of the hold at 2500 K."""
    from scipy.integrate import quad

    for low, high in ((300.0, 2200.0), (250.0, 300.0), (2400.0, 2500.0), (2500.0, 3000.0)):
        heat = quad(
            lambda T: law.gas_constant / (law.gamma(T) - 1.0), low, high, epsabs=1e-9, epsrel=1e-13
        )[0]
        difference = law.internal_energy(high) - law.internal_energy(low)
        assert difference == pytest.approx(heat, rel=1e-11)


@of_slot("gas_properties")
def test_ratio_of_heats_is_above_one(law):
    assert all(1.0 < law.gamma(T) < 1.7 for T in np.linspace(100.0, 4000.0, 100))


@of_slot("heat_transfer")
def test_heat_flows_from_hot_to_cold(law):
    if isinstance(law, laws.PolytropicLoss):  # its exponents say which way, not the wall
        return
    assert all(law.coefficient(gas, CHARGE) >= 0.0 for gas in GASES)


def test_polytropic_loss_makes_the_exponent():
    """The rate of the pressure, by Eq. 48, is that along the polytrope of either way."""
    law, gas = laws.PolytropicLoss(1.4, compression=1.3, expansion=1.5), GASES[1]
    for rate, exponent in ((-3.0, 1.3), (3.0, 1.5)):
        area = 2.0 * gas.V / gas.clearance + math.pi * gas.bore * gas.clearance
        difference = gas.T - gas.wall_temperature
        moving = gas._replace(clearance_rate=rate)
        lost = law.coefficient(moving, CHARGE) * area * difference
        assert lost > 0.0
        growth = rate / gas.clearance
        p_rate = -1.4 * gas.p * growth - 0.4 / gas.V * lost
        assert p_rate == pytest.approx(-exponent * gas.p * growth, rel=1e-13)


def test_cosine_force_takes_the_work_of_its_mean():
    """Eq. 34: over the whole stroke a cosine of A takes as much as a constant 2 A / pi."""
    from scipy.integrate import quad

    law = laws.CosineForce(amplitude=1000.0, half_stroke=0.1)
    there = quad(lambda x: law.force(1.0, Motion(0.0, x, 5.0, 1.0)), -0.1, 0.1)[0]
    back = quad(lambda x: law.force(1.0, Motion(0.0, x, -5.0, -1.0)), 0.1, -0.1)[0]
    constant = laws.ConstantForce(amplitude=2000.0 / math.pi)
    wanted = 0.2 * constant.force(1.0, Motion(0.0, 0.0, 5.0, 1.0))
    assert there == pytest.approx(wanted, rel=1e-12)
    assert back == pytest.approx(wanted, rel=1e-12)


@of_slot("heat_release")
def test_burnt_fraction_is_the_integral_of_its_rate(law):
    from scipy.integrate import quad

    if law.duration(GASES[1], CHARGE) == 0.0:
        return
    breaks = np.linspace(0.0, 1.0, 41)  # no law has a kink elsewhere
    pieces = [quad(law.burn_rate, a, b)[0] for a, b in itertools.pairwise(breaks)]
    assert law.burnt_fraction(0.0) == 0.0
    assert 0.5 < law.burnt_fraction(1.0) <= 1.0 + 1e-15
    assert all(law.burn_rate(u) >= 0.0 for u in breaks)
    for i in (5, 20, 40):
        assert sum(pieces[:i]) == pytest.approx(law.burnt_fraction(breaks[i]), rel=1e-8)


@of_slot("ignition")
def test_hotter_and_denser_ignites_no_later(law):
    cold = GASES[1]
    assert law.rate(cold, CHARGE) >= 0.0
    assert law.rate(cold._replace(T=1.1 * cold.T), CHARGE) >= law.rate(cold, CHARGE)
    assert law.rate(cold._replace(p=2.0 * cold.p), CHARGE) >= law.rate(cold, CHARGE)


@of_slot("gas_exchange")
def test_mass_is_conserved_and_the_ratio_met(law):
    if isinstance(law, laws.FlowExchange):  # composes no charge: tests/breathing
        return
    fuel, air, burnt, fresh = law.charge(5e-4, 1e-6, 2e-4, 3e-4, 0.6, 17.5)
    assert fuel + air + burnt == pytest.approx(5e-4, rel=1e-14)
    assert fuel * 17.5 / air == pytest.approx(0.6, rel=1e-12)
    assert 0.0 <= fresh <= fuel


@of_slot("springs")
def test_spring_force_is_the_gradient_of_its_energy(law):
    for motion in MOTIONS:
        ahead, behind = (law.energy(motion._replace(x=motion.x + dx)) for dx in (1e-6, -1e-6))
        assert law.force(motion) == pytest.approx(-(ahead - behind) / 2e-6, rel=1e-6, abs=1e-6)


@of_slot("friction")
def test_friction_dissipates(law):
    assert all(law.force(1.05, motion) * motion.v >= 0.0 for motion in MOTIONS)
    assert all(law.at_dead_centre(-1.0, stroke) >= 0.0 for stroke in STROKES)


@of_slot("alternator")
def test_alternator_delivers_no_more_than_it_takes(law):
    for motion in MOTIONS:
        taken = law.force(1.05, motion) * motion.v
        if isinstance(law, laws.CircuitAlternator):  # less what goes into the magnetic field
            taken -= law.inductance * motion.current * law.current_rate(1.05, motion)
        assert law.electrical_power(1.05, motion) <= taken
    assert all(law.at_dead_centre(1.0, stroke) >= 0.0 for stroke in STROKES)


def test_a_load_follows_from_flux_and_resistance():
    """Eq. 44 to 47: the induced voltage k v on the load R, all losses in the efficiency."""
    law = laws.LinearLoad.from_circuit(50.0, 40.0, efficiency=0.8, regulator_gain=3.0)
    assert law.load_constant == pytest.approx(78.125)
    assert law.regulator_gain == 3.0
    for motion in MOTIONS:
        power = (50.0 * motion.v) ** 2 / 40.0
        assert law.electrical_power(1.0, motion) == pytest.approx(power)
        assert law.force(1.0, motion) * motion.v == pytest.approx(power / 0.8)


def test_hohenberg_against_a_hand_calculation():
    gas = GASES[1]._replace(p=50e5, T=1500.0, V=1e-4, mean_piston_speed=5.0)
    assert laws.Hohenberg(a=130.0).coefficient(gas, CHARGE) == pytest.approx(1223.56, abs=0.005)


def test_chang_gamma_against_the_printed_polynomial():
    for T in (550.0, 1000.0, 2150.0):
        printed = -9.967e-12 * T**3 + 6.207e-8 * T**2 - 1.436e-4 * T + 1.396
        assert laws.ChangGas().gamma(T) == pytest.approx(printed, rel=1e-13)
    assert laws.ChangGas().gamma(4000.0) == pytest.approx(1.2692, abs=1e-4)


def test_steady_composition_follows_the_closed_form():
    """F = m / (1 + 17.5/phi + 17.575 EGR / (1 - EGR)) with 95 % of the fuel burnt."""
    law, mass, phi, egr = laws.InstantExchange(0.3), 5e-4, 0.6, 0.3
    fuel, air, burnt = 1e-5, 4e-4, 9e-5
    for _ in range(200):
        eaten = 0.95 * fuel
        state = (fuel - eaten, air - 17.5 * eaten, burnt + 18.5 * eaten)
        fuel, air, burnt, _ = law.charge(mass, *state, phi, 17.5)
    assert fuel == pytest.approx(mass / (1 + 17.5 / phi + 17.575 * egr / (1 - egr)), rel=1e-10)


TABLE = [1.0, 2.0]


@dataclasses.dataclass(frozen=True)
class Listing(laws.LinearSprings):
    def force(self, motion):
        return TABLE[0] * motion.x


@dataclasses.dataclass(frozen=True)
class SelfCalling(laws.LinearSprings):
    def force(self, motion):
        return -self.energy(motion)


@dataclasses.dataclass(frozen=True)
class Printing(laws.LinearSprings):
    def force(self, motion):
        print(motion.x)
        return 0.0


@dataclasses.dataclass(frozen=True)
class WrongArguments(laws.LinearSprings):
    def force(self, x, v):
        return 0.0


@pytest.mark.parametrize(
    ("law", "hint"),
    [
        (Listing, "uses 'TABLE', a list"),
        (SelfCalling, "calls its method 'self.energy'"),
        (Printing, "built-in 'print'"),
        (WrongArguments, r"must take \(self, motion\)"),
    ],
)
def test_what_a_law_may_not_do_is_said(law, hint):
    from saleg import LawError

    with pytest.raises(LawError, match=hint):
        methods_text(law, "force", "one", BASES["springs"])


def test_a_law_without_source_is_recognised():
    names = {}
    exec("def force(self, motion): return 0.0", names)
    with pytest.raises(NoSource):
        Borrowed("x", "x").add_method(laws.LinearSprings, names["force"], "x")


@dataclasses.dataclass(frozen=True)
class Branching(laws.NoHeatTransfer):
    """Chained locals and a condition: not a straight line, so nothing may be eased."""

    n: float = 0.8

    def coefficient(self, gas, charge):
        p = gas.p * 1e-5
        h = 30.0 * p**self.n
        if gas.burning > 0.0:
            h *= 2.0
        return h


@dataclasses.dataclass(frozen=True)
class Shadowing(laws.NoHeatTransfer):
    """Local names that the kernel might want for itself."""

    def coefficient(self, gas, charge):
        _aid = gas.p * 1e-5
        math = gas.T**-0.4
        exp = gas.mean_piston_speed + 1.4
        return 65.0 * gas.V**-0.06 * _aid**0.8 * math * exp**0.8


@pytest.mark.parametrize("law", [Branching(), Shadowing()], ids=lambda law: type(law).__name__)
def test_laws_of_any_shape_keep_their_value_when_eased(law):
    names = {"math": math, "np": np, "inline": numba.njit(error_model="numpy")}
    names[EXPONENTIAL] = math.exp
    text = "\n".join(
        methods_text(type(law), "coefficient", "one", BASES["heat_transfer"], eases=True)
    )
    exec(text, names)
    record = np.array(numbers_of([law])).view(record_of(law))[0]
    for gas in GASES:
        constants = names["one_coefficient_constants"](record, gas, CHARGE)
        logarithms = Logarithms(math.log(gas.p), math.log(gas.T), math.log(gas.V), *constants)
        found = names["one_coefficient"](record, gas, CHARGE, logarithms)
        assert found == pytest.approx(law.coefficient(gas, CHARGE), rel=1e-12)


@pytest.mark.parametrize(
    ("times", "fractions", "said"),
    [
        ((0.0, 0.5), (0.0, 0.8), "must end at 1"),
        ((0.2, 1.0), (0.0, 1.0), "must begin at 0"),
        ((0.0, 0.5, 1.0), (0.0, 0.8, 0.5), "no number may be less"),
    ],
)
def test_a_burn_profile_covers_its_duration_and_never_falls(times, fractions, said):
    found = problems(laws.BurnProfile(times=times, fractions=fractions))
    assert said in str(found[0])


def test_completeness_is_a_curve_over_the_equivalence_ratio():
    law = laws.CompletenessByRatio((0.2, 0.4, 1.0), (0.0, 0.9, 0.95))
    found = [law.share(None, CHARGE._replace(equivalence_ratio=phi)) for phi in (0.1, 0.3, 0.4, 2)]
    assert found == pytest.approx([0.0, 0.45, 0.9, 0.95], rel=1e-15)
    assert laws.CompleteCombustion().share(None, CHARGE) == 1.0
