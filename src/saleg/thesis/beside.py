"""A run of one of the thesis' engines beside what its tables print."""

from __future__ import annotations

from typing import NamedTuple

from saleg import Engine, Run
from saleg.machines import CATALOGUE
from saleg.simulation.performance import FIGURES
from saleg.simulation.readable import readable
from saleg.thesis.tables import TABLE_2, TABLE_5, columns


class Column(NamedTuple):
    """One published set of results.

    Attributes
    ----------
    title : str
        Where it is printed.
    figures : dict of str to float
        Figures of :class:`saleg.Performance` by name, in SI.
    """

    title: str
    figures: dict[str, float]


def _results(number: int) -> dict[str, float]:
    """Results of Table 1 or 13 under the names of :class:`saleg.Performance`."""
    printed = columns(number)["value"]
    printed["charge_mass"] = printed.pop("mixture_mass")
    names = [name for name in FIGURES if name != "moving_mass"]
    return {name: printed[name] for name in names if name in printed}


TABLE_1 = Column("Table 1 (5 us)", _results(1))
TABLE_13 = Column("Table 13 (5 us)", _results(13))
#: Table 2 at a step of 0.5 us; compression ratio and frequency from the base row of Table 5.
FINEST = Column(
    "finest (T. 2, 5)",
    {name: value for name, value in TABLE_2[5e-7].items() if name != "cost"}
    | {name: TABLE_5["single Wiebe (base)"][name] for name in ("compression_ratio", "frequency")},
)
COLUMNS = {"thesis-base": (TABLE_1, FINEST), "thesis-transient": (TABLE_13,)}

REMARKS = {
    "thesis-base": """\
Why they differ: the thesis takes steps of 5 us, and its results still move with the step (first
order: 0.25 points of efficiency per us, Table 2). saleg ends its steps exactly on the events, so
the column to compare with is the finest one: Table 2 at 0.5 us, compression ratio and frequency
from Table 5. Power and fuel energy come out 2-3 % higher because the fuel energy of Table 1,
1.38 kJ, lies 2.2 % below what the charge it describes holds; efficiency is free of that.""",
    "thesis-transient": """\
Why they differ: the fuel energy of Table 13, 222 J, lies 2.5 % below what the charge it describes
holds, and power and alternator force are higher in step with it; efficiency is free of that. The
thesis' steps of 5 us add a first-order error (Table 2 shows it for the base case).""",
}


def comparison(run: Run) -> str | None:
    """Performance of a run beside what the thesis prints.

    Parameters
    ----------
    run : Run

    Returns
    -------
    str or None
        An aligned table of the figures printed there, with deviations in percent, and an
        explanation; None unless the engine is one of the thesis', unmodified, and completed a
        cycle.
    """
    name = run.engine.name
    if not is_published(run.engine) or run.last_cycle_strokes is None:
        return None
    beside = COLUMNS[name]
    head = f"  {'':<24} {'saleg':>10} {'':<6}"
    head += "".join(f" {column.title:>16} {'':>8}" for column in beside)
    lines = [head.rstrip()]
    for figure, (unit, label, digits, _) in FIGURES.items():
        if not any(figure in column.figures for column in beside):
            continue
        shown = readable(figure, unit)
        value = shown.of(getattr(run.performance, figure))
        text = f"  {label:<24} {value:>10.{digits}f} {'' if shown.unit == '-' else shown.unit:<6}"
        text += "".join(_beside(column, figure, value, shown.factor) for column in beside)
        lines.append(text.rstrip())
    return "\n".join([*lines, "", REMARKS[name]])


def is_published(engine: Engine) -> bool:
    """Whether an engine is one of the thesis', with nothing changed.

    Parameters
    ----------
    engine : Engine

    Returns
    -------
    bool
    """
    return engine.name in COLUMNS and engine == CATALOGUE[engine.name]()


def _beside(column: Column, figure: str, value: float, factor: float) -> str:
    """A figure as printed and how far the value, in the readable unit, is from it."""
    if figure not in column.figures:
        return f" {'':>16} {'':>8}"
    printed = column.figures[figure] * factor
    return f" {printed:>16g} {100.0 * (value / printed - 1.0):>+6.1f} %"
