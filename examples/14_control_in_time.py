"""Control within the stroke: start-up by a push along the motion: cold, after a stall, by 110 N.

Run with ``python examples/14_control_in_time.py``; it draws nothing.
"""

from dataclasses import dataclass
from pathlib import Path

import saleg
from saleg import Controller, control
from saleg.control import Plant, generator
from saleg.engine.start import AtRest
from saleg.laws import AlwaysMotored, FuelCut, PositionSensor, PushAlong, StateLogic
from saleg.thesis.walls import with_walls_that_follow

PUSH = PushAlong(limit=264.0)
SENSOR = PositionSensor(sample_time=1e-4, noise=2e-5, resolution=1e-5, delay=1)


@dataclass(frozen=True)
class LeftToStall(StateLogic):
    """A motor below the threshold, but none for a while in which the motion dies away."""

    begin: float = 1.0
    end: float = 3.0

    def is_motor(self, memory, signals):
        if self.begin <= signals.t < self.end:
            return 0.0
        return 1.0 if signals.compression_ratio < 12.0 else 0.0


def small_dual_engine(friction: float) -> saleg.Engine:
    """Two cylinders of 52.5 mm with 70 mm between the heads, no springs, 5 kg, at rest and cold."""
    return saleg.machines.thesis_transient().replace(
        start=AtRest(),
        bore=0.0525,
        half_stroke=0.035,
        port_closing=0.035,
        wall_temperature=300.0,
        **{
            "intake.pressure": 1e5,
            "intake.temperature": 300.0,
            "translator.mass": 5.0,
            "springs.stiffness": 0.0,
            "friction.coefficient": friction,
        },
    )


def main(folder: Path) -> None:
    engine = saleg.machines.thesis_transient().replace(start=AtRest())
    controller = Controller(force_control=PUSH, position_sensor=SENSOR)

    run = control.simulate(engine, controller, 1.5)
    drawn = control.bus_energy(run).drawn
    print(f"push along: fired at {control.fired_at(run):.2f} s, {drawn:.0f} J from the bus")
    assert control.fired_at(run) < 0.5
    assert run.status is saleg.Status.STEADY

    cold = with_walls_that_follow(engine).replace(wall_temperature=300.0)
    run = control.simulate(cold, controller, 3.0)
    wall = run.strokes["wall_temperature"][-1, 0]
    print(f"cold walls: fired at {control.fired_at(run):.2f} s, walls at {wall:.0f} K after 3 s")
    assert control.fired_at(run) < 0.5
    assert wall > 310.0

    stalling = Controller(
        state_logic=LeftToStall(),
        force_control=PUSH,
        fuel_control=FuelCut(at=1.0, strokes=150.0),
        position_sensor=SENSOR,
    )
    run = control.simulate(engine, stalling, 4.5)
    table = run.dead_centres
    stalled = table[(table.t > 1.0) & (table.t < 3.0)].stroke.min()
    print(f"left to stall: stroke down to {1e3 * stalled:.2f} mm; {run.message}")
    assert stalled < 0.02
    assert table.power.iloc[-1] > 3000.0

    pushed = Controller(state_logic=AlwaysMotored(), force_control=PushAlong(limit=110.0))
    for friction in (0.0, 20.0, 40.0):
        table = control.simulate(small_dual_engine(friction), pushed, 0.8).dead_centres
        reached = table.t[table.compression_ratio >= 9.0].min()
        print(f"110 N against {friction:g} N s/m: compression ratio 9 at {reached:.2f} s")
        assert reached < 0.8

    # In Python, at sample times: a load that goes by how far the translator has come since.
    firing = saleg.machines.thesis_transient()
    plant, before = Plant(firing, 0.5), firing.start.initial(firing).x
    while plant.running:
        v = (plant.signals.position - before) / 2e-4
        before = plant.signals.position
        force = -firing.alternator.load_constant * v
        plant.command(generator(plant.signals, sets_force=1.0, force=force))
        plant.advance(2e-4)
    power = plant.run().dead_centres.power.tail(10).mean()
    print(f"a load in Python: {power:.0f} W on the bus; {plant.run().message}")
    assert power > 2000.0


if __name__ == "__main__":
    main(Path())
