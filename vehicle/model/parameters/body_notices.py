"""Notices on the changes that follow from a variation of mass or centre of gravity of the body (`whole_body`)."""

import contextlib
from collections.abc import Iterable, Mapping

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.paths import meant
from vehicle.model.parameters.vehicle import Vehicle


def body_notices(vehicle: Vehicle, overrides: Iterable[str]) -> list[str]:
    """Return a notice for each override of mass or CoG of the body: the changes that followed."""
    body, texts = vehicle.body, {text.partition("=")[0].strip(): text.strip() for text in overrides}
    notices = _notices(vehicle, texts)
    moments = ", ".join(f"{name} {getattr(body.inertia, name):.6g}" for name in MOMENTS[:3])
    now = f"{moments} kg m2 about the {'CoG' if body.inertia.about == 'cog' else 'origin'}"
    if body.flexible and body.model_mass is not None:
        root = body.model_factor**-0.5
        now += (
            f"; the masses of the body model are multiplied by {body.model_factor:.6g}, its frequencies by {root:.6g}"
        )
    return [f"{text}; {now}" for text in notices]


def body_rules(vehicle: Vehicle, paths: Iterable[str]) -> list[str]:
    """Return a notice for mass and CoG of the body if a study varies them: the changes that follow."""
    return _notices(vehicle, {path: path for path in paths})


def _notices(vehicle: Vehicle, texts: Mapping[str, str]) -> list[str]:
    """Return the notices for mass and CoG; `texts`: text that names each path."""
    text_of_path: dict[str, str] = {}
    for path, text in texts.items():
        # An optional parameter may have its default again.
        with contextlib.suppress(ConfigurationError):
            text_of_path |= dict.fromkeys(meant(vehicle.table, path), text)
    inertia_set = any(path.startswith("body.inertia.") for path in text_of_path)
    exception = ", except the given values of body.inertia" if inertia_set else ""
    moved = dict.fromkeys(
        text for path, text in text_of_path.items() if path == "body.cog" or path.startswith("body.cog.")
    )
    notices = (
        [f"{text_of_path['body.mass']}: the whole body is scaled, so its radii of gyration stay the same{exception}"]
        if ("body.mass" in text_of_path)
        else []
    )
    return notices + (
        [f"{', '.join(moved)}: the inertia about the centre of gravity stays the same{exception}"] if moved else []
    )
