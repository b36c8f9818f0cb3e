"""Words of HTML that cards are written in: readable in light and dark, without script.

What is called text is escaped here; parts are HTML already. Colours of text and lines are those of
the page around the card.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

_SIDE_BY_SIDE = "display: flex; flex-wrap: wrap; gap: 0.4em 2em; align-items: flex-start"
_FAINT = "opacity: 0.72"
_CELL = "padding: 0.1em 0.7em 0.1em 0; text-align: left; background: none; border: none"
_NUMBER = f"{_CELL}; text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap"


def card(title: str, subtitle: str, *parts: str, notes: Iterable[str] = ()) -> str:
    """A card: title and subtitle (text), parts (HTML) side by side, and notes (text) below."""
    below = "".join(f'<div style="{_FAINT}; font-size: 90%">{escape(note)}</div>' for note in notes)
    head = f"<b>{escape(title)}</b>"
    told = f'<div style="{_FAINT}">{escape(subtitle)}</div>' if subtitle else ""
    inside = f'<div style="{_SIDE_BY_SIDE}">{"".join(parts)}</div>'
    return f'<div style="line-height: 1.4; max-width: 68em">{head}{told}{inside}{below}</div>'


def figures(rows: Iterable[tuple[str, str, str]]) -> str:
    """Table of names, numbers and units (text)."""
    lines = (
        f'<tr style="background: none"><td style="{_CELL}">{escape(name)}</td>'
        f'<td style="{_NUMBER}; padding-right: 0.3em">{escape(number)}</td>'
        f'<td style="{_CELL}">{escape(raised(unit))}</td></tr>'
        for name, number, unit in rows
    )
    return f'<table style="border-collapse: collapse; margin: 0.4em 0">{"".join(lines)}</table>'


def raised(unit: str) -> str:
    """A unit with its exponents set as such."""
    return unit.replace("^2", "²").replace("^3", "³")


def details(summary: str, *parts: str) -> str:
    """Parts (HTML) that open under a summary (text)."""
    return f"<details><summary>{escape(summary)}</summary>{''.join(parts)}</details>"


def column(*parts: str) -> str:
    """Parts (HTML) one below the other."""
    return f"<div>{''.join(parts)}</div>"


def grid(heads: Sequence[Sequence[str]], rows: Iterable[Sequence[str]]) -> str:
    """Table with heads of one or more lines and rows, all of them text; wide ones scroll."""
    head = "".join(
        _line(line, "th", "font-weight: 600" if not i else _FAINT) for i, line in enumerate(heads)
    )
    body = "".join(_line(row, "td", "") for row in rows)
    inside = f"<thead>{head}</thead><tbody>{body}</tbody>"
    table = f'<table style="border-collapse: collapse">{inside}</table>'
    return f'<div style="overflow-x: auto; max-width: 100%">{table}</div>'


def _line(cells: Sequence[str], tag: str, look: str) -> str:
    looks = [f"{_CELL}; {look}", *[f"{_NUMBER}; {look}"] * (len(cells) - 1)]
    inside = "".join(
        f'<{tag} style="{style}">{escape(cell)}</{tag}>'
        for style, cell in zip(looks, cells, strict=True)
    )
    return f'<tr style="background: none">{inside}</tr>'
