"""Pictures asked for by name: ``--plot forces``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from saleg.cli.words import CommandError
from saleg.errors import nearest
from saleg.files.atomic import new_file

if TYPE_CHECKING:
    from saleg.simulation.run import Run
    from saleg.steady.state import SteadyState


def add_plot(parser: argparse.ArgumentParser, where: str) -> None:
    """Add the option that asks for pictures."""
    parser.add_argument(
        "--plot",
        action="append",
        default=[],
        metavar="NAME",
        help=f"draw a figure as NAME.png {where}, such as forces or pressure_volume; repeatable",
    )


def names() -> list[str]:
    """Names of the figures of a run."""
    from saleg.plotting.namespace import FIGURES

    return list(FIGURES)


def check(asked: Sequence[str]) -> None:
    """Refuse names of no figure.

    Raises
    ------
    CommandError
    """
    for name in asked:
        if name not in names():
            hint = nearest(name, names()) or f"; there are {', '.join(names())}"
            raise CommandError(f"--plot {name}: no such figure{hint}")


def draw(result: Run | SteadyState, asked: Sequence[str], folder: Path) -> list[str]:
    """Write figures to a folder that is there; returns the names of the files."""
    written = []
    for name in dict.fromkeys(asked):
        axes = np.ravel(getattr(result.plot, name)())
        with new_file(folder / f"{name}.png", overwrite=True) as temporary:
            axes[0].figure.savefig(temporary, format="png")
        written.append(f"{name}.png")
    return written
