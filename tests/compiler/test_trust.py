"""What of the cache is executed: what is the user's own, and nobody else could have written."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from saleg.compiler.kernel import Kernel
from saleg.compiler.module import load

TEXT = """
import numba

@numba.njit(cache=ON_DISK)
def double(x):
    return 2.0 * x
"""

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="owners and modes of POSIX")


class Planted:
    """Leaves a file behind when it is unpickled."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return Path.touch, (self.mark,)


@pytest.fixture(params=["in the cache folder", "NUMBA_CACHE_DIR"])
def cache(request, tmp_path, monkeypatch):
    """A cache folder others may look into, with the machine code of one module."""
    folder = tmp_path / "cache"
    folder.mkdir(mode=0o755)
    monkeypatch.setenv("SALEG_CACHE_DIR", str(folder))
    if request.param == "NUMBA_CACHE_DIR":
        monkeypatch.setattr("numba.config.CACHE_DIR", str(tmp_path / "numba"))
    assert doubled() is not None
    return folder


def doubled():
    """What a new process does with the module; where it keeps it."""
    module, kept = load(TEXT, "toy")
    assert Kernel(module, kept).call("double", 1.5) == 3.0
    return kept


def index_of(kept):
    (index,) = kept.code.glob("*.nbi")
    return index


def plant(index, mark):
    index.write_bytes(pickle.dumps(Planted(mark)))
    return index


def test_what_is_ours_is_loaded_and_what_is_damaged_is_mended(cache, tmp_path):
    kept = doubled()
    module, _ = load(TEXT, "toy")
    Kernel(module, kept).call("double", 1.5)
    assert sum(module.double.stats.cache_hits.values()) == 1
    plant(index_of(kept), tmp_path / "mark")  # by ourselves: this shows the attack is one
    doubled()
    assert (tmp_path / "mark").exists()
    whole = index_of(kept).read_bytes()
    for damage in (b"", whole[:40], b"no pickle", pickle.dumps(None)):
        index_of(kept).write_bytes(damage)
        assert doubled() == kept
        assert index_of(kept).read_bytes() == whole


def open_folder(index):
    index.parent.chmod(0o777)


def open_file(index):
    index.chmod(0o666)


def link(index):
    index.rename(index.with_name("elsewhere"))
    index.symlink_to("elsewhere")


def folder(index):
    index.unlink()
    index.mkdir()


def foreign(index):
    os.chown(index, 12345, 12345)


def foreign_folder(index):
    os.chown(index.parent, 12345, 12345)


NEEDS_ROOT = pytest.mark.skipif(
    sys.platform == "win32" or os.getuid() != 0, reason="gives files away"
)


@pytest.mark.parametrize(
    "expose",
    [
        open_folder,
        open_file,
        link,
        folder,
        pytest.param(foreign, marks=NEEDS_ROOT),
        pytest.param(foreign_folder, marks=NEEDS_ROOT),
    ],
)
def test_what_others_may_have_written_is_not_loaded(cache, tmp_path, expose):
    """Before, only the top folder was looked at: the planted index was executed."""
    index = plant(index_of(doubled()), tmp_path / "mark")
    expose(index)
    with pytest.warns(RuntimeWarning, match="are not kept") as caught:
        assert doubled() is None
    assert len(caught) == 1
    assert str(index.parent) in str(caught[0].message)
    assert not (tmp_path / "mark").exists()


@pytest.mark.parametrize("mask", [0o002, 0o000])
def test_any_mask_of_new_files_leaves_a_cache_that_is_used(tmp_path, monkeypatch, mask):
    """Numba's files are then open to others, but the folder they are in is closed."""
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path / "new"))
    before = os.umask(mask)
    try:
        assert doubled() == doubled() is not None
    finally:
        os.umask(before)


def test_a_new_folder_open_to_its_group_is_closed_and_used(tmp_path, monkeypatch):
    """As ``mkdir`` makes it under a mask of 002."""
    folder = tmp_path / "cache"
    folder.mkdir()
    folder.chmod(0o775)
    monkeypatch.setenv("SALEG_CACHE_DIR", str(folder))
    assert doubled() is not None
    assert folder.stat().st_mode & 0o077 == 0
    folder.chmod(0o775)  # what is in it now may be anybody's
    with pytest.warns(RuntimeWarning, match="others may write"):
        assert doubled() is None


NOWHERE = """
import os
import numba
import saleg.compiler.inner_functions  # imported late otherwise, when it may not be readable
from saleg.compiler.kernel import Kernel
from saleg.compiler.module import load
numba.njit(lambda x: x)(1.0)  # all of numba is imported while it can be read
os.environ.pop("HOME", None)
os.environ.pop("XDG_CACHE_HOME", None)
os.setgroups([])
os.setgid(54321)
os.setuid(54321)
for _ in range(2):
    module, kept = load({text!r}, "toy")
    assert kept is None
    assert Kernel(module, kept).call("double", 1.5) == 3.0
print("fine")
"""


@NEEDS_ROOT
def test_a_user_without_a_home_compiles_in_memory(tmp_path):
    """As in any container started with ``--user``."""
    environment = {k: v for k, v in os.environ.items() if not k.endswith("CACHE_DIR")}
    out = subprocess.run(
        [sys.executable, "-W", "default", "-c", NOWHERE.format(text=TEXT)],
        capture_output=True,
        text=True,
        env=environment,
        cwd="/",
    )
    assert out.stdout.strip() == "fine", out.stderr
    assert out.stderr.count("RuntimeWarning") == 1
    assert "home" in out.stderr


def test_a_full_disk_leaves_kernels_in_memory(tmp_path, monkeypatch):
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.warns(RuntimeWarning, match="No space left"):
        assert doubled() is None


CONTROLLER = """
import numba

@numba.cfunc("float64(float64)", cache=ON_DISK)
def entry(x):
    return 2.0 * x
"""


def test_damaged_code_of_a_controller_is_mended(tmp_path, monkeypatch):
    """It is loaded as its module is executed."""
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))
    index = index_of(load(CONTROLLER, "toy").kept)
    for damage in (b"", b"no pickle"):
        index.write_bytes(damage)
        module, kept = load(CONTROLLER, "toy")
        assert module.entry.ctypes(1.5) == 3.0
        assert index_of(kept).stat().st_size > 40
