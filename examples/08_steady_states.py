"""Steady states solved for: one, many, and along a parameter through its loss of stability.

Run with ``python examples/08_steady_states.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/steady.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import saleg
from saleg.plotting import new_figure
from saleg.steady.continuation import branch


def main(folder: Path) -> None:
    base = saleg.machines.thesis_base()
    found = saleg.steady_state(base)
    print(found.message)
    print("multipliers of a cycle:", np.round(found.multipliers[:2], 4))
    assert found.stable
    assert abs(found.performance.frequency - 46.968) < 1e-3

    table = saleg.steady_states(
        base.replace(**{"intake.pressure": pressure}) for pressure in np.linspace(0.9e5, 1.5e5, 7)
    )
    print(table[["status", "stroke", "power", "efficiency", "half_cycles"]])
    assert (table.status == "steady").all()

    figure = new_figure(width=11.0, height=4.3)
    left, right = figure.subplots(1, 2)
    gains = branch(base, "alternator.regulator_gain", 18.0)
    gains.plot("power", left)
    ((gain, kind),) = gains.stability_changes
    print(f"{kind} beyond a gain of {gain:.2f}")
    assert kind == "quasi-periodic"
    assert 13.0 < gain < 14.0

    warm = branch(base, "intake.temperature", 700.0)
    warm.plot("stroke", right)
    print(f"intake temperature: fold at {warm.folds[0]:.1f} K; {warm.ended}")
    figure.savefig(folder / "steady_states.png")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
