"""Who does the work of a batch: threads, processes, a Dask cluster, and what they lose."""

import dataclasses
import os
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import saleg
from helpers import SMALL_SWEEP
from saleg import SalegError, sweep
from saleg.laws import LinearSprings


def test_results_do_not_depend_on_who_does_the_work():
    points = sweep.grid(SMALL_SWEEP)
    one = sweep.run(points, workers=1)
    many = sweep.run(points, workers=3, chunk=1)
    assert one.equals(many)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert sweep.run(points, executor=pool, chunk=2).equals(one)


def test_a_broken_pool_costs_time_not_results(tmp_path):
    """One of the processes is killed in the middle; the rest is done here."""
    points = sweep.grid({"bore": np.linspace(0.056, 0.070, 40)})
    whole = sweep.run(points, chunk=8)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        killed = []

        def kill(done, total):
            if done < 24 and not killed:
                killed.append(next(iter(pool._processes)))
                os.kill(killed[0], signal.SIGKILL)

        with pytest.warns(RuntimeWarning, match="executor broke"):
            table = sweep.run(points, executor=pool, chunk=8, folder=tmp_path / "s", report=kill)
    assert table.equals(whole)


def test_work_that_cannot_travel_is_refused(base):
    """Before, an AttributeError of pickle's or a TypeError, naming nothing of the user's."""

    @dataclasses.dataclass(frozen=True)
    class Local(LinearSprings):
        pass

    engines = [base.replace(springs=Local(stiffness)) for stiffness in (29e3, 30e3)]
    with (
        ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool,
        pytest.raises(SalegError, match=r"cannot be sent to another process.*Local.*top of a"),
    ):
        saleg.steady_states(engines, executor=pool)


@pytest.fixture
def cluster(tmp_path):
    """Scheduler and two workers of a Dask cluster, each a process of its own, on loopback."""
    distributed = pytest.importorskip("distributed")
    file = tmp_path / "scheduler.json"
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    spec = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    processes = [subprocess.Popen(command + spec, **quiet)]
    command = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file)]
    spec = ["--host", "127.0.0.1", "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    spec += ["--local-directory", str(tmp_path)]
    try:
        processes += [subprocess.Popen(command + spec, **quiet) for _ in range(2)]
        client = distributed.Client(scheduler_file=str(file), timeout=60, set_as_default=False)
        client.wait_for_workers(2, timeout=60)
        yield client, processes[1:]
        client.close()
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_and_a_worker_killed_in_the_middle(cluster, tmp_path):
    client, workers = cluster
    points = sweep.grid({"bore": np.linspace(0.056, 0.070, 60)})
    whole = sweep.run(points, chunk=6)
    killed = []

    def kill(done, total):
        if not killed and done >= 8:
            workers[0].kill()
            killed.append(done)

    with client.get_executor() as pool:
        table = sweep.run(points, executor=pool, chunk=6, folder=tmp_path / "s", report=kill)
    assert killed
    assert table.equals(whole)
