import dataclasses
import math

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import saleg
from saleg import BounceChamber, Cylinder, Engine, Fuel, Intake, SealedCylinder, Translator
from saleg.engine.toml import SLOTS, laws_by_slot
from saleg.laws.base import CHAMBER_SLOTS, ENGINE_SLOTS
from saleg.quantities import quantity


def numbers(limits):
    """Numbers in the range of a quantity, its ends included where they are allowed."""
    return st.floats(
        min_value=None if math.isinf(limits.low) else limits.low,
        max_value=None if math.isinf(limits.high) else limits.high,
        exclude_min=limits.open_low,
        exclude_max=limits.open_high,
        allow_nan=False,
        allow_infinity=False,
    )


def instances(kind, **fixed):
    """Instances of a dataclass of quantities, parts and laws."""
    parts = {"intake": Intake, "fuel": Fuel}
    made = {}
    for item in dataclasses.fields(kind):
        if item.name in fixed:
            made[item.name] = fixed[item.name]
        elif "series" in item.metadata:
            made[item.name] = st.just(item.default)  # lengths and order go together
        elif "limits" in item.metadata:
            made[item.name] = numbers(item.metadata["limits"])
        elif item.name in parts:
            made[item.name] = instances(parts[item.name])
        else:
            made[item.name] = laws(item.name)
    return st.builds(kind, **made)


def laws(slot):
    # A gas of a known charge has to be that of the fuel: tests/fuels.
    fixed = {"air_fuel_ratio": st.just(0.0)} if slot == "gas_properties" else {}
    return st.one_of([instances(law, **fixed) for law in laws_by_slot()[slot].values()])


# Lengths in an order that fits: gap < port < maximum stroke, gap < half stroke.
lengths = {
    "half_stroke": st.floats(0.01, 1.0),
    "head_gap": st.floats(1e-6, 1e-3),
    "port_closing": st.floats(2e-3, 0.019),
    "back_area": st.floats(1e-6, 1e-2),  # with which any pressure may act
}
exchange = st.one_of(
    instances(saleg.laws.InstantExchange),
    instances(
        saleg.laws.PortFlow,
        intake_delay=st.floats(0.0, 9e-4),
        exhaust_height=st.floats(1e-6, 0.02),
        intake_height=st.floats(1e-6, 0.02),
    ),
)
injection = st.one_of(
    instances(saleg.laws.PortMixing),
    instances(saleg.laws.DirectInjection, clearance=st.floats(1.1e-3, 1.9e-3)),
)
plenum = st.just(saleg.laws.Plenum())  # a crankcase has to fit: tests/breathing
chambers = st.one_of(
    instances(Cylinder, **lengths, gas_exchange=exchange, injection=injection, supply=plenum),
    *(
        instances(
            kind,
            **{key: lengths[key] for key in ("half_stroke", "head_gap", "back_area")},
            injection=injection,
        )
        for kind in (SealedCylinder, BounceChamber)
    ),
)
text = st.text(st.characters(exclude_categories=["Cs"]))


@st.composite
def engines(draw):
    left = draw(chambers)
    slots = {slot: draw(laws(slot)) for slot in (*ENGINE_SLOTS, "start")}
    return Engine(
        translator=draw(instances(Translator)),
        left=left,
        right=draw(st.one_of(st.just(left), chambers)),
        name=draw(text),
        **slots,
    )


@pytest.fixture
def write(tmp_path):
    def written(text):
        path = tmp_path / "engine.toml"
        path.write_text(text, encoding="utf-8", newline="")
        return path

    return written


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(engine=engines())
def test_any_engine_comes_back_exactly(tmp_path_factory, engine):
    assume(not engine.problems())  # some laws do not go together
    path = tmp_path_factory.getbasetemp() / "random.toml"
    path.write_text(engine.to_toml(), encoding="utf-8", newline="")
    assert Engine.from_toml(path) == engine


@pytest.mark.parametrize("machine", saleg.machines.CATALOGUE.values())
def test_machines_come_back(machine, write):
    assert Engine.from_toml(write(machine().to_toml())) == machine()


def test_numbers_carry_their_unit(base):
    assert "bore = 0.064  # m\n" in base.to_toml()
    assert "pressure = 105000.0  # Pa\n" in base.to_toml()


def test_every_exported_law_is_found():
    found = {law for known in laws_by_slot().values() for law in known}
    bases = {base.__name__ for base in SLOTS.values()} | {"Law", "FlowExchange"}
    public = [getattr(saleg.laws, name) for name in saleg.laws.__all__]
    exported = [value for value in public if isinstance(value, type)]
    laws = [law for law in exported if issubclass(law, saleg.laws.Law) and law.slot in SLOTS]
    wanted = {law.__name__ for law in laws} - bases
    assert wanted <= found
    assert all(laws_by_slot()[slot] for slot in CHAMBER_SLOTS)


def test_an_engine_that_cannot_be_read_back_is_not_written(base):
    with pytest.raises(saleg.InvalidEngine, match="bore"):
        base.replace(bore=math.nan).to_toml()


@dataclasses.dataclass(frozen=True)
class Braked(saleg.laws.Friction):
    """A law of the user's own."""

    brake: float = quantity("N", default=3.0, low=0)


def test_own_laws_are_read_when_handed_in(base, write):
    engine = base.replace(friction=Braked(4.5))
    path = write(engine.to_toml())
    assert Engine.from_toml(path, laws=[Braked]) == engine
    with pytest.raises(saleg.EngineFileError, match=r"friction\.law = 'Braked': no such law"):
        Engine.from_toml(path)


def test_what_is_left_out_takes_its_default(write):
    engine = Engine.from_toml(
        write("""
        [translator]
        mass = 2
        [cylinder]
        bore = 0.06
        half_stroke = 0.1
        port_closing = 0.13
        """)
    )
    cylinder = Cylinder(bore=0.06, half_stroke=0.1, port_closing=0.13)
    assert engine == Engine.mirrored(Translator(2.0), cylinder)


WRONG = [
    ("bore = 0.064", "boar = 0.064", r"cylinder\.boar: unknown key; did you mean 'bore'"),
    ("bore = 0.064", "", r"cylinder\.bore: missing \[m\]"),
    ("bore = 0.064", "bore = '64 mm'", r"cylinder\.bore = '64 mm': must be a number"),
    ("bore = 0.064", "bore = true", r"cylinder\.bore = True: must be a number"),
    ("temperature = 325.05", "temperature = []", r"cylinder\.intake\.temperature = \[\]"),
    ('"Hohenberg"', '"Hohenburg"', r"cylinder\.heat_transfer\.law = 'Hohenburg': .*'Hohenberg'"),
    ('"Hohenberg"', '"Wiebe"', r"heat_transfer\.law = 'Wiebe': .*fills heat_release"),
    ('"Hohenberg"', '"os.system"', r"heat_transfer\.law = 'os\.system': no such law"),
    ('law = "LinearSprings"', "", r"springs\.law: missing; one of"),
    ('kind = "Cylinder"', 'kind = "Cilinder"', r"cylinder\.kind = 'Cilinder': .*'Cylinder'"),
    ('name = "thesis-base"', "name = 3", "name = 3: must be text"),
    ('name = "thesis-base"', "springs = 3", r"springs.* must be a table|not a TOML file"),
    ("[translator]\nmass = 2.39  # kg", "", r"translator\.mass: missing \[kg\]"),
    ("[cylinder]", "[left]", r"needs \[cylinder\] .*; has \[left\], \[cylinder\]|cylinder"),
    ("[start]", "[begin]", r"begin: unknown key"),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_a_wrong_file_names_file_and_key(base, write, old, new, message):
    good = base.to_toml()
    assert old in good
    path = write(good.replace(old, new, 1))
    with pytest.raises(saleg.EngineFileError, match=message) as caught:
        Engine.from_toml(path)
    assert "engine.toml" in str(caught.value)


def test_all_wrong_keys_are_named_together(base, write):
    text = base.to_toml().replace("bore", "boar").replace("stiffness", "stiffnes")
    with pytest.raises(saleg.EngineFileError) as caught:
        Engine.from_toml(write(text))
    for key in ("cylinder.boar", "cylinder.bore", "springs.stiffnes", "'stiffness'"):
        assert key in str(caught.value)


def test_a_value_out_of_range_names_file_field_and_range(base, write):
    path = write(base.to_toml().replace("bore = 0.064", "bore = -0.064"))
    with pytest.raises(saleg.InvalidEngine, match=r"engine\.toml.*\n.*bore = -0\.064 \[m\].*> 0"):
        Engine.from_toml(path)


def test_a_syntax_error_names_file_and_line(write):
    with pytest.raises(saleg.EngineFileError, match=r"engine\.toml.*line 2"):
        Engine.from_toml(write('name = "x"\nbore 0.064\n'))


def test_files_that_are_no_text_or_not_there(tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    for name in ("binary.toml", "missing.toml", ""):
        with pytest.raises(saleg.EngineFileError, match=name or "cannot read"):
            Engine.from_toml(tmp_path / name)


def test_a_byte_order_mark_does_no_harm(base, tmp_path):
    path = tmp_path / "notepad.toml"
    path.write_text(base.to_toml(), encoding="utf-8-sig")
    assert Engine.from_toml(path) == base
