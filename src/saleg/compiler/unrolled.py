"""The adaptive pair written out: a step without tables, its coefficients in the text.

The general step of :mod:`saleg.kernel.general` reads its coefficients from a table, zeros among
them; this one has those of :data:`saleg.kernel.tableaus.ADAPTIVE` in its text, steps only what the
laws at hand need, and holds the right-hand side itself: as a call of its own, with all its arrays
as arguments, that took a sixth longer.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from saleg.compiler.needs import Stretch
from saleg.kernel.adaptive import MANIFOLD
from saleg.kernel.tableaus import ADAPTIVE

STEP = '''\
@compiled
def take_adaptive_step(P, E, C, t, h, y, k, y_new, motored):
    """Advance `y` by `h` into `y_new` with the adaptive pair, written out."""
    for stage in range(1, {stages} + 1):
{moves}
        write_rates(P, E, C, t + node * h, y_new, k[stage], motored)
{keeps}    E.evaluations += {stages}.0


@inline
def defect(k, n):
    """Estimated error of an entry of the state, over the length of the step."""
    return {defect}


@inline
def late_defect(k, n):
    """The same with the rate at the end of the step in the place of that of its last stage."""
    return {late_defect}


@inline
def grows_manifold(k, n):
    """Whether the rate of an entry at the end of the step is many times that at its begin."""
    return k[{stages}, n] > {manifold!r} * k[0, n]
'''
#: Where a stage stands in the step. Quadratures need no stage values: they are summed at its end.
MOVE = """\
        {word} stage == {stage}:
            node = {node!r}
"""
ALONG = """\
            for n in range({first}, {end}):
                y_new[n] = y[n] + h * ({rate})
"""
KEEP = """\
    for n in range({first}, {end}):
        y_new[n] = y[n]
"""


def adaptive_step(
    states: Sequence[Stretch], kept: Sequence[Stretch], sums: Sequence[Stretch]
) -> str:
    """Text of a step of the adaptive pair and of its error.

    Parameters
    ----------
    states : sequence of tuple of int
        Stretches of entries that are stepped.
    kept : sequence of tuple of int
        Stretches of those that stay as they are.
    sums : sequence of tuple of int
        Stretches of those that are summed.
    """
    A, b, c, e = ADAPTIVE
    stages = len(b)
    moves = [_move(stage, c[stage], A[stage][:stage], states) for stage in range(1, stages)]
    moves.append(_move(stages, 1.0, b, [*states, *sums]))
    keeps = "".join(KEEP.format(first=first, end=end) for first, end in kept)
    return STEP.format(
        stages=stages,
        moves="".join(moves).rstrip(),
        keeps=keeps,
        defect=_sum(e),
        late_defect=_sum([*e[:-2], 0.0, e[-2] + e[-1]]),
        manifold=MANIFOLD,
    )


def _move(stage: int, node: float, weights: Iterable[float], stretches: Sequence[Stretch]) -> str:
    """Lines that move the state to a stage."""
    rate = _sum(weights)
    begin = MOVE.format(word="if" if stage == 1 else "elif", stage=stage, node=float(node))
    return begin + "".join(ALONG.format(first=a, end=b, rate=rate) for a, b in stretches)


def _sum(weights: Iterable[float]) -> str:
    """Sum of the weighted rates of an entry, zero weights left out."""
    found = [(j, float(weight)) for j, weight in enumerate(weights) if weight != 0.0]
    return " + ".join(f"{weight!r} * k[{j}, n]" for j, weight in found)
