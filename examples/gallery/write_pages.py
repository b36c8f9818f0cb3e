"""Gallery and comparison with the dissertation: docs/gallery.md, its pictures, docs/comparison.md.

Run with ``python examples/gallery/write_pages.py [FIGURE ...]``, which takes some minutes; with
numbers of figures it only draws these.
"""

import sys
from collections.abc import Iterable
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image

from saleg.thesis import claims, printed_tables
from saleg.thesis.figures import FIGURES

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"
PICTURES = DOCS / "images" / "gallery"
#: Width of a picture by that of its figure [pixel]: wide ones have many panels.
NARROW, WIDE = 560, 860
COLOURS = 255
CHAPTERS = {
    9: "Chapter 2: fundamental analysis",
    36: "Chapter 3: numerical model",
    63: "Chapter 4: design and optimisation",
    92: "Chapter 5: transient operation",
    115: "Appendix C",
}
INTRODUCTION = """# Gallery

Every figure of the dissertation that holds data, drawn by saleg, with one sentence on how ours
compares with the printed one and numbers for it that a test asserts. Each is drawn so:

```python
from saleg.thesis.figures import FIGURES

figure = FIGURES[10]
ax = figure.draw(figure.run())
ax.figure.savefig("figure_10.png")
```

Figures of several panels return an array of axes. [The dissertation on one page](dissertation.md)
has all equations, tables and figures; [the comparison](comparison.md) has all numbers. This page is
written by `examples/gallery/write_pages.py`.
"""
COMPARISON = """# Comparison with the dissertation

Every printed table that saleg computes and every number of the text, beside ours. Table 1 and
Tables 9 to 12 carry the error of a step of 5 µs, which lies in the dissertation's own method
([steps, solvers and a lag](studies.md)); what else differs is in [physics](physics.md) and
[component design](design.md). This page is written by `examples/gallery/write_pages.py`.
"""


def main(numbers: Iterable[int] = ()) -> None:
    PICTURES.mkdir(exist_ok=True)
    only = set(numbers)
    found = Results()
    for shown in claims.SHOWN:
        if not only or only & set(shown.figures):
            picture(shown, found)
    if not only:
        (DOCS / "gallery.md").write_text(gallery(found), encoding="utf-8")
        (DOCS / "comparison.md").write_text(comparison(found), encoding="utf-8")


class Results:
    """Data of figures, run once each."""

    def __init__(self):
        self._known = {}

    def __call__(self, shown):
        run = FIGURES[shown.figures[0]].run
        key = (run.func, repr(run.args)) if isinstance(run, partial) else run
        if key not in self._known:
            self._known[key] = claims.data(shown)
        return self._known[key]


def picture(shown, found):
    """Draw what is shown into its file, with few colours."""
    axes = FIGURES[shown.figures[0]].draw(found(shown))
    figure = np.ravel(axes)[0].figure
    width = figure.get_size_inches()[0]
    pixels = NARROW if width < 7.7 else WIDE
    drawn = BytesIO()
    figure.savefig(drawn, dpi=pixels / width)
    few = Image.open(drawn).convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    few.save(PICTURES / file_of(shown), optimize=True)


def file_of(shown):
    return f"figure_{shown.figures[0]}.png"


def heading(shown):
    return ("Figure " if len(shown.figures) == 1 else "Figures ") + " and ".join(
        map(str, shown.figures)
    )


def gallery(found) -> str:
    parts = [INTRODUCTION]
    for shown in claims.SHOWN:
        if shown.figures[0] in CHAPTERS:
            parts.append(f"## {CHAPTERS[shown.figures[0]]}\n")
        name = name_of(FIGURES[shown.figures[0]].run)
        parts.append(f"### {heading(shown)}\n\n**{shown.title}**{name}. {shown.says}\n")
        parts.append(f"![{shown.title}](images/gallery/{file_of(shown)})\n")
        parts.append(claims_table(shown, found(shown)))
    return "\n".join(parts)


def name_of(run) -> str:
    """Where the data come from, in words; nothing for what needs no data."""
    function = run.func if isinstance(run, partial) else run
    if function.__name__ == "<lambda>":
        return ""
    return f" (`{function.__module__}.{function.__qualname__}`)"


def claims_table(shown, data) -> str:
    lines = ["| | printed | saleg |", "|---|---|---|"]
    for claim in shown.claims:
        lines.append(f"| {claim.what} | {claim.printed} | {number(claim.ours(data))} |")
    return "\n".join(lines) + "\n"


def comparison(found) -> str:
    parts = [COMPARISON]
    for title, rows in printed_tables.TABLES.items():
        parts += [f"## {title}\n", rows_table(rows())]
    parts += ["## Numbers of the text\n", "| figures | | printed | saleg | deviation |"]
    parts.append("|---|---|---|---|---|")
    for shown in claims.SHOWN:
        data = found(shown)
        for claim in shown.claims:
            ours = claim.ours(data)
            off = percent(claim.deviation(ours))
            figures = ", ".join(map(str, shown.figures))
            parts.append(f"| {figures} | {claim.what} | {claim.printed} | {number(ours)} | {off} |")
    return "\n".join(parts) + "\n"


def rows_table(rows) -> str:
    lines = ["| | | printed | saleg | deviation |", "|---|---|---|---|---|"]
    for row in rows:
        ours, off = number(row.ours), percent(row.deviation)
        lines.append(f"| {row.case} | {row.quantity} | {number(row.printed)} | {ours} | {off} |")
    return "\n".join(lines) + "\n"


def number(value: float) -> str:
    """Number of four digits; what rounding left is nothing."""
    return "0" if abs(value) < 1e-9 else f"{value:.4g}"


def percent(share: float) -> str:
    return "" if np.isnan(share) else f"{100.0 * share:+.1f} %"


if __name__ == "__main__":
    main(map(int, sys.argv[1:]))
