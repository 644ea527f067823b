"""Which program makes the rows of a sweep: other sources or libraries, other rows."""

from __future__ import annotations

import hashlib
import inspect
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from vehicle.errors import ConfigurationError

LIBRARIES = ("mujoco", "numpy", "scipy", "numba")
"""What computes the numbers; without numba, "auto" is another engine."""


@cache
def libraries() -> dict[str, str]:
    """Versions of the libraries, empty where one is missing."""
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found


@cache
def program_digest() -> str:
    """Digest of the sources of this package and the versions of its libraries."""
    content = hashlib.sha256(repr(libraries()).encode())
    root = Path(__file__).parents[2]
    for path in sorted(root.rglob("*.py")):
        content.update(str(path.relative_to(root)).encode() + path.read_bytes())
    return content.hexdigest()[:20]


def class_source(instance: object) -> str:
    """Source text of the class of an object, which may be the user's own; empty where it has none."""
    try:
        return inspect.getsource(type(instance))
    except (OSError, TypeError):
        return ""


def require_same_program(digest: str) -> None:
    """Refuse to compute rows for another program: a cluster may have another version installed.

    Raises:
        ConfigurationError: this process has other sources or libraries than the one that started the sweep.
    """
    if digest != program_digest():
        raise ConfigurationError(
            f"the workers have another program ({program_digest()} with {libraries()}) than this sweep ({digest}): "
            "install the same version of this package and its libraries there, and do not change it during a sweep"
        )
