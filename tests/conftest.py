import gc

import pytest

import saleg


def pytest_collection_finish():
    """What is collected stays: looking through it again and again took a twentieth of all time."""
    gc.freeze()


@pytest.fixture(scope="session")
def base():
    return saleg.machines.thesis_base()


@pytest.fixture(scope="session")
def base_run(base):
    return saleg.simulate(base, 1.5, rtol=1e-9, motored_pressure=True)


@pytest.fixture(scope="session")
def transient():
    return saleg.machines.thesis_transient()
