"""Cars and short runs that several test folders share, made once a session."""

import gc
import os
import shutil
import tempfile

import pytest

from tests.advice import LARGEST, run_advice
from tests.shared_cars import share_cars
from tests.undrawn import leave_out_drawings
from tests.validation_page import check_page
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal

LONGEST = (
    *("documentation/test_pages", "studies/design/test_scaled_parts", "studies/sweeps/test_sweep"),
    *("runs/report/test_trial", "studies/design/test_new_car", "runs/car/test_motion_figures"),
    *("scenarios/test_quarter_car", "scenarios/test_tuning", "system/test_shaker_command"),
    *("handover/bench/test_state", "documentation/test_site", "documentation/test_doctests"),
    *("studies/tuning/test_posterior", "system/test_installation", "benchmarks/test_speed"),
)
"""Modules of tests that take the longest; two workers that begin with them end at about the same time."""


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


def pytest_collection_modifyitems(items):
    """Begin with the longest modules."""
    order = {f"tests/{name}.py": place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: order.get(item.nodeid.partition("::")[0], len(order)))


def pytest_configure(config):
    """Draw figures only where a test looks at them; build equal cars once; keep the user's list of trusted code."""
    # Not a TemporaryDirectory: a forked process would remove it at its end.
    folder = tempfile.mkdtemp(prefix="configuration-")
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))
    os.environ["XDG_CONFIG_HOME"] = folder
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


ADVISED = (
    *("signals/formats", "signals/records", "signals/excitation", "commands", "runs/comparison"),
    *("studies/mounts", "studies/replication", "studies/tuning"),
    *("system/test_bad_inputs", "system/test_lost_files", "system/test_no_traceback", "system/test_road_run"),
)
"""Folders and modules of tests whose record files are those of users: `inspect` advises a command that accepts each of
them."""

_SEEN: set[tuple[str, int, bytes]] = set()


@pytest.fixture(autouse=True)
def _advice_is_accepted(request, tmp_path_factory):
    """Run the commands that `inspect` advises for the files that a test leaves in its folder, each file once."""
    files = request.node.path.relative_to(request.config.rootpath / "tests").as_posix()
    if not files.startswith(ADVISED) or "tmp_path" not in request.fixturenames:
        yield
        return
    folder = request.getfixturevalue("tmp_path")
    yield
    for file in sorted(folder.glob("*.*")):
        if not file.is_file() or not 0 < file.stat().st_size < LARGEST:
            continue
        identity = (file.suffix, file.stat().st_size, file.read_bytes()[-4000:])
        if identity not in _SEEN:
            _SEEN.add(identity)
            run_advice(file, tmp_path_factory.mktemp("advice"), whole=False)


@pytest.fixture(scope="session")
def car() -> Car:
    """The car of Bommer 2006."""
    return Car.load()


@pytest.fixture(scope="session")
def high_piece() -> Signal:
    """The first four seconds of the shipped high input; it begins at rest."""
    signal = read_signal(find_input("high.csv"), wheel="fr")
    return Signal(time=signal.time[:4001], displacement={"fr": signal.displacement["fr"][:4001]})


@pytest.fixture(scope="session")
def high_run(car: Car, high_piece: Signal) -> Run:
    """That piece on the car at the default step."""
    return car.run(high_piece)
