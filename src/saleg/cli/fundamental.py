"""``saleg fundamental``: a figure of Chapter 2, in closed form."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from saleg.errors import SalegError
from saleg.files.reading import expanded


class FigureError(SalegError, ValueError):
    """A figure that cannot be written as asked."""


def add_to(commands: Any) -> None:
    """Add the command to the parser's sub-commands."""
    parser = commands.add_parser("fundamental", help="draw a figure of Chapter 2 (9 to 19)")
    add = parser.add_argument
    add("figure", type=int, choices=range(9, 20), metavar="FIGURE", help="its number, 9 to 19")
    add("--out", type=expanded, metavar="FILE", help="picture to write (figure_N.png)")
    parser.set_defaults(command=draw)


def draw(options: argparse.Namespace) -> bool:
    """Draw the figure and say what it shows."""
    from saleg.thesis.chapter_2 import FIGURES

    target = options.out or Path(f"figure_{options.figure}.png")
    drawing = FIGURES[options.figure]
    figure = np.ravel(drawing())[0].figure
    known = figure.canvas.get_supported_filetypes()
    if target.suffix.removeprefix(".").lower() not in known:
        raise FigureError(f"--out {target}: must end in one of .{', .'.join(sorted(known))}")
    figure.savefig(target)
    print((drawing.__doc__ or "").partition("\n")[0])
    print(f"wrote {target}")
    return True
