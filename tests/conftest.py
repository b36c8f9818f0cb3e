import pytest

import saleg


@pytest.fixture(scope="session")
def base():
    return saleg.machines.thesis_base()


@pytest.fixture(scope="session")
def base_run(base):
    return saleg.simulate(base, 1.5, rtol=1e-9, motored_pressure=True)


@pytest.fixture(scope="session")
def transient():
    return saleg.machines.thesis_transient()
