"""Tools of control engineers around a plant: LQR of python-control, predictive control by CasADi.

Run with ``python examples/13_control_tools.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/dead_centre.md. Needs the extra ``control``.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import casadi
import matplotlib.pyplot as plt
import numpy as np

import control
import saleg
from saleg.control import Plant, generator

BEFORE, STROKES, HORIZON = 60, 40, 8
TARGET = -0.5e-3  # m, by how much nearer to the midpoint the dead centre is to be
LARGEST = 1.1  # load weight


class Observer:
    """State of a linear model by python-control's Kalman filter on the measured dead centre."""

    def __init__(self, model):
        self.model = model
        noise = 1e-6 * np.eye(len(model.states))
        self.gain, *_ = control.dlqe(model.A, np.eye(len(noise)), model.C, noise, [[1e-10]])
        self.x = np.zeros(len(model.states))

    def see(self, signals):
        seen = abs(signals.x) - self.model.output_values[0]
        self.x = self.x + (self.gain @ (seen - self.model.C @ self.x)).ravel()

    def expect(self, change):
        self.x = self.model.A @ self.x + self.model.B[:, 0] * change


def lqr(model):
    """State feedback towards the target; the load weight at rest there is known beforehand."""
    system = model.to_control()
    cost = 1e6 * model.C.T @ model.C
    gain, *_ = control.dlqr(system, cost, np.eye(1))
    u = TARGET / control.dcgain(system).item()
    x = np.linalg.solve(np.eye(len(model.A)) - model.A, model.B[:, 0] * u)
    return lambda now: u - float((gain @ (now - x)).item())


def predictive(model):
    """Model predictive control: the load weight stays between zero and the largest."""
    problem = casadi.Opti("conic")
    u, start = problem.variable(HORIZON), problem.parameter(len(model.states))
    regulated = model.states.index("load_weight")
    x, cost = start, 0.0
    for k in range(HORIZON):
        problem.subject_to(
            problem.bounded(0.0, model.input_values[0] + x[regulated] + u[k], LARGEST)
        )
        x = casadi.DM(model.A) @ x + casadi.DM(model.B) @ u[k]
        cost += 1e6 * (casadi.DM(model.C) @ x - TARGET) ** 2
        cost += 1e-2 * (u[k] - u[k - 1]) ** 2 if k else 0.0
    problem.minimize(cost)
    problem.solver("qrqp", {"print_time": False, "print_iter": False, "print_header": False})

    def change(now):
        problem.set_value(start, now)
        return float(problem.solve().value(u)[0])

    return change


def loop(engine, model, change):
    """Dead centres [mm] and load weights of a plant, whose load is changed after a while."""
    plant, observer, seen = Plant(engine, 10.0), Observer(model), []
    for stroke in range(BEFORE + STROKES):
        signals = plant.signals
        by = 0.0
        if stroke >= BEFORE:
            observer.see(signals)
            by = change(observer.x)
            seen.append((1e3 * abs(signals.x), signals.regulated_weight + by))
        weight = min(max(signals.regulated_weight + by, 0.0), LARGEST)
        if stroke >= BEFORE:
            observer.expect(weight - signals.regulated_weight)
        plant.command(generator(signals, load_weight=weight))
        plant.advance()
    return np.array(seen).T


def main(folder: Path) -> None:
    engine = saleg.machines.thesis_transient()
    model = saleg.steady_state(engine).linear(["load_weight"], ["dead_centre"])
    goal = 1e3 * (model.output_values[0] + TARGET)
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.2), layout="constrained")
    for name, law in (("LQR", lqr(model)), ("predictive control", predictive(model))):
        places, weights = loop(engine, model, law)
        print(f"{name}: {places[-1]:.3f} mm, load weight up to {weights.max():.2f}")
        axes[0].plot(places, "o-", ms=3, label=name)
        axes[1].plot(weights, "o-", ms=3, label=name)
        assert abs(places[-1] - goal) < 0.05
    axes[0].axhline(goal, color="black", linestyle=":", linewidth=1.0)
    axes[0].set(xlabel="Stroke", ylabel="Dead centre from the midpoint [mm]")
    axes[1].set(xlabel="Stroke", ylabel="Load weight [-]")
    axes[0].legend(fontsize="small")
    figure.savefig(folder / "control_tools.png", dpi=90)
    plt.close(figure)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
