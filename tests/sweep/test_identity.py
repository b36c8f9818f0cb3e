"""A sweep is known by its users' code and values."""

import importlib.util
import linecache

import numpy as np
import pytest

import saleg
from saleg import sweep
from saleg.design import Design, MassModel

MODELS = """
from dataclasses import dataclass

import numpy as np

from saleg.laws import Friction

DENSITY = {density}


def per_length(share):
    return {per_length} * share


@dataclass(frozen=True)
class Rod:
    share: float = 1.0

    def mass(self, parameters, operation):
        return DENSITY * per_length(self.share)


class Plain:
    def __init__(self, held):
        self.held = held

    def mass(self, parameters, operation):
        return 0.3


@dataclass(frozen=True)
class Drag(Friction):
    factor: float = 100.0

    def at_dead_centre(self, held, stroke):
        return {drag} * self.factor

    def force(self, held, motion):
        return held * motion.v
"""


def models(folder, density=1.0, per_length=0.3, drag=1.0):
    """A user's module, as another process would import it."""
    file = folder / "own_models.py"
    file.write_text(MODELS.format(density=density, per_length=per_length, drag=drag))
    linecache.clearcache()
    spec = importlib.util.spec_from_file_location("own_models", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_folder_knows_mass_models_by_their_code(tmp_path):
    points, folder = sweep.grid({"bore": [0.064]}), tmp_path / "s"

    def run(rod):
        return sweep.run(points, Design(masses=MassModel(rod=rod)), folder=folder)

    first = run(models(tmp_path).Rod())
    assert run(models(tmp_path).Rod()).equals(first)
    for edited in ({"density": 2.0}, {"per_length": 0.4}):
        with pytest.raises(sweep.SweepError, match="another sweep"):
            run(models(tmp_path, **edited).Rod())
    with pytest.raises(sweep.SweepError, match="another sweep"):
        run(models(tmp_path).Rod(share=1.1))


def test_plain_objects_are_known_by_their_values_or_refused(tmp_path):
    points, kind = sweep.grid({"bore": [0.064]}), models(tmp_path).Plain

    def run(held):
        design = Design(masses=MassModel(rod=kind(held)))
        return sweep.run(points, design, folder=tmp_path / "s", multipliers=False)

    assert run(np.arange(3.0)).equals(run(np.arange(3.0)))
    with pytest.raises(sweep.SweepError, match="another sweep"):
        run(np.arange(4.0))
    with pytest.raises(sweep.SweepError, match=r"masses\.rod\.held is a .*dataclass"):
        run(iter([1.0]))


def test_a_folder_knows_own_laws_by_their_code(tmp_path):
    points, engine = sweep.grid({"bore": [-1.0]}), saleg.machines.thesis_base()

    def run(swept, name):
        """Of an engine that cannot be: who asks is known before anything is compiled."""
        return sweep.run(points, swept, folder=tmp_path / name, multipliers=False)

    for name, base in (("engine", engine), ("design", Design())):
        run(base.replace(friction=models(tmp_path).Drag()), name)
        run(base.replace(friction=models(tmp_path).Drag()), name)
        with pytest.raises(sweep.SweepError, match="another sweep"):
            run(base.replace(friction=models(tmp_path, drag=1.5).Drag()), name)
