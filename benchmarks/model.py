"""The base case as somebody would write it for a general solver: seven states, one jitted function.

States: position, velocity, two pressures, two knock integrals, electrical energy. What changes at
events only stands in an array of parameters. Nothing of saleg's integrator is used; the constants
are read from the engine, the composition of the charge follows the same rules.
"""

from __future__ import annotations

import math

import numba
import numpy as np

import saleg

N = 7
X, V, P, K, ENERGY = 0, 1, 2, 4, 6
# Parameters that change at events, one value a side.
CLOSED, BURNING, ARMED, T_IGNITION, HEAT, MASS, PHI = range(0, 14, 2)
WEIGHT, SPEED = 14, 15
N_PARAMETERS = 16

E = saleg.machines.thesis_base()
L, BORE, D_PORT = E.get("half_stroke"), E.get("bore"), E.get("port_closing")
AREA = math.pi * BORE**2 / 4.0
M, STIFFNESS, C_F = E.get("moving_mass"), E.get("spring.stiffness"), E.get("friction.coefficient")
C_A, ETA, GAIN = E.alternator.load_constant, E.alternator.efficiency, E.alternator.regulator_gain
T_IN, T_W = E.get("intake.temperature"), E.get("wall_temperature")
R = E.left.gas_properties.gas_constant
H_A = E.left.heat_transfer.a
WIEBE_A, C_D = E.left.heat_release.a, E.left.heat_release.combustion_duration
CFR_A, CFR_B, CFR_N = E.left.ignition.A, E.left.ignition.b, E.left.ignition.n
CFR_X, CFR_K = E.left.ignition.x, E.left.ignition.k
AFR, LHV = E.left.fuel.air_fuel_ratio, E.left.fuel.lower_heating_value
ETA_C = E.left.combustion_efficiency
T_HOLD = 2500.0
PORT = L - D_PORT


@numba.njit(error_model="numpy")
def rhs(t, y, par, dy):
    """Rates of the states."""
    force = -2.0 * STIFFNESS * y[0] - (C_F + par[14] * C_A) * y[1]
    for side in range(2):
        sign = 1.0 - 2.0 * side
        p = y[2 + side]
        force += sign * AREA * p
        dy[2 + side] = 0.0
        dy[4 + side] = 0.0
        if par[side] == 0.0:
            continue
        height = L + sign * y[0]
        volume = AREA * height
        T = p * volume / (par[10 + side] * R)
        Tg = min(T, 2500.0)
        g = 1.396 + Tg * (-1.436e-4 + Tg * (6.207e-8 - 9.967e-12 * Tg))
        h = H_A * volume**-0.06 * (p * 1e-5) ** 0.8 * T**-0.4 * (par[15] + 1.4) ** 0.8
        heat = -h * (2.0 * AREA + math.pi * BORE * height) * (T - T_W)
        if par[2 + side] != 0.0:
            u = min(max((t - par[6 + side]) / C_D, 0.0), 1.0)
            heat += par[8 + side] / C_D * 3.0 * WIEBE_A * u * u * math.exp(-WIEBE_A * u * u * u)
        dy[2 + side] = -g * p / height * sign * y[1] + (g - 1.0) / volume * heat
        if par[4 + side] != 0.0:
            chemistry = math.exp(-CFR_B * (p * 1e-3) ** CFR_N / T)
            dy[4 + side] = CFR_K / CFR_A * par[12 + side] ** CFR_X * chemistry
    dy[0] = y[1]
    dy[1] = force / M
    dy[6] = ETA * par[14] * C_A * y[1] * y[1]


class Engine:
    """State, modes and masses; what happens at an event.

    Parameters
    ----------
    engine : saleg.Engine
        The base case, or one of its geometry and laws with other numbers.
    """

    def __init__(self, engine=E):
        from saleg.simulation.initial_state import prepare

        state = prepare(engine)
        self.compose = engine.left.gas_exchange.charge
        self.p_in, self.phi = engine.get("intake.pressure"), engine.get("equivalence_ratio")
        c, e = state.chambers, state.engine[0]
        self.t = 0.0
        self.y = np.zeros(N)
        self.y[X] = state.y[0]
        for side in range(2):
            height = L + (1 - 2 * side) * state.y[0]
            closed = c["mode"][side] > 0
            self.y[P + side] = math.exp(state.y[2 + side] - 1.33 * math.log(height / L))
            self.y[P + side] = self.y[P + side] if closed else self.p_in
        self.par = np.zeros(N_PARAMETERS)
        self.par[CLOSED : CLOSED + 2] = c["mode"] > 0
        self.par[BURNING : BURNING + 2] = c["mode"] == 2
        self.par[MASS : MASS + 2] = c["mass"]
        self.par[PHI : PHI + 2] = c["equivalence_ratio"]
        self.par[HEAT : HEAT + 2] = c["fuel_to_burn"] * LHV
        self.par[WEIGHT], self.par[SPEED] = e["load_weight"], e["mean_piston_speed"]
        self.masses = [list(values) for values in c[["fuel", "air", "burnt"]].tolist()]
        self.direction = 1.0
        self.last_turn = (0.0, float(self.y[X]))
        self.turns = []
        self.peaks = [0.0, 0.0]
        self.peaks_from = math.inf

    def end_of_combustion(self):
        """Earliest known end of a combustion."""
        burning = [s for s in range(2) if self.par[BURNING + s]]
        return min((self.par[T_IGNITION + s] + C_D for s in burning), default=math.inf)

    def possible(self):
        """Events that can come next: (kind, side, index of the state, threshold, direction)."""
        found = [("turn", 0, V, 0.0, -self.direction)]
        for side in range(2):
            sign = 1 - 2 * side
            outward = sign * self.direction > 0
            if outward == bool(self.par[CLOSED + side]):
                found.append(("port", side, X, -sign * PORT, self.direction))
            if self.par[ARMED + side]:
                found.append(("ignition", side, K + side, 1.0, 1.0))
            elif self.t > self.peaks_from and not outward and not self.peaks[side]:
                found.append(("peak", side, P + side, 0.0, -1.0))
        return found

    def happen(self, event):
        """Change modes at an event; None is the end of a combustion."""
        for side in range(2):
            if self.par[BURNING + side] and self.t >= self.par[T_IGNITION + side] + C_D * (
                1 - 1e-12
            ):
                self.burn(side, 1.0)
        if event is None:
            return
        kind, side, index, threshold, _ = event
        if kind == "peak":
            self.peaks[side] = self.y[index]
            return
        self.y[index] = threshold
        if kind == "turn":
            self.turn()
        elif kind == "ignition":
            fuel, air, _ = self.masses[side]
            self.par[ARMED + side], self.par[BURNING + side] = 0.0, 1.0
            self.par[T_IGNITION + side] = self.t
            self.par[HEAT + side] = ETA_C * min(fuel, air / AFR) * LHV
        elif self.par[CLOSED + side]:
            if self.par[BURNING + side]:
                self.burn(side, (self.t - self.par[T_IGNITION + side]) / C_D)
            self.par[CLOSED + side] = self.par[ARMED + side] = 0.0
            self.y[P + side], self.y[K + side] = self.p_in, 0.0
        else:
            self.charge(side)

    def burn(self, side, u):
        """Turn what burnt into burnt gas."""
        burnt = self.par[HEAT + side] / LHV * -math.expm1(-WIEBE_A * u**3)
        fuel, air, gas = self.masses[side]
        self.masses[side] = [fuel - burnt, air - AFR * burnt, gas + (1 + AFR) * burnt]
        self.par[BURNING + side] = 0.0

    def charge(self, side):
        """Fresh charge at port closing."""
        mass = self.p_in * AREA * D_PORT / (R * T_IN)
        fuel, air, gas, _ = self.compose(mass, *self.masses[side], self.phi, AFR)
        self.masses[side] = [fuel, air, gas]
        self.par[CLOSED + side] = self.par[ARMED + side] = 1.0
        self.par[MASS + side], self.par[PHI + side] = mass, fuel * AFR / air
        self.y[P + side], self.y[K + side] = self.p_in, 0.0

    def turn(self):
        """Dead centre: regulator, totals, and the way back."""
        t, x = self.last_turn
        stroke = abs(self.y[X] - x)
        self.par[WEIGHT] = max(1.0 - GAIN * (0.9 * 2.0 * L - stroke) / L, 0.0)
        self.par[SPEED] = stroke / (self.t - t)
        self.turns.append((self.t, float(self.y[X]), float(self.y[ENERGY])))
        self.last_turn = (self.t, float(self.y[X]))
        self.direction = -self.direction
        for side in range(2):
            if self.par[ARMED + side] and (1 - 2 * side) * self.direction > 0:
                self.par[ARMED + side] = self.y[K + side] = 0.0

    def figures(self):
        """Frequency, stroke, electrical work of the last full cycle, and the last peak pressure."""
        turns = self.turns if self.turns[-1][1] < 0.0 else self.turns[:-1]
        (t0, x0, w0), (_, x1, _), (t2, x2, w2) = turns[-3:]
        stroke = 0.5 * (abs(x1 - x0) + abs(x2 - x1))
        return np.array([1.0 / (t2 - t0), stroke, w2 - w0, max(self.peaks)])


def run(advance, duration):
    """Drive an engine with `advance(engine, end, events) -> event or None` to `duration`."""
    engine = Engine()
    engine.peaks_from = duration - 0.03
    while engine.t < duration:
        end = min(engine.end_of_combustion(), duration)
        event = advance(engine, end, engine.possible())
        if engine.t < duration:
            engine.happen(event)
    return engine
