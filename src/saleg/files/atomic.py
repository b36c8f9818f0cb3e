"""Files and folders that are there whole or not at all."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from saleg.errors import RunFileError, SalegError
from saleg.files.reading import expanded, is_folder
from saleg.files.signals import ending_in_order, held_off


def write_text(path: Path, text: str, mode: int = 0o666) -> None:
    """Write a text file, the same on every system, in place of an earlier one.

    Parameters
    ----------
    path : Path
        The file wanted, in a folder that is there.
    text : str
    mode : int
        Who may read and write it, less what the user's mask takes away.

    Raises
    ------
    OSError
        If it cannot be written; an earlier file then stays as it was.
    """
    write_bytes(path, text.encode(), mode)


def write_bytes(path: Path, data: bytes, mode: int = 0o666) -> None:
    """Write a file of bytes in the same way."""

    def opened(name: str, flags: int) -> int:
        return os.open(name, flags, mode)

    temporary = _beside(path)
    with ending_in_order():
        try:
            with open(temporary, "xb", opener=opened) as file:
                file.write(data)
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


@contextmanager
def new_file(target: Path, overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary name beside `target`; the file written there takes its place at the end.

    Parameters
    ----------
    target : Path
        The file wanted; folders above it are made.
    overwrite : bool
        Replace an earlier file; it stays until the new one is complete.

    Yields
    ------
    Path
        Where to write. It is removed if anything goes wrong, Ctrl-C and SIGTERM included.

    Raises
    ------
    RunFileError
        If the target is in the way or cannot be written.
    """

    def check(path: Path) -> None:
        _no_file_above(path)
        if path.is_dir():
            raise RunFileError(f"{path} is a folder; name a file")
        if path.exists() and not overwrite:
            raise RunFileError(f"{path} exists already; name another file, or pass overwrite=True")
        is_folder(path, RunFileError)  # refuses devices and pipes

    with ending_in_order(), _taking_its_place(target, check) as temporary:
        yield temporary


@contextmanager
def new_folder(
    target: Path,
    overwrite: bool = False,
    known: Collection[str] = (),
    how: str = "pass overwrite=True",
) -> Iterator[Path]:
    """Give a temporary folder beside `target` that takes its place once all is written.

    Parameters
    ----------
    target : Path
        The folder wanted; folders above it are made.
    overwrite : bool
        Replace an earlier folder of ours; it stays until the new one is complete.
    known : collection of str
        Names of the files a folder of ours may hold; one with others is never replaced.
    how : str
        What a user has to do to replace a folder, for the message.

    Yields
    ------
    Path
        Folder to write to. It is removed if anything goes wrong, Ctrl-C and SIGTERM included.

    Raises
    ------
    RunFileError
        If the target is in the way or cannot be written.
    """

    def check(path: Path) -> None:
        _no_file_above(path / "any")
        if path.exists() and not overwrite:
            raise RunFileError(f"{path} exists already; name another folder, or {how}")
        _refuse_strange(path, known)

    with ending_in_order(), _taking_its_place(target, check) as temporary:
        temporary.mkdir()
        yield temporary


@contextmanager
def _taking_its_place(target: Path, check: Callable[[Path], None]) -> Iterator[Path]:
    made: list[Path] = []
    try:
        target = expanded(target).resolve()
        check(target)
        made = _make_parents(target)
        temporary = _beside(target)
        made.append(temporary)
        yield temporary
        check(target)
        _put_in_place(temporary, target)
    except BaseException as error:
        _remove(made)
        if isinstance(error, OSError) and not isinstance(error, SalegError):
            raise RunFileError(f"cannot write {target}: {error.strerror or error}") from None
        raise


def _beside(path: Path) -> Path:
    """A hidden name in the same folder that nobody else uses."""
    return path.with_name(f".{path.name}-{os.getpid()}-{secrets.token_hex(8)}")


def _no_file_above(path: Path) -> None:
    for folder in path.parents:
        if folder.exists() and not folder.is_dir():
            raise RunFileError(f"{folder} is a file; name another folder")


def _refuse_strange(folder: Path, known: Collection[str]) -> None:
    """Refuse to replace a folder with anything in it that is not ours."""
    entries = sorted(folder.iterdir()) if folder.exists() else []
    strange = [entry.name for entry in entries if entry.name not in known or not entry.is_file()]
    if strange:
        raise RunFileError(
            f"{folder} holds what no run of saleg writes ({', '.join(strange[:3])}"
            f"{', ...' if len(strange) > 3 else ''}) and is left alone; name another folder"
        )


def _make_parents(target: Path) -> list[Path]:
    """Make the folders above the target; returns those that were missing, outermost first."""
    missing = [folder for folder in reversed(target.parents) if not folder.exists()]
    target.parent.mkdir(parents=True, exist_ok=True)
    return missing


def _remove(made: list[Path]) -> None:
    """Remove the temporary file or folder and what was made above it, as far as it is empty."""
    with held_off():
        if made and made[-1].is_dir():
            shutil.rmtree(made[-1], ignore_errors=True)
        elif made:
            made[-1].unlink(missing_ok=True)
        for folder in reversed(made[:-1]):
            try:
                folder.rmdir()
            except OSError:
                return


def _put_in_place(temporary: Path, target: Path) -> None:
    """Give what is complete its name; a folder that had it is set aside, then removed."""
    with held_off():
        if not target.is_dir():
            os.replace(temporary, target)
            return
        aside = temporary.with_name(f"{temporary.name}-old")
        target.rename(aside)
        try:
            temporary.rename(target)
        except BaseException:
            aside.rename(target)
            raise
        shutil.rmtree(aside)
