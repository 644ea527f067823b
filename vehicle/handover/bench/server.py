"""Web server of the bench: viser on 127.0.0.1 with the checks of the guard."""

import asyncio
import io
import logging
import sys
from contextlib import redirect_stdout
from importlib import import_module
from typing import Any

from vehicle.errors import ConfigurationError, OutputError
from vehicle.handover.bench.guard import Guard
from vehicle.signals.formats.optional_library import extra

HOST = "127.0.0.1"
"""Address on which the page is served: this machine alone."""

LONGEST = 200
"""Maximum length of the message of an error; the error may quote the message of a client."""

PORTS = (1024, 65535)
"""Permitted ports."""


def open_server(guard: Guard, port: int) -> Any:
    """Start a viser server whose requests the guard checks, also a websocket before it is accepted.

    viser passes `process_request` to `websockets.asyncio.server.serve` without an option to change it. Therefore
    `serve` is replaced while the server starts.

    Args:
        guard: check of the requests.
        port: port; the next free one if it is taken.

    Returns:
        The viser server; `get_port()` is its port.

    Raises:
        ConfigurationError: a port outside `PORTS`.
        MissingPartError: viser is not installed.
        OutputError: the installed viser starts its server in another way, so that it would not be guarded.
    """
    if not PORTS[0] <= port <= PORTS[1]:
        raise ConfigurationError(f"--port {port}: must be {PORTS[0]} to {PORTS[1]}")
    viser = extra("viser", "bench", "the bench")
    websockets: Any = import_module("websockets.asyncio.server")
    serve: Any = websockets.serve
    base: Any = viser.ViserServer
    started = []

    class GuardedServe(serve):  # type: ignore[misc]
        """Server of websockets that checks requests first."""

        def __init__(self, *arguments: Any, process_request: Any, **options: Any) -> None:
            options["logger"] = connection_log()
            # viser handles each message in a task, whose error asyncio would print with its traceback.
            asyncio.get_running_loop().set_exception_handler(_report)
            super().__init__(*arguments, process_request=guard.checked(process_request), **options)
            started.append(True)

    class Server(base):  # type: ignore[misc]
        """Server without the tunnel to the host of viser's authors."""

        def request_share_url(self, verbose: bool = True) -> None:
            """Return no public address."""

    websockets.serve = GuardedServe
    try:
        with redirect_stdout(io.StringIO()):  # it prints an address without the token
            server = Server(host=HOST, port=port, label="bench", verbose=False)
    finally:
        websockets.serve = serve
    if not started:
        server.stop()
        raise OutputError("bench: viser starts its web server in an unknown way, so its page would not be guarded; "
                          "install the version of constraints.txt")  # fmt: skip
    return server


class OneLine(logging.Handler):
    """Reports a failed connection in a line: a malformed message ends its connection, not the bench."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write the error of a record to standard error."""
        _say("a connection was closed", (record.exc_info and record.exc_info[1]) or record.getMessage())


def _report(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Report a message of the page that could not be handled, for example a word as the value of a slider."""
    if (error := context.get("exception")) is not None:
        _say("a message from the page was ignored", error)
    else:
        _say("the page server reported an event", context["message"])


def _say(event: str, cause: BaseException | str) -> None:
    """Write an event and its cause to standard error, in one line without control characters."""
    description = cause if isinstance(cause, str) else f"{type(cause).__name__}: {cause}"
    text = " ".join(description.split())[:LONGEST]
    sys.stderr.write(f"bench: {event} ({''.join(sign if sign.isprintable() else '?' for sign in text)})\n")


def connection_log() -> logging.Logger:
    """Return the log of the connections, whose errors are lines without a traceback."""
    log = logging.Logger("bench", logging.ERROR)
    log.addHandler(OneLine())
    return log


def close_server(server: Any) -> None:
    """Stop a server of `open_server`."""
    with redirect_stdout(io.StringIO()):
        server.stop()
