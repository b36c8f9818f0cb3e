"""What Chapter 2 says of its Figures 9 to 19, and their drawings."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import quad

from saleg import fundamental as fm
from saleg.cli import main
from saleg.thesis import chapter_2


def test_figure_9_excess_heat_runs_away():
    history = chapter_2.excess()
    assert np.all(np.diff(history.compression_ratios) > 0.0)
    more = fm.march(history.strokes[0].system, history.strokes[0].start, 500)
    assert more.outcome is fm.Outcome.RUNAWAY


def test_figure_10_a_deficit_decays():
    history = chapter_2.deficit()
    assert np.all(np.diff(history.compression_ratios) < 0.0)
    more = fm.march(history.strokes[0].system, history.strokes[0].start, 500)
    assert more.outcome is fm.Outcome.DECAY


def test_figures_11_and_12_reach_the_same_equilibrium_from_below_and_above():
    below, above = chapter_2.from_below(), chapter_2.from_above()
    assert below.strokes[0].system == above.strokes[0].system
    assert np.all(np.diff(np.abs(below.dead_centres)) > -1e-12)
    assert np.all(np.diff(np.abs(above.dead_centres)) < 1e-12)
    (equilibrium, _) = fm.equilibria(below.strokes[0].system)
    for history in (below, above):
        assert history.outcome is fm.Outcome.EQUILIBRIUM
        assert history.strokes[-1].depth == pytest.approx(equilibrium.depth, abs=1e-9)


def test_figure_13_the_otto_efficiency_holds_the_stroke():
    history = chapter_2.held()
    assert np.abs(history.dead_centres) == pytest.approx(0.9, abs=1e-12)
    assert history.compression_ratios == pytest.approx(19.0, rel=1e-11)


def test_figures_14_and_15_the_cosine_raises_the_peaks():
    constant, cosine = chapter_2.profiles().values()
    wanted = quad(lambda s: 1.0, -0.9, 0.9)[0]
    taken = quad(lambda s: float(cosine.force(s)), -0.9, 0.9)[0]
    assert taken == pytest.approx(wanted, rel=1e-12)
    assert cosine.work(-0.9, 1.8) == pytest.approx(taken, rel=1e-12)
    assert constant.work(-0.9, 1.8) == pytest.approx(taken, rel=1e-12)
    x = np.linspace(-0.9, 0.9, 5001)
    strokes = [history.strokes[0] for history in chapter_2.both_loads().values()]
    velocities = [stroke.velocity(x).max() for stroke in strokes]
    accelerations = [stroke.acceleration(x).max() for stroke in strokes]
    assert 1.01 < velocities[1] / velocities[0] < 1.05
    assert 1.0 < accelerations[1] / accelerations[0] < 1.1
    # The decline is more rapid at the midpoint, where both have done half of their work.
    assert strokes[1].velocity(0.0) == pytest.approx(strokes[0].velocity(0.0), rel=1e-12)
    assert strokes[1].acceleration(0.0) < strokes[0].acceleration(0.0)


def test_at_all_of_the_first_pressure_nothing_changes():
    # 2.5: with the threshold at 100 %, and Eq. 31 for the load, it burns at dead centre.
    ignition = fm.AtPressure.share_of_start(1.0, -0.9, fm.Isentropic())
    late = dataclasses.replace(chapter_2.early().strokes[0].system, ignition=ignition)
    history = fm.march(late, -0.9, 10)
    assert np.abs(history.dead_centres) == pytest.approx(0.9, abs=1e-12)


def test_figure_16_early_combustion_lowers_the_compression_ratio_until_it_is_late():
    # At 20 % of the first pressure; towards combustion at dead centre, as the text says.
    history = chapter_2.early()
    system = history.strokes[0].system
    assert system.ignition.ratio * 0.1**1.4 == pytest.approx(0.2)
    assert np.all(np.diff(history.compression_ratios) < 1e-9)
    assert history.outcome is fm.Outcome.EQUILIBRIUM
    # p = p_start (0.1/h)^1.4 is 20 % at h = 0.1 * 5^(1/1.4).
    assert history.strokes[-1].depth == pytest.approx(1.0 - 0.1 * 5.0 ** (1 / 1.4), abs=1e-6)
    (found,) = fm.equilibria(system)
    assert found.depth == pytest.approx(history.strokes[-1].depth, abs=1e-6)
    assert found.attracting


def test_figure_17_loss_and_early_combustion_invert_the_loop():
    lossy = chapter_2.lossy()
    adverse = {name: fm.cycle_balance(h).adverse_work for name, h in lossy.items()}
    assert adverse["adiabatic"] == pytest.approx(0.0, abs=1e-12)
    assert adverse["polytropic"] > 1e-3
    # By quadrature over both branches, each from its own stroke.
    history = lossy["polytropic"]
    inward, outward = history.strokes[-2], history.strokes[-2].next()
    gas, end = history.strokes[0].system.gas, float(inward.end)
    lit = -inward.direction * inward.system.ignition.position(gas)
    chamber = 1 if inward.direction > 0.0 else 0

    def excess(x):
        return float(inward.pressures(x)[chamber] - outward.pressures(x)[chamber])

    work = abs(quad(excess, end, -lit * (1.0 + 1e-12), epsrel=1e-10)[0])
    assert excess(0.5 * (end - lit)) > 0.0
    assert inward.system.ignition.adverse_work(inward.system, abs(end)) == pytest.approx(work)


def test_figures_18_and_19_settle_and_give_half_of_the_heat_as_work():
    history = chapter_2.combined()
    assert history.outcome is fm.Outcome.EQUILIBRIUM
    assert history.compression_ratios[-1] == pytest.approx(19.0, rel=1e-6)
    assert 0.0 < history.strokes[0].system.load.second_law < 1.0
    balance = fm.cycle_balance(history)
    # With less than a tenth of the work as friction, "overall efficiency just under 50 %".
    assert 0.48 < 0.9 * balance.efficiency < 0.50
    assert balance.stored == pytest.approx(0.0, abs=1e-6)
    assert 0.0 < balance.adverse_work < balance.heat_transfer


@pytest.mark.parametrize("number", chapter_2.FIGURES)
def test_every_figure_has_labelled_axes(number):
    panels = np.ravel(chapter_2.FIGURES[number]())
    for ax in panels:
        assert ax.get_title()
        assert ax.patches or (ax.get_xlabel().endswith("[-]") and ax.get_ylabel().endswith("[-]"))
    given = panels[0].figure.subplots(1, len(panels), squeeze=False).ravel()
    handed = chapter_2.FIGURES[number](given if len(given) > 1 else given[0])
    assert all(a is b for a, b in zip(np.ravel(handed), given, strict=True))


def test_the_command_line_draws_a_figure(tmp_path, capsys):
    target = tmp_path / "loops.svg"
    assert main(["fundamental", "17", "--out", str(target)]) == 0
    assert target.read_text(encoding="utf-8").lstrip().startswith("<?xml")
    assert "loops.svg" in capsys.readouterr().out
    assert main(["fundamental", "9", "--out", str(tmp_path / "9.word")]) == 2
    assert ".png" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["fundamental", "8"])
