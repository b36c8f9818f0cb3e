"""Files users name: ordinary ones are read, anything else is refused with one clear error."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from saleg.errors import SalegError


def as_path(path: Any, error: type[SalegError]) -> Path:
    """A path from what a user gives as one.

    Raises
    ------
    SalegError
        Of the type `error`, if it is neither text nor a path, or no system has such a name.
    """
    try:
        given = Path(path)
        os.fsencode(given)
        if "\0" in str(given):
            raise ValueError
    except (TypeError, ValueError):
        raise error(f"{path!r} is no name of a file: must be text or a Path") from None
    return given


@contextmanager
def reading(path: Path, error: type[SalegError]) -> Iterator[None]:
    """Refuse what is there but is no ordinary file, and name the file in what goes wrong.

    Raises
    ------
    SalegError
        Of the type `error`.
    """
    try:
        if path.exists() and not path.is_file():
            what = "a folder" if path.is_dir() else "a device, a pipe or the like"
            raise error(f"cannot read {path}: it is {what}, no file")
        yield
    except OSError as trouble:
        if isinstance(trouble, SalegError):
            raise
        raise error(f"cannot read {path}: {trouble.strerror or trouble}") from None


def read_text(path: Any, error: type[SalegError]) -> str:
    """Text of a file in UTF-8, with or without a mark at its beginning.

    Raises
    ------
    SalegError
        Of the type `error`, naming the file and what is wrong with it.
    """
    path = as_path(path, error)
    with reading(path, error):
        content = path.read_bytes()
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as trouble:
        raise error(f"cannot read {path}: it is no text in UTF-8 ({trouble})") from None
