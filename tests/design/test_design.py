"""Component design: Eq. 60-67, the closed loop, scores and drawings."""

import dataclasses
import math
import re
from dataclasses import dataclass

import numpy as np
import pandas as pd
import pytest

import saleg
from helpers import single_piston
from saleg import Status, laws, sweep
from saleg.design import (
    AirSprings,
    Design,
    Geometry,
    MassModel,
    Operation,
    Parameters,
    Score,
    formulas,
)
from saleg.plotting import design as drawings


@pytest.fixture(scope="module")
def base_design():
    return saleg.design.evaluate()


def test_formulas_at_printed_values():
    """Eq. 60 at the limit the text names, 20 m; Eq. 65 and 67 by their coefficients."""
    assert formulas.mean_speed(0.181, 46.9) == pytest.approx(16.98, rel=1e-3)
    assert formulas.alternator_diameter(100e3, 0.05, 2.0 * 0.05 * 12.7) == pytest.approx(20.0, 0.02)
    half = formulas.alternator_diameter(1e3, 0.1, 5.0)
    assert formulas.alternator_diameter(1e3, 0.1, 5.0, poles=4.0) == pytest.approx(half / 2.0)
    assert formulas.spring_mass(350e3) == pytest.approx(10.0)
    assert formulas.piston_mass(0.1) == pytest.approx(0.8242784)
    assert formulas.rod_mass(1.008) == pytest.approx(1.17)
    # Eq. 64: 0 at the greatest clearance, 1 where the crown meets the head.
    assert formulas.port_position(0.0, 0.1, 0.4) == pytest.approx(0.3)
    assert formulas.port_position(1.0, 0.1, 0.4) == pytest.approx(0.5)


def test_geometry_fits_together(base_design):
    """Eq. 62-64, and the piston stays clear of the bearing at its farthest."""
    g, length = base_design.geometry, 0.1
    assert g.head - g.crown == pytest.approx(length)
    assert g.bearing - g.mover_end == pytest.approx(length)
    assert g.head - g.port == pytest.approx(0.133)
    # As Eq. 63 is printed the piston would have to pass the bearing; with a crankcase it has room.
    assert g.crown - length >= g.bearing
    printed = saleg.design.evaluate(Design(masses=MassModel.as_printed())).geometry
    assert printed.crown - length < printed.bearing
    assert g.mover_inner_diameter == pytest.approx(0.8 * g.mover_outer_diameter)
    assert math.pi * g.rod_diameter**2 / 4.0 == pytest.approx(75e-6)
    assert g.length == 2.0 * g.head


def test_mass_and_orbit_belong_together():
    """For random designs the mass is that of the components, and the orbit that of the mass."""
    box = {
        "bore": (0.05, 0.08),
        "half_stroke": (0.07, 0.13),
        "spring_stiffness": (10e3, 100e3),
        "intake_pressure": (0.9e5, 1.5e5),
        "equivalence_ratio": (0.4, 0.9),
    }
    for values in sweep.latin_hypercube(box, 40, seed=3).to_dict("records"):
        found = saleg.design.evaluate(**values)
        assert found.status is Status.STEADY, found.message
        assert abs(found.mass_error) < 1.1e-6
        sized = found.design.masses.masses(
            found.design.parameters, Operation.of_strokes(found.strokes)
        )
        assert sized.total == pytest.approx(found.moving_mass, rel=1.1e-6)
        plain = saleg.steady_state(found.engine)
        for name in ("stroke", "frequency", "power"):
            ours = getattr(found.quick_performance, name)
            assert ours == pytest.approx(getattr(plain.quick_performance, name), rel=2e-5)


def test_the_loop_costs_at_most_twice_a_plain_steady_state():
    """Counted in strokes integrated, which is what it costs."""
    points = sweep.latin_hypercube({"bore": (0.052, 0.078), "half_stroke": (0.08, 0.12)}, 60)
    table = saleg.design.evaluate_many(points)
    engines = [
        Design().replace(values).engine(mass)
        for values, mass in zip(points.to_dict("records"), table.moving_mass, strict=True)
    ]
    plain = saleg.steady_states(engines)
    assert table.half_cycles.sum() <= 1.4 * plain.half_cycles.sum()


@pytest.mark.parametrize("law", [laws.DoubleWiebe(), laws.BurnProfile()], ids=["double", "table"])
def test_the_loop_closes_with_a_burn_rate_that_is_not_smooth(law):
    found = saleg.design.solve(Design().replace({"heat_release": law}))
    assert found.method == "fixed point", found.message
    assert found.half_cycles <= 20
    assert abs(found.mass_error) < 1e-6


def test_a_neighbour_is_a_start(base_design):
    """It leads to the same orbit where there is but one."""
    near = base_design.design.replace(bore=0.0642)
    warm = saleg.design.solve(near, near=base_design)
    cold = saleg.design.solve(near)
    assert warm.moving_mass == pytest.approx(cold.moving_mass, rel=5e-6)
    assert warm.quick_performance.power == pytest.approx(cold.quick_performance.power, rel=1e-5)


def test_an_orbit_away_from_the_standard_starts_is_followed_there():
    """The piston reaches the port down to 0.0422; cold starts lead nowhere below 0.053."""
    found = saleg.design.evaluate(port_location=0.043)
    assert found.status is Status.STEADY
    assert found.method == "continuation"
    assert "followed from the base case" in found.message
    assert found.stable
    assert abs(found.mass_error) < 1.1e-6
    lost = saleg.design.evaluate(port_location=0.042)
    assert lost.status is Status.STALLED
    assert "no orbit could be followed" in lost.message
    # Its piston would turn before it has opened the port.
    assert found.performance.stroke < 0.2 * (1.0 - 2.0 * 0.042)


def test_a_row_without_an_orbit_has_no_mass():
    table = saleg.design.evaluate_many(pd.DataFrame({"port_location": [0.335, 0.03]}))
    assert list(table.status) == ["steady", "stalled"]
    for name in ("moving_mass", "power_density", "frequency_ratio"):
        assert table[name].notna().tolist() == [True, False], name


def test_air_springs_are_faster(base_design):
    """4.4: without moving mass the springs no longer cost frequency and power density."""
    light = saleg.design.evaluate(Design(masses=MassModel(springs=AirSprings())))
    assert light.masses.springs == 0.0
    assert light.moving_mass < base_design.moving_mass
    assert light.performance.frequency > 1.1 * base_design.performance.frequency


@dataclass(frozen=True)
class HeavyRod:
    """A rod of fixed mass."""

    kilograms: float = 1.0

    def mass(self, parameters, operation):
        return self.kilograms


def test_mass_models_can_be_replaced():
    found = saleg.design.evaluate(Design(masses=MassModel(rod=HeavyRod(0.7))))
    assert found.masses.rod == 0.7
    assert abs(found.mass_error) < 1.1e-6


@dataclass(frozen=True)
class JumpyRod:
    """A rod whose mass jumps where its own orbit lies."""

    def mass(self, parameters, operation):
        return 0.3 if operation.stroke > 0.1806 else 2.0


def test_an_open_loop_is_no_steady_state():
    """No orbit has the mass of its components: the simulation's own outcome does not count."""
    found = saleg.design.evaluate(Design(masses=MassModel(rod=JumpyRod())))
    assert abs(found.mass_error) > 0.1
    assert found.status is Status.UNSTEADY
    assert not found.found
    assert "mass of the components still differs" in found.message


def test_the_loop_closes_through_simulations_as_tightly():
    """One misfire long ago: nothing for a return map, and yet the same mass."""
    design = Design().replace({"misfires": saleg.laws.ScheduledMisfires(first=3.0)})
    found = saleg.design.evaluate(design)
    assert (found.method, found.status) == ("simulation", Status.STEADY)
    assert abs(found.mass_error) <= 1e-6
    assert found.moving_mass == pytest.approx(saleg.design.evaluate().moving_mass, rel=1e-5)


def test_an_alternator_of_ones_own_needs_no_diameter():
    design = Design(masses=MassModel(alternator=HeavyRod(0.8)))
    found = saleg.design.evaluate(design)
    assert found.found
    assert math.isnan(found.geometry.mover_outer_diameter)
    texts = [text.get_text() for text in found.draw().texts]
    assert not any("D_o" in text for text in texts)
    table = sweep.run(sweep.grid({"bore": [0.064]}), design)
    assert table.status[0] == "steady"
    assert np.isnan(table.alternator_diameter[0])


@dataclass(frozen=True)
class WrongRod:
    """A rod that weighs whatever it is told."""

    given: object

    def mass(self, parameters, operation):
        return self.given


@pytest.mark.parametrize("given", [-10.0, math.nan, "heavy", None, np.array([0.3])])
def test_models_that_give_no_mass_are_named(given):
    with pytest.raises(saleg.design.InvalidMass, match=r"masses\.rod: WrongRod\.mass gave"):
        saleg.design.evaluate(Design(masses=MassModel(rod=WrongRod(given))))


def test_what_is_no_design_is_refused():
    for wrong in ("thesis", {"bore": 0.06}, saleg.machines.thesis_base()):
        with pytest.raises(saleg.design.InvalidDesign, match=r"must be a saleg\.design\.Design"):
            saleg.design.evaluate(wrong)
    with pytest.raises(saleg.design.InvalidDesign, match=r"must be a saleg\.design\.Design"):
        saleg.design.solve(None)
    for part in ({"parameters": {"bore": 0.06}}, {"laws": None}, {"masses": 3.0}):
        with pytest.raises(saleg.design.InvalidDesign, match="must be a"):
            Design(**part)
    with pytest.raises(saleg.design.InvalidDesign, match="not a class"):
        saleg.design.evaluate(Design(masses=MassModel(rod=AirSprings)))
    bounce = saleg.BounceChamber(bore=0.064, half_stroke=0.1, pressure=2.5e5)
    engine = saleg.Engine(translator=saleg.Translator(mass=2.0), left=bounce, right=bounce)
    with pytest.raises(saleg.design.InvalidDesign, match="cylinders with ports"):
        saleg.design.evaluate(Design(laws=engine))


def test_a_single_piston_engine_is_designed(base):
    """The gas spring stays; the mass is that of the components, where engine and design agree."""
    laws_of = single_piston(base, length=0.1, pressure=2.5e5)
    masses = MassModel(pistons=saleg.design.UnlikePistons(gas_spring_bore=0.08))
    design = Design(laws=laws_of, masses=masses)
    found = saleg.design.evaluate(design, bore=0.066, spring_stiffness=20e3)
    assert found.status is Status.STEADY, found.message
    assert found.engine.right == laws_of.right
    assert found.engine.left.bore == 0.066
    heads = [82.3 * bore**2 + 0.0136 * bore - 8.16e-5 for bore in (0.066, 0.08)]
    assert found.masses.pistons == pytest.approx(sum(heads) / 2.0, rel=1e-12)
    assert found.moving_mass == pytest.approx(found.masses.total, rel=1e-6)
    alone = saleg.steady_state(found.engine.replace(moving_mass=found.moving_mass))
    assert alone.performance.power == pytest.approx(found.performance.power, rel=1e-5)
    points = saleg.sweep.grid({"bore": [0.064, 0.066]})
    table = saleg.sweep.run(points, design.replace(spring_stiffness=20e3))
    assert table.power.iloc[1] == pytest.approx(found.performance.power, rel=1e-5)


def test_laws_that_the_eight_parameters_do_not_fit_are_named(base):
    flows = base.replace(gas_exchange=laws.PortFlow())
    with pytest.raises(saleg.design.InvalidDesign, match=r"egr = 0\.12: must be 0: gas flows"):
        saleg.design.evaluate(Design(laws=flows))
    with pytest.raises(saleg.design.InvalidDesign, match="mirrored, or have a gas spring"):
        saleg.design.evaluate(Design(laws=base.replace(**{"left.bore": 0.06})))
    open_end = dataclasses.replace(base, right=saleg.OpenEnd())
    with pytest.raises(saleg.design.InvalidDesign, match="springs with a right_stiffness"):
        saleg.design.evaluate(Design(laws=open_end))


def alone_agrees(found):
    """Whether the engine of a design by itself has the same steady state."""
    assert found.status is Status.STEADY, found.message
    assert found.moving_mass == pytest.approx(found.masses.total, rel=1e-6)
    alone = saleg.steady_state(found.engine.replace(moving_mass=found.moving_mass))
    assert alone.performance.power == pytest.approx(found.performance.power, rel=1e-5)


def test_an_engine_that_breathes_is_designed(base):
    ports = laws.PortFlow(exhaust_width=0.1, exhaust_height=0.03, intake_width=0.1)
    design = Design(laws=base.replace(gas_exchange=ports)).replace(
        {"egr": 0.0, "intake_pressure": 1.4e5, "equivalence_ratio": 0.4}
    )
    found = saleg.design.evaluate(design)
    assert found.engine.left.gas_exchange == ports
    assert found.scavenging[0].delivery_ratio > 0.5
    alone_agrees(found)


def test_an_engine_with_one_spring_is_designed(base):
    spring = laws.OneSidedSprings(right_stiffness=1.0, right_contact=-0.03)
    engine = saleg.Engine(
        saleg.Translator(mass=5.0),
        base.left,
        None,
        springs=spring,
        friction=base.friction,
        alternator=laws.LinearLoad(load_constant=40.0),
    )
    design = Design(laws=engine, masses=MassModel(pistons=saleg.design.OnePiston()))
    found = saleg.design.evaluate(design, equivalence_ratio=0.5, spring_stiffness=60e3)
    assert found.engine.springs == dataclasses.replace(spring, right_stiffness=60e3)
    alone_agrees(found)


@pytest.mark.parametrize(
    ("values", "match"),
    [
        ({"bore": 64.0}, "given in mm?"),
        ({"half_stroke": 100.0}, "given in mm?"),
        ({"intake_pressure": 1.05}, "given in bar?"),
        ({"intake_temperature": 51.9}, "given in degrees Celsius?"),
        ({"egr": 12.0}, "given in %?"),
    ],
)
def test_other_units_are_suspected(values, match):
    with pytest.raises(saleg.design.InvalidDesign, match=re.escape(match)):
        saleg.design.evaluate(**values)


def test_a_name_is_suggested_once():
    with pytest.raises(saleg.UnknownPath) as error:
        saleg.design.evaluate(boer=0.06)
    assert str(error.value).count("'bore'") == 1


def test_what_fails_is_said():
    stalled = saleg.design.evaluate(equivalence_ratio=0.0)
    assert stalled.status is Status.STALLED
    assert not stalled.found
    assert stalled.moving_mass > 0.0
    with pytest.raises(saleg.design.InvalidDesign, match=r"port_location = 1\.2"):
        saleg.design.evaluate(port_location=1.2)
    with pytest.raises(saleg.UnknownPath, match="bore"):
        saleg.design.evaluate(boer=0.06)
    with pytest.raises(saleg.UnknownPath, match="follows from the eight"):
        saleg.design.evaluate(**{"intake.pressure": 1.3e5})
    with pytest.raises(saleg.UnknownPath, match="masses"):
        Design().replace({"masses.rod.colour": 1.0})
    with pytest.raises(saleg.SalegError, match="rtol"):
        saleg.design.solve(Design(), rtol=1.0)
    with pytest.raises(saleg.design.InvalidDesign, match="must have a method mass"):
        saleg.design.solve(Design(masses=MassModel(rod=1.0)))
    with pytest.raises(saleg.design.InvalidDesign, match="mirrored"):
        saleg.design.solve(Design().replace({"left.wall_temperature": 500.0}))


def test_idling_is_no_steady_power():
    """600 K at the intake: the engine fires but the regulator takes the load off."""
    hot = saleg.design.evaluate(intake_temperature=600.0)
    assert hot.status is Status.IDLING
    assert hot.masses.alternator == 0.0


def test_empirical_constants_are_inputs_too(base_design):
    lossy = saleg.design.evaluate(**{"heat_transfer.a": 90.0})
    assert lossy.performance.efficiency < base_design.performance.efficiency - 0.01
    heavy = saleg.design.evaluate(**{"masses.alternator.density": 2000.0})
    assert heavy.moving_mass > base_design.moving_mass + 0.5
    assert Design().unit("masses.alternator.density") == "kg/m^3"
    assert Design().unit("intake_pressure") == "Pa"
    assert Design().unit("friction.factor") == "kg/m^2/s"


def test_groups_of_appendix_c(base_design):
    """By their definitions."""
    figures = base_design.component_figures
    p, mass = base_design.performance, base_design.moving_mass
    assert figures["stroke_to_bore"] == pytest.approx(200.0 / 64.0)
    pressure = math.pi * 0.064**2 * 1.05e5 / (4.0 * 0.1 * 30e3)
    assert figures["dimensionless_pressure"] == pytest.approx(pressure)
    assert figures["frequency_ratio"] == pytest.approx(p.frequency / math.sqrt(30e3 / mass))
    burnt = 0.95 * (1.0 - math.exp(-5.0)) * p.fuel_energy_per_cycle / 2.0
    assert figures["dimensionless_heat"] == pytest.approx(burnt / (30e3 * 0.1**2), rel=0.01)


def test_score_rewards_what_figure_85_rewards():
    good = {
        "efficiency": 0.45,
        "stability": 0.0,
        "compression_ratio": 20.0,
        "peak_pressure": 100e5,
    }
    score = Score()
    best = score(good)
    assert best > 0.99
    for worse in (
        {"efficiency": 0.25},
        {"stability": 0.3},
        {"compression_ratio": 60.0},
        {"compression_ratio": 3.0},
        {"peak_pressure": 400e5},
    ):
        assert score({**good, **worse}) < best - 0.1
    assert score({**good, "efficiency": math.nan}) == 0.0


def test_score_knows_unstable_orbits_and_engines_that_deliver_nothing():
    good = {
        "efficiency": 0.45,
        "stability": 1e-7,
        "compression_ratio": 20.0,
        "peak_pressure": 100e5,
    }
    score = Score()
    best = score(good)
    assert score({**good, "largest_multiplier": 0.9}) == best
    assert score({**good, "largest_multiplier": math.nan}) == best
    assert score({**good, "largest_multiplier": 1.1}) == pytest.approx(best - 3.0 / 8.0)
    assert score({**good, "efficiency": 0.0}) == 0.0
    table = saleg.design.evaluate_many(
        pd.DataFrame({"bore": [0.064, 0.040], "intake_temperature": [600.0, 325.0]}),
        multipliers=True,
    )
    assert list(table.status) == ["idling", "steady"]
    assert not table.stable[1]
    assert table.score[0] == 0.0
    assert table.score[1] < 5.0 / 8.0
    assert score(table).tolist() == table.score.tolist()


@pytest.mark.parametrize(
    ("wrong", "match"),
    [
        ({"efficiency": -1.0}, "efficiency = -1"),
        ({"target_efficiency": 0.0}, "target_efficiency"),
        ({"least_compression_ratio": 40.0}, "must be >= 40"),
        (
            {"efficiency": 0.0, "stability": 0.0, "compression_ratio": 0.0, "peak_pressure": 0.0},
            "one of the weights",
        ),
    ],
)
def test_scores_that_make_no_sense_are_refused(wrong, match):
    with pytest.raises(saleg.SalegError, match=match):
        Score(**wrong)


def test_figures_of_the_design(base_design):
    ax = base_design.draw()
    assert "990 mm" in ax.get_title()
    texts = [text.get_text() for text in ax.texts]
    parts = ["head", "piston", "ports", "mover", "spring", "bearing", "rod"]
    assert [text for text in texts if text in parts] == parts
    assert ax.get_aspect() == 1.0
    drawings.piston_mass()
    panels = drawings.alternator_map()
    assert len(panels) == 3
    assert "diameter" in panels[0].figure.axes[-1].get_ylabel()
    # Figure 66: with their mass stiffer springs gain little, and never pass sqrt(2/c) / (2 pi).
    constant, growing = drawings.natural_frequency().lines
    assert constant.get_ydata()[-1] > 2.0 * growing.get_ydata()[-1]
    limit = math.sqrt(2.0 * 35000.0) / (2.0 * math.pi)
    assert growing.get_ydata()[-1] < limit


def test_a_short_engine_is_drawn_whole():
    ax = saleg.design.evaluate(half_stroke=0.02, bore=0.1, port_location=0.3).draw()
    ax.figure.canvas.draw()
    renderer, page = ax.figure.canvas.get_renderer(), ax.figure.bbox
    for text in (ax.title, ax.xaxis.label, *ax.texts):
        box = text.get_window_extent(renderer)
        assert page.x0 <= box.x0 <= box.x1 <= page.x1, text
        assert page.y0 <= box.y0 <= box.y1 <= page.y1, text


def test_geometry_of_an_engine_without_output():
    idle = Geometry.of(Parameters(), MassModel(), Operation(0.1, 40.0, 0.0))
    assert idle.mover_outer_diameter == 0.0
