"""Long runs must not grow, long histories must not be in memory twice; each in its own process."""

import subprocess
import sys

import pytest

PEAK = """
def peak():
    lines = open("/proc/self/status").read().splitlines()
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))

import saleg
base = saleg.machines.thesis_base()
"""

linux_only = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")


def growth(code):
    out = subprocess.run([sys.executable, "-c", PEAK + code], capture_output=True, check=True)
    return [float(word) for word in out.stdout.split()]


@linux_only
def test_cycles_kept_do_not_grow():
    """A hundredth of the million cycles the benchmark runs; the growth is not a hundredth."""
    grown, cycles = growth(
        """
saleg.simulate(base, 1.0, rtol=1e-5, keep_cycles=10).performance
before = peak()
run = saleg.simulate(base, 213.0, rtol=1e-5, keep_cycles=10)
print(peak() - before, run.duration * run.performance.frequency)
"""
    )
    assert cycles > 9_900
    assert grown < 3.0


@linux_only
def test_full_history_is_not_held_twice():
    """700,000 rows, as 3.5 s at 5 us."""
    grown, size, rows = growth(
        """
saleg.simulate(base, 0.01, step=1e-6, history=1).history
before = peak()
run = saleg.simulate(base, 0.7, step=1e-6, history=1)
frame = run.history
print(peak() - before, frame.memory_usage().sum() / 2**20, len(frame))
"""
    )
    assert rows > 700_000
    assert grown < 1.3 * size
