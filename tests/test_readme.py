import re
import shlex
import subprocess
import sys

import pytest

from helpers import ROOT, blocks

RUN, TEST = (block.strip() for block in blocks("sh"))


PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
PYTHON = [
    pytest.param(block, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, block in enumerate(blocks("python", page.read_text(encoding="utf-8")))
]


@pytest.mark.parametrize("block", PYTHON)
def test_python_blocks_run(block, tmp_path):
    script = tmp_path / "block.py"
    script.write_text(block, encoding="utf-8")
    subprocess.run([sys.executable, "-W", "error", str(script)], check=True, cwd=tmp_path)


def test_the_run_command_runs():
    words = shlex.split(RUN.split("&&")[-1])
    assert words[0] == ".venv/bin/saleg"
    done = subprocess.run(
        [sys.executable, "-m", "saleg", *words[1:]], capture_output=True, text=True, check=True
    )
    assert "Table 1" in done.stdout


def test_ci_calls_the_test_command_as_it_stands_here():
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert TEST in script.splitlines()


def test_links_lead_somewhere():
    for page in PAGES:
        for link in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / link).exists(), f"{page.name}: {link}"


def test_python_blocks_pass_a_strict_type_check(tmp_path):
    pytest.importorskip("mypy")
    for block in PYTHON:
        name = block.id.replace("-", "_").lower()
        (tmp_path / f"{name}.py").write_text(block.values[0], encoding="utf-8")
    settings = ["--strict", "--no-error-summary", "--ignore-missing-imports"]
    settings += ["--config-file", "", "--cache-dir", str(ROOT / ".mypy_cache" / "pages")]
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "mypy",
            *settings,
            *sorted(str(file) for file in tmp_path.iterdir()),
        ],
        capture_output=True,
        text=True,
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stdout + done.stderr
