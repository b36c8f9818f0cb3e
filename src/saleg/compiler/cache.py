"""The folder where composed modules and their machine code are kept.

It belongs to the user alone: machine code found there is executed. A module is used only if its
text is exactly the composed one; its name is no proof. Machine code is used only if the folders it
lies in and its files are the user's own and nobody else can write to them.
"""

from __future__ import annotations

import os
import stat
import sys
import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple, TypeVar

from saleg.compiler import machine_code

Result = TypeVar("Result")


def cache_folder() -> Path:
    """Folder of composed modules: ``SALEG_CACHE_DIR``, or ``saleg`` in the user's cache folder.

    Raises
    ------
    RuntimeError
        If the user has no home folder.
    """
    chosen = os.environ.get("SALEG_CACHE_DIR")
    if chosen:
        return Path(chosen).expanduser()
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
    else:
        base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "saleg"


def usable_folder() -> Path | None:
    """The cache folder, made if need be; None, with a warning, if it is not the user's alone."""
    try:
        folder = cache_folder()
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(f"{folder}: not writable")
        _close_if_new(folder)
        _refuse_strange(folder.resolve(), stat.S_ISDIR)
    except (OSError, RuntimeError) as error:
        warn_of_no_cache(str(error))
        return None
    return folder


@lru_cache
def warn_of_no_cache(reason: str) -> None:
    """Say once that machine code is not kept, and why.

    Python itself would say it for every kernel: what it has said is forgotten as numba compiles.
    """
    warnings.warn(
        f"compiled kernels are not kept: {reason}; set SALEG_CACHE_DIR to a folder of your own",
        RuntimeWarning,
        stacklevel=3,
    )


class Kept(NamedTuple):
    """A module kept on disk.

    Attributes
    ----------
    path : Path
        Its text.
    code : Path
        Folder of its machine code.
    """

    path: Path
    code: Path

    @property
    def lock(self) -> Path:
        """File that serialises compilation among processes."""
        return self.path.with_suffix(".lock")

    def has_code(self, name: str) -> bool:
        """Whether there is machine code of an entry point."""
        return any(self.code.glob(f"{self.path.stem}.{name}-*.nbi"))

    def check(self) -> None:
        """Refuse machine code others may have written.

        Raises
        ------
        PermissionError
            Naming the folder or file.
        """
        above = [self.path.parent] if self.path.parent in self.code.parents else []
        _close_if_new(self.code)
        _refuse_strange(self.code, stat.S_ISDIR, above)
        for file in self._files():
            _refuse_strange(file, stat.S_ISREG, [*above, self.code])

    def mended(self, action: Callable[[], Result]) -> Result:
        """Do what loads or compiles machine code; if what is there is damaged, without it."""
        try:
            return action()
        except machine_code.refusals():
            raise
        except Exception:
            for file in self._files():
                file.unlink(missing_ok=True)
            return action()

    def _files(self) -> list[Path]:
        """Files of machine code."""
        return list(self.code.glob(f"{self.path.stem}*"))


def _close_if_new(folder: Path) -> None:
    """Close a folder of ours, left open to its group by a mask of 002, before anything is in it."""
    if sys.platform == "win32":
        return
    status = folder.stat()
    only_group = status.st_mode & 0o022 == 0o020
    if only_group and status.st_uid == os.getuid() and not any(folder.iterdir()):
        folder.chmod(0o700)


def _refuse_strange(
    path: Path, is_right: Callable[[int], bool], above: Sequence[Path] = ()
) -> None:
    """Refuse what is not ours alone; where a folder above is closed, others cannot reach it."""
    if sys.platform == "win32":
        return
    status = path.lstat()
    if not is_right(status.st_mode):
        raise PermissionError(f"{path}: something else stands there, or a link")
    if status.st_uid != os.getuid():
        raise PermissionError(f"{path}: belongs to another user")
    if status.st_mode & 0o022 and all(folder.stat().st_mode & 0o011 for folder in above):
        raise PermissionError(f"{path}: others may write to it")
