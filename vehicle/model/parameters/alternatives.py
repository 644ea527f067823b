"""Keys of a vehicle file that exclude each other, of which a file over a base, or an override, replaces one by another.

A key of the base that is excluded would otherwise count as given by the user too, or take precedence over the new key.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any

LAW = ("force", "velocity", "displacement", "stiffness", "table", "table_x", "table_y", "table_z")
"""Keys of a force law as numbers, in place of which `curve` names a file."""

ALTERNATIVES: tuple[tuple[str, tuple[str, ...], tuple[str, ...]], ...] = (
    ("crank", ("rpm", "end_rpm", "run_up_time"), ("file", "channel")),
    ("force.*", ("harmonics", "angle", "frequency"), ("file", "channel", "unit", "ends_at_zero")),
    ("force.*", ("angle",), ("frequency",)),
    ("force.*", ("force",), ("moment",)),
    ("*.nonuniformity", ("runout",), ("rfv",)),
    ("*.orders", ("torque",), ("pressure",)),
    ("*.damper", ("function",), ("control",)),
    ("*.stop", LAW, ("bump", "rebound")),
)
"""Pattern of the path of a table, and two sets of its keys that exclude each other."""

NAMING = {"curve", *(key for _, *both in ALTERNATIVES for keys in both for key in keys)} - {*LAW, "bump", "rebound"}
"""Keys that replace others as an override; a number in place of a file stays refused: a car in memory has both."""


def replaced_by(above: Collection[str], path: str) -> set[str]:
    """Return the keys of a table of a base that the keys of the same table above it replace.

    Args:
        above: keys of the table above.
        path: path of the table.
    """
    excluded = set[str]()
    for pattern, *groups in ALTERNATIVES:
        for new, old in (groups, groups[::-1]):
            if fnmatchcase(path, pattern) and not set(new).isdisjoint(above) and set(old).isdisjoint(above):
                excluded |= set(old)
    if "curve" in above:
        return excluded | {*LAW} | ({"damping", "rotational_stiffness"} if is_bushing(path.split(".")) else set())
    return excluded if set(LAW).isdisjoint(above) else {*excluded, "curve"}


def remove_excluded(table: Mapping[str, Any], paths: Iterable[str], overrides: Iterable[str]) -> None:
    """Remove the values of a car that a new value excludes from a vehicle file in place.

    Args:
        table: the file.
        paths: whole paths of the new value.
        overrides: whole paths of all values that the user sets; those remain, and the car refuses both as given twice.
    """
    kept = {each for path in overrides for each in (path, path.rpartition(".")[0])}  # or the key before a component
    for path in paths:
        *parents, name = path.split(".")
        law: Any = table
        for key in parents:
            law = law.get(key) if isinstance(law, Mapping) else None
        if isinstance(law, dict):
            at = ".".join(parents)
            for key in replaced_by({name}, at) & set(law):
                if f"{at}.{key}" not in kept:
                    del law[key]


def is_bushing(names: Sequence[str]) -> bool:
    """Return True for the path of a bushing, or of a table in it."""
    return "bushings" in names[-3:] or names[:1] == ["connection"]
