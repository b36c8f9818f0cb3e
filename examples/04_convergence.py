"""Tables 2-4 of the thesis regenerated, and where its first-order error comes from.

Run with ``python examples/04_convergence.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/studies.md.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import saleg
from saleg import studies
from saleg.plotting import new_figure
from saleg.thesis.tables import TABLE_2


def main(folder: Path) -> None:
    base = saleg.machines.thesis_base()

    steps = studies.step_size_study(base, [5e-5, 1e-5, 5e-6], duration=1.0)
    beside = studies.beside_thesis(steps, TABLE_2, "step")
    print("Table 2, efficiency [-]:")
    print(beside[["step", "efficiency", "thesis_efficiency"]].to_string(index=False))
    # Steps of 50 us change the efficiency by less than 1e-6 of itself; in Table 2 it grows by half.
    spread = steps["efficiency"].max() / steps["efficiency"].min() - 1.0
    assert spread < 1e-6, spread

    late = studies.delay_study(base, [1e-6, 5e-6, 1e-5], [0, 1, 2, 3])
    print("\nWith the gas force some steps late:")
    columns = ["step", "delay", "stroke", "peak_pressure", "efficiency"]
    print(late[columns].to_string(index=False))
    # Two steps late, the thesis' rows at 5 and 10 us come out within 1 %.
    for step in (5e-6, 1e-5):
        row = late[(late["step"] == step) & (late["delay"] == 2)].iloc[0]
        for name in ("stroke", "peak_pressure", "efficiency"):
            assert abs(row[name] / TABLE_2[step][name] - 1.0) < 0.01, (step, name, row[name])

    figure = new_figure(width=11.0, height=4.3)
    left, right = figure.subplots(1, 2)
    saleg.plotting.studies.work_precision(studies.work_precision(base, duration=0.5), left)
    saleg.plotting.studies.delay(late, right, printed=TABLE_2)
    figure.savefig(folder / "convergence.png", dpi=90)


if __name__ == "__main__":
    with TemporaryDirectory() as scratch:
        main(Path(sys.argv[1] if len(sys.argv) > 1 else scratch))
