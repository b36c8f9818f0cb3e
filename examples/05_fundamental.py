"""Figures 9 to 19 of the thesis: its Chapter 2 in closed form.

Run with ``python examples/05_fundamental.py [FOLDER]``; without a name it makes the pictures of
docs/fundamental.md.
"""

import sys
from pathlib import Path

from saleg import fundamental as fm
from saleg.fundamental import figures, plots
from saleg.plotting import new_figure

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "images"


def main(folder: Path = PICTURES) -> None:
    # Figures 9 and 10: runaway and decay. Figures 11 and 12: one equilibrium, from either side.
    pairs = {
        "runaway_decay": (figures.figure_9, figures.figure_10),
        "settling": (figures.figure_11, figures.figure_12),
    }
    for name, drawings in pairs.items():
        figure = new_figure(width=10.5, height=4.2)
        for draw, ax in zip(drawings, figure.subplots(1, 2), strict=True):
            draw(ax)
        figure.savefig(folder / f"fundamental_{name}.png", dpi=80)

    # Why: the next dead centre over the last one, and the loads that have an equilibrium.
    figure = new_figure(width=10.5, height=4.6)
    left, right = figure.subplots(1, 2)
    plots.cobweb(figures.from_above(), left)
    plots.tolerance(1.4, right)
    figure.savefig(folder / "fundamental_equilibria.png", dpi=80)

    # Figures 13 to 15: held by the Otto efficiency, with a constant and a cosine force.
    figure = new_figure(width=10.5, height=8.0)
    axes = figure.subplots(2, 2)
    figures.figure_13(axes[0, 0])
    figures.figure_14(axes[0, 1])
    figures.figure_15(axes[1])
    figure.savefig(folder / "fundamental_loads.png", dpi=80)

    # Figures 16 and 17: early combustion, and heat transfer.
    figures.figure_16()[0].figure.savefig(folder / "fundamental_early.png", dpi=80)
    figures.figure_17().figure.savefig(folder / "fundamental_adverse.png", dpi=80)

    # Figures 18 and 19: all together.
    figure = new_figure(width=10.5, height=8.0)
    axes = figure.subplots(2, 2)
    figures.figure_18(axes[0])
    figures.figure_19(axes[1])
    figure.savefig(folder / "fundamental_combined.png", dpi=80)

    # Eq. 32: a compression ratio of 19 repeats itself. It repels: the multiplier is above one.
    held = figures.held()
    assert abs(held.compression_ratios[-1] - 19.0) < 1e-9
    multiplier = float(fm.multiplier(held.strokes[0].system, 0.9))
    print(f"compression ratio 19: multiplier {multiplier:.3f}")
    assert multiplier > 1.0
    # 2.7: with less than a tenth of it as friction, efficiency is just under 50 %.
    balance = fm.cycle_balance(figures.combined())
    print(f"work {balance.efficiency:.3f} of the heat, residual {balance.residual:.1e}")
    assert 0.48 < 0.9 * balance.efficiency < 0.50


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
