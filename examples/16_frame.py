"""What shakes: one engine bolted down, on mounts, and two of them on one frame.

Run with ``python examples/16_frame.py [FOLDER]``; without a folder the picture is thrown away.
With docs/images it makes that of docs/frame.md.
"""

import dataclasses
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import saleg
from saleg import laws, reference
from saleg.plotting import new_figure

FRAME = laws.MountedFrame(mass=60.0, stiffness=2e4, damping=300.0)
STIFFNESSES = np.geomspace(1e3, 3e7, 25)


def transmitted(engine, stiffness):
    """Steady state on mounts of some stiffness [N/m]."""
    frame = dataclasses.replace(FRAME, stiffness=float(stiffness))
    return saleg.steady_state(dataclasses.replace(engine, frame=frame))


def main(folder: Path) -> None:
    engine = saleg.machines.thesis_transient()
    fixed = saleg.steady_state(engine)
    mounted = saleg.steady_state(dataclasses.replace(engine, frame=FRAME))
    print(f"bolted down: {fixed.shaking.peak_force / 1e3:.1f} kN")
    print(f"on mounts: {mounted.shaking}")
    print(f"frequency: {fixed.performance.frequency:.2f}, {mounted.performance.frequency:.2f} Hz")
    assert round(fixed.shaking.peak_force / 1e3) == 22
    assert mounted.shaking.peak_force < 0.1 * fixed.shaking.peak_force

    opposite = engine.replace(**{"start.position": -engine.start.position})
    pair = reference.simulate_on_one_frame([engine, opposite], FRAME, 0.2)
    together = reference.simulate_on_one_frame([engine, engine], FRAME, 0.2)
    assert pair.frame["x"].abs().max() < 1e-9
    both = together.frame["x"].abs().max()
    print(f"two in phase: {1e3 * both:.2f} mm; in antiphase: {pair.frame['x'].abs().max():.0e} m")

    figure = new_figure(width=11.0, height=4.3)
    left, right = figure.subplots(1, 2)
    for steady, label in ((fixed, "bolted down"), (mounted, "on soft mounts")):
        seen = steady.orbit.history
        t = 1e3 * (seen["t"] - seen["t"].iloc[0])
        left.plot(t, 1e-3 * seen["shaking_force"], label=label)
    left.plot(t, 0.0 * t, ":", color="C2", label="two in antiphase")
    left.set_xlabel("time [ms]")
    left.set_ylabel("force on the ground [kN]")
    left.set_title(f"{engine.name}, one cycle")
    left.legend(loc="upper right")

    orbits = [transmitted(engine, stiffness) for stiffness in STIFFNESSES]
    found = np.array([orbit.found for orbit in orbits])
    force = np.array([orbit.shaking.peak_force if orbit.found else np.nan for orbit in orbits])
    total = engine.translator.mass + FRAME.mass
    natural = np.sqrt(STIFFNESSES / total) / (2.0 * np.pi) / fixed.performance.frequency
    print(f"steady on {found.sum()} of {len(found)} stiffnesses")
    right.loglog(natural, 1e-3 * force, "o-", markersize=3, label="on mounts")
    lost = natural[~found]
    right.axvspan(lost.min(), lost.max(), color="C3", alpha=0.15, lw=0, label="no steady state")
    right.axhline(1e-3 * fixed.shaking.peak_force, color="grey", ls="--", label="bolted down")
    right.set_xlabel("natural frequency on the mounts / frequency of the engine")
    right.set_ylabel("greatest force on the ground [kN]")
    right.set_title(f"frame of {FRAME.mass:g} kg, damping {FRAME.damping:g} N s/m")
    right.legend(loc="lower right")
    figure.savefig(folder / "frame.png", dpi=100)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as folder:
            main(Path(folder))
