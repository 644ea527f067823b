"""Requests that the bench rejects."""

import pytest

from vehicle.handover.bench.guard import Guard

PORT = 8630
HERE = f"127.0.0.1:{PORT}"


@pytest.fixture(scope="module")
def guard():
    return Guard()


def test_the_address_contains_a_secret_of_its_own(guard):
    assert guard.address(PORT) == f"http://{HERE}/{guard.token}/"
    assert len(guard.token) == 32 and Guard().token != guard.token


def test_page_and_websocket_of_the_address_are_answered(guard):
    for host in (HERE, f"localhost:{PORT}"):
        assert guard.refusal(f"/{guard.token}/", {"host": host}, PORT) == ""
        socket = {"host": host, "upgrade": "WebSocket", "origin": f"http://{host}"}
        assert guard.refusal(f"/{guard.token}", socket, PORT) == ""
    assert guard.inner_path(f"/{guard.token}") == "/"
    assert guard.inner_path(f"/{guard.token}/assets/a.js?x=1") == "/assets/a.js"


@pytest.mark.parametrize(
    ("path", "headers", "reason"),
    [
        ("/", {}, "token"),
        ("/TOKENx/", {}, "token"),
        ("//TOKEN/", {}, "token"),
        ("TOKEN", {}, "token"),
        ("/?TOKEN", {}, "token"),
        ("/TOKEN/", {"host": "attacker.example"}, "host"),
        ("/TOKEN/", {"host": f"attacker.example:{PORT}"}, "host"),
        ("/TOKEN/", {"host": "127.0.0.1:80"}, "host"),
        ("/TOKEN/", {"host": ""}, "host"),
        ("/TOKEN", {"upgrade": "websocket"}, "origin"),
        ("/TOKEN", {"upgrade": "websocket", "origin": "http://attacker.example"}, "origin"),
        ("/TOKEN", {"upgrade": "websocket", "origin": "null"}, "origin"),
        ("/TOKEN", {"upgrade": "websocket", "origin": f"https://{HERE}"}, "origin"),
        ("/TOKEN", {"upgrade": "websocket", "origin": f"http://localhost:{PORT}"}, "origin"),
        ("/TOKEN/", {"origin": "http://attacker.example"}, "origin"),
        ("/", {"upgrade": "websocket", "origin": f"http://{HERE}"}, "token"),
    ],
)
def test_other_requests_are_rejected(guard, path, headers, reason):
    full = {"host": HERE, **headers}
    assert guard.refusal(path.replace("TOKEN", guard.token), full, PORT) == reason


def test_missing_host_is_rejected(guard):
    assert guard.refusal(f"/{guard.token}/", {}, PORT) == "host"
