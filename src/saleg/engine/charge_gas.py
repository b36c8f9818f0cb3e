"""Gas of a charge and the charge: the one goes with the other, and where it does not it is told."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

from saleg.columns import Column
from saleg.laws import ChargeGas
from saleg.quantities import Problem, as_float

#: Relative difference of air-fuel ratios from which a gas is that of another fuel.
OTHER_FUEL = 0.02
SIDES = ("left", "right")


def with_gas_of_charge(before: Any, after: Any) -> Any:
    """An engine some numbers were changed of, with the gas of the charges it has now.

    A gas goes with equivalence ratio and retained share of its chamber where it was that of both,
    and was not itself changed.

    Parameters
    ----------
    before, after : Engine

    Returns
    -------
    Engine
    """
    for side in SIDES:
        old, new = getattr(before, side), getattr(after, side)
        if old is not new and _known_gas(new) is not None:
            gas = _followed(old, new)
            if gas is not new.gas_properties:
                changed = dataclasses.replace(new, gas_properties=gas)
                after = dataclasses.replace(after, **{side: changed})
    return after


def _followed(old: Any, new: Any) -> Any:
    """Gas of a changed chamber."""
    gas = new.gas_properties
    known = _known_gas(old)
    if known is None or known != gas:
        return gas
    ratio, share = gas.equivalence_ratio, gas.burnt_share
    if ratio == old.equivalence_ratio:
        ratio = new.equivalence_ratio
    if share == retained_share(old):
        share = retained_share(new)
    if isinstance(ratio, Column) or isinstance(share, Column):
        raise TypeError("a gas is not one of columns")
    numbers = as_float(ratio), as_float(share)
    if None in numbers or not (0.0 <= ratio < float("inf") and 0.0 <= share <= 1.0):
        return gas  # `problems` names them
    direct = _is_direct(new)
    same = numbers == (gas.equivalence_ratio, gas.burnt_share) and direct == _is_direct(old)
    if same or not _is_as_made(gas, old):
        return gas
    return gas.for_charge(*numbers, direct=direct)


def _is_as_made(gas: ChargeGas, chamber: Any) -> bool:
    """Whether nobody has changed the numbers of a gas since it was made."""
    made = gas.for_charge(gas.equivalence_ratio, gas.burnt_share, direct=_is_direct(chamber))
    return made == gas


def _is_direct(chamber: Any) -> bool:
    """Whether fuel is injected into the closed cylinder."""
    return bool(getattr(chamber.injection, "is_direct", False))


def retained_share(chamber: Any) -> Any:
    """Share of its charge that a cylinder retains [-]; 0 where that is not given."""
    return getattr(getattr(chamber, "gas_exchange", None), "egr", 0.0)


def is_gas_of_charge(chamber: Any) -> Any:
    """Whether a gas is that of its chamber's charge; of columns, in each row."""
    gas = _known_gas(chamber)
    if gas is None or _is_of_other_mixing(gas, chamber):
        return gas is None
    return gas.equivalence_ratio == chamber.equivalence_ratio


def _is_of_other_mixing(gas: ChargeGas, chamber: Any) -> bool:
    """Whether a gas has its fuel where the chamber has none as its ports close, or the reverse."""
    charge, direct = (gas.equivalence_ratio, gas.burnt_share), _is_direct(chamber)
    other = gas.for_charge(*charge, direct=not direct)
    return bool(gas == other and gas != gas.for_charge(*charge, direct=direct))


def is_gas_of_fuel(chamber: Any) -> Any:
    """Whether a gas is that of its chamber's fuel; of columns, in each row."""
    gas = _known_gas(chamber)
    ratio: Any = None if gas is None else chamber.fuel.air_fuel_ratio
    if gas is None or not (isinstance(ratio, Column) or as_float(ratio) is not None):
        return True
    return abs(ratio / gas.air_fuel_ratio - 1.0) <= OTHER_FUEL


def other_gases(engine: Any) -> Iterator[Problem]:
    """Charges of an engine whose gas is that of another one, and what that does."""
    for side in SIDES:
        chamber = getattr(engine, side)
        gas = _known_gas(chamber)
        if gas is None or is_gas_of_charge(chamber):
            continue
        own = gas.for_charge(chamber.equivalence_ratio, gas.burnt_share, direct=_is_direct(chamber))
        more = 100.0 * (own.gas_constant / gas.gas_constant - 1.0)
        kept, path = f"{gas.equivalence_ratio:g}", "equivalence_ratio"
        if _is_of_other_mixing(gas, chamber):
            kept, path = "another way of mixing", "injection"
        told = (
            f"gas_properties is the gas of {kept}, with which a charge holds "
            f"{more:+.2g} % of mass and fuel; saleg.fuels.fill sets both"
        )
        yield Problem(f"{side}.{path}", getattr(chamber, path), "-", told)


def _known_gas(chamber: Any) -> ChargeGas | None:
    """Gas of a chamber that burns fuel, if it is that of a known charge."""
    gas = getattr(chamber, "gas_properties", None)
    burns = hasattr(chamber, "equivalence_ratio")
    known = isinstance(gas, ChargeGas) and as_float(gas.air_fuel_ratio) is not None
    return gas if burns and known and gas.is_of_known_charge else None  # type: ignore[union-attr]
