"""The folder where composed modules and their machine code are kept.

It belongs to the user alone: machine code found there is executed. A module is used only if its
text is exactly the composed one; its name is no proof.
"""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path


def cache_folder() -> Path:
    """Folder of composed modules: ``SALEG_CACHE_DIR``, or ``saleg`` in the user's cache folder."""
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
    folder = cache_folder()
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        reason = _distrust(folder)
    except OSError as error:
        reason = str(error)
    if reason is None:
        return folder
    warnings.warn(
        f"compiled kernels are not kept: {folder}: {reason}; set SALEG_CACHE_DIR to a folder of "
        "your own",
        RuntimeWarning,
        stacklevel=2,
    )
    return None


def _distrust(folder: Path) -> str | None:
    """Why a folder must not be trusted; None if it may be."""
    if not os.access(folder, os.W_OK):
        return "not writable"
    if sys.platform == "win32":
        return None
    status = folder.stat()
    if status.st_uid != os.getuid():
        return "belongs to another user"
    if status.st_mode & 0o022:
        return "others may write to it"
    return None
