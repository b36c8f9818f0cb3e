"""Interpolation in tables, for laws: plain functions that run compiled and as Python.

Grids rise; beyond their ends the value at the end holds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence


def interval(x: float, grid: Sequence[float]) -> int:
    """Index i of the interval ``grid[i] <= x < grid[i + 1]``, the outermost ones for x outside."""
    low, high = 0, len(grid) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x < grid[middle]:
            high = middle
        else:
            low = middle
    return low


def share(x: float, grid: Sequence[float], i: int) -> float:
    """Where x lies in an interval, from 0 at its begin to 1 at its end."""
    if len(grid) == 1:
        return 0.0
    return min(max((x - grid[i]) / (grid[i + 1] - grid[i]), 0.0), 1.0)


def next_point(x: float, direction: float, points: Sequence[float]) -> float:
    """Nearest point beyond x on the way up (`direction` 1) or down (-1); infinite if none is."""
    found, nearest = direction * math.inf, math.inf
    for i in range(len(points)):
        way = direction * (points[i] - x)
        if 0.0 < way < nearest:
            found, nearest = points[i], way
    return found


def linear(x: float, grid: Sequence[float], values: Sequence[float]) -> float:
    """Piecewise linear interpolation."""
    if len(grid) == 1:
        return values[0]
    i = interval(x, grid)
    u = share(x, grid, i)
    return values[i] + u * (values[i + 1] - values[i])


def linear_integral(x: float, grid: Sequence[float], values: Sequence[float]) -> float:
    """Integral of :func:`linear` from 0 to x, for x >= 0 and a grid that begins at 0 or above."""
    total = values[0] * min(x, grid[0])
    for i in range(len(grid) - 1):
        width = min(max(x - grid[i], 0.0), grid[i + 1] - grid[i])
        end = values[i] + width / (grid[i + 1] - grid[i]) * (values[i + 1] - values[i])
        total += 0.5 * width * (values[i] + end)
    last = len(grid) - 1
    return total + values[last] * max(x - grid[last], 0.0)


def bilinear(
    x: float,
    y: float,
    x_grid: Sequence[float],
    y_grid: Sequence[float],
    values: Sequence[float],
) -> float:
    """Bilinear interpolation; the values of one x after the other, y running fastest."""
    i, j = interval(x, x_grid), interval(y, y_grid)
    u, v = share(x, x_grid, i), share(y, y_grid, j)
    columns = len(y_grid)
    i_next, j_next = min(i + 1, len(x_grid) - 1), min(j + 1, columns - 1)
    here = values[i * columns + j] * (1.0 - v) + values[i * columns + j_next] * v
    there = values[i_next * columns + j] * (1.0 - v) + values[i_next * columns + j_next] * v
    return here * (1.0 - u) + there * u


def slope(grid: Sequence[float], values: Sequence[float], i: int) -> float:
    """Slope at a point of a monotone cubic (Fritsch and Butland), zero at a turning point."""
    last = len(grid) - 1
    if last == 0:
        return 0.0
    if i == 0:
        return (values[1] - values[0]) / (grid[1] - grid[0])
    if i == last:
        return (values[last] - values[last - 1]) / (grid[last] - grid[last - 1])
    before, after = grid[i] - grid[i - 1], grid[i + 1] - grid[i]
    left, right = (values[i] - values[i - 1]) / before, (values[i + 1] - values[i]) / after
    if left * right <= 0.0:
        return 0.0
    w_left, w_right = 2.0 * after + before, after + 2.0 * before
    return (w_left + w_right) / (w_left / left + w_right / right)


def monotone(x: float, grid: Sequence[float], values: Sequence[float]) -> float:
    """Piecewise cubic through the points, monotone between them, with a continuous slope."""
    i = interval(x, grid)
    h = grid[i + 1] - grid[i]
    u = share(x, grid, i)
    w = 1.0 - u
    a, b = slope(grid, values, i), slope(grid, values, i + 1)
    start = w * w * ((1.0 + 2.0 * u) * values[i] + h * u * a)
    return start + u * u * ((1.0 + 2.0 * w) * values[i + 1] - h * w * b)


def monotone_slope(x: float, grid: Sequence[float], values: Sequence[float]) -> float:
    """Derivative of :func:`monotone`."""
    i = interval(x, grid)
    h = grid[i + 1] - grid[i]
    u = share(x, grid, i)
    w = 1.0 - u
    a, b = slope(grid, values, i), slope(grid, values, i + 1)
    return (
        6.0 * u * w * (values[i + 1] - values[i]) / h
        + w * (w - 2.0 * u) * a
        + u * (u - 2.0 * w) * b
    )


def slopes(grid: Sequence[float], values: Sequence[float], step: int) -> tuple[float, ...]:
    """Slopes at all entries of a table along an axis, whose neighbours are `step` entries apart."""
    found = []
    for n in range(len(values)):
        i = n // step % len(grid)
        first = n - i * step
        found.append(slope(grid, values[first : first + len(grid) * step : step], i))
    return tuple(found)


def cubic_weights(x: float, grid: Sequence[float], i: int) -> tuple[float, float, float, float]:
    """Weights of the values at both ends of an interval and of the slopes there, for a cubic."""
    if len(grid) == 1:
        return 1.0, 0.0, 0.0, 0.0
    u, h = share(x, grid, i), grid[i + 1] - grid[i]
    w = 1.0 - u
    return w * w * (1.0 + 2.0 * u), u * u * (1.0 + 2.0 * w), h * u * w * w, -h * u * u * w


def bicubic(
    tables: tuple[Sequence[float], Sequence[float], Sequence[float]],
    first: int,
    steps: tuple[int, int],
    over_x: tuple[float, float, float, float],
    over_y: tuple[float, float, float, float],
) -> float:
    """Cubic interpolation both ways in a cell of a table, without slopes of slopes.

    `tables` are the values and their slopes over x and y, `first` is the entry at the cell's first
    corner, `steps` lead on from it, and `over_x` and `over_y` are :func:`cubic_weights`.
    """
    values, x_slopes, y_slopes = tables
    total = 0.0
    for a in range(2):
        for b in range(2):
            n = first + a * steps[0] + b * steps[1]
            total += over_x[a] * (over_y[b] * values[n] + over_y[2 + b] * y_slopes[n])
            total += over_x[2 + a] * over_y[b] * x_slopes[n]
    return total
