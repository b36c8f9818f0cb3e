"""Component design and sweeps: Figures 62 and 67 to 70, Appendix C, Sobol' indices.

Run with ``python examples/07_design_sweep.py [FOLDER]``; without a name it makes the pictures of
docs/design.md and docs/sweeps.md.
"""

import sys
from pathlib import Path

import numpy as np

import saleg
from saleg import sweep
from saleg.design import Design, MassModel
from saleg.plotting import design as drawings
from saleg.plotting import sweeps as plots

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "images"
#: Half of every range is about what a builder would not know.
ASSUMPTIONS = {
    "intake_temperature": (315.0, 335.0),
    "half_stroke": (0.095, 0.105),
    "bore": (0.061, 0.067),
    "heat_transfer.a": (50.0, 90.0),
    "heat_release.combustion_duration": (1.0e-3, 1.5e-3),
    "ignition.k": (500.0, 900.0),
    "friction.factor": (10.0, 17.0),
    "masses.alternator.density": (750.0, 900.0),
}
BOX = {
    "bore": (0.04, 0.075),
    "half_stroke": (0.05, 0.16),
    "spring_stiffness": (10e3, 150e3),
    "intake_pressure": (0.9e5, 1.5e5),
    "intake_temperature": (290.0, 400.0),
    "equivalence_ratio": (0.3, 0.8),
}


def main(folder: Path = PICTURES) -> None:
    # From eight inputs to masses, dimensions and a steady state; the mass is found, not given.
    found = saleg.design.evaluate()
    print(found)
    print(found.masses, f"error {found.mass_error:.1e}")
    assert abs(found.moving_mass / 2.39 - 1.0) < 0.006
    printed = saleg.design.evaluate(Design(masses=MassModel.as_printed()))
    found.draw().figure.savefig(folder / "design_engine.png", dpi=120)
    printed.draw().figure.savefig(folder / "design_engine_printed.png", dpi=120)
    drawings.alternator_map()[0].figure.savefig(folder / "design_alternator.png", dpi=80)
    drawings.natural_frequency().figure.savefig(folder / "design_springs.png", dpi=80)

    # Figures 67 to 70: along the bore and along the neutral clearance length.
    bores = sweep.run(sweep.grid({"bore": np.linspace(0.025, 0.1, 61)}))
    plots.panels(bores, "bore")[0].figure.savefig(folder / "sweep_bore.png", dpi=80)
    lengths = sweep.run(sweep.grid({"half_stroke": np.linspace(0.04, 0.3, 53)}))
    plots.panels(lengths, "half_stroke")[0].figure.savefig(folder / "sweep_length.png", dpi=80)
    border = bores.bore[bores.stable].min()
    print(f"stable from a bore of {1e3 * border:.1f} mm")
    assert 0.045 < border < 0.050

    # Appendix C: a cloud of designs over a dimensionless group, and a map of three columns.
    cloud = sweep.run(sweep.sobol(BOX, 512, seed=2))
    print(cloud.status.value_counts().to_dict())
    plots.groups(cloud, "stroke_to_bore")[0].figure.savefig(folder / "sweep_groups.png", dpi=56)
    ax = plots.design_map(cloud, "stroke_to_bore", "frequency", "power_density")
    ax.figure.savefig(folder / "sweep_map.png", dpi=80)

    # Which assumption matters: Sobol' indices of the efficiency, inputs and constants together.
    table = sweep.run(sweep.saltelli_points(ASSUMPTIONS, 256), multipliers=False)
    shares = sweep.indices(table, "efficiency")
    shares.plot().figure.savefig(folder / "sweep_indices.png", dpi=80)
    print(shares.table[["first", "total"]].round(3))
    assert shares.table.total["heat_transfer.a"] > shares.table.total["bore"]


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
