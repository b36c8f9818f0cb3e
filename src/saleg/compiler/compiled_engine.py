"""An engine as the integrator takes it: the kernel of its laws, their numbers, a controller."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from saleg.compiler import machine_code, plain, records
from saleg.compiler.controllers import control_of, nobody
from saleg.compiler.imported_text import NoSource, warn_if_edited
from saleg.compiler.kernel import Kernel
from saleg.compiler.module import load
from saleg.compiler.needs import Needs
from saleg.compiler.shared_kernel import shared_kernel
from saleg.compiler.slot_text import methods_text
from saleg.compiler.source import fingerprint, is_ours
from saleg.compiler.text import INTEGRATOR, compose, compose_laws
from saleg.kernel.tuples import Control
from saleg.laws import (
    Actuators,
    CFRIgnition,
    ChangGas,
    CompleteCombustion,
    Converter,
    FixedWall,
    InstantExchange,
    Law,
    NoHeatTransfer,
    NoLeak,
    NoMisfires,
    Plenum,
    PortMixing,
    Wiebe,
)
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS

if TYPE_CHECKING:
    from saleg.compiler.records import Lengths
    from saleg.engine import Engine
    from saleg.engine.controller import Controller

#: What fills the combustion slots of a bounce chamber, which never lights, and all slots of an open
#: end, which holds no gas.
IDLE_LAWS: dict[str, Law] = {
    "gas_properties": ChangGas(),
    "heat_transfer": NoHeatTransfer(),
    "heat_release": Wiebe(),
    "ignition": CFRIgnition(),
    "gas_exchange": InstantExchange(),
    "injection": PortMixing(),
    "misfires": NoMisfires(),
    "completeness": CompleteCombustion(),
    "supply": Plenum(),
    "leak": NoLeak(),
    "wall": FixedWall(),
}

#: Actuators and converter of an engine without a controller; never called.
IDLE_COMMANDED: tuple[Law, Law] = Actuators(), Converter()


class CompiledEngine(NamedTuple):
    """An engine as the integrator takes it.

    Attributes
    ----------
    kernel : Kernel
    parameters : array of one record
        Numbers of the laws; the laws themselves where nothing is compiled.
    control : Control
        What the kernel asks for commands.
    """

    kernel: Kernel
    parameters: Any
    control: Control


def compiled_engine(
    engine: Engine,
    controller: Controller | None = None,
    *,
    asks: bool = True,
    modules: tuple[str, ...] = INTEGRATOR,
    motored_pressure: bool = False,
) -> CompiledEngine:
    """Kernel, numbers and controller of an engine; compilation waits for the first call.

    Parameters
    ----------
    engine : Engine
    controller : Controller, optional
        Whose actuators and converter stand before the engine.
    asks : bool
        Whether the kernel asks the controller at dead centres; if not, its caller does. What acts
        within the stroke is always asked by the kernel.
    modules : tuple of str
        Modules of the kernel.
    motored_pressure : bool
        Whether the motored pressure is integrated though no law asks for it.

    Raises
    ------
    LawError
        If a law cannot be compiled, naming it.
    """
    laws = _laws_in_order(engine, controller)
    control = nobody() if controller is None else control_of(controller, asks=asks)
    numbers = plain.plain_laws(laws) if plain.is_wanted() else records.parameters(laws)
    motored = motored_pressure or engine.needs_motored_pressure
    return CompiledEngine(_kernel(laws, modules, motored), numbers, control)


def numbers_of_rows(engine: Engine, count: int) -> np.ndarray:
    """Numbers of the laws of many engines, given as one of columns; shape (count, k)."""
    numbers = records.numbers_of(_laws_in_order(engine, None))
    rows = np.empty((count, len(numbers)))
    for n, values in enumerate(numbers):
        rows[:, n] = values
    return rows


def kernel_for(
    engine: Engine,
    modules: tuple[str, ...] = INTEGRATOR,
    controller: Controller | None = None,
) -> Kernel:
    """Kernel for the laws of an engine and of what stands between it and a controller.

    Composed once per choice of laws, and anew when a law, or a helper or constant it uses, has
    been changed in this process, as in a notebook.
    """
    laws = _laws_in_order(engine, controller)
    return _kernel(laws, modules, engine.needs_motored_pressure)


def kernel_of_lanes(engine: Engine, width: int) -> Kernel:
    """Kernel that steps so many engines side by side, of the laws of one."""
    laws = _laws_in_order(engine, None)
    return _kernel(laws, INTEGRATOR, engine.needs_motored_pressure, width)


def check_methods(laws: Iterable[Law]) -> None:
    """Refuse laws of a user's that cannot be compiled, before any of them is called.

    Where nothing is compiled, a law may do what Python does: print, for instance.

    Raises
    ------
    LawError
        Naming law, method and what in it cannot be compiled.
    """
    if plain.is_wanted():
        return
    for law in dict.fromkeys(map(type, laws)):
        if not is_ours(law):
            kind: Any = law
            _check_methods(kind, fingerprint(law))


@lru_cache(maxsize=256)
def _check_methods(law: type[Law], state: tuple[object, ...]) -> None:
    """The same of one class in a certain state."""
    base: Any = next(base for base in law.__mro__ if "slot" in vars(base))
    for method in base.compiled:
        methods_text(law, method, "one", base, {})


def _laws_in_order(engine: Engine, controller: Controller | None) -> list[Law]:
    """Laws of an engine in the order of their record: left, right, engine, actuators, converter."""
    left, right = (IDLE_LAWS | chamber.laws for chamber in engine.chambers)
    laws = [side[slot] for side in (left, right) for slot in CHAMBER_SLOTS]
    laws += [getattr(engine, slot) for slot in ENGINE_SLOTS]
    if controller is None:
        return [*laws, *IDLE_COMMANDED]
    return [*laws, controller.actuators, controller.converter]


def _kernel(
    laws: list[Law], modules: tuple[str, ...], motored_pressure: bool, width: int = 1
) -> Kernel:
    if plain.is_wanted():
        return plain.plain_kernel(modules)
    classes: tuple[Any, ...] = tuple(map(type, laws))
    state = tuple(map(fingerprint, _own(classes)))
    lengths = records.lengths_of_all(laws)
    return _composed(classes, modules, motored_pressure, lengths, state, width)


@lru_cache(maxsize=256)
def _own(classes: tuple[Any, ...]) -> tuple[type[Law], ...]:
    """Those among some law classes that are not the library's."""
    return tuple(law for law in dict.fromkeys(classes) if not is_ours(law))


@lru_cache(maxsize=128)
def _composed(
    classes: tuple[type[Law], ...],
    modules: tuple[str, ...],
    motored_pressure: bool,
    lengths: tuple[Lengths, ...],
    state: tuple[object, ...],
    width: int,
) -> Kernel:
    """Kernel for a choice of law classes in a certain state."""
    kinds = dict.fromkeys(zip(classes, lengths, strict=True))
    own = [kind for kind in kinds if not is_ours(kind[0])]
    names: dict[str, Any] = {}
    if width == 1 and modules == INTEGRATOR and machine_code.has_halves():
        kernel = shared_kernel(Needs.of(classes, motored_pressure))
        compose_now = partial(compose_laws, classes, kernel.digest)
        names["LINKED"] = kernel.linked
    else:
        given: dict[str, Any] = {"motored_pressure": motored_pressure, "width": width}
        compose_now = partial(compose, classes, modules, **given)
    injected: dict[str, Any] = {}
    try:
        text = compose_now()
    except NoSource as error:
        warn_if_edited(error)
        text = compose_now(injected=injected)
    text = f"# Lengths of the laws' series: {[dict(item) for item in lengths]}\n{text}"
    # What is compiled from bytecode is not kept: the text does not say all of it.
    kind = "kernel" if width == 1 else "lanes"
    return Kernel(*load(text, kind, names | injected, keeps=not injected), own)
