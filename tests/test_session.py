"""What a session shares does not depend on the test that asks for it first."""

import pytest


@pytest.fixture(scope="session")
def seen_in_a_session(pytestconfig):
    return pytestconfig.pluginmanager.get_plugin("present test").node


@pytest.fixture(scope="module")
def seen_in_a_module(pytestconfig):
    return pytestconfig.pluginmanager.get_plugin("present test").node


def test_a_fixture_of_the_session_is_built_for_no_test(request, seen_in_a_session, seen_in_a_module):
    assert (seen_in_a_session, seen_in_a_module) == ("", request.node.nodeid)
