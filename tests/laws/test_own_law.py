"""The page "Write your own law", in a notebook's cell; as a script test_readme runs it."""

import subprocess
import sys

import pytest

from helpers import ROOT, blocks

CELL = """
import pathlib, sys
from IPython.core.interactiveshell import InteractiveShell

shell = InteractiveShell.instance()
cell = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
shell.run_cell(cell).raise_error()
run, law = shell.user_ns["run"], shell.user_ns["law"]

from saleg.compiler.compiled_engine import kernel_for

# It is kept on disk like a law of a file, and what stands beside it is part of it.
assert kernel_for(run.engine).module.__file__.endswith(".py")
assert shell.user_ns["table"]["stable"].all()
print("power", run.performance.power)
"""


def test_the_law_works_in_a_cell(tmp_path):
    pytest.importorskip("IPython")
    (page,) = blocks("python", (ROOT / "docs" / "own_law.md").read_text(encoding="utf-8"))
    cell, program = tmp_path / "cell.txt", tmp_path / "program.py"
    cell.write_text(page, encoding="utf-8")
    program.write_text(CELL, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(program), str(cell)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert float(done.stdout.split()[-1]) > 1e4
