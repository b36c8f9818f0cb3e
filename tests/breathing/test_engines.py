"""Engines that breathe: what is conserved, limits, symmetry, steady states, bad input."""

import dataclasses

import numpy as np
import pytest

import saleg
from agreement import assert_agree
from breathing_engines import PORTS, single_piston
from saleg import Effort, laws
from saleg.engine.columns import rows_by_make
from saleg.kernel import layout
from saleg.simulation.initial_state import prepare
from saleg.status import Status
from saleg.steady.many import steady_rows
from saleg.steady.return_map import ReturnMap


@pytest.fixture(scope="module")
def breathing(base):
    """Base case with ports and a charged intake."""
    return base.replace(gas_exchange=PORTS, **{"intake.pressure": 1.4e5})


@pytest.fixture(scope="module")
def crankcase(base):
    """Single-piston engine: crankcase, leaking rings, a wall that follows, a leaking gas spring."""
    return single_piston(base, PORTS)


def test_mass_and_fuel_are_conserved_to_rounding(breathing, crankcase):
    for engine in (breathing, crankcase):
        strokes = saleg.simulate(engine, 0.4).strokes
        gained = strokes["supplied_mass"] - strokes["expelled_mass"]
        change = np.diff(strokes["charge_mass"], axis=0)
        assert np.abs(change - gained[1:]).max() < 1e-15 * len(strokes)
        fuel = strokes["fresh_fuel_energy"] - strokes["exhaust_fuel_energy"]
        left_over = (fuel - strokes["heat_released"])[1:] - np.diff(strokes["fuel_energy"], axis=0)
        assert strokes["heat_released"].max() > 100.0
        assert np.abs(left_over).max() < 1e-9


def test_energy_closes_at_the_order_of_the_method(breathing, crankcase):
    for engine in (breathing, crankcase):
        off = [
            abs(run.energy.residual) / run.energy.largest_term
            for run in (saleg.simulate(engine, 0.4, rtol=rtol) for rtol in (1e-5, 1e-9))
        ]
        assert off[0] < 1e-5
        assert off[1] < 1e-9


@pytest.mark.filterwarnings("ignore:unusual for an engine")
def test_wide_ports_tend_to_the_instantaneous_exchange(base):
    boosted = base.replace(**{"intake.pressure": 1.01e5, "egr": 0.0})
    wanted = saleg.steady_state(boosted).performance
    off = []
    for width in (0.3, 3.0):
        ports = laws.PortFlow(
            exhaust_width=width,
            exhaust_height=0.06,
            intake_width=width,
            intake_height=0.06,
            intake_delay=0.001,
            displacement=0.97,
        )
        steady = saleg.steady_state(boosted.replace(gas_exchange=ports))
        assert steady.found
        off.append(abs(steady.performance.charge_mass / wanted.charge_mass - 1.0))
    assert off[1] < 0.02
    assert off[1] < 0.5 * off[0]


def test_the_mirror_image_of_an_engine_runs_as_its_mirror_image(crankcase):
    mirrored = dataclasses.replace(crankcase, left=crankcase.right, right=crankcase.left)
    one, other = (saleg.simulate(engine, 0.2) for engine in (crankcase, mirrored))
    for name in ("supplied_mass", "charge_mass", "wall_temperature", "peak_pressure"):
        assert np.array_equal(one.strokes[name], other.strokes[name][:, ::-1]), name
    assert np.array_equal(one.strokes["x_end"], -other.strokes["x_end"])


def test_a_fixed_point_is_where_waiting_leads(breathing):
    steady, run = saleg.steady_state(breathing), saleg.simulate(breathing, 3.0)
    assert steady.status is Status.STEADY
    assert run.status is Status.STEADY
    for name in ("stroke", "power", "efficiency", "charge_mass", "peak_pressure"):
        found, waited = (getattr(one.performance, name) for one in (steady, run))
        assert found == pytest.approx(waited, rel=1e-5), name
    assert steady.stable
    assert not np.isclose(steady.multipliers, 1.0).any()


def test_a_single_piston_engine_with_crankcase_and_walls_is_solved(crankcase):
    steady, run = saleg.steady_state(crankcase), saleg.simulate(crankcase, 40.0)
    assert steady.status is Status.STEADY, steady.message
    assert steady.performance.power == pytest.approx(run.performance.power, rel=1e-5)
    assert steady.stable
    assert not np.isclose(steady.multipliers, 1.0, atol=1e-9).any()
    wall = steady.strokes["wall_temperature"].mean(axis=0)[0]
    heat = steady.strokes["heat_lost"].sum(axis=0)[0] * steady.performance.frequency
    law = crankcase.left.wall
    # At rest the wall hands on what it takes; the bounce chamber takes none.
    assert law.conductance * (wall - law.coolant_temperature) == pytest.approx(heat, rel=1e-3)


def test_scavenging_figures_fit_together(breathing):
    run = saleg.simulate(breathing, 2.0)  # after 1 s the fuel blown out, a trace, changes by 1e-6
    left, right = run.scavenging
    assert left.charging_efficiency == pytest.approx(
        left.delivery_ratio * left.trapping_efficiency, rel=1e-12
    )
    assert left.residual_fraction + left.scavenging_efficiency == pytest.approx(1.0)
    assert 0.0 < left.residual_fraction < 0.2
    # In a steady state what is delivered and not retained has been lost.
    cycle = run.last_cycle_strokes
    lost = cycle["expelled_fresh"][:, 0].sum()
    retained = cycle["supplied_mass"][:, 0].sum() - lost
    assert retained == pytest.approx(left.trapped_mass * left.scavenging_efficiency, rel=1e-6)
    assert dataclasses.astuple(left) == pytest.approx(dataclasses.astuple(right), rel=1e-6)


def test_an_engine_without_flow_has_no_scavenging(base):
    left, right = saleg.simulate(base, 0.2).scavenging
    assert np.isnan([*dataclasses.astuple(left), *dataclasses.astuple(right)]).all()


def test_wrong_ports_and_crankcases_are_named_together(base):
    wrong = base.replace(
        gas_exchange=laws.PortFlow(intake_delay=0.08),
        supply=laws.Crankcase(volume_at_midpoint=1e-4, area=3e-3),
    )
    assert [problem.path for problem in wrong.problems()] == [
        "gas_exchange.intake_delay",
        "supply.volume_at_midpoint",
    ]
    alone = base.replace(supply=laws.Crankcase(volume_at_midpoint=1e-3, area=3e-3))
    with pytest.raises(saleg.InvalidEngine, match="gas_exchange = InstantExchange"):
        saleg.simulate(alone, 0.1)


def test_an_engine_that_breathes_goes_to_a_file_and_back(crankcase, tmp_path):
    path = tmp_path / "engine.toml"
    path.write_text(crankcase.to_toml(), encoding="utf-8")
    assert saleg.Engine.from_toml(path) == crankcase
    run = saleg.simulate(crankcase, 0.2)
    run.save(tmp_path / "run.npz")
    loaded = saleg.Run.load(tmp_path / "run.npz")
    assert np.array_equal(loaded.strokes, run.strokes)


def test_the_vector_of_a_dead_centre_holds_all_that_a_return_depends_on(crankcase):
    """A charge that burns at dead centre: how much leaked since it was lit counts as well."""
    engine = crankcase.replace(**{"heat_release.combustion_duration": 4e-3})
    start = saleg.steady_state(engine).replay.start
    assert start.chambers["mode"][0] == layout.BURNING
    other = prepare(engine)
    other.engine["direction"] = start.engine["direction"]
    for name in ("mode", "armed"):
        other.chambers[name] = start.chambers[name]
    images = []
    for state in (start, other):
        return_map = ReturnMap.of(engine, state.copy(), 1e-11, mirrored=False)
        images.append(return_map.image(state, return_map.vector(start)))
    assert np.abs(images[0] - images[1]).max() < 1e-7


def test_a_branch_of_a_single_piston_engine_that_breathes(crankcase):
    burning = crankcase.replace(**{"heat_release.combustion_duration": 4e-3})
    branch = saleg.continuation.branch(burning, "alternator.load_constant", 12.6, step=0.6)
    assert branch.ended == "arrived"
    for point in branch.points[1:]:
        there = burning.replace(**{"alternator.load_constant": point.value})
        alone = saleg.steady_state(there, rtol=1e-8)
        for name in ("stroke", "power", "charge_mass", "peak_pressure"):
            wanted = getattr(alone.performance, name)
            assert getattr(point.steady.performance, name) == pytest.approx(wanted, rel=1e-6), name
        leading = [abs(found.multipliers[0]) for found in (point.stability, alone.stability)]
        assert leading[0] == pytest.approx(leading[1], abs=1e-5)


@pytest.mark.parametrize(
    ("base_law", "body", "words"),
    [
        (laws.base.Leak, {"area": lambda self, gas: 1e-5}, "area acts on"),
        (
            laws.base.Wall,
            {"temperature_rate": lambda self, temperature, heat: 1.0},
            "wall_temperature",
        ),
        (laws.RingLeak, {"states": ("foo",)}, "there are contents, wall_temperature, crankcase"),
    ],
)
def test_a_law_that_forgets_its_states_is_refused(base, base_law, body, words):
    kind = dataclasses.dataclass(frozen=True)(type("Forgetful", (base_law,), body))
    slot = {base_law.slot: kind()}
    with pytest.raises(saleg.LawError, match=words):
        saleg.simulate(base.replace(**slot), 0.01)


@pytest.mark.parametrize("heat_capacity", [1e3, 3e5])
def test_walls_of_any_mass_settle_at_one_temperature(base, heat_capacity):
    """A heavy wall moves less in a cycle than the tolerance, however far it has to go."""
    wall = laws.LumpedWall(heat_capacity=heat_capacity, conductance=20.0)
    steady = saleg.steady_state(base.replace(wall=wall, wall_temperature=300.0))
    assert steady.status == saleg.Status.STEADY
    # At rest the coolant takes, on average, what the gas of either cylinder loses.
    lost = steady.strokes["heat_lost"].sum(axis=0) * steady.performance.frequency
    rest = wall.coolant_temperature + lost / wall.conductance
    assert steady.strokes["wall_temperature"][-1] == pytest.approx(rest, abs=0.3)


def test_walls_follow_where_one_end_is_open(base):
    engine = saleg.Engine(
        saleg.Translator(mass=5.0),
        base.left,
        saleg.OpenEnd(),
        springs=laws.OneSidedSprings(right_stiffness=60e3, right_contact=-0.03),
        friction=base.friction,
        alternator=laws.LinearLoad(load_constant=40.0),
    ).replace(wall=laws.LumpedWall())
    run = saleg.simulate(engine, 0.1, rtol=1e-9)
    assert_agree(run, saleg.reference.simulate(engine, 0.1, jitted=True))


def test_reports_tell_the_gas_exchange_and_plain_engines_have_none(base, breathing, tmp_path):
    steady = saleg.steady_state(breathing)
    left, _ = steady.scavenging
    assert left.is_known
    assert f"{left.delivery_ratio:.3f}" in str(steady)
    for text in (str(steady), steady._repr_html_()):
        assert "trapping efficiency" in text
    assert "trapping efficiency" not in str(saleg.steady_state(base))
    page = tmp_path / "report.html"
    saleg.report(steady, page)
    assert "Gas exchange" in page.read_text(encoding="utf-8")


def test_histories_have_masses_and_walls(crankcase):
    run = saleg.simulate(crankcase, 0.1, history=1, rtol=1e-10)
    seen, gas = run.history, crankcase.left.gas_properties
    mass = seen["p_left"] * seen["V_left"] / (gas.gas_constant * seen["T_left"])
    np.testing.assert_allclose(seen["mass_left"], mass, rtol=1e-9)
    assert (seen["burnt_left"] <= seen["mass_left"]).all()
    law = crankcase.left.wall
    warming = (
        seen["heat_loss_left"]
        - law.conductance * (seen["wall_temperature_left"] - law.coolant_temperature)
    ) / law.heat_capacity
    total = np.trapezoid(warming, seen["t"])
    change = seen["wall_temperature_left"].iloc[-1] - seen["wall_temperature_left"].iloc[0]
    assert total == pytest.approx(change, rel=1e-3)


def test_engines_searched_for_together_have_the_steady_states_they_have_alone(breathing):
    engines = [breathing.replace(equivalence_ratio=0.4 + 0.01 * n) for n in range(8)]
    table = saleg.steady_states(engines, rtol=1e-9)
    for n in (0, 7):
        alone = saleg.steady_state(engines[n], rtol=1e-9)
        for name in ("power", "stroke", "frequency", "peak_pressure", "charge_mass"):
            wanted = getattr(alone.performance, name)
            assert abs(table[name][n] / wanted - 1.0) < 1e-7, name
    assert table.half_cycles.sum() < 8 * alone.half_cycles  # they follow each other


def test_walls_that_follow_are_searched_for_one_by_one(crankcase):
    (rows,) = rows_by_make([crankcase, crankcase.replace(moving_mass=2.5)])
    assert steady_rows(rows, 1e-6, Effort.THOROUGH, 2) == []


def test_fresh_gas_blown_back_comes_again_and_is_not_lost(breathing):
    shut = breathing.replace(gas_exchange=dataclasses.replace(PORTS, exhaust_width=1e-15))
    with pytest.warns(saleg.SalegWarning, match="exhaust_width"):
        strokes = saleg.simulate(shut, 0.1).strokes
    assert strokes["expelled_mass"].max() > 1e-6  # what was there before is lost
    assert strokes["expelled_fresh"].max() < 1e-12  # through the exhaust alone


def test_a_single_piston_engine_is_started_from_its_equilibrium(crankcase):
    """At rest where rounding misses the balance of forces: the first stroke has no length."""
    controller = saleg.Controller(motor_control=laws.PhaseLockedMotor())
    run = saleg.control.start_up(crankcase, duration=2.0, controller=controller)
    assert run.status is Status.COMPLETED, run.message
    assert run.fired
    assert run.performance.power > 4e3
