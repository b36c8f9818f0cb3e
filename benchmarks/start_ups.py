"""Start-up from anywhere: the search of the dissertation beside a motor that follows the motion.

Run with ``python benchmarks/start_ups.py [COUNT] [PICTURE]``: so many starts for each of three
controllers, mass, stiffness and friction of the engine off by up to 10 % either way, the base
frequency anywhere from 20 to 60 Hz, positions noisy by 0.1 mm. A thousand take a quarter of
an hour of one core.
"""

import sys
from dataclasses import replace

import numpy as np
import pandas as pd

import saleg
from saleg import Controller, control
from saleg.control import Sensors
from saleg.engine.start import AtRest
from saleg.laws import PhaseLockedMotor, PositionSensor, PushAlong, ResonanceSearch

FORCE, DURATION, NOISE = 264.0, 6.0, 1e-4
SENSOR = PositionSensor(sample_time=2e-4, noise=NOISE)


def controllers(base_frequency: float, seed: int) -> dict[str, Controller]:
    """Controllers to compare, all with the same force."""
    search = ResonanceSearch(base_frequency=base_frequency, amplitude=FORCE)
    lock = PhaseLockedMotor(base_frequency=base_frequency, amplitude=FORCE)
    push = PushAlong(limit=FORCE, threshold=0.3)
    return {
        "ResonanceSearch": Controller(motor_control=search),
        "PhaseLockedMotor": Controller(motor_control=lock),
        "PushAlong": Controller(force_control=push, position_sensor=replace(SENSOR, seed=seed)),
    }


def engine_off(factors: np.ndarray) -> saleg.Engine:
    """The transient engine at rest, with factors on its mass, stiffness and friction."""
    engine = saleg.machines.thesis_transient().replace(start=AtRest())
    paths = ("translator.mass", "springs.stiffness", "friction.coefficient")
    return engine.replace(
        **{path: engine.get(path) * f for path, f in zip(paths, factors, strict=True)}
    )


def starts(count: int, seed: int = 1) -> pd.DataFrame:
    """One row per start: controller, base frequency [Hz], when it was fired [s], energy [J]."""
    rng = np.random.default_rng(seed)
    rows = []
    for n in range(count):
        engine, base_frequency = engine_off(rng.uniform(0.9, 1.1, 3)), rng.uniform(20.0, 60.0)
        sensors = Sensors(position_noise=NOISE, seed=n)
        for name, controller in controllers(base_frequency, n).items():
            run = control.simulate(engine, controller, DURATION, sensors=sensors, rtol=1e-6)
            last = run.dead_centres.iloc[-1]
            runs_alone = not last.motoring and last.power > 0.0
            rows.append(
                {
                    "controller": name,
                    "base_frequency": base_frequency,
                    "fired_at": control.fired_at(run) if runs_alone else np.nan,
                    "drawn": control.bus_energy(run).drawn,
                }
            )
    return pd.DataFrame(rows)


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Share of the engines that run at the end, and time and energy of the starts of those."""
    lasting = table[table.fired_at.notna()]
    by_name = lasting.groupby("controller")
    return pd.DataFrame(
        {
            "started": table.groupby("controller").fired_at.apply(lambda t: t.notna().mean()),
            "median time [s]": by_name.fired_at.median(),
            "longest time [s]": by_name.fired_at.max(),
            "median energy [J]": by_name.drawn.median(),
        }
    )


def draw(table: pd.DataFrame, picture: str) -> None:
    """Time of every start over its base frequency; those that never started at the top."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(10, 3.4), sharey=True, layout="constrained")
    for ax, (name, rows) in zip(axes, table.groupby("controller"), strict=True):
        never = rows.fired_at.isna()
        ax.plot(rows.base_frequency, rows.fired_at, ".", ms=3, label="started")
        top = np.full(never.sum(), DURATION)
        ax.plot(rows.base_frequency[never], top, "rx", ms=3, label="never")
        ax.set(title=name, xlabel="base frequency [Hz]", ylim=(0.0, 1.05 * DURATION))
    axes[0].set_ylabel("fired at [s]")
    axes[1].legend(loc="center right")
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    found = starts(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
    print(summary(found).to_string(float_format="%.3f"))
    if len(sys.argv) > 2:
        draw(found, sys.argv[2])
