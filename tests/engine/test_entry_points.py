"""Laws and machines other installed packages offer."""

import pytest

import saleg
from saleg.engine.toml import laws_by_slot
from saleg.files.entry_points import offered

MODULE = """
import dataclasses
import saleg
from saleg.quantities import quantity


@dataclasses.dataclass(frozen=True)
class CubicSprings(saleg.laws.base.Springs):
    stiffness: float = quantity("N/m^3", default=1e6, low=0)

    def force(self, motion):
        return -self.stiffness * motion.x**3

    def energy(self, motion):
        return 0.25 * self.stiffness * motion.x**4


def rig():
    return saleg.machines.thesis_base().replace(moving_mass=3.0, springs=CubicSprings())
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Installed package with a law, a machine, one under a name of ours and a broken one."""
    (tmp_path / "rigs_of_others.py").write_text(MODULE)
    info = tmp_path / "rigs_of_others-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: rigs-of-others\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[saleg.laws]\nCubicSprings = rigs_of_others:CubicSprings\n"
        "[saleg.machines]\nrig = rigs_of_others:rig\nthesis-base = rigs_of_others:rig\n"
        "broken = no_such_module:rig\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    offered.cache_clear()
    yield
    offered.cache_clear()


def test_laws_and_machines_of_others_have_names(package, tmp_path):
    with pytest.warns(saleg.SalegWarning, match="no_such_module:rig of saleg.machines"):
        machines = saleg.machines.catalogue()
    assert set(machines) == {"rig", *saleg.machines.CATALOGUE}
    assert machines["thesis-base"] is saleg.machines.thesis_base
    assert "CubicSprings" in laws_by_slot()["springs"]
    path = tmp_path / "rig.toml"
    path.write_text(machines["rig"]().to_toml())
    assert saleg.Engine.from_toml(path) == machines["rig"]()


def test_without_others_there_are_ours():
    offered.cache_clear()
    assert saleg.machines.catalogue() == saleg.machines.CATALOGUE
