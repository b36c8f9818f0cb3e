"""Cards of designs, optimisations, branches and Sobol' indices."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.results import COMPONENT_UNITS
from saleg.display.cards import bars, steady_card
from saleg.display.numbers import number, shown
from saleg.display.page import card, figures, raised
from saleg.display.svg import LEFT, RIGHT, Curve, chart
from saleg.simulation.performance import UNITS
from saleg.simulation.readable import readable

if TYPE_CHECKING:
    from saleg.design.designs import Design
    from saleg.design.results import DesignedState
    from saleg.optimize.result import Found
    from saleg.steady.continuation import Branch
    from saleg.sweep.sobol_indices import Indices

#: What a design adds to the key figures of its steady state.
COMPONENTS = ("power_density", "engine_length", "alternator_diameter", "relative_stroke")
#: Figures of the best design beside its inputs.
BEST = ("power", "efficiency", "compression_ratio", "frequency", "peak_pressure", "moving_mass")


def design_card(design: Design) -> str:
    """The eight parameters of a design."""
    rows = [
        shown(item.name, design.unit(item.name), getattr(design.parameters, item.name))
        for item in dataclasses.fields(design.parameters)
    ]
    told = "design: mass and dimensions follow from its steady state, saleg.design.evaluate"
    return card(design.laws.name, told, figures(rows))


def designed_card(state: DesignedState) -> str:
    """Steady state of a design with what its components add."""
    found = state.component_figures
    rows = [shown(name, COMPONENT_UNITS[name], found[name]) for name in COMPONENTS]
    return steady_card(state, rows)


def found_card(found: Found) -> str:
    """The best design of an optimisation, and how the search went."""
    best, units = found.best, found.table.attrs["units"]
    names = [*found.problem.bounds, found.problem.objectives[0].figure, *BEST]
    rows = [shown(name, units[name], best[name]) for name in dict.fromkeys(names) if name in best]
    course = found.history
    drawn = readable(found.problem.objectives[0].figure, units[found.problem.objectives[0].figure])
    done = course["evaluations"].to_numpy(dtype=float)
    curves = [
        Curve(done, drawn.of(course[name].to_numpy(dtype=float)), colour, words)
        for name, colour, words in (("best", LEFT, "best so far"), ("mean", RIGHT, "mean"))
    ]
    picture = chart("course of the search", curves, "designs evaluated", drawn.label)
    notes = [] if found.succeeded else ["no design has a steady state within all limits"]
    return card("best design", str(found), figures(rows), picture, notes=notes)


def branch_card(branch: Branch) -> str:
    """Where a branch of steady states leads, and stroke and efficiency along it."""
    table = branch.table
    read = readable(branch.path, branch.unit)
    along = read.of(table[branch.path].to_numpy(dtype=float))
    rows = [
        ("steady states", str(len(table)), ""),
        ("from", number(along[0]), read.unit),
        ("to", number(along[-1]), read.unit),
        *(("fold at", number(read.of(value)), read.unit) for value in branch.folds),
        *(
            (kind, f"at {number(read.of(value))}", read.unit)
            for value, kind in branch.stability_changes
        ),
    ]
    pictures = []
    for name in ("stroke", "efficiency"):
        drawn = readable(name, UNITS[name])
        values, stable = drawn.of(table[name].to_numpy()), table["stable"].to_numpy(dtype=bool)
        curves = [
            Curve(
                along,
                np.where(rows_of, values, np.nan),
                colour,
                words if rows_of.any() else "",
                points=True,
            )
            for rows_of, colour, words in ((stable, LEFT, "stable"), (~stable, RIGHT, "unstable"))
        ]
        size = (300.0, 200.0)
        pictures.append(chart(name, curves, raised(read.label), drawn.label, size=size))
    told = f"steady states along {read.words}; {branch.ended}"
    return card(branch.engine.name, told, figures(rows), *pictures)


def indices_card(indices: Indices) -> str:
    """First and total index of every input."""
    table: Any = indices.table
    rows = [
        (str(name), f"{first:.3f} | {total:.3f}", "")
        for name, first, total in zip(table.index, table["first"], table["total"], strict=True)
    ]
    told = "share of the variance an input explains by itself | all that involves it"
    shares = {
        str(name): float(total) for name, total in zip(table.index, table["total"], strict=True)
    }
    return card(f"Sobol' indices of {indices.figure}", told, figures(rows), bars(shares))
