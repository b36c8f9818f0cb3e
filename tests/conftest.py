import pytest

import saleg


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="also run studies that take minutes")


def pytest_collection_modifyitems(config, items):
    if not config.getoption("--long"):
        for item in items:
            if item.get_closest_marker("long"):
                item.add_marker(pytest.mark.skip(reason="a study that takes minutes: --long"))


@pytest.fixture(scope="session")
def base():
    return saleg.machines.thesis_base()


@pytest.fixture(scope="session")
def base_run(base):
    return saleg.simulate(base, 1.5, rtol=1e-9, motored_pressure=True)


@pytest.fixture(scope="session")
def transient():
    return saleg.machines.thesis_transient()
