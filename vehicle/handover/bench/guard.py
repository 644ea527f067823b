"""Access to the page of the bench: a secret in its address, and requests of this machine and of the page only.

The page listens on 127.0.0.1, which other users of the machine and every page in the browser can reach. So each request
is checked before it is answered, and a websocket before it is accepted:

- The path begins with a random token, which only the printed address contains.
- `Host` is 127.0.0.1 or localhost with the port of the page: a foreign name that resolves to 127.0.0.1 is rejected.
- `Origin` is the page itself. A websocket without it is rejected; browsers always send it.
"""

import hmac
import secrets
from collections.abc import Callable, Mapping
from typing import Any

TOKEN_BYTES = 24
"""Random bytes of a token: 192 bits."""

HEADERS = {
    "Referrer-Policy": "no-referrer",
    "X-Frame-Options": "DENY",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
}
"""Headers of every page: the address goes to no other page, and no other page shows it in a frame."""


class Guard:
    """Check of requests.

    Attributes:
        token: secret of the address.
        rejected: number of rejected requests.
    """

    def __init__(self) -> None:
        self.token = secrets.token_urlsafe(TOKEN_BYTES)
        self.rejected = 0

    def address(self, port: int) -> str:
        """Return the address of the page."""
        return f"http://127.0.0.1:{port}/{self.token}/"

    def inner_path(self, path: str) -> str | None:
        """Return the path after the token; None for a path without the token."""
        head, _, inner = path.partition("?")[0].removeprefix("/").partition("/")
        if path.startswith("/") and hmac.compare_digest(head.encode(), self.token.encode()):
            return f"/{inner}"
        return None

    def refusal(self, path: str, headers: Mapping[str, str], port: int) -> str:
        """Return the reason to reject a request, whose headers have names in lower case; empty for one of the page."""
        hosts = (f"127.0.0.1:{port}", f"localhost:{port}")
        if headers.get("host", "") not in hosts:
            return "host"
        origin = headers.get("origin")
        websocket = headers.get("upgrade", "").lower() == "websocket"
        if (origin is None and websocket) or (origin is not None and origin != f"http://{headers['host']}"):
            return "origin"
        return "" if self.inner_path(path) is not None else "token"

    def checked(self, process: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
        """Return a `process_request` of websockets that checks each request first.

        Args:
            process: `process_request` of the checked requests.
        """

        def process_request(connection: Any, request: Any) -> Any:
            names = {name.lower() for name, _ in request.headers.raw_items()}
            repeated = any(len(request.headers.get_all(name)) > 1 for name in ("host", "origin", "upgrade"))
            headers = (
                {} if repeated else {name: request.headers[name] for name in names & {"host", "origin", "upgrade"}}
            )
            if self.refusal(request.path, headers, connection.local_address[1]):
                self.rejected += 1
                return connection.respond(
                    403, "The address of the bench is printed in the terminal where the bench was started.\n"
                )
            request.path = self.inner_path(request.path)
            response = process(connection, request)
            if response is not None:
                for name, value in HEADERS.items():
                    response.headers[name] = value
            return response

        return process_request
