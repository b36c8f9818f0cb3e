"""Every notebook runs in a kernel, and each of its cells ends with something worth seeing."""

import sys

import pytest

from helpers import ROOT

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
kernelspec = pytest.importorskip("jupyter_client.kernelspec")
manager = pytest.importorskip("jupyter_client.manager")

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
#: What the cells of the tour show, of the kind a browser would choose.
SHOWN = {"engine": "html", "steady": "html", "compare": "html", "plot": "png"}


class ThisPython(manager.AsyncKernelManager):
    """A kernel of the Python that runs the tests, whatever kernels are installed."""

    @property
    def kernel_spec(self):
        command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        return kernelspec.KernelSpec(argv=command, display_name="tests", language="python")


def outputs(path, folder):
    """Outputs of the cells of a notebook by the cell's id."""
    notebook = nbformat.read(path, as_version=4)
    settings = {"timeout": 300, "kernel_manager_class": ThisPython, "kernel_name": "tests"}
    nbclient.NotebookClient(
        notebook, resources={"metadata": {"path": folder}}, **settings
    ).execute()
    return {cell.id: cell.outputs for cell in notebook.cells if cell.cell_type == "code"}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore")  # of the tools that start a kernel, not of the library
def test_a_notebook_runs_and_every_cell_shows_something(path, tmp_path, monkeypatch):
    monkeypatch.setenv("TQDM_DISABLE", "1")  # whether a bar shows depends on the machine
    shown = outputs(path, tmp_path)
    for name, found in shown.items():
        (result,) = found  # nothing on the streams of errors, such as a warning
        assert result.output_type == "execute_result", name
    kinds = {name: set(found[0].data) - {"text/plain"} for name, found in shown.items()}
    if path.stem == "tour":
        expected = {"html": {"text/html"}, "png": {"image/png"}}
        assert kinds == {name: expected[kind] for name, kind in SHOWN.items()}
        engine = shown["engine"][0].data
        assert "<svg" in engine["text/html"]
        assert len(engine["text/plain"]) < 100


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_outputs(path):
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None
