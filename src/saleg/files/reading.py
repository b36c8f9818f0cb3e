"""Files users name: ordinary ones are read, anything else is refused with one clear error."""

from __future__ import annotations

import codecs
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from saleg.errors import SalegError, shown


def expanded(path: str | os.PathLike[str]) -> Path:
    """A path with ``~`` at its beginning as the home folder, where there is one."""
    return Path(os.path.expanduser(path))


def as_path(path: Any, error: type[SalegError], name: str = "path") -> Path:
    """A path from what a user gives as one, ``~`` being the home folder.

    Raises
    ------
    SalegError
        Of the type `error`, if it is neither text nor a path, or no system has such a name.
    """
    try:
        given = expanded(path)
        os.fsencode(given)
        if "\0" in str(given):
            raise ValueError
    except (TypeError, ValueError):
        raise error(
            f"{name} = {shown(path)}: must be text or a Path, and a possible name"
        ) from None
    return given


@contextmanager
def named(path: Path, error: type[SalegError], verb: str = "read") -> Iterator[None]:
    """Name a file in what the system says of it.

    Raises
    ------
    SalegError
        Of the type `error`.
    """
    try:
        yield
    except OSError as trouble:
        if isinstance(trouble, SalegError):
            raise
        raise error(f"cannot {verb} {path}: {trouble.strerror or trouble}") from None


def is_folder(path: Path, error: type[SalegError]) -> bool:
    """Whether a path is that of a folder; what is neither file nor folder is refused.

    A pipe or a device would be waited for without end.
    """
    with named(path, error):
        mode = path.stat().st_mode if path.exists() else stat.S_IFREG
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        raise error(f"cannot read {path}: it is a pipe, a device or the like, no file")
    return stat.S_ISDIR(mode)


def read_text(path: Any, error: type[SalegError]) -> str:
    """Text of a file in UTF-8, with or without a mark at its beginning.

    Raises
    ------
    SalegError
        Of the type `error`, naming the file and what is wrong with it.
    """
    given, path = path, as_path(path, error)
    if "\n" in str(path) and not os.path.exists(path):
        raise error(f"path = {shown(given)}: must be the path of a file, and not its text")
    if is_folder(path, error):
        raise error(f"cannot read {path}: it is a folder, no file")
    with named(path, error):
        content = path.read_bytes()
    try:
        return decoded(content)
    except ValueError as trouble:
        raise error(f"cannot read {path}: {trouble}") from None


def decoded(content: bytes) -> str:
    """Text of bytes in UTF-8, with or without a mark at their beginning.

    Raises
    ------
    ValueError
        Saying what they are instead.
    """
    refuse_utf16(content)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as trouble:
        raise ValueError(f"it is no text in UTF-8 ({trouble})") from None


def refuse_utf16(beginning: bytes) -> None:
    """Raise a ValueError if a file begins as one that an editor saved in UTF-16."""
    if beginning.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise ValueError("it is text in UTF-16; save it as UTF-8")
