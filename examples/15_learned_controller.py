"""A learned controller: eight numbers, found by the cross-entropy method, follow a power demand.

Before that a fixed load whose fuel follows the demand, its three numbers found in the same way.

Run with ``python examples/15_learned_controller.py [FOLDER]``; without a folder the picture is
thrown away. With docs/images it makes that of docs/plugs.md. It needs ``pip install "saleg[rl]"``.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import saleg
from saleg.plugs.gymnasium import EngineVectorEnv

ENGINE = saleg.machines.thesis_base()
TARGET = 0.9 * ENGINE.maximum_stroke
RATED = 22.6e3  # W, of the base case
ACTIONS = {"load_weight": (0.5, 1.5), "equivalence_ratio": (0.2, 0.8)}
STROKES, STEP = 220, 0.4  # strokes of an episode; time between steps of the demand [s]
CANDIDATES, ELITE, GENERATIONS, SPREAD = 48, 10, 14, 0.6
# Numbers of a policy: what the load weight, then the equivalence ratio, makes of one, the demand,
# the error of the power and that of the stroke. At a fixed load the fuel follows the demand alone.
FIXED_LOAD = np.array([1, 0, 0, 0, 1, 1, 0, 0], bool)


def demand_of(seed):
    """A demand that steps every now and then [W]."""
    levels = RATED * np.random.default_rng(seed).uniform(0.5, 1.0, 64)
    return lambda t: levels[(np.asarray(t) / STEP).astype(int)]


def policy(numbers, seen, demand):
    """Actions of candidates: linear in demand, error of the power and error of the stroke."""
    wanted = demand(seen["t"]) / RATED
    late = np.where(seen["frequency"] > 0.0, wanted - seen["power"] / RATED, 0.0)
    ones = np.ones_like(wanted)
    features = np.stack([ones, wanted, late, 10.0 * (seen["stroke"] / TARGET - 1.0)], axis=1)
    return np.einsum("nak,nk->na", numbers.reshape(-1, 2, 4), features)


def episode(numbers, demand):
    """Cost of each candidate [-], powers and times of its strokes; what stops costs the rest."""

    def reward(signals, commands, ended):
        return -np.abs(signals.power - demand(signals.t)) / RATED

    count = len(numbers)
    envs = EngineVectorEnv(
        ENGINE, count, actions=ACTIONS, reward=reward, strokes=STROKES, misfire_ends=False
    )
    _, seen = envs.reset()
    alive, cost = np.ones(count, bool), np.zeros(count)
    powers, times = [], []
    for _ in range(STROKES):
        _, rewards, ended, _, seen = envs.step(policy(numbers, seen, demand))
        alive &= ~ended
        cost += np.where(alive, -rewards, 1.0) / STROKES
        powers.append(seen["power"])
        times.append(seen["t"])
    return cost, np.array(powers), np.array(times)


def learned(free, start, demand, seed):
    """Policy whose free numbers are the best found, and the least cost of every generation."""
    chance = np.random.default_rng(seed)
    mean, spread = start, np.where(free, SPREAD, 0.0)
    history = []
    for _ in range(GENERATIONS):
        tried = mean + spread * chance.standard_normal((CANDIDATES, 8))
        cost, *_ = episode(tried, demand)
        best = tried[np.argsort(cost)[:ELITE]]
        mean, spread = best.mean(axis=0), np.where(free, best.std(axis=0) + 0.01, 0.0)
        history.append(cost.min())
    return mean, history


def main(folder: Path) -> None:
    known, unknown = demand_of(1), demand_of(2)
    fixed, history_fixed = learned(FIXED_LOAD, np.zeros(8), known, seed=0)
    found, history = learned(np.ones(8, bool), fixed, known, seed=1)
    cost, powers, times = episode(np.array([fixed, found]), unknown)
    print(f"mean error on a demand never seen: fixed load {100 * cost[0]:.1f} %, ", end="")
    print(f"learned {100 * cost[1]:.1f} % of the rated power")
    assert cost[1] < 0.5 * cost[0]
    draw((history_fixed, history), powers, times, unknown, folder / "learned_controller.png")


def draw(histories, powers, times, demand, path):
    """Power over time under both, and how the learned one came about."""
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9.0, 3.2), width_ratios=(3, 1), layout="constrained"
    )
    for n, name in enumerate(("fixed load", "all eight numbers")):
        left.plot(times[:, n], 1e-3 * powers[:, n], lw=1.2, label=name)
        generations = np.arange(1, GENERATIONS + 1)
        right.plot(generations, 100.0 * np.array(histories[n]), "o-", ms=3)
    t = np.linspace(0.0, times.max(), 2000)
    left.plot(t, 1e-3 * demand(t), "k--", lw=0.9, label="demand")
    left.set(xlabel="time [s]", ylabel="electrical power of a stroke [kW]")
    figure.legend(*left.get_legend_handles_labels(), loc="outside upper left", ncols=3)
    right.set(xlabel="generation", ylabel="least mean error [% of rated]", ylim=(0.0, None))
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
