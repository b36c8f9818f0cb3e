import gc

import pytest

import saleg


def pytest_collection_finish():
    """Garbage is looked for seldom, and not in what is collected: it took up to a tenth of all."""
    gc.freeze()
    gc.set_threshold(50_000)


@pytest.fixture(scope="session")
def base():
    return saleg.machines.thesis_base()


@pytest.fixture(scope="session")
def base_run(base):
    return saleg.simulate(base, 1.5, rtol=1e-9, motored_pressure=True)


@pytest.fixture(scope="session")
def transient():
    return saleg.machines.thesis_transient()
