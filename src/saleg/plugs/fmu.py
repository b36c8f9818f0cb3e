"""Export of an engine as a functional mock-up unit: FMI 2.0, co-simulation.

The unit holds the engine, its settings and a few lines that hand it to
:class:`saleg.plugs.fmu_slave.EngineSlave`. It runs in the Python of its host, in which saleg has to
be installed; the library that calls Python comes from pythonfmu, for Linux and Windows.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from keyword import iskeyword
from os import PathLike
from pathlib import Path
from typing import Any

from saleg.checks import FLAG, NAMES, Check, a
from saleg.engine import Engine
from saleg.engine.paths import MAIN_INPUTS, get
from saleg.errors import Problem, UnknownPath, WrongArguments
from saleg.export.extras import extra
from saleg.files.atomic import new_file
from saleg.quantities import is_number
from saleg.simulation.settings import Settings, refuse

#: What a unit is made of beside its engine.
SCRIPT = '''"""An engine as a functional mock-up unit, by saleg."""

from saleg.plugs.fmu_slave import EngineSlave, hold

hold()  # before the class, which may have any name


class {name}(EngineSlave):
    """The engine in engine.toml."""
'''
ENGINE_FILE = "engine.toml"
SETTINGS_FILE = "saleg.json"


def to_fmu(
    engine: Engine,
    path: str | Path,
    *,
    parameters: Sequence[str] | None = None,
    overwrite: bool = False,
    **settings: Any,
) -> Path:
    """Write an engine as a functional mock-up unit (FMI 2.0, co-simulation).

    Parameters
    ----------
    engine : Engine
        Of laws an engine file may name.
    path : str or Path
        Of the unit, ending in ``.fmu``; without that it is the name of the model.
    parameters : sequence of str, optional
        Paths of the engine's numbers that the host may set before the run; what is usually told of
        an engine first unless given.
    overwrite : bool
        Replace an earlier file.
    **settings
        Further settings of :func:`saleg.simulate`.

    Returns
    -------
    Path
        Of the unit.

    Raises
    ------
    InvalidEngine, SettingsError, UnknownPath, WrongArguments
        Naming all that is wrong with the engine, the settings, the parameters, or several of them.
    SalegError
        If pythonfmu is not installed, or the file cannot be written or is there already.

    Notes
    -----
    The steps of the host end steps of the integrator and change it by no more than its tolerance.
    Inputs are the commands of :class:`saleg.laws.Commands` as ``command.load_weight`` and so on, in
    force from the step after the host sets them, and ``command.regulated``, true unless set: the
    alternator's own regulator then sets the load weight. Whatever the host leaves alone is as the
    engine has it. Outputs are motion, gas and alternator at the instant, and the figures of the
    latest stroke as ``signal.stroke`` and so on. Once the motion has ended a step is discarded,
    with the reason in the log.
    """
    builder = extra("pythonfmu").FmuBuilder
    chosen = _checked(engine, path, parameters, overwrite, settings)
    known, path = Settings.of(1.0, settings), Path(path)
    model = path.stem
    kept = {"parameters": chosen, "settings": {name: getattr(known, name) for name in settings}}
    with tempfile.TemporaryDirectory() as folder, _imports_from(folder):
        script, built = Path(folder) / f"saleg_{model}.py", Path(folder) / "built.fmu"
        script.write_text(SCRIPT.format(name=model), encoding="utf-8")
        files = [Path(folder) / ENGINE_FILE, Path(folder) / SETTINGS_FILE]
        files[0].write_text(engine.to_toml(), encoding="utf-8")
        files[1].write_text(json.dumps(kept), encoding="utf-8")
        builder.build_FMU(script, built, project_files=files, needsExecutionTool="true")
        with new_file(path, overwrite) as made:
            shutil.copyfile(built, made)
    return path


def _checked(
    engine: Any, path: Any, parameters: Any, overwrite: Any, settings: Mapping[str, Any]
) -> list[str]:
    """Paths of the numbers that are offered; one error names all that is wrong."""
    wrong = [
        Problem(name, value, "", check.wanted)
        for name, value, check in (
            ("path", path, FILE),
            ("parameters", parameters, NAMES.optional),
            ("overwrite", overwrite, FLAG),
        )
        if check.read(value) is None and not (value is None and check.or_none)
    ]
    is_engine = isinstance(engine, Engine)
    engines = engine.problems() if is_engine else [Problem("engine", engine, "", a(Engine).wanted)]
    chosen: list[str] = []
    unknown: list[Problem] = []
    if not engines:
        chosen = main_parameters(engine) if parameters is None else NAMES.read(parameters) or []
        unknown = [*_no_numbers(engine, chosen)]
    known = Settings.wrong(1.0, settings)
    if unknown and not (wrong or engines or known):
        raise UnknownPath("\n".join(item.allowed for item in unknown))
    if wrong or unknown:
        found = [*engines, *wrong, *unknown, *known]
        raise WrongArguments(found, "arguments of to_fmu()")
    refuse("to_fmu", engines, known)
    return chosen


def _no_numbers(engine: Engine, names: Sequence[str]) -> Iterator[Problem]:
    """Parameters that are no numbers of an engine, or that stand twice."""
    for n, name in enumerate(names):
        text = f"'{name}' stands twice" if name in names[:n] else ""
        try:
            if not is_number(get(engine, name)):
                text = f"'{name}' is no number of this engine"
        except UnknownPath as error:
            text = str(error)
        if text:
            yield Problem("parameters", name, "", text)


def _named_file(value: Any) -> Any:
    """A path whose name can be that of a model."""
    path = Path(value) if isinstance(value, (str, PathLike)) else Path()
    model = path.stem
    good = path.suffix == ".fmu" and model.isidentifier() and not iskeyword(model)
    return value if good else None


FILE = Check(_named_file, "must be a name of letters and .fmu")


def main_parameters(engine: Engine) -> list[str]:
    """Paths of the numbers that are told of an engine first; by side where its sides differ."""
    found = []
    for name in MAIN_INPUTS:
        for one in (name, f"left.{name}", f"right.{name}"):
            try:
                value = get(engine, one)
            except UnknownPath:
                continue
            if is_number(value):
                found.append(one)
            if one == name:
                break
    return found


@contextmanager
def _imports_from(folder: str) -> Iterator[None]:
    """Let modules be imported from a folder, and forget them afterwards."""
    paths, modules = list(sys.path), set(sys.modules)
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path[:] = paths
        for name in set(sys.modules) - modules:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(folder):
                del sys.modules[name]
