"""Settings of a road beside the speed of the car, each declared once: for Python, its documentation and the options."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

Class = TypeVar("Class", bound=type)


def setting(meaning: str, *, metavar: str = "", number_type: type = float, choices: tuple[str, ...] = ()) -> Any:
    """Declare a field of `RoadSettings`.

    Args:
        meaning: meaning with unit and default, for documentation and help.
        metavar: word for the value in the help.
        number_type: type of a number.
        choices: allowed texts, in place of a number.
    """
    option = {"choices": choices} if choices else {"type": number_type, "metavar": metavar}
    return field(default=None, metadata={"meaning": meaning, "option": option})


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadSettings:
    """Settings of a road; None is the default of each."""

    duration: float | None = setting("length [s]; 60, or the whole profile, by default", metavar="S")
    rate: float | None = setting("samples a second; 1000 by default", metavar="HZ")
    seed: int | None = setting("one seed is one road; 1 by default", metavar="N", number_type=int)
    coherence: float | None = setting("of the tracks: 1 equal, 0 unrelated; isotropic plane by default", metavar="G")
    patch: float | None = setting(
        "length of the contact patch that averages the road [m], 0 for none; 0.1 by default", metavar="M"
    )
    contact: str | None = setting(
        "patch: the road is averaged over the contact patch; cams: two elliptical cams envelop the road; patch by "
        "default, cams on an obstacle",
        choices=("patch", "cams"),
    )
    tyre: str | None = setting(
        "rolling: tyres roll at the speed, the default on a road; standing: tyres on moving plates, as on a rig, the "
        "default for a car that is on blocks too",
        choices=("rolling", "standing"),
    )

    def given(self, *, without: tuple[str, ...] = ()) -> dict[str, Any]:
        """Return the settings that are not left at their default, by name.

        Args:
            without: names that are left out.
        """
        return {name: value for name in SETTINGS if name not in without and (value := getattr(self, name)) is not None}


SETTINGS: dict[str, Mapping[str, Any]] = {each.name: each.metadata for each in fields(RoadSettings)}
"""Name to the declaration of each setting: meaning, and arguments of `argparse`."""


def with_settings(decorated: Class) -> Class:
    """Add the settings to the attributes at the end of the docstring of a class."""
    lines = "".join(f"\n        {name}: {each['meaning']}." for name, each in SETTINGS.items())
    decorated.__doc__ = f"{(decorated.__doc__ or '').rstrip()}{lines}\n    "
    return decorated
