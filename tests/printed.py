"""Figures of a performance beside what the dissertation prints."""

import pytest


def within(actual, expected, share):
    assert actual == pytest.approx(expected, rel=share)


def check_table_13(p):
    within(p.stroke, 83.5e-3, 0.035)
    within(p.compression_ratio, 17.9, 0.035)
    within(p.frequency, 44.8, 0.035)
    within(p.power, 3.81e3, 0.035)
    within(p.efficiency, 0.382, 0.035)
    within(p.mean_alternator_force, 449.0, 0.035)
    within(p.peak_pressure, 102e5, 0.035)
    within(p.peak_acceleration, 4.46e3, 0.035)
    within(p.peak_velocity, 11.2, 0.035)
    within(p.fuel_energy_per_cycle, 222.0, 0.035)
    within(p.charge_mass, 0.0853e-3, 0.035)
