"""Libraries of formats and commands: optional ones are imported at their use, and errors of readers are converted."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

from vehicle.errors import DataError, MissingPartError


def extra(package: str, name: str, purpose: str) -> Any:
    """Import an optional library.

    Args:
        package: package to import.
        name: name of the extra that installs the package.
        purpose: use of the package, for the message.
    """
    try:
        return import_module(package)
    except ImportError:
        raise MissingPartError(
            f"{purpose} needs {package}, which is not installed; install it with: pip install "
            f"'vehicle-on-shaker[{name}]'"
        ) from None


@contextmanager
def reading(path: Path, form: str, remedy: str) -> Iterator[None]:
    """Convert the errors of a library that reads a file; for damaged files libraries raise errors of any type."""
    try:
        yield
    except DataError:
        raise
    except Exception as error:
        raise DataError(f"{path}: cannot be read as {form} ({' '.join(str(error).split())}); {remedy}") from None
