"""Number of threads for linear algebra: one in commands and in calls of the package; the setting of the user stays."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
from threadpoolctl import ThreadpoolController, threadpool_limits

from tests.benchmarks.blas_threads import Server, jobs
from tests.patience import HANG
from vehicle import threads
from vehicle.threads import THREADS, one_blas_thread, prefer_one_thread

ROOT = Path(__file__).resolve().parents[2]


def blas_threads():
    controller = ThreadpoolController().select(user_api="blas")
    return {library.num_threads for library in controller.lib_controllers}


@pytest.fixture
def three():
    """Three threads, set by the user."""
    with threadpool_limits(3, user_api="blas"):
        yield


def test_one_thread_unless_the_user_has_set_a_number(monkeypatch):
    for name in THREADS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    prefer_one_thread()
    assert [os.environ.get(name) for name in THREADS] == [None, "3", None]
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    prefer_one_thread()
    assert [os.environ.pop(name) for name in THREADS] == ["1"] * len(THREADS)


def test_the_number_of_the_user_is_restored_also_after_an_error(three):
    before = dict(os.environ)
    with pytest.raises(ValueError, match="wrong"), one_blas_thread():
        assert blas_threads() == {1} and dict(os.environ) == before
        raise ValueError("wrong")
    assert blas_threads() == {3} and dict(os.environ) == before


def test_a_limit_of_the_user_inside_a_block_is_restored(three):
    with one_blas_thread():
        with threadpool_limits(2, user_api="blas"):
            with one_blas_thread():
                assert blas_threads() == {1}
            assert blas_threads() == {2}
        assert blas_threads() == {1}
    assert blas_threads() == {3}


def test_a_number_that_the_user_sets_inside_a_block_stays(three):
    with one_blas_thread():
        threadpool_limits(2, user_api="blas")
    assert blas_threads() == {2}


def test_the_last_of_several_threads_restores_the_number(three):
    entered, leave, inside = threading.Event(), threading.Event(), []

    def other():
        with one_blas_thread():
            entered.set()
            leave.wait(HANG)
            with one_blas_thread():
                pass
            inside.append(blas_threads())

    thread = threading.Thread(target=other)
    with one_blas_thread():
        thread.start()
        assert entered.wait(HANG)
    assert blas_threads() == {1}
    leave.set()
    thread.join()
    assert inside == [{1}] and blas_threads() == {3}


def test_many_threads_leave_the_number_as_it_was(three):
    seen = []

    def enter_often():
        for _ in range(200):
            with one_blas_thread():
                seen.append(blas_threads_of_libraries())

    libraries = ThreadpoolController().select(user_api="blas").lib_controllers

    def blas_threads_of_libraries():
        return max(library.num_threads for library in libraries)

    threads = [threading.Thread(target=enter_often) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert set(seen) == {1} and blas_threads() == {3}


@pytest.mark.parametrize("first", ["numpy", "scipy.linalg", "vehicle.threads", "vehicle.runs.car"])
def test_libraries_are_found_whatever_is_imported_first(first):
    code = (
        f"import {first}\nfrom vehicle.threads import one_blas_thread\nwith one_blas_thread(): pass\n"
        "import numpy, scipy.linalg\nfrom threadpoolctl import ThreadpoolController\n"
        "libraries = ThreadpoolController().select(user_api='blas').lib_controllers\n"
        "[library.set_num_threads(3) for library in libraries]\n"
        "with one_blas_thread(): print(len(libraries) > 0, {library.num_threads for library in libraries})\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG, check=True, cwd=ROOT
    )
    assert done.stdout.strip() == "True {1}"


@pytest.mark.parametrize("given", [None, "3"])
def test_a_command_has_one_thread_with_or_without_a_search_for_libraries(given, monkeypatch):
    for name in THREADS:
        monkeypatch.delenv(name, raising=False)
    if given is not None:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", given)
    code = (
        "from vehicle.commands.command_line import begin_process\nbegin_process()\n"
        "from vehicle import threads\n"
        "with threads.one_blas_thread():\n"
        "    import numpy, scipy.linalg\n    from threadpoolctl import ThreadpoolController\n"
        "    numbers = {b.num_threads for b in ThreadpoolController().select(user_api='blas').lib_controllers}\n"
        "print(numbers, len(threads._libraries()) > 0)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG, check=True, cwd=ROOT
    )
    assert done.stdout.strip() == f"{{1}} {given is not None}"


def test_linear_algebra_of_public_functions_has_one_thread(three, monkeypatch):
    libraries = ThreadpoolController().select(user_api="blas").lib_controllers
    seen: dict[str, set[int]] = {}

    def recorded(function, name):
        def call(*arguments, **options):
            seen.setdefault(name, set()).update(library.num_threads for library in libraries)
            return function(*arguments, **options)

        return call

    for library in (np.linalg, scipy.linalg):
        for name in ("eig", "eigh", "eigvals", "eigvalsh", "inv", "lstsq", "qr", "solve", "svd"):
            monkeypatch.setattr(library, name, recorded(getattr(library, name), f"{library.__name__}.{name}"))
    for job in jobs(4.0).values():
        job()
    assert len(seen) >= 4 and set().union(*seen.values()) == {1}, seen
    assert blas_threads() == {3}


def test_results_are_bitwise_those_of_one_thread_in_the_environment():
    one, free = Server(one=True, duration=3.0), Server(threads=4, duration=3.0)
    assert one.names == free.names and len(one.names) == 6
    for name in one.names:
        assert one(name)[2] == free(name)[2], name
    one.close()
    free.close()


def test_another_thread_can_set_the_number_after_a_block(three):
    with one_blas_thread():
        pass
    thread = threading.Thread(target=threadpool_limits, args=(2, "blas"))
    thread.start()
    thread.join()
    assert blas_threads() == {2}


class NumberOfEachThread(threading.local):
    """Library whose number of threads belongs to the calling thread, as that of MKL."""

    internal_api, num_threads = "mkl", 3

    def set_num_threads(self, number):
        self.num_threads = number


def test_a_number_of_each_thread_is_restored_in_its_thread(monkeypatch):
    library, leave, after = NumberOfEachThread(), threading.Event(), []
    monkeypatch.setattr(threads, "_libraries", lambda: (library,))

    def other():
        with one_blas_thread():
            after.append(library.num_threads)
        after.append(library.num_threads)
        leave.set()

    with one_blas_thread():
        threading.Thread(target=other).start()
        assert leave.wait(HANG) and library.num_threads == 1
    assert after == [1, 3] and library.num_threads == 3
