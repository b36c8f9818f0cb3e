"""Ignition delays of fuels in tables, as laws: those kept here, and any by a chemical mechanism."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Iterable, Mapping, Sequence
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from saleg.errors import nearest, shown
from saleg.fuels.mixtures import FuelError, added, mass_of, times
from saleg.fuels.real_fuel import RealFuel, pure
from saleg.fuels.species import all_species
from saleg.laws import TabulatedDelay
from saleg.quantities import as_float

#: Fuels whose delays are kept, and the mechanisms they were computed with: GRI-Mech 3.0 and its
#: part for hydrogen.
KEPT = {
    "methane": "gri30.yaml",
    "propane": "gri30.yaml",
    "hydrogen": "h2o2.yaml",
}
#: Grid of the tables kept: evenly spaced in 1/T and in ln p.
TEMPERATURES = tuple(float(round(1.0 / x, 1)) for x in np.linspace(1 / 750.0, 1 / 1800.0, 17))
PRESSURES = tuple(float(round(p, -3)) for p in np.geomspace(4e5, 200e5, 9))
EQUIVALENCE_RATIOS = (0.3, 0.5, 0.7, 1.0)
BURNT_SHARES = (0.0, 0.2, 0.5)
#: Delay beyond which a charge counts as one that does not light [s].
LONGEST = 10.0
#: Names of species in mechanisms, where they are not those of NASA.
FORMULAS = {
    "methane": "CH4",
    "propane": "C3H8",
    "hydrogen": "H2",
    "ammonia": "NH3",
    "dimethyl ether": "CH3OCH3",
    "methanol": "CH3OH",
    "ethanol": "C2H5OH",
    "iso-octane": "IC8H18",
    "n-heptane": "NC7H16",
    "toluene": "C6H5CH3",
    "oxygen": "O2",
    "nitrogen": "N2",
    "carbon dioxide": "CO2",
    "water": "H2O",
}


def ignition_delays(fuel: RealFuel) -> TabulatedDelay:
    """Ignition delays of methane, propane or hydrogen, from the tables kept here.

    They were made by :func:`compute_delays`: 750 K to 1800 K, 4 bar to 200 bar, phi 0.3 to 1 and up
    to half of burnt gas.

    Parameters
    ----------
    fuel : RealFuel

    Returns
    -------
    TabulatedDelay
        For the slot ``ignition``.

    Raises
    ------
    FuelError
        If no table is kept for that fuel.

    Examples
    --------
    >>> from saleg import fuels
    >>> law = fuels.ignition_delays(fuels.methane)
    >>> len(law.delays) == len(law.pressures) * len(law.temperatures) * 12
    True
    """
    if not isinstance(fuel, RealFuel):
        raise FuelError(f"fuel = {shown(fuel)}: must be a fuel of saleg.fuels")
    molecules = tuple(fuel.moles)
    name = molecules[0] if len(molecules) == 1 else fuel.name
    if molecules != (name,) or name not in KEPT:
        hint = f"; there are {', '.join(KEPT)}"
        raise FuelError(f"no ignition delays are kept for {shown(name)}{hint}; see compute_delays")
    file = resources.files("saleg.fuels").joinpath(f"delays_{name}.csv")
    rows = list(csv.DictReader(file.read_text(encoding="utf-8").splitlines()))
    axes = [sorted({float(row[key]) for row in rows}) for key in ("burnt", "p_Pa", "T_K", "phi")]
    shares, pressures, temperatures, ratios = map(tuple, axes)
    delays = tuple(float(row["delay_s"]) for row in rows)
    return TabulatedDelay(pressures, temperatures, ratios, delays, shares, fuel.air_fuel_ratio)


def compute_delays(
    fuel: RealFuel,
    mechanism: str,
    *,
    pressures: Sequence[float] = PRESSURES,
    temperatures: Sequence[float] = TEMPERATURES,
    equivalence_ratios: Sequence[float] = EQUIVALENCE_RATIOS,
    burnt_shares: Sequence[float] = BURNT_SHARES,
    species: Mapping[str, str] | None = None,
    phase: str = "",
) -> TabulatedDelay:
    """Compute ignition delays by a chemical mechanism; needs the extra ``saleg[chemistry]``.

    The delay is the time to the steepest rise of the temperature at constant volume, adiabatic;
    10 s where nothing lights.

    Parameters
    ----------
    fuel : RealFuel
    mechanism : str
        Mechanism of Cantera, such as ``"gri30.yaml"``.
    pressures, temperatures, equivalence_ratios, burnt_shares : sequence of float
        Grid [Pa], [K], [-], [-], each rising.
    species : dict of str to str, optional
        What the mechanism calls molecules of :func:`saleg.fuels.pure`, air and products, where it
        does not follow their formulas.
    phase : str
        Phase of the mechanism, where it has several: an ideal gas.

    Returns
    -------
    TabulatedDelay

    Raises
    ------
    FuelError
        If Cantera is not installed; naming every grid that is none, and every molecule that the
        mechanism lacks or has with other atoms.
    """
    grids = {
        "burnt_shares": burnt_shares,
        "pressures": pressures,
        "temperatures": temperatures,
        "equivalence_ratios": equivalence_ratios,
    }
    wrong = _problems(fuel, mechanism, grids, species)
    if wrong:
        raise FuelError("\n".join(wrong))
    gas = _solution(mechanism, phase)
    names = FORMULAS | dict(species or {})
    charges = {
        (ratio, share): _charge(fuel, float(ratio), float(share))
        for ratio, share in itertools.product(equivalence_ratios, burnt_shares)
    }
    others = _other_molecules(
        gas, mechanism, names, dict.fromkeys(itertools.chain(*charges.values()))
    )
    if others:
        raise FuelError("\n".join(others))
    delays = []
    for share, p, T, ratio in itertools.product(*grids.values()):
        moles = charges[ratio, share]
        gas.TPX = T, p, {names[key]: amount for key, amount in moles.items()}
        delays.append(_delay(gas))
    axes = {name: tuple(map(float, grid)) for name, grid in grids.items()}
    return TabulatedDelay(delays=tuple(delays), air_fuel_ratio=fuel.air_fuel_ratio, **axes)


def _problems(fuel: Any, mechanism: Any, grids: dict[str, Any], species: Any) -> list[str]:
    """Everything wrong with what delays are to be computed of."""
    wrong = [
        f"{name} = {shown(grid)}: must be rising numbers > 0"
        + (" (or from 0) and <= 1" if name == "burnt_shares" else "")
        for name, grid in grids.items()
        if not _is_grid(grid, name)
    ]
    if not isinstance(fuel, RealFuel):
        wrong.append(f"fuel = {shown(fuel)}: must be a fuel of saleg.fuels")
    if not isinstance(mechanism, str | PathLike):
        wrong.append(f"mechanism = {shown(mechanism)}: must name a mechanism of Cantera")
    if not isinstance(species or {}, Mapping):
        wrong.append(f"species = {shown(species)}: must map molecules to names in the mechanism")
        return wrong
    for key, name in (species or {}).items():
        if key not in FORMULAS and key not in all_species():
            wrong.append(f"species: no molecule {shown(key)}{nearest(str(key), FORMULAS)}")
        if not isinstance(name, str):
            wrong.append(f"species: {shown(key)} = {shown(name)}: must be a name in the mechanism")
    return wrong


def _other_molecules(
    gas: Any, mechanism: str, names: dict[str, str], molecules: Iterable[str]
) -> list[str]:
    """What a mechanism has not, or has other atoms in than the molecule has."""
    wrong = []
    unknown = [names[key] for key in molecules if names[key] not in gas.species_names]
    if unknown:
        wrong.append(f"{mechanism} has no {', '.join(unknown)}: name them in species")
    for key in molecules:
        if names[key] in gas.species_names:
            atoms = {a: n for a, n in all_species()[key].atoms._asdict().items() if n > 0.0}
            theirs = dict(gas.species(names[key]).composition)
            if theirs != atoms:
                told = f"is {_formula(theirs)}, and {key} is {_formula(atoms)}"
                wrong.append(f"species: {names[key]} of {mechanism} {told}")
    return wrong


def _formula(atoms: Mapping[str, float]) -> str:
    return "".join(f"{atom}{n:g}" for atom, n in atoms.items())


def _is_grid(grid: Any, name: str) -> bool:
    is_row = isinstance(grid, (list, tuple)) or (isinstance(grid, np.ndarray) and grid.ndim == 1)
    numbers = [as_float(value) for value in grid] if is_row else []
    least, most = (0.0, 1.0) if name == "burnt_shares" else (1e-9, 1e300)
    known = [number for number in numbers if number is not None and least <= number <= most]
    rising = all(a < b for a, b in itertools.pairwise(known))
    return bool(numbers) and len(known) == len(numbers) and rising


def _solution(mechanism: str, phase: str) -> Any:
    """Gas of a mechanism."""
    try:
        import cantera
    except ImportError:
        raise FuelError('needs Cantera: pip install "saleg[chemistry]"') from None
    try:
        gas = cantera.Solution(mechanism, phase)
    except Exception as error:
        raise FuelError(f"mechanism = {shown(mechanism)}: Cantera cannot read it") from error
    if gas.thermo_model != "ideal-gas":
        raise FuelError(f"mechanism = {shown(mechanism)}: must be an ideal gas; name it in phase")
    return gas


def _charge(fuel: RealFuel, ratio: float, burnt: float) -> dict[str, float]:
    """Molecules of a charge with a share of burnt gas by mass."""
    fresh, gone = fuel.fresh(ratio), fuel.burnt(ratio)
    moles = added(times((1.0 - burnt) / mass_of(fresh), fresh), times(burnt / mass_of(gone), gone))
    return {name: amount for name, amount in moles.items() if amount > 0.0}


def _delay(gas: Any) -> float:
    """Time to the steepest rise of the temperature at constant volume [s]."""
    import cantera

    reactor = cantera.IdealGasReactor(gas, clone=False)
    net = cantera.ReactorNet([reactor])
    net.rtol, net.atol = 1e-8, 1e-15
    begin = before = reactor.T
    steepest, found, time = 0.0, LONGEST, 0.0
    while net.time < LONGEST:
        net.step()
        slope = (reactor.T - before) / (net.time - time)
        if slope > steepest:
            steepest, found = slope, 0.5 * (net.time + time)
        if begin + 400.0 < reactor.T and slope < 0.1 * steepest:
            break
        before, time = reactor.T, net.time
    return min(found, LONGEST) if begin + 200.0 < reactor.T else LONGEST


def write_kept(folder: Path) -> None:
    """Write the tables kept here anew, into a folder; takes some minutes.

    Parameters
    ----------
    folder : Path
    """
    for name, mechanism in KEPT.items():
        law = compute_delays(pure(name), mechanism)
        grid = itertools.product(
            law.burnt_shares, law.pressures, law.temperatures, law.equivalence_ratios
        )
        rows = [
            f"{share:g},{p:g},{T:g},{ratio:g},{delay:.5g}"
            for (share, p, T, ratio), delay in zip(grid, law.delays, strict=True)
        ]
        text = "\n".join(["burnt,p_Pa,T_K,phi,delay_s", *rows, ""])
        (folder / f"delays_{name}.csv").write_text(text, encoding="utf-8")
