import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", README, flags=re.DOTALL | re.MULTILINE)


RUN, TEST = (block.strip() for block in blocks("sh"))


@pytest.mark.parametrize("number", range(len(blocks("python"))))
def test_python_blocks_run(number, tmp_path):
    script = tmp_path / "block.py"
    script.write_text(blocks("python")[number], encoding="utf-8")
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
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    for page in pages:
        for link in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / link).exists(), f"{page.name}: {link}"


def test_the_picture_is_small_and_can_be_made(tmp_path):
    picture = ROOT / "docs" / "images" / "base_case.png"
    assert picture.stat().st_size < 150e3
    made = tmp_path / "made.png"
    example = ROOT / "examples" / "01_base_case.py"
    subprocess.run([sys.executable, str(example), str(made)], check=True)
    assert made.stat().st_size < 150e3
