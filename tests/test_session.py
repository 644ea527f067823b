"""What a session shares depends on no test that asks first; the parts of the suite are what they say."""

from pathlib import Path

import pytest

from tests.parts import KEPT, REST, is_rest
from tools.mutations import FAULTS

TESTS = Path(__file__).parent


@pytest.fixture(scope="session")
def seen_in_a_session(pytestconfig):
    return pytestconfig.pluginmanager.get_plugin("present test").node


@pytest.fixture(scope="module")
def seen_in_a_module(pytestconfig):
    return pytestconfig.pluginmanager.get_plugin("present test").node


def test_a_fixture_of_the_session_is_built_for_no_test(request, seen_in_a_session, seen_in_a_module):
    assert (seen_in_a_session, seen_in_a_module) == ("", request.node.nodeid)


def test_the_entries_of_the_parts_exist():
    for entry in (*REST, *KEPT):
        file, _, name = entry.partition("::")
        found = [path.relative_to(TESTS).as_posix() for path in TESTS.rglob("test_*.py")]
        there = [path for path in found if path.startswith(file)]
        assert there and (not name or f"def {name}" in (TESTS / file).read_text(encoding="utf-8")), entry


def test_every_seeded_fault_has_tests_of_the_product():
    def of_product(name):
        path = TESTS / name
        files = path.rglob("test_*.py") if path.is_dir() else [path]
        return any(not is_rest(file.relative_to(TESTS).as_posix(), renders=False) for file in files)

    assert [fault.file for fault in FAULTS if not any(map(of_product, fault.tests.split()))] == []
