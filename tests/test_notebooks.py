"""Every notebook runs in a kernel, and each of its cells ends with something worth seeing."""

import sys

import pytest

from helpers import ROOT

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
run_sync = pytest.importorskip("jupyter_core.utils").run_sync
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


@pytest.fixture(scope="module")
def kernel():
    """One kernel for all notebooks: it takes longer to begin than most of them."""
    found = ThisPython(kernel_name="tests")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TQDM_DISABLE", "1")  # whether a bar shows depends on the machine
        yield found
    run_sync(found.shutdown_kernel)(now=True)


def outputs(path, folder, kernel):
    """Outputs of the cells of a notebook by the cell's id, in a folder and with no names yet."""
    notebook = nbformat.read(path, as_version=4)
    begin = nbformat.v4.new_code_cell(f"%reset -f\n%cd -q {folder}")
    notebook.cells.insert(0, begin)
    client = nbclient.NotebookClient(notebook, km=kernel, timeout=300)
    client.execute()
    client.kc.stop_channels()
    assert begin.outputs == []
    cells = notebook.cells[1:]
    return {cell.id: cell.outputs for cell in cells if cell.cell_type == "code"}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore")  # of the tools that start a kernel, not of the library
def test_a_notebook_runs_and_every_cell_shows_something(path, kernel, tmp_path):
    shown = outputs(path, tmp_path, kernel)
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
