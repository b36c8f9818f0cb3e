"""MATLAB's ``.mat`` (version 5): a struct of column vectors per table, and beside it its units."""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from saleg.errors import RunFileError
from saleg.export.description import Description, Stored
from saleg.export.units import CODES, LAYOUTS

KIND = "MATLAB file"
#: Bytes of the head of a file, and of the text it begins with.
HEAD, HEAD_TEXT = 128, 116
BLOCK = 1 << 20
#: Longest name in MATLAB.
LONGEST = 63
WORDS = """break case catch classdef continue else elseif end for function global if otherwise
parfor persistent return spmd switch try while"""
KEYWORDS = frozenset(WORDS.split())


def legal_names(names: Iterable[str]) -> dict[str, str]:
    """Names MATLAB accepts, all different, for names of any kind.

    A name that is legal already stays; scipy would silently drop some of the others.

    Parameters
    ----------
    names : iterable of str

    Returns
    -------
    dict of str to str
        Legal name by name.

    Examples
    --------
    >>> legal_names(["stroke", "2nd stroke", "_held", "end"])
    {'stroke': 'stroke', '2nd stroke': 'x2nd_stroke', '_held': 'x_held', 'end': 'xend'}
    """
    wanted = list(dict.fromkeys(names))
    legal = {name: name for name in wanted if _legal(name) == name}
    for name in wanted:
        if name not in legal:
            legal[name] = _unlike(_legal(name), set(legal.values()))
    return {name: legal[name] for name in wanted}


def _legal(name: str) -> str:
    made = re.sub(r"[^A-Za-z0-9_]", "_", name)
    if not re.match("[A-Za-z]", made) or made in KEYWORDS:
        made = "x" + made
    return made[:LONGEST]


def _unlike(name: str, taken: set[str]) -> str:
    """The name, or the first numbered one that is free."""
    number, free = 1, name
    while free in taken:
        number += 1
        free = f"{name[: LONGEST - len(str(number)) - 1]}_{number}"
    return free


def write(description: Description, path: Path) -> None:
    """Write a description; columns go to the file one by one."""
    from scipy.io import savemat
    from scipy.io.matlab import MatWriteError

    content: dict[str, Any] = {}
    for table, columns in description.tables.items():
        legal = legal_names(columns)
        content[table] = {legal[name]: held.values for name, held in columns.items()}
        content[f"{table}_units"] = {legal[name]: held.unit for name, held in columns.items()}
    content["codes"] = {name: np.array(words) for name, words in CODES.items()}
    content |= description.texts  # last: without them a file that was cut short is none
    with open(path, "wb+") as file:
        try:
            savemat(file, content, long_field_names=True, oned_as="column")
        except MatWriteError as error:
            raise RunFileError(f"too much for a MATLAB file ({error}); use .h5") from None
        mark = _mark(file)
        file.seek(0)
        file.write(mark)


def _mark(file: BinaryIO) -> bytes:
    """Text for the head of a file, with the checksum of all that follows the head."""
    file.seek(HEAD)
    total = 0
    while block := file.read(BLOCK):
        total = zlib.crc32(block, total)
    return f"MATLAB 5.0 MAT-file, written by saleg, CRC-32 {total:08x}".ljust(HEAD_TEXT).encode()


def _refuse_damaged(path: Path) -> None:
    """Refuse a file of ours that has changed, as scipy's reader may crash on one."""
    with open(path, "rb") as file:
        head = file.read(HEAD_TEXT)
        if b"saleg" not in head:
            raise RunFileError("saleg did not write it, or it is damaged")
        if head != _mark(file):
            raise RunFileError("it is damaged or was cut short")


@contextmanager
def opened(path: Path) -> Iterator[Stored]:
    """Look into a file for reading, table by table."""
    from scipy.io import loadmat

    _refuse_damaged(path)

    def variables(*names: str) -> list[Any]:
        found = loadmat(path, appendmat=False, variable_names=names)
        return [found[name] for name in names]

    @lru_cache(maxsize=1)
    def struct(table: str) -> np.ndarray:
        return variables(table)[0][0, 0]

    def column(table: str, name: str) -> np.ndarray:
        word = legal_names(LAYOUTS[table].places)[name]
        if word not in (struct(table).dtype.names or ()):
            raise KeyError(name)
        return struct(table)[word].reshape(-1)

    engine_toml, run_json = (str(text[0]) for text in variables("engine_toml", "run_json"))
    yield Stored(engine_toml, run_json, column)
