"""Progress bars where somebody looks on: a terminal, or the cell of a notebook."""

import subprocess
import sys
import threading
from types import ModuleType

from saleg.simulation.progress import progress_bar


def kind():
    with progress_bar(10.0) as bar:
        return None if bar is None else type(bar).__name__


def test_nobody_looks_on_where_errors_go_to_a_file():
    assert kind() is None


def test_a_cell_of_a_notebook_has_a_bar_and_its_threads_have_none(monkeypatch):
    monkeypatch.setitem(sys.modules, "ipykernel.zmqshell", ModuleType("ipykernel.zmqshell"))
    assert kind().startswith("tqdm")
    found = []
    thread = threading.Thread(target=lambda: found.append(kind()))
    thread.start()
    thread.join()
    assert found == [None]


def test_a_notebook_without_widgets_is_no_reason_to_warn():
    """tqdm warns of missing ipywidgets when it is first imported, so in a process of its own."""
    code = (
        "import sys, types, IPython; name = 'ipykernel.zmqshell'; sys.modules['ipywidgets'] = None;"
        "sys.modules[name] = types.ModuleType(name);"
        "from saleg.simulation.progress import progress_bar; bar = progress_bar(1.0);"
        "assert type(bar).__module__ != 'contextlib'; bar.close()"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)
