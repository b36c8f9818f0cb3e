"""Control: a start-up, a step in demand, a misfire, and a controller of one's own.

Run with ``python examples/09_control.py [FOLDER]``; without a folder the pictures are thrown away.
With docs/images it makes those of docs/control.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import saleg
from saleg import Controller, control
from saleg.control import Demand, generator, motor
from saleg.engine.start import AtRest
from saleg.laws import ResonanceSearch


class BangBang:
    """Pushes along below the threshold, draws a fixed load above it."""

    def act(self, signals):
        if signals.compression_ratio < 12.0:
            return motor(signals, amplitude=500.0, frequency=signals.frequency or 38.0)
        return generator(signals, load_weight=0.9)


def main(folder: Path) -> None:
    engine = saleg.machines.thesis_transient()
    # The force sin(2 pi f t) keeps the dates of Figure 97: ports near 1 s, fired just before 2 s.
    literal = Controller(motor_control=ResonanceSearch(literal_phase=1.0))
    run = control.start_up(engine, base_frequency=30.0, controller=literal)
    print(f"ports open at {control.ports_opened_at(run):.3f} s")
    print(f"fired at {control.fired_at(run):.3f} s; {run.message}")
    assert abs(control.ports_opened_at(run) - 1.0) < 0.1
    assert 1.9 < control.fired_at(run) < 2.0
    saleg.plotting.control.start_up(run)[0].figure.savefig(folder / "control_start_up.png")

    demand = Demand.step(2.0, 3905.0, 1905.0)
    heated = control.demand_by_intake(engine, demand)
    p = heated.performance
    print(f"by intake temperature: {p.power:.0f} W at {100 * p.efficiency:.1f} %")
    assert abs(p.power - 1905.0) < 20.0
    ramp = Demand.ramp(2.0, 6.0, 3905.0, 905.0)
    low = control.demand_by_intake(engine, ramp, duration=10.0).performance
    print(f"down to {low.power:.0f} W at {100 * low.efficiency:.1f} %")
    assert abs(low.efficiency - 0.15) < 0.005
    alone = control.demand_by_load(engine, demand)
    print(f"by load alone: {alone.message}")
    assert alone.status is saleg.Status.HEAD_CONTACT

    cut = control.misfire(engine, strokes=1)
    print(f"one stroke without fuel: recovered in {control.recovery_time(cut, 1.5):.2f} s")
    assert control.recovery_time(cut, 1.5) < 0.5

    own = control.simulate(engine.replace(start=AtRest()), BangBang(), 2.0)
    print(f"bang-bang: fired at {control.fired_at(own):.2f} s; {own.message}")
    assert own.status is saleg.Status.STEADY


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
