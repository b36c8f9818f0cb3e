"""Real fuels: heating values, stoichiometry, caloric data, and engines filled with them."""

import dataclasses
import math

import numpy as np
import pytest

import saleg
from fuel_cases import BLENDS, FUELS, SPECIES, cantera_gas
from saleg import fuels, laws
from saleg.engine.columns import is_usual, rows_by_make
from saleg.fuels import FuelError, mixtures
from saleg.fuels.species import all_species

#: Lower heating value [MJ/kg] and stoichiometric air-fuel ratio from tables of fuels.
KNOWN = {
    "methane": (50.03, 17.12),
    "propane": (46.33, 15.57),
    "hydrogen": (119.95, 34.06),
    "ammonia": (18.60, 6.05),
    "dimethyl ether": (28.83, 8.94),
    "methanol": (21.10, 6.43),
    "ethanol": (27.73, 8.94),
    "iso-octane": (44.65, 15.03),
    "n-heptane": (44.92, 15.08),
    "toluene": (40.94, 13.41),
}


@pytest.mark.parametrize("fuel", FUELS, ids=lambda fuel: fuel.name)
def test_known_numbers(fuel):
    heating, air = KNOWN[fuel.name]
    assert fuel.lower_heating_value / 1e6 == pytest.approx(heating, abs=0.006)
    assert fuel.air_fuel_ratio == pytest.approx(air, abs=0.006)


def test_gases_of_methane_and_hydrogen():
    for fuel, gammas in (
        (fuels.methane, (1.392, 1.343, 1.310)),
        (fuels.hydrogen, (1.400, 1.369, 1.342)),
    ):
        found = [fuel.charge(0.5).gamma(T) for T in (300.0, 700.0, 1000.0)]
        assert found == pytest.approx(gammas, abs=6e-4)
    products = [fuels.methane.charge(0.5, burnt=1.0).gamma(T) for T in (1500.0, 2200.0)]
    assert products == pytest.approx((1.286, 1.267), abs=6e-4)


@pytest.mark.parametrize("fuel", [*FUELS, *BLENDS], ids=lambda fuel: fuel.name)
@pytest.mark.parametrize("ratio", [0.0, 0.4, 1.0, 1.7])
def test_burning_keeps_mass_and_atoms(fuel, ratio):
    def atoms(moles):
        return np.sum([n * np.array(all_species()[name].atoms) for name, n in moles.items()], 0)

    before = fuel.fresh(ratio)
    after = fuel.burnt(ratio)
    np.testing.assert_allclose(atoms(before), atoms(after), rtol=1e-14, atol=1e-14)
    assert min(after.values()) >= 0.0


@pytest.mark.parametrize("fuel", [fuels.hydrogen, *BLENDS], ids=lambda fuel: fuel.name)
def test_energy_is_the_integral_of_the_heat_capacity(fuel):
    gas = fuel.charge(0.7, 0.3)
    for low, high in ((298.15, 900.0), (1001.0, 2900.0)):
        T = np.linspace(low, high, 4001)
        cv = [gas.gas_constant / (gas.gamma(t) - 1.0) for t in T]
        rise = gas.internal_energy(high) - gas.internal_energy(low)
        assert rise == pytest.approx(np.trapezoid(cv, T), rel=1e-7)
    assert gas.internal_energy(298.15) == 0.0
    below, above = gas.internal_energy(1000.0), gas.internal_energy(math.nextafter(1000.0, 2e3))
    assert above == pytest.approx(below, rel=1e-12)


@pytest.mark.parametrize("fuel", [*FUELS, *BLENDS], ids=lambda fuel: fuel.name)
@pytest.mark.parametrize(("ratio", "burnt"), [(0.0, 0.0), (0.6, 0.12), (1.0, 1.0), (1.4, 0.5)])
def test_gas_is_that_of_cantera(fuel, ratio, burnt):
    fresh = fuel.fresh(ratio)
    gone = fuel.burnt(ratio)
    shares = (1.0 - burnt) / mixtures.mass_of(fresh), burnt / mixtures.mass_of(gone)
    moles = mixtures.added(mixtures.times(shares[0], fresh), mixtures.times(shares[1], gone))
    cantera, gas = cantera_gas(moles)
    ours = fuel.charge(ratio, burnt)
    exact = cantera.gas_constant / gas.mean_molecular_weight
    assert ours.gas_constant == pytest.approx(exact, rel=1e-6)
    gas.TP = 298.15, 1e5
    zero = gas.int_energy_mass
    for T in (250.0, 500.0, 999.0, 1500.0, 2500.0, 3500.0):
        gas.TP = T, 1e5
        assert ours.gas_constant / (ours.gamma(T) - 1.0) == pytest.approx(gas.cv_mass, rel=1e-6)
        energy = gas.int_energy_mass - zero
        assert ours.internal_energy(T) == pytest.approx(energy, rel=1e-6, abs=1e-6 * 1e6)


@pytest.mark.parametrize("fuel", [*FUELS, *BLENDS], ids=lambda fuel: fuel.name)
def test_heating_value_is_that_of_cantera(fuel):
    fresh = fuel.fresh(1.0)
    _, gas = cantera_gas(fresh)
    gas.TP = 298.15, 1e5
    before = gas.enthalpy_mass
    gas.X = {SPECIES[name]: amount for name, amount in fuel.burnt(1.0).items()}
    gas.TP = 298.15, 1e5
    share = fuel.molar_mass / mixtures.mass_of(fresh)
    assert fuel.lower_heating_value == pytest.approx((before - gas.enthalpy_mass) / share, rel=1e-6)


def test_hydrogen_charge_holds_what_its_gas_constant_leaves_room_for(base):
    plain = base.replace(fuel=fuels.hydrogen.fuel, equivalence_ratio=1.0, egr=0.0)
    filled = fuels.fill(base.replace(egr=0.0), fuels.hydrogen, equivalence_ratio=1.0)
    charges = [saleg.engine.start.standard_charge(engine.left) for engine in (plain, filled)]
    too_much = charges[0][1] / charges[1][1] - 1.0
    assert too_much == pytest.approx(0.39, abs=0.01)  # published: 39 %
    # By the gas law: at phi 1 hydrogen is 29.6 % of the moles.
    full = base.left.reference_state
    moles = full.pressure * base.left.area * full.clearance / (8.314462618 * full.temperature)
    share = 1.0 / (1.0 + 0.5 * 4.76)
    assert charges[1][1] == pytest.approx(moles * share * 2.016e-3, rel=1e-6)


@pytest.mark.parametrize("fuel", [fuels.hydrogen, fuels.ammonia, BLENDS[1]], ids=lambda f: f.name)
def test_engines_on_any_fuel_keep_their_energy(base, fuel):
    engine = fuels.fill(base, fuel, equivalence_ratio=0.4)
    run = saleg.simulate(engine, 0.2, rtol=1e-9)
    energy = run.energy
    assert abs(energy.residual) < 1e-8 * (abs(energy.fuel) + abs(energy.stored) + 1.0)


def test_fuel_is_metered_by_mass_or_heat(base):
    by_mass = fuels.fill(base, fuels.propane, fuel_mass=1.2e-5)
    by_heat = fuels.fill(base, fuels.propane, heat=400.0)
    held = [saleg.engine.start.standard_charge(engine.right)[1] for engine in (by_mass, by_heat)]
    assert held[0] == pytest.approx(1.2e-5, rel=1e-9)
    assert held[1] * fuels.propane.lower_heating_value == pytest.approx(400.0, rel=1e-9)
    assert fuels.fill(base, fuels.propane, heat=0.0).get("equivalence_ratio") == 0.0


@pytest.mark.parametrize("follows", [False, True])
def test_the_gas_goes_with_mixture_and_retained_share(base, follows):
    """Filled lean and enriched is filled rich: a lean gas let in 22 % more hydrogen."""

    def filled(ratio, **changes):
        engine = base.replace(**changes)
        return fuels.fill(engine, fuels.hydrogen, equivalence_ratio=ratio, follows=follows)

    rich = filled(1.0)
    assert filled(0.3).replace(equivalence_ratio=1.0) == rich
    assert filled(1.0, egr=0.3) == rich.replace(egr=0.3)
    assert filled(0.3, egr=0.3) == rich.replace(**{"gas_exchange.egr": 0.3}, equivalence_ratio=0.3)
    left = filled(0.3).replace(**{"left.equivalence_ratio": 1.0})
    assert (left.left, left.right) == (rich.left, filled(0.3).right)
    assert filled(0.3).replace(equivalence_ratio="much").problems()


def test_a_gas_of_ones_own_stays(base):
    engine = fuels.fill(base, fuels.hydrogen, equivalence_ratio=0.5, burnt=1.0)
    richer = engine.replace(equivalence_ratio=0.8, egr=0.4)
    assert richer.left.gas_properties == fuels.hydrogen.charge(0.8, 1.0)
    own = engine.replace(**{"gas_properties.gas_constant": 300.0}, equivalence_ratio=0.8)
    assert own.left.gas_properties.gas_constant == 300.0
    assert own.replace(equivalence_ratio=0.9).left.gas_properties == own.left.gas_properties


def test_the_gas_goes_with_the_place_where_fuel_enters(base):
    direct = laws.DirectInjection()
    for follows in (False, True):
        filled = fuels.fill(base, fuels.hydrogen, follows=follows).replace(injection=direct)
        assert filled == fuels.fill(base.replace(injection=direct), fuels.hydrogen, follows=follows)
        assert filled.left.gas_properties.gas_constant < 300.0  # air, and not a third hydrogen


def test_a_filled_engine_survives_a_file(base, tmp_path):
    """And goes on with its gas; one of a file that knows no charge stays as it is."""
    path = tmp_path / "engine.toml"
    for follows in (False, True):
        engine = fuels.fill(base, fuels.hydrogen, equivalence_ratio=0.3, follows=follows)
        path.write_text(engine.to_toml())
        read = saleg.Engine.from_toml(path)
        assert read == engine
        assert read.replace(equivalence_ratio=0.5) == engine.replace(equivalence_ratio=0.5)
    earlier = base.replace(gas_properties=laws.BurningGas())
    assert "air_fuel_ratio" not in earlier.to_toml().partition("gas_properties")[2][:2000]
    richer = earlier.replace(equivalence_ratio=0.9)
    assert richer.left.gas_properties == laws.BurningGas()
    assert richer.unusual() == richer.problems() == []


def test_the_text_of_a_file_is_no_path_and_a_name_no_fuel(base):
    with pytest.raises(saleg.EngineFileError, match="must be the path of a file") as caught:
        saleg.Engine.from_toml(base.to_toml())
    assert len(str(caught.value)) < 200
    with pytest.raises(saleg.InvalidEngine, match=r"must be a Fuel; saleg\.fuels\.fill sets"):
        base.replace(fuel="hydrogen").validate()


def test_a_gas_of_another_charge_is_told(base):
    """What holds 16 % less hydrogen at phi 0.4, by the molar masses, than the gas of phi 1 says."""
    engine = fuels.fill(base.replace(egr=0.0), fuels.hydrogen, equivalence_ratio=1.0)
    left = dataclasses.replace(engine.left, equivalence_ratio=0.4)
    other = dataclasses.replace(engine, left=left)
    (told,) = other.unusual()
    assert (told.path, told.value) == ("left.equivalence_ratio", 0.4)

    def molar_mass(ratio):
        hydrogen, air = ratio * 2.016, 0.5 * (31.998 + 3.76 * 28.014)
        return (hydrogen + air) / (ratio + 0.5 * 4.76)

    assert f"{100.0 * (molar_mass(1.0) / molar_mass(0.4) - 1.0):+.2g} %" in str(told)
    assert engine.unusual() == []
    (rows,) = rows_by_make([other])
    assert is_usual(rows).tolist() == [False]


def test_the_gas_of_another_fuel_is_refused(base):
    for follows in (False, True):
        engine = fuels.fill(base, fuels.methane, follows=follows)
        with pytest.raises(saleg.InvalidEngine, match=r"fuel.*saleg\.fuels\.fill sets both"):
            saleg.simulate(engine.replace(fuel=fuels.hydrogen.fuel), 0.1)
        assert engine.replace(fuel=dataclasses.replace(engine.left.fuel)).problems() == []


def test_what_is_metered_is_in_the_charge_of_a_gas_that_burns(base):
    """Its mass is that of fuel, air and what is retained, at their own gas constants."""
    engine = fuels.fill(base.replace(egr=0.3), fuels.hydrogen, heat=600.0, follows=True)
    mass, fuel, air, burnt = saleg.engine.start.standard_charge(engine.left)
    assert fuel * fuels.hydrogen.lower_heating_value == pytest.approx(600.0, rel=1e-9)
    gas = engine.left.gas_properties
    constants = sum(m * R for m, R in zip((fuel, air, burnt), gas.gas_constants, strict=True))
    full = engine.left.reference_state
    assert constants * full.temperature == pytest.approx(
        full.pressure * engine.left.area * full.clearance
    )
    assert fuel + air + burnt == pytest.approx(mass)


def test_the_engine_keeps_what_the_fuel_does_not_change(base):
    filled = fuels.fill(base, fuels.methane)
    assert filled.get("equivalence_ratio") == base.get("equivalence_ratio")
    assert filled.is_mirrored
    back = filled.replace(fuel=base.left.fuel, gas_properties=base.left.gas_properties)
    assert back == base


def test_blends(base):
    by_mole = fuels.blend({"methane": 4.0, "hydrogen": 1.0})
    mass = 0.8 * fuels.methane.molar_mass + 0.2 * fuels.hydrogen.molar_mass
    expected = 0.8 * fuels.methane.molar_mass * fuels.methane.lower_heating_value
    expected += 0.2 * fuels.hydrogen.molar_mass * fuels.hydrogen.lower_heating_value
    assert by_mole.lower_heating_value == pytest.approx(expected / mass, rel=1e-12)
    by_mass = fuels.blend({"methane": 0.5, "hydrogen": 0.5}, by_mass=True)
    mean = 0.5 * (fuels.methane.lower_heating_value + fuels.hydrogen.lower_heating_value)
    assert by_mass.lower_heating_value == pytest.approx(mean, rel=1e-12)


def test_wrong_fuels_and_amounts_are_named(base):
    for call, words in (
        (lambda: fuels.pure("methan"), "methane"),
        (lambda: fuels.pure("water"), "no fuel 'water'"),
        (lambda: fuels.blend({}), "shares"),
        (lambda: fuels.blend({"methane": -1.0, "hydrogen": math.nan}), "share of hydrogen"),
        (lambda: fuels.methane.charge(-1.0, 2.0), "burnt = 2.0"),
        (lambda: fuels.fill(base, "methane"), "must be a fuel of saleg.fuels"),
        (lambda: fuels.fill(base, fuels.methane, heat=1.0, fuel_mass=1.0), "give one"),
        (lambda: fuels.fill(base, fuels.methane, heat=1e6), "more than a charge holds"),
        (lambda: fuels.fill(base, fuels.methane, heat=-1.0), "heat = -1.0"),
        (lambda: fuels.fill(base, fuels.methane, follows="no"), "follows = 'no'"),
        (lambda: fuels.pure("nitrogen"), "no fuel 'nitrogen'; there are"),
        (lambda: fuels.RealFuel("x", {"oxygen": 1.0}), "must take air"),
        (lambda: fuels.gas_of({}), "moles = "),
    ):
        with pytest.raises(FuelError, match=words):
            call()


def test_all_that_is_wrong_is_named_at_once(base):
    for call, words in (
        (lambda: fuels.fill(base, fuels.methane, burnt="x", equivalence_ratio="y"), "xy"),
        (lambda: fuels.blend({"metane": 1.0, "hydrogen": -1.0}), ("metane", "hydrogen = -1")),
        (
            lambda: fuels.RealFuel("x", {"foo": 1.0, "methane": "1", "hydrogen": -0.5}),
            ("'foo'", "methane = '1'", "hydrogen = -0.5"),
        ),
        (lambda: fuels.gas_of({"foo": 1.0, "oxygen": -1.0}), ("'foo'", "oxygen = -1")),
    ):
        with pytest.raises(FuelError) as caught:
            call()
        for word in words:
            assert word in str(caught.value)


def test_fuels_are_values():
    """Shares of any size are shares, and equal fuels are one key."""
    huge = fuels.blend({"methane": 1e308, "hydrogen": 1e308}, name="half")
    assert huge == fuels.blend({"methane": 1.0, "hydrogen": 1.0}, name="half")
    assert {huge: 1, fuels.methane: 2}[fuels.pure("methane")] == 2


def test_gas_law_is_dry_air_by_default():
    air, ours = fuels.gas_of({"oxygen": 1.0, "nitrogen": 3.76}), laws.MixtureGas()
    assert ours.gas_constant == pytest.approx(air.gas_constant, rel=1e-4)
    for T in (300.0, 900.0, 1100.0, 2500.0):
        assert ours.gamma(T) == pytest.approx(air.gamma(T), rel=1e-4)
