import dataclasses
import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

import saleg
from saleg import fundamental as fm
from saleg.errors import InvalidEngine, OutsideModel
from saleg.fundamental import figures, plots

GAMMAS = st.floats(1.1, 1.67)
PRESSURES = st.floats(0.01, 3.0)
HEATS = st.floats(0.0, 5.0)
SHARES = st.floats(0.0, 0.4)
DEPTHS = st.floats(0.05, 0.97)
COMMON = settings(max_examples=60, deadline=None, derandomize=True)


# ---- a stroke ----------------------------------------------------------------------------------


@COMMON
@given(GAMMAS, PRESSURES, HEATS, SHARES, DEPTHS, st.sampled_from([1.0, -1.0]))
def test_acceleration_is_the_slope_of_kinetic_energy(gamma, pressure, heat, share, depth, way):
    groups = {"gamma": gamma, "pressure": pressure, "heat": heat, "force": share * heat}
    start, x = -way * depth, np.linspace(-0.97, 0.97, 41)
    # A step along the imaginary axis differentiates without cancellation: a = v dv/dx.
    slope = np.imag(fm.kinetic_energy(x + 1e-30j, start, **groups, direction=way)) / 1e-30
    acceleration = fm.acceleration(x, start, **groups, direction=way)
    scale = np.maximum(np.abs(acceleration), 1.0)
    assert np.all(np.abs(slope - acceleration) < 1e-10 * scale)
    assert fm.kinetic_energy(start, start, **groups, direction=way) == pytest.approx(0.0, abs=1e-12)


@COMMON
@given(GAMMAS, PRESSURES, HEATS, SHARES, DEPTHS)
def test_to_the_left_is_the_exact_mirror_image(gamma, pressure, heat, share, depth):
    groups = {"gamma": gamma, "pressure": pressure, "heat": heat, "force": share * heat}
    x = np.linspace(-0.97, 0.97, 41)
    for sign, formula in ((1.0, fm.kinetic_energy), (-1.0, fm.acceleration)):
        to_right = formula(x, -depth, **groups)
        to_left = formula(-x, depth, **groups, direction=-1.0)
        assert np.array_equal(to_left, sign * to_right)


@COMMON
@given(GAMMAS, PRESSURES, HEATS, SHARES, DEPTHS)
def test_strokes_follow_the_printed_formulas(gamma, pressure, heat, share, depth):
    gas, force = fm.Isentropic(gamma), share * heat
    groups = {"gamma": gamma, "pressure": pressure, "heat": heat, "force": force}
    first = fm.System(pressure=pressure, heat=heat, gas=gas, load=fm.ConstantLoad(force)).stroke(
        -depth
    )
    assume(first.depth > 0.01)
    for stroke in (first, first.next()):
        x = stroke.positions()
        energy = stroke.kinetic_energy(x)
        scale = max(1.0, float(np.max(energy)))
        # The end is a floating-point number: half a unit in its last place times the slope.
        rounding = 2e-16 * abs(float(stroke.acceleration(stroke.end)))
        assert np.min(energy) > -1e-12 * scale - rounding
        printed = fm.kinetic_energy(x, stroke.start, **groups, direction=stroke.direction)
        assert np.max(np.abs(printed - energy)) < 1e-11 * scale
        printed = fm.acceleration(x, stroke.start, **groups, direction=stroke.direction)
        assert stroke.acceleration(x) == pytest.approx(printed, rel=1e-11, abs=1e-11)


def test_eq_28_holds_as_printed_and_eq_30_with_the_other_sign():
    g, P, Q, F, x = 1.4, 0.17, 2.2, 0.8, np.linspace(-0.85, 0.85, 41)

    def stored(x):
        return P / (g - 1.0) * ((1.0 + x) ** (1.0 - g) + (1.0 - x) ** (1.0 - g)) + x**2

    def eq_28(x, left):
        return -Q * ((1.0 + left) / (1.0 + x)) ** (g - 1.0) - stored(x) - F * x

    def eq_30(x, right):
        return Q * ((1.0 - right) / (1.0 - x)) ** (g - 1.0) + stored(x) - F * x

    groups = {"gamma": g, "pressure": P, "heat": Q, "force": F}
    to_right = fm.kinetic_energy(x, -0.9, **groups)
    to_left = fm.kinetic_energy(x, 0.9, **groups, direction=-1.0)
    assert eq_28(x, -0.9) - eq_28(-0.9, -0.9) == pytest.approx(to_right, abs=1e-13)
    assert np.all(to_left > 0.0)
    assert eq_30(x, 0.9) - eq_30(0.9, 0.9) == pytest.approx(-to_left, abs=1e-13)


def test_the_basic_system_swings_to_the_mirrored_position():
    # 2.2: without heat and work, x_r = -x_l, and the velocity is greatest at the midpoint.
    depth = np.linspace(0.01, 0.999, 200)
    system = fm.System(pressure=0.4)
    assert system.stroke(-depth).end == pytest.approx(depth, abs=1e-13)
    stroke = system.stroke(-0.8)
    assert stroke.velocity(0.0) > max(stroke.velocity(1e-3), stroke.velocity(-1e-3))


def test_a_step_too_weak_to_start_stays():
    stuck = fm.System(pressure=0.0, load=fm.ConstantLoad(1.0)).stroke(-0.4)
    assert stuck.end == -0.4
    assert stuck.duration == 0.0
    assert fm.march(stuck.system, -0.4).outcome is fm.Outcome.DECAY


def test_springs_alone_do_not_stop_a_fired_translator():
    # Without gas ahead nothing but the head does.
    fired = fm.System(pressure=0.0, heat=5.0).stroke(-0.9)
    assert fired.end == pytest.approx(1.0, abs=1e-11)
    assert fired.impact == pytest.approx(fm.stroke_balance(fired).residual, rel=1e-9)
    wanted = quad(lambda s: 1.0 / float(fired.velocity(s)), 0.0, fired.end)[0]
    assert fired.duration - fired.time(0.0) == pytest.approx(wanted, rel=1e-9)
    assert np.all(np.diff(fired.time(fired.positions())) > 0.0)
    assert fm.march(fired.system, -0.9).outcome is fm.Outcome.RUNAWAY


# ---- against an ODE solver ---------------------------------------------------------------------

SCALES = fm.Scales(half_stroke=0.1, bore=0.064, stiffness=30e3, mass=2.39)


def newton(system, start):
    """The first stroke in SI from Newton's law and p V^n alone; x, t and the way there."""
    L, A, k, m = SCALES.half_stroke, SCALES.area, SCALES.stiffness, SCALES.mass
    gas, p_mp = system.gas, system.pressure * SCALES.pressure
    Q, x0 = system.heat * SCALES.energy, start * L
    p_fired = p_mp * (L / (L + x0)) ** gas.compression + Q * (gas.gamma - 1.0) / (A * (L + x0))
    threshold = getattr(system.ignition, "ratio", math.inf) * p_mp
    charge = {"p": p_mp, "V": A * L}

    def compressed(x):
        return charge["p"] * (charge["V"] / (A * (L - x))) ** gas.compression

    def rates(t, y):
        x, v = y
        fired = p_fired * ((L + x0) / (L + x)) ** gas.expansion
        profile = system.load.for_stroke(system, -start)
        load = float(profile.force(x / L)) * SCALES.force
        return [v, (A * (fired - compressed(x)) - 2.0 * k * x - load) / m]

    def ignites(t, y):
        return compressed(y[0]) - threshold if math.isfinite(threshold) else -1.0

    def stops(t, y):
        return y[1] if t > 0.0 else 1.0

    ignites.terminal = stops.terminal = True
    stops.direction = -1.0
    t, y, pieces = 0.0, [x0, 0.0], []
    while True:
        how = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "max_step": 2e-4}
        run = solve_ivp(rates, (t, t + 1.0), y, events=(ignites, stops), **how)
        pieces.append((run.t, run.y))
        t, y = run.t[-1], run.y[:, -1]
        if len(run.t_events[0]) == 0:
            return y[0], t, pieces
        V = A * (L - y[0])
        charge.update(p=compressed(y[0]) + Q * (gas.gamma - 1.0) / V, V=V)
        threshold = math.inf


LOSSY = fm.Polytropic(1.4, compression=1.35, expansion=1.45)
CASES = {
    "basic": (fm.System(pressure=0.3), -0.8),
    "heat and work": (fm.System(pressure=0.17, heat=2.2, load=fm.ConstantLoad(0.8)), -0.9),
    "cosine": (fm.System(pressure=0.5, heat=1.0, load=fm.CosineLoad(0.5)), -0.7),
    "early": (fm.System(pressure=0.17, heat=2.2, ignition=fm.AtPressure(8.0)), -0.9),
    "combined": (
        fm.System(
            pressure=0.17,
            heat=2.2,
            gas=LOSSY,
            load=fm.OttoLoad(fm.CosineLoad(), second_law=0.8),
            ignition=fm.AtPressure(15.0),
        ),
        -0.92,
    ),
}


def check_against_newton(system, start):
    stroke = system.stroke(start)
    end, duration, pieces = newton(system, start)
    assert stroke.end * SCALES.length == pytest.approx(end, rel=1e-9)
    assert stroke.duration * SCALES.time == pytest.approx(duration, rel=1e-9)
    for t, (x, v) in pieces:
        inside = slice(1, -1)
        velocity = stroke.velocity(x / SCALES.length) * SCALES.velocity
        # Both know the kinetic energy; a velocity near zero is its root, and its error grows.
        energy, known = velocity[inside] ** 2, v[inside] ** 2
        assert energy == pytest.approx(known, rel=1e-9, abs=1e-12 * v.max() ** 2)
        times = stroke.time(x / SCALES.length) * SCALES.time
        assert times[inside] == pytest.approx(t[inside], rel=1e-9, abs=1e-9 * duration)


@pytest.mark.parametrize("name", CASES)
def test_closed_form_and_ode_agree(name):
    check_against_newton(*CASES[name])


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    st.builds(
        fm.Polytropic, st.floats(1.2, 1.6), compression=st.floats(1.2, 1.6), expansion=GAMMAS
    ),
    st.floats(0.1, 2.0),
    HEATS,
    SHARES,
    st.sampled_from([fm.ConstantLoad, fm.CosineLoad]),
    st.one_of(st.just(fm.AtDeadCentre()), st.builds(fm.AtPressure, st.floats(1.5, 30.0))),
    st.floats(0.2, 0.95),
)
def test_closed_form_and_ode_agree_on_random_systems(
    gas, pressure, heat, share, kind, ignition, depth
):
    load = kind(share * heat)
    system = fm.System(pressure=pressure, heat=heat, gas=gas, load=load, ignition=ignition)
    end = system.stroke(-depth).depth
    lit = ignition.position(gas)
    # Left out: strokes that end near a head or the midpoint, or just where the charge burns.
    assume(0.1 < end < 0.98 and abs(end - lit) > 1e-3)
    check_against_newton(system, -depth)


# ---- time --------------------------------------------------------------------------------------


def test_springs_alone_have_the_frequency_of_a_textbook():
    # sqrt(2k/m) / 2 pi, whatever the amplitude.
    wanted = math.sqrt(2.0 * SCALES.stiffness / SCALES.mass) / (2.0 * math.pi)
    for depth in (1e-3, 0.5, 0.999):
        history = fm.march(fm.System(pressure=0.0), -depth, 2)
        assert history.frequency * SCALES.frequency == pytest.approx(wanted, rel=1e-12)
    stroke = fm.System(pressure=0.0).stroke(-0.5)
    x = np.linspace(-0.5, 0.5, 101)[:-1]  # near the end a rounding of x is its root in time
    assert stroke.time(x) == pytest.approx(np.arccos(-2.0 * x) / math.sqrt(2.0), abs=1e-12)


def test_small_oscillations_have_the_stiffness_of_springs_and_gas():
    # About the midpoint Eq. 11 is a = -(2 + 2 gamma P) x.
    stroke = fm.System(pressure=0.5).stroke(-1e-5)
    assert stroke.duration == pytest.approx(math.pi / math.sqrt(2.0 + 2.0 * 1.4 * 0.5), rel=1e-9)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("start", [-0.3, -0.99, -0.9999])
def test_the_quadrature_of_time_has_converged(name, start):
    stroke = CASES[name][0].stroke(start)
    middle, half = 0.5 * (stroke.start + stroke.end), 0.5 * (stroke.end - stroke.start)
    lit = stroke.system.ignition.position(stroke.system.gas)
    # Chebyshev's angle takes away the square root; near its ends rounding would win.
    edge = 1e-3
    breaks = [math.acos((middle - lit) / half)] if lit < stroke.end else None

    def slowness(angle):
        return half * math.sin(angle) / float(stroke.velocity(middle - half * math.cos(angle)))

    how = {"epsabs": 0.0, "epsrel": 1e-11, "limit": 400, "points": breaks}
    wanted = quad(slowness, edge, math.pi - edge, **how)[0]
    ends = middle - half * np.cos([edge, math.pi - edge])
    assert np.diff(stroke.time(ends))[0] == pytest.approx(wanted, rel=2e-8)


def test_arrays_of_strokes_equal_single_ones():
    system, _ = CASES["combined"]
    starts = np.array([-0.91, -0.93, -0.95])
    together = system.stroke(starts)
    alone = [system.stroke(start) for start in starts]
    assert together.end.tolist() == [stroke.end for stroke in alone]
    assert together.duration == pytest.approx([stroke.duration for stroke in alone], rel=1e-14)


# ---- equilibria --------------------------------------------------------------------------------


@COMMON
@given(GAMMAS, PRESSURES, st.floats(0.01, 5.0), DEPTHS)
def test_eq_32_is_a_fixed_point(gamma, pressure, heat, depth):
    force = fm.equilibrium_force(-depth, gamma=gamma, heat=heat)
    gas, load = fm.Isentropic(gamma), fm.ConstantLoad(float(force))
    system = fm.System(pressure=pressure, heat=heat, gas=gas, load=load)
    assert system.stroke(-depth).end == pytest.approx(depth, abs=1e-12)
    balanced = fm.at_equilibrium(system, -depth)
    assert balanced.load.amplitude == pytest.approx(force, rel=1e-11)
    # The multiplier is the slope of the return map, here by differences.
    step = 1e-6 * (1.0 - depth)
    ends = fm.return_map(system, depth + step * np.array([-1.0, 1.0]))
    slope = np.diff(ends)[0] / (2.0 * step)
    assert fm.multiplier(system, depth) == pytest.approx(slope, abs=1e-6)
    # It attracts on the near side of the fold, and nowhere else.
    fold = fm.tolerance_band(gamma).fold
    assume(abs(depth - fold) > 1e-3)
    assert (slope < 1.0) == (depth < fold)


@pytest.mark.parametrize("share", [0.356, 0.37, 0.39])
def test_two_equilibria_one_attracts(share):
    system = fm.System(pressure=0.5, heat=1.0, load=fm.ConstantLoad(share))
    near, far = fm.equilibria(system)
    assert near.attracting
    assert not far.attracting
    for found in (near, far):
        force = fm.equilibrium_force(-found.depth, gamma=1.4, heat=1.0)
        assert force == pytest.approx(share, rel=1e-12)
    for start in (0.5 * near.depth, 0.5 * (near.depth + far.depth)):
        history = fm.march(system, -start, 4000)
        assert history.outcome is fm.Outcome.EQUILIBRIUM
        assert history.strokes[-1].depth == pytest.approx(near.depth, rel=1e-4)
    beyond = fm.march(system, -0.5 * (1.0 + far.depth), 4000)
    assert beyond.outcome is fm.Outcome.RUNAWAY


def test_equilibria_meet_in_the_fold_and_vanish():
    band = fm.tolerance_band(1.4)
    (fold,) = fm.folds(fm.System(pressure=0.3, heat=2.0, load=fm.ConstantLoad(1.0)))
    assert fold.depth == pytest.approx(band.fold, abs=1e-7)
    assert fold.load.amplitude / 2.0 == pytest.approx(band.lowest, rel=1e-13)

    def found(share):
        return fm.equilibria(fm.System(pressure=0.3, heat=2.0, load=fm.ConstantLoad(2.0 * share)))

    assert len(found(band.lowest * (1.0 - 1e-9))) == 0
    near, far = found(band.lowest * (1.0 + 1e-9))
    assert near.depth < band.fold < far.depth
    assert far.depth - near.depth < 1e-3
    assert [one.multiplier for one in (near, far)] == pytest.approx([1.0, 1.0], abs=1e-4)
    # The other end of the band: the equilibrium shrinks to the midpoint as F/Q nears gamma - 1.
    assert found(band.highest * (1.0 - 1e-3))[0].depth < 0.01
    assert not any(one.attracting for one in found(band.highest * 1.001))
    # Least over all depths: no depth asks for less.
    depth = np.linspace(0.01, 0.99, 2001)
    assert band.lowest <= fm.equilibrium_force(-depth, gamma=1.4, heat=1.0).min()


def test_the_otto_load_makes_every_dead_centre_an_equilibrium():
    # Eq. 31 applied in every stroke balances wherever the stroke began: nothing is attracted.
    system = fm.System(pressure=0.3, heat=1.0, load=fm.OttoLoad())
    depth = np.linspace(0.05, 0.97, 50)
    assert fm.return_map(system, depth) == pytest.approx(depth, abs=1e-12)
    assert fm.multiplier(system, depth) == pytest.approx(np.ones(50), abs=1e-10)
    assert fm.equilibria(system) == ()


def test_no_load_no_equilibrium():
    assert fm.equilibria(fm.System(pressure=0.3, heat=1.0)) == ()
    assert fm.equilibria(fm.System(pressure=0.3)) == ()
    for load in (fm.ConstantLoad(), fm.OttoLoad()):
        assert fm.folds(fm.System(pressure=0.3, load=load)) == ()


# ---- early combustion --------------------------------------------------------------------------


@COMMON
@given(GAMMAS, PRESSURES, st.floats(0.1, 5.0), st.floats(0.3, 0.95), st.floats(0.3, 0.99))
def test_early_combustion_lowers_any_compression_ratio(gamma, pressure, heat, depth, share):
    # "This trend holds for any set of operating parameters."
    gas = fm.Isentropic(gamma)
    assume(share * (1.0 - depth) ** -gamma > 1.0)
    ignition = fm.AtPressure.share_of_start(share, -depth, gas)
    system = fm.System(pressure=pressure, heat=heat, gas=gas, ignition=ignition, load=fm.OttoLoad())
    assert fm.march(system, -depth, 1).strokes[0].depth < depth


def test_a_charge_that_misses_the_threshold_does_not_burn():
    system = fm.System(pressure=0.2, heat=1.0, ignition=fm.AtPressure(20.0))
    second = system.stroke(-0.3).next()
    assert second.system.ignition.fires(system, 0.3) == np.False_
    x = second.positions()
    unfired = fm.kinetic_energy(x, second.start, gamma=1.4, pressure=0.2, direction=-1.0)
    assert second.kinetic_energy(x) == pytest.approx(unfired, abs=1e-12)


def test_earlier_combustion_and_more_loss_make_more_adverse_work():
    # 2.7: "advancing the combustion timing or allowing for high heat transfer both increase it".
    def adverse(ratio, expansion):
        gas = fm.Polytropic(1.4, compression=1.35, expansion=expansion)
        system = fm.System(pressure=0.17, heat=2.2, gas=gas, ignition=fm.AtPressure(ratio))
        return system.ignition.adverse_work(system, 0.9)

    assert adverse(10.0, 1.45) > adverse(15.0, 1.45) > 0.0
    assert adverse(15.0, 1.50) > adverse(15.0, 1.45)
    assert fm.AtDeadCentre().adverse_work(fm.System(pressure=0.17, heat=2.2, gas=LOSSY), 0.9) == 0.0


# ---- energy ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_the_energy_balance_closes_out_of_equilibrium_too(name):
    system, start = CASES[name]
    for stroke in fm.march(system, start, 6).strokes:
        balance = fm.stroke_balance(stroke)
        assert balance.residual == pytest.approx(0.0, abs=1e-12)


def test_the_basic_efficiency_is_that_of_the_otto_cycle():
    balance = fm.cycle_balance(figures.held())
    assert balance.efficiency == pytest.approx(1.0 - 19.0**-0.4, rel=1e-12)
    assert balance.heat_transfer == pytest.approx(0.0, abs=1e-14)
    assert balance.rejected == pytest.approx(balance.heat * 19.0**-0.4, rel=1e-12)


# ---- outside the model -------------------------------------------------------------------------


def test_one_error_names_every_wrong_field():
    with pytest.raises(OutsideModel) as caught:
        fm.System(
            pressure=-1.0,
            heat=math.nan,
            gas=fm.Polytropic(1.0, compression=0.9),
            load=fm.OttoLoad(fm.CosineLoad(math.inf), second_law=-1.0),
            ignition=0.2,
        )
    assert {problem.path for problem in caught.value.problems} == {
        "pressure",
        "heat",
        "gas.gamma",
        "gas.compression",
        "load.profile.amplitude",
        "load.second_law",
        "ignition",
    }
    with pytest.raises(OutsideModel) as caught:
        fm.acceleration([0.0, 1.5], -1.0, gamma=1.0, pressure=0.1)
    assert {problem.path for problem in caught.value.problems} == {"x", "start", "gamma"}
    assert isinstance(caught.value, saleg.SalegError)


@pytest.mark.parametrize("start", [-1.0, 0.0, 0.5, math.nan, "left", [-0.5, -1.5]])
def test_starts_lie_left_of_the_midpoint(start):
    with pytest.raises(OutsideModel, match=r"start = .*must be"):
        fm.System(pressure=0.1).stroke(start)


def test_what_else_is_outside():
    system = fm.System(pressure=0.1, heat=1.0)
    for wrong in (
        lambda: fm.return_map(system, 1.0),
        lambda: system.stroke(-0.5).velocity([0.0, 1.2]),
        lambda: system.stroke(-0.5).time(math.nan),
        lambda: fm.at_equilibrium(system, 0.3),
        lambda: fm.at_equilibrium(dataclasses.replace(system, gas=LOSSY, heat=1e-6), -0.9),
        lambda: fm.at_equilibrium(fm.System(pressure=0.1, load=fm.OttoLoad()), -0.5),
        lambda: fm.tolerance_band(2.5),
        lambda: fm.Scales(half_stroke=0.0, bore=1.0, stiffness=1.0, mass=-1.0),
        lambda: fm.System(pressure=0.1, ignition=fm.AtPressure(0.5)),
    ):
        with pytest.raises(OutsideModel):
            wrong()


# ---- engines -----------------------------------------------------------------------------------


def test_the_groups_of_the_base_case(base, base_run):
    groups = fm.from_engine(base)
    area = math.pi * 0.064**2 / 4.0
    assert groups.stroke_to_bore == pytest.approx(0.200 / 0.064)
    assert groups.intake_pressure == pytest.approx(area * 1.05e5 / (0.1 * 30e3), rel=1e-12)
    assert groups.midpoint_pressure == pytest.approx(
        groups.intake_pressure * 1.33**groups.gamma, rel=1e-12
    )
    # Two charges a cycle, of which the engine reports the fuel (Table 1: 1.38 kJ of it).
    released = 2.0 * groups.heat * groups.scales.energy
    assert 0.90 < released / base_run.performance.fuel_energy_per_cycle < 1.0
    # Appendix C divides by sqrt(k/m); the fundamental frequency has two springs and 2 pi.
    assert groups.frequency_ratio(math.sqrt(2 * 30e3 / 2.39) / (2 * math.pi)) == pytest.approx(
        math.sqrt(0.5) / math.pi, rel=1e-12
    )
    # Chapter 2 knows no heat loss nor burn duration, and comes within a tenth of the frequency.
    system = groups.equilibrium(base_run.performance.stroke)
    history = fm.march(system, -0.5 * base_run.performance.stroke / 0.1, 2)
    frequency = history.frequency * groups.scales.frequency
    assert frequency == pytest.approx(base_run.performance.frequency, rel=0.1)


def test_groups_of_other_engines(base):
    bounce = saleg.BounceChamber(bore=0.05, half_stroke=0.1, pressure=2e5)
    engine = dataclasses.replace(base, right=bounce)
    assert fm.from_engine(engine) == fm.from_engine(base)
    groups = fm.from_engine(engine, bounce, gamma=1.4)
    assert (groups.heat, groups.gamma) == (0.0, 1.4)
    assert groups.midpoint_pressure == groups.intake_pressure
    with pytest.raises(InvalidEngine, match="springs"):
        fm.from_engine(base.replace(**{"spring.stiffness": 0.0}))
    with pytest.raises(OutsideModel, match="gamma"):
        fm.from_engine(base, gamma=math.nan)


def test_without_combustion_the_engine_swings_as_the_formula_says():
    # The numeric engine with two adiabatic gas springs, beside Eq. 14 and the quadrature of time.
    from helpers import bounce_engine, strokes_from_start

    engine = bounce_engine(stiffness=20e3, pressure=3e5, position=-0.8)
    run, _ = strokes_from_start(engine, 2, rtol=1e-11)
    groups = fm.from_engine(engine)
    stroke = groups.system().stroke(-0.8)
    assert run.strokes["x_end"][0] == pytest.approx(0.1 * stroke.end, rel=1e-8)
    duration = stroke.duration * groups.scales.time
    assert run.strokes["duration"][0] == pytest.approx(duration, rel=1e-8)


# ---- plots, import -----------------------------------------------------------------------------


def test_plots_of_stability():
    ax = plots.cobweb(figures.from_above())
    assert {"attracting", "repelling"} <= set(ax.get_legend_handles_labels()[1])
    ax = plots.tolerance(1.4)
    assert "fold, CR 3.75" in ax.get_legend_handles_labels()[1]


def test_importing_it_needs_neither_matplotlib_nor_scipy():
    code = (
        "import sys, saleg.fundamental, saleg.thesis.chapter_2;"
        "assert not {'matplotlib', 'pandas', 'numba', 'scipy'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
