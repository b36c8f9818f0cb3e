"""What a crankcase that holds burnt gas gives to its cylinder."""

import dataclasses

import pytest

from saleg import laws
from saleg.kernel import layout
from saleg.kernel.breathing import chamber_flows
from saleg.kernel.rhs import gas_of
from saleg.simulation.initial_state import prepare


def test_fuel_is_metered_to_the_air_in_what_a_crankcase_gives(base):
    """Fuel stands to the air drawn as wanted; burnt gas leaves at the share it has in there."""
    share = 0.3
    ports = laws.PortFlow(exhaust_width=0.0, intake_delay=0.0)
    supply = laws.Crankcase(volume_at_midpoint=6e-4, area=4e-3)
    cylinder = dataclasses.replace(base.left, gas_exchange=ports, supply=supply)
    engine = dataclasses.replace(base, left=cylinder)
    state = prepare(engine)
    E, C = state.records
    y = state.y
    C[0].mode = layout.OPEN
    y[layout.X] = cylinder.port_closing - cylinder.half_stroke + 0.005
    y[layout.CRANKCASE_MASS] *= 1.5
    y[layout.CRANKCASE_BURNT] = share * y[layout.CRANKCASE_MASS]
    y[layout.CRANKCASE_THETA] += 3.0
    flows = chamber_flows(engine, C, 0, y, gas_of(E, C, 0, y, False))
    assert flows.supplied > 0.0
    burnt = flows.burnt
    air = flows.supplied - flows.supplied_fuel - burnt
    wanted = cylinder.equivalence_ratio / cylinder.fuel.air_fuel_ratio
    assert flows.supplied_fuel / air == pytest.approx(wanted, rel=1e-12)
    assert burnt / (air + burnt) == pytest.approx(share, rel=1e-12)
    assert flows.drawn == pytest.approx(air + burnt, rel=1e-12)
    assert flows.drawn_burnt == pytest.approx(burnt, rel=1e-12)
