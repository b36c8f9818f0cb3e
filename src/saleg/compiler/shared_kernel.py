"""The kernel without laws, typed and lowered once for all laws that need the same of the state.

It is kept in the cache folder beside its text, with a digest before it, by which what is damaged
there is found and made afresh.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path
from typing import Any

from saleg.compiler import machine_code
from saleg.compiler.cache import warn_of_no_cache
from saleg.compiler.module import DECLARED, digest, load
from saleg.compiler.needs import Needs
from saleg.compiler.text import compose_kernel
from saleg.files.atomic import write_bytes
from saleg.files.lock import locked


class SharedKernel:
    """Kernel without laws.

    Parameters
    ----------
    needs : Needs
        What its laws need of the state.
    """

    def __init__(self, needs: Needs):
        self._text = compose_kernel(needs)
        self._found: dict[Any, bytes] = {}
        #: Name of its text.
        self.digest = digest(self._text)

    def linked(self, names: dict[str, Any]) -> Any:
        """The integrator it makes with the laws of a module, of which these are the names."""
        return machine_code.linked(names, self.bitcode)

    def bitcode(self, run: Any) -> bytes:
        """The kernel for arguments of some type of numba's; the first call lowers it."""
        if run not in self._found:
            self._found[run] = self._kept(run)
        return self._found[run]

    def _kept(self, run: Any) -> bytes:
        """The kernel from the cache folder, put there if need be."""
        module, kept = load(self._text, "shared", {DECLARED: machine_code.declared})
        if kept is None:
            return machine_code.lowered(module.run_on, run)
        path = kept.code / f"{kept.path.stem}.{digest(str(run))}.bc"
        with locked(kept.lock):
            found = _read(path)
            if not found:
                found = machine_code.lowered(module.run_on, run)
                _write(path, found)
        return found


@lru_cache(maxsize=32)
def shared_kernel(needs: Needs) -> SharedKernel:
    """Kernel without laws for those that need certain parts of the state."""
    return SharedKernel(needs)


def _read(path: Path) -> bytes:
    """What a file holds after its digest; nothing if it is not there or damaged."""
    data = path.read_bytes() if path.is_file() else b""
    size = hashlib.sha256().digest_size
    return data[size:] if hashlib.sha256(data[size:]).digest() == data[:size] else b""


def _write(path: Path, data: bytes) -> None:
    """Keep something under its digest."""
    try:
        write_bytes(path, hashlib.sha256(data).digest() + data, mode=0o600)
    except OSError as error:
        warn_of_no_cache(f"{path}: {error.strerror or error}")
