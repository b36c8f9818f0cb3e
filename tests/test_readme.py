import re
import runpy
import shlex
import subprocess
import sys
from contextlib import suppress
from dataclasses import fields

import matplotlib.pyplot as plt
import pytest

import saleg
from helpers import ROOT, blocks
from saleg import Performance
from saleg.engine.paths import unit_of

RUN, TEST = (block.strip() for block in blocks("sh"))


PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def python_of(page):
    """Blocks of Python of a page, by names of their own."""
    found = blocks("python", page.read_text(encoding="utf-8"))
    return {f"{page.stem.lower()}_{number}": block for number, block in enumerate(found)}


@pytest.mark.parametrize("page", [page for page in PAGES if python_of(page)], ids=lambda p: p.stem)
def test_python_blocks_run(page, tmp_path, monkeypatch):
    """Each as a script by itself, all in one process: it takes longer to begin than most blocks."""
    monkeypatch.chdir(tmp_path)
    for name, block in python_of(page).items():
        (tmp_path / f"{name}.py").write_text(block, encoding="utf-8")
        runpy.run_path(f"{name}.py", run_name="__main__")
        plt.close("all")


def test_the_first_block_runs_in_a_process_of_its_own(tmp_path):
    (tmp_path / "block.py").write_text(blocks("python")[0], encoding="utf-8")
    command = [sys.executable, "-W", "error", "block.py"]
    subprocess.run(command, check=True, cwd=tmp_path)


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
    others = (ROOT / "CONTRIBUTING.md", ROOT / "docs" / "api" / "index.md")
    for page in (*PAGES, *others):
        for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            assert (page.parent / link).exists(), f"{page.name}: {link}"


def test_python_blocks_pass_a_strict_type_check(tmp_path):
    pytest.importorskip("mypy")
    for page in PAGES:
        for name, block in python_of(page).items():
            (tmp_path / f"{name}.py").write_text(block, encoding="utf-8")
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


def test_every_claim_of_validity_names_a_test_there_is():
    page = ROOT / "docs" / "validity.md"
    claims = re.findall(r"\[(test_\w+)[^]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
    assert len(claims) > 20
    for name, file in claims:
        assert f"def {name}(" in (page.parent / file).read_text(encoding="utf-8"), name


def test_the_nomenclature_has_the_units_of_the_code(base):
    """Paths of an engine and figures of a performance; other rows name arguments of laws."""
    text = (ROOT / "docs" / "nomenclature.md").read_text(encoding="utf-8")
    figures = {f"performance.{f.name}": f.metadata["figure"].unit for f in fields(Performance)}
    seen = 0
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        names = re.findall(r"^`([\w.]+)`|, `([\w.]+)`", cells[2]) if len(cells) == 4 else []
        for name, unit in zip(["".join(one) for one in names], cells[-1].split(", "), strict=False):
            with suppress(saleg.UnknownPath):
                known = figures.get(name) or unit_of(base, name)
                assert unit.replace("in the docstring", known) == known, name
                seen += 1
    assert seen > 25


def test_the_citation_is_of_this_version():
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {saleg.__version__}\n" in text
