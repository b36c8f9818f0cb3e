"""General solvers, each driving the model from event to event."""

from __future__ import annotations

import math

import model
import numpy as np
from model import ARMED, BURNING, CLOSED, HEAT, MASS, PHI, SPEED, T_IGNITION, WEIGHT, N, rhs

#: Natural size of the states; absolute tolerances are the relative one times these.
SCALE = np.array([model.L, 17.0, 1e6, 1e6, 1.0, 1.0, 500.0])


def value_of(event, par):
    """Number that passes through zero at an event."""
    kind, _, index, threshold, _ = event
    if kind == "peak":
        dy = np.empty(N)

        def rate(t, y):
            rhs(t, np.asarray(y), par, dy)
            return dy[index]

        return rate
    return lambda t, y: y[index] - threshold


def scipy_solver(method, rtol):
    """``scipy.integrate.solve_ivp`` with terminal events."""
    from scipy.integrate import solve_ivp

    def advance(engine, end, events):
        def rates(t, y):
            dy = np.empty(N)
            rhs(t, y, engine.par, dy)
            return dy

        functions = []
        for event in events:
            function = value_of(event, engine.par)
            function.terminal, function.direction = True, event[4]
            functions.append(function)
        solution = solve_ivp(
            rates,
            (engine.t, end),
            engine.y,
            method=method,
            rtol=rtol,
            atol=rtol * SCALE,
            events=functions,
        )
        engine.t, engine.y = float(solution.t[-1]), solution.y[:, -1].copy()
        hit = [index for index, times in enumerate(solution.t_events) if len(times)]
        return events[hit[0]] if hit else None

    return advance


def cvode_solver(method, rtol):
    """CVODE of SUNDIALS through scikit-sundae."""
    from sksundae.cvode import CVODE

    def advance(engine, end, events):
        values = [value_of(event, engine.par) for event in events]

        def rates(t, y, dy):
            rhs(t, y, engine.par, dy)

        def functions(t, y, out):
            for index, value in enumerate(values):
                out[index] = value(t, y)

        functions.terminal = [True] * len(events)
        functions.direction = [int(event[4]) for event in events]
        solver = CVODE(
            rates,
            method=method,
            rtol=rtol,
            atol=rtol * SCALE,
            eventsfn=functions,
            num_events=len(events),
            max_num_steps=100_000,
        )
        solution = solver.solve([engine.t, end], engine.y)
        engine.t, engine.y = float(solution.t[-1]), np.array(solution.y[-1])
        if solution.i_events is None or not len(solution.i_events):
            return None
        return events[int(np.flatnonzero(np.asarray(solution.i_events[-1]))[0])]

    return advance


def heyoka_equations(mass=model.M, stiffness=model.STIFFNESS, friction=model.C_F, load=model.C_A):
    """The model as expressions: its system, and what passes through zero at each event.

    Every event that can ever come is among them, told apart by a parameter that switches it on.
    """
    import heyoka as hk

    names = hk.make_vars("x", "v", "pl", "pr", "kl", "kr", "w")
    x, v, ps, ks = names[0], names[1], names[2:4], names[4:6]
    par = hk.par
    force = -2.0 * stiffness * x - (friction + par[WEIGHT] * load) * v
    pressure_rates, integral_rates = [], []
    for side, (p, _) in enumerate(zip(ps, ks, strict=True)):
        sign = 1.0 - 2.0 * side
        force += sign * model.AREA * p
        height = model.L + sign * x
        volume = model.AREA * height
        T = p * volume / (par[MASS + side] * model.R)
        g = 1.396 + T * (-1.436e-4 + T * (6.207e-8 - 9.967e-12 * T))
        h = model.H_A * volume**-0.06 * (p * 1e-5) ** 0.8 * T**-0.4
        h *= (par[SPEED] + 1.4) ** 0.8
        wall = 2.0 * model.AREA + math.pi * model.BORE * height
        u = par[BURNING + side] * (hk.time - par[T_IGNITION + side]) / model.C_D
        burn = 3.0 * model.WIEBE_A * u * u * hk.exp(-model.WIEBE_A * u * u * u)
        heat = par[HEAT + side] / model.C_D * burn - h * wall * (T - model.T_W)
        rate = -g * p / height * sign * v + (g - 1.0) / volume * heat
        pressure_rates.append(par[CLOSED + side] * rate)
        chemistry = hk.exp(-model.CFR_B * (p * 1e-3) ** model.CFR_N / T)
        scale = model.CFR_K / model.CFR_A * par[PHI + side] ** model.CFR_X
        integral_rates.append(par[ARMED + side] * scale * chemistry)
    power = model.ETA * par[WEIGHT] * load * v * v
    system = [(x, v), (v, force / mass)]
    system += zip(ps, pressure_rates, strict=True)
    system += zip(ks, integral_rates, strict=True)
    system += [(names[6], power)]
    possible = [("turn", 0, v)]
    for side in range(2):
        possible.append(("port", side, x + (1 - 2 * side) * model.PORT))
        possible.append(("ignition", side, ks[side] - 1.0))
        possible.append(("peak", side, pressure_rates[side] * 1e-9))
    kinds = [(kind, side) for kind, side, _ in possible]
    on = [par[model.N_PARAMETERS + n] for n in range(len(kinds))]
    functions = [p[2] * switch + (1.0 - switch) for p, switch in zip(possible, on, strict=True)]
    return system, kinds, functions


def heyoka_solver(rtol):
    """Heyoka's Taylor method, its events found within the step; one integrator for all modes."""
    import heyoka as hk

    hk.set_logger_level_error()
    system, kinds, functions = heyoka_equations()
    switch, events = model.N_PARAMETERS, [hk.t_event(function) for function in functions]
    integrator = hk.taylor_adaptive(
        system, [0.0] * N, pars=[0.0] * (switch + len(kinds)), tol=rtol, t_events=events
    )

    def advance(engine, end, events):
        integrator.time = engine.t
        integrator.state[:] = engine.y
        integrator.pars[:switch] = engine.par
        wanted = {event[:2]: event for event in events}
        integrator.pars[switch:] = [float(kind in wanted) for kind in kinds]
        integrator.reset_cooldowns()
        while True:
            outcome = integrator.propagate_until(end)[0]
            if outcome == hk.taylor_outcome.time_limit:
                break
            hit = -int(outcome) - 1
            event = wanted.get(kinds[hit]) if 0 <= hit < len(kinds) else None
            direction = np.sign(rate_of(engine, event, integrator)) if event else 0.0
            if event and direction == np.sign(event[4]):
                engine.t, engine.y = integrator.time, integrator.state.copy()
                return event
        engine.t, engine.y = integrator.time, integrator.state.copy()
        return None

    return advance


def rate_of(engine, event, integrator):
    """Direction in which an event's value passes through zero."""
    kind, _, index, _, direction = event
    if kind == "peak":
        return direction
    dy = np.empty(N)
    rhs(integrator.time, integrator.state, engine.par, dy)
    return dy[index]
