"""Version of the package: from `pyproject.toml` in a clone, else from the metadata of the installed package."""

import tomllib
from importlib import metadata
from pathlib import Path

PROJECT = "vehicle-on-shaker"


def package_version() -> str:
    """Return name and version of the package, for example "vehicle-on-shaker 0.1.0".

    The metadata of an editable installation can be outdated, so `pyproject.toml` of a clone has priority.
    """
    try:
        project = tomllib.loads(Path(__file__).parents[1].joinpath("pyproject.toml").read_text(encoding="utf-8"))
        if project["project"]["name"] == PROJECT:
            return f"{PROJECT} {project['project']['version']}"
    except (OSError, ValueError, KeyError):
        pass
    return f"{PROJECT} {metadata.version(PROJECT)}"
