"""Optional libraries of formats and commands: imported at their use, or named with the extra that installs them."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from vehicle.errors import MissingPartError


def extra(package: str, name: str, purpose: str) -> Any:
    """Import an optional library.

    Args:
        package: package to import.
        name: name of the extra that installs the package.
        purpose: use of the package, for the message.

    Raises:
        MissingPartError: the library is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        raise MissingPartError(
            f"{purpose} needs {package}, which is not installed; install it with: pip install "
            f"'vehicle-on-shaker[{name}]'"
        ) from None
