"""Words of SVG that pictures in cards are drawn in; no library and no script."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np

#: Colours that are read on white and on black: left and right side, alternator, spring.
LEFT, RIGHT, GREEN, YELLOW = "#2B8FD6", "#E0742C", "#1FA37C", "#D2A106"
#: Points of a curve.
POINTS = 160
#: Room for labels left of and below a chart [px], and size of its text.
_LEFT, _BOTTOM, _TOP, _RIGHT, _TEXT = 58.0, 36.0, 10.0, 12.0, 11


class Curve(NamedTuple):
    """A curve of a chart.

    Attributes
    ----------
    x, y : ndarray
        In the units of the labels.
    colour : str
    name : str
        In the legend; no entry if it is empty.
    dashed : bool
    points : bool
        Draw a dot at each point instead of a line.
    """

    x: np.ndarray
    y: np.ndarray
    colour: str
    name: str = ""
    dashed: bool = False
    points: bool = False


def picture(width: float, height: float, title: str, *parts: str) -> str:
    """An SVG of some parts; its title (text) says what it shows."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" '
        f'width="{width:g}" height="{height:g}" role="img" style="max-width: 100%; height: auto" '
        f'font-size="{_TEXT}" font-family="sans-serif" fill="currentColor">'
        f"<title>{escape(title)}</title>{''.join(parts)}</svg>"
    )


def tag(name: str, inside: str = "", **look: Any) -> str:
    """An element with attributes; ``stroke_width`` stands for ``stroke-width``."""
    attributes = "".join(
        f' {key.replace("_", "-")}="{_shown(value)}"' for key, value in look.items()
    )
    return f"<{name}{attributes}>{inside}</{name}>"


def text(x: float, y: float, words: str, **look: Any) -> str:
    """Words at a point."""
    return tag("text", escape(words), x=x, y=y, **look)


def chart(
    title: str,
    curves: Sequence[Curve],
    x_label: str,
    y_label: str,
    *,
    size: tuple[float, float] = (340.0, 230.0),
    from_zero: bool = False,
) -> str:
    """Curves on axes with ticks, and their names below the title's place."""
    width, height = size
    named = _legend([curve for curve in curves if curve.name], _LEFT, width)
    top = _TOP + 16.0 * len(named)
    across = _Axis.around([curve.x for curve in curves], _LEFT, width - _RIGHT)
    up = _Axis.around([curve.y for curve in curves], height - _BOTTOM, top, from_zero)
    faint: dict[str, Any] = {"stroke": "currentColor", "stroke_opacity": 0.18}
    parts = []
    for tick in across.ticks:
        parts.append(tag("line", x1=across(tick), x2=across(tick), y1=top, y2=up.start, **faint))
        parts.append(text(across(tick), up.start + 14, f"{tick:g}", text_anchor="middle"))
    for tick in up.ticks:
        parts.append(tag("line", x1=across.start, x2=across.end, y1=up(tick), y2=up(tick), **faint))
        parts.append(text(across.start - 5, up(tick) + 4, f"{tick:g}", text_anchor="end"))
    parts.append(text(0.5 * (across.start + across.end), height - 5, x_label, text_anchor="middle"))
    turned = f"rotate(-90 11 {0.5 * (top + up.start):g})"
    middle = 0.5 * (top + up.start)
    parts.append(text(11, middle, y_label, text_anchor="middle", transform=turned))
    parts += [_drawn(curve, across, up) for curve in curves]
    return picture(width, height, title, *parts, *named)


def path(points: Iterable[tuple[float, float]], **look: Any) -> str:
    """A line through points [px]."""
    return tag(
        "polyline", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in points), fill="none", **look
    )


class _Axis(NamedTuple):
    """An axis from a value to another, drawn from one place to another [px]."""

    low: float
    high: float
    start: float
    end: float

    @classmethod
    def around(
        cls, values: Sequence[np.ndarray], start: float, end: float, from_zero: bool = False
    ) -> _Axis:
        """An axis around all finite values."""
        known = np.concatenate([value[np.isfinite(value)] for value in values])
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
        low = 0.0 if from_zero else low
        room = 0.04 * (high - low) or 0.05 * abs(high) or 1.0
        return cls(low if from_zero else low - room, high + room, start, end)

    def __call__(self, value: Any) -> Any:
        """Place of a value [px]."""
        share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    @property
    def ticks(self) -> list[float]:
        """Four to nine round values."""
        step = 10.0 ** math.floor(math.log10((self.high - self.low) / 4.0))
        step *= next(
            by for by in (1.0, 2.0, 2.5, 5.0, 10.0) if (self.high - self.low) / (by * step) <= 6
        )
        first, last = math.ceil(self.low / step), math.floor(self.high / step)
        return [number * step for number in range(first, last + 1)]


def _drawn(curve: Curve, across: _Axis, up: _Axis) -> str:
    known = np.isfinite(curve.x) & np.isfinite(curve.y)
    x, y = across(curve.x[known]), up(curve.y[known])
    if curve.points:
        return "".join(
            tag("circle", cx=a, cy=b, r=3.2, fill=curve.colour) for a, b in zip(x, y, strict=True)
        )
    look: dict[str, Any] = {"stroke": curve.colour, "stroke_width": 1.8}
    if curve.dashed:
        look["stroke_dasharray"] = "6 4"
    kept = _sparse(x, y)
    return path(zip(x[kept], y[kept], strict=True), stroke_linejoin="round", **look)


def _sparse(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Numbers of points equally far along a curve, its ends and extremes among them."""
    if len(x) <= POINTS:
        return np.arange(len(x))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    spread = np.searchsorted(way, np.linspace(0.0, way[-1], POINTS))
    ends = [0, len(x) - 1, np.argmin(x), np.argmax(x), np.argmin(y), np.argmax(y)]
    return np.unique(np.concatenate([np.minimum(spread, len(x) - 1), ends]))


def _legend(named: Sequence[Curve], start: float, width: float) -> list[str]:
    """Rows of names of curves above a chart, each behind a piece of its line."""
    rows: list[str] = []
    x = width
    for curve in named:
        room = 40.0 + 6.4 * len(curve.name)
        if x + room > width:
            rows.append("")
            x = start
        y = 16.0 * len(rows) - 7.0
        dash: dict[str, Any] = {"stroke_dasharray": "6 4"} if curve.dashed else {}
        look: dict[str, Any] = {"stroke": curve.colour, "stroke_width": 2.4, **dash}
        rows[-1] += tag("line", x1=x, x2=x + 20, y1=y, y2=y, **look)
        rows[-1] += text(x + 25, y + 4, curve.name)
        x += room
    return rows


def _shown(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float) else escape(str(value))
