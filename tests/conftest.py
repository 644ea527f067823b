"""Cars and short runs that several test folders share, made once a session."""

import gc
import os
import shutil
import tempfile

# As in the Makefile, before numpy is imported: threads of small matrices only wait for each other.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import pytest

from tests.parts import PARTS, is_rest
from tests.processor_time import ProcessorTime, known
from tests.shared_cars import share_cars
from tests.undrawn import leave_out_drawings
from tests.validation_page import check_page
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.wording import speak_options


class PresentTest:
    """The test that runs; none while a fixture of the whole session is built, as the test that asks first must not
    matter."""

    def __init__(self) -> None:
        self.node = ""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item):
        """Note the test, also for the fixtures of its module."""
        self.node = item.nodeid

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        """Build what a session shares as a program of its own would."""
        asking = self.node
        self.node = "" if fixturedef.scope == "session" else asking
        try:
            return (yield)
        finally:
            self.node = asking


def pytest_addoption(parser):
    """Add the options of the suite."""
    group = parser.getgroup("vehicle")
    group.addoption("--part", choices=PARTS, help="part of the suite (default: product; with paths: all of them)")
    group.addoption("--processor-time", action="store_true", help="print and write the time of folders and modules")


def pytest_collection_modifyitems(config, items):
    """Take the tests of a part, and begin with the longest modules."""
    chosen: list[pytest.Item] = []
    others: list[pytest.Item] = []
    for item in items:
        rest = is_rest(item.nodeid.removeprefix("tests/"), renders=item.get_closest_marker("render") is not None)
        (chosen if config.option.part in ("all", "rest" if rest else "product") else others).append(item)
    items[:] = sorted(chosen, key=lambda item: -known().get(module_of(item.nodeid), 0.0))
    if others:
        config.hook.pytest_deselected(items=others)


def module_of(node: str) -> str:
    """Return the path of the module of a test, relative to tests/."""
    return node.partition("::")[0].removeprefix("tests/")


def pytest_configure(config):
    """Draw figures only where a test looks at them; build equal cars once; keep the user's list of trusted code."""
    # Workers get the option, and the paths as if they had been named.
    named = config.args_source is not pytest.Config.ArgsSource.TESTPATHS
    config.option.part = config.option.part or ("all" if named else "product")
    if config.option.processor_time:
        config.pluginmanager.register(ProcessorTime(), "processor time")
    # Not a TemporaryDirectory: a forked process would remove it at its end.
    folder = tempfile.mkdtemp(prefix="configuration-")
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))
    os.environ["XDG_CONFIG_HOME"] = folder
    # Messages are written with options; tests/test_wording.py reads them in Python.
    speak_options()
    present = PresentTest()
    # Not as functions of this file: pytest does not ask a conftest about fixtures of the session.
    config.pluginmanager.register(present, "present test")
    share_cars(lambda: present.node)
    leave_out_drawings(lambda: present.node)


def pytest_collection_finish():
    """Take what is imported and collected out of the garbage collection, which otherwise walks it again and again."""
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Compare the rows that a test recorded with those of the validation page."""
    try:
        result = yield
    except BaseException:
        check_page(item.nodeid, passed=False)
        raise
    check_page(item.nodeid)
    return result


@pytest.fixture(scope="session")
def car() -> Car:
    """The car of Bommer 2006."""
    return Car.load()


@pytest.fixture(scope="session")
def sedan() -> Car:
    """The shipped sedan."""
    return Car.load("sedan")


@pytest.fixture(scope="session")
def road_car() -> Car:
    """The car of Bommer 2006 on four wheels."""
    return Car.load("focus_road")


@pytest.fixture(scope="session")
def high_piece() -> Signal:
    """The first four seconds of the shipped high input; it begins at rest."""
    signal = read_signal(find_input("high.csv"), wheel="fr")
    return Signal(time=signal.time[:4001], displacement={"fr": signal.displacement["fr"][:4001]})


@pytest.fixture(scope="session")
def high_run(car: Car, high_piece: Signal) -> Run:
    """That piece on the car at the default step."""
    return car.run(high_piece)
