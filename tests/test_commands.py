"""Commands of the README and the pages run as they stand there, each page in an empty folder."""

import re
import shlex
import subprocess
import sys

import pytest

from helpers import ROOT, blocks
from saleg.cli import main

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
#: What stands for something of the reader's own.
MEANT = {
    "MACHINE": "thesis-base",
    "MACHINE|FILE.toml|RUN": "thesis-base",
    "DIR": "folder",
    "N": "2",
    "FIGURE": "17",
    "EXPERIMENT": "start-up",
    "STUDY": "stop-time",
}
#: Commands that do something without a word more.
ALONE = ("list", "control", "design", "studies")
#: Examples of files, by the command that reads them: the page they stand on.
FILES = {"sweep": "sweeps.md", "optimize": "optimisation.md"}
#: Designs of the optimisation that is run here.
FEW = 40


def commands_of(page):
    """Commands of a page: those in its lines, then those in its blocks."""
    text = page.read_text(encoding="utf-8")
    lines = re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.M)
    found = re.findall(r"`saleg( [^`]+)`", lines)
    found += re.findall(r"^saleg( .+)$", "".join(blocks("sh", text)), flags=re.M)
    return [" ".join(command.split()) for command in found]


def words_of(command):
    """Words of a command with all its options, and with something in place of what is meant."""
    words = [word.strip("[]") for word in shlex.split(command)]
    named = {f"{name}/engine.toml": f"{own}/engine.toml" for name, own in MEANT.items()} | MEANT
    return [named.get(word, word) for word in words]


def write_file(name, command):
    """The example of a file that a command reads, with few designs."""
    page = ROOT / "docs" / FILES[command]
    (text,) = blocks("toml", page.read_text(encoding="utf-8"))
    with open(name, "w", encoding="utf-8") as file:
        text = re.sub(r"^evaluations = \d+", f"evaluations = {FEW}", text, flags=re.M)
        file.write(text.replace("count = 31", "count = 3"))


def run(words):
    """Exit code; a name of a command alone is asked for its help, processes begin at a script."""
    if "--processes" in words:
        return subprocess.run([sys.executable, "-m", "saleg", *words], check=False).returncode
    try:
        return main(words if len(words) > 1 or words[0] in ALONE else [*words, "--help"])
    except SystemExit as done:
        return done.code


CASES = [
    pytest.param(
        page,
        animated,
        id=f"{page.stem}{'-animated' if animated else ''}",
        marks=[pytest.mark.long] if animated else [],
    )
    for page in PAGES
    for animated in (False, True)
    if any(("--animate" in command) == animated for command in commands_of(page))
]


@pytest.mark.parametrize(("page", "animated"), CASES)
def test_the_commands_of_a_page_run(page, animated, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for command in commands_of(page):
        if ("--animate" in command) != animated:
            continue
        words = words_of(command)
        if words[0] in FILES:
            words[1] = f"{words[0]}.toml"
            write_file(words[1], words[0])
        assert run(words) == 0, (command, capsys.readouterr().err)
        assert capsys.readouterr().out or "--processes" in words


def test_commands_are_found():
    found = [command for page in PAGES for command in commands_of(page)]
    assert len(found) > 20
    assert {words_of(command)[0] for command in found} >= {
        "run",
        "steady",
        "sweep",
        "optimize",
        "list",
        "fundamental",
        "control",
    }


def test_scripts_named_in_blocks_are_there():
    pages = [*PAGES, ROOT / "CONTRIBUTING.md"]
    text = "\n".join(block for page in pages for block in blocks("sh", page.read_text("utf-8")))
    scripts = re.findall(r"python ([\w/]+\.py)", text)
    assert len(scripts) >= 4
    for script in scripts:
        assert (ROOT / script).is_file(), script
