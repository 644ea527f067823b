"""Digest of the program that computes the rows of a sweep: sources and library versions."""

import hashlib
import inspect
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from vehicle.errors import ConfigurationError

LIBRARIES = ("mujoco", "numpy", "scipy")
"""Libraries that affect the values."""


@cache
def libraries() -> dict[str, str]:
    """Return library to version, empty for a missing library."""
    versions = {}
    for name in LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = ""
    return versions


@cache
def program_digest() -> str:
    """Return a digest of the sources of this package and the versions of its libraries."""
    content = hashlib.sha256(repr(libraries()).encode())
    root = Path(__file__).parents[2]
    paths = [*root.rglob("*.py"), *(root / "core" / "source").glob("*.[ch]")]
    for name, path in sorted((path.relative_to(root).as_posix(), path) for path in paths):  # the same on Windows
        content.update(name.encode() + path.read_bytes())
    return content.hexdigest()[:20]


def class_source(instance: object) -> str:
    """Return the source text of the class of an object; empty if there is no source."""
    try:
        return inspect.getsource(type(instance))
    except (OSError, TypeError):
        return ""


def require_same_program(digest: str) -> None:
    """Check that this process has the same program as the process of the sweep.

    A cluster may have another version installed.
    """
    if digest != program_digest():
        raise ConfigurationError(
            f"the workers run a different version of this package or its libraries ({program_digest()} with "
            f"{libraries()}) from that of this sweep ({digest}): install the same versions on the workers, and do not "
            "change them during a sweep"
        )
