"""Words in the names of measured channels: wheel, axis, and the model channel that a name suggests."""

import re
import shlex
from collections.abc import Collection, Iterable, Mapping, Sequence

from vehicle.signals.formats.channel import Channel

FRONT = ("front", "f", "vorn", "vorne", "v", "va")
REAR = ("rear", "r", "back", "hinten", "hinter", "h", "ha")
RIGHT = ("right", "r", "rechts", "re")
LEFT = ("left", "l", "links", "li")
"""Words for the ends and the sides of a car."""

PAIRS = {
    "fr": "fr",
    "fl": "fl",
    "rr": "rr",
    "rl": "rl",
    "vr": "fr",
    "vl": "fl",
    "hr": "rr",
    "hl": "rl",
    "rf": "fr",
    "lf": "fl",
    "lr": "rl",
}
"""Two letters for a wheel, in English and German, the side first or last."""

AXES = {
    "x": ("x", "longitudinal", "long", "fore", "laengs", "längs"),
    "y": ("y", "lateral", "lat", "quer"),
    "z": ("z", "vertical", "vert", "vertikal", "hoch", "heave"),
}
"""Words for the axes."""

SEAT = ("seat", "sitz")
RAIL = ("rail", "schiene")
KNUCKLE = {"knuckle", "upright", "hub", "wheel", "spindle", "radträger", "radtraeger", "rad", "nabe", "achsschenkel"}
ENGINE = {"engine", "motor", "powertrain"}
SPRING = {"feder", "federweg", "spring", "damper", "dämpfer", "daempfer", "suspension", "travel", "einfederung"}
"""Words for the places of the model channels, those of seats also within a word, as "Fahrersitz"; displacements of
springs and dampers are no plates."""

LATITUDE = {"lat", "latitude", "breite", "breitengrad"}
LONGITUDE = {"lon", "long", "lng", "longitude", "länge", "laenge", "längengrad"}
"""Words for the position of a satellite receiver."""

ROUTE = {"altitude", "alt", "distance", "odometer", "accuracy", "range", "strecke", "entfernung", "höhenmeter"}
"""Words for lengths along or above a route, which are no motion of a plate."""

MAPPED = 10
"""Maximum number of channels in a printed command: plates and knuckles of four wheels, seat and seat rail."""


def words_of(name: str) -> list[str]:
    """Return the words of a channel name, as "accSeatZ", in small letters: split at signs, digits and capitals."""
    parts = re.findall(r"[A-ZÄÖÜ]?[a-zäöüß]+|[A-ZÄÖÜ]+(?![a-zäöüß])", name)
    return [part.lower() for part in parts]


def wheel_of(name: str) -> str:
    """Return the wheel in a channel name, as "FR", "VL", "rear left", "LeftFront"; empty if there is none."""
    parts = words_of(name)
    pair = next((PAIRS[word] for word in parts if word in PAIRS), "")
    if pair:
        return pair
    end = next((letter for letter, names in (("f", FRONT), ("r", REAR)) if _any(parts, names)), "")
    side = next((letter for letter, names in (("r", RIGHT), ("l", LEFT)) if _any(parts, names)), "")
    return end + side if end and side else ""


def _any(parts: Sequence[str], names: Sequence[str]) -> bool:
    """Return True if a word of more than one letter is among the names."""
    return any(word in names for word in parts if len(word) > 1)


def axis_of(channel: Channel) -> str:
    """Return the axis of a channel, from its direction or its name; empty if it has none."""
    if channel.direction:
        return channel.direction[-1].lower() if channel.direction[-1] in "XYZxyz" else ""
    parts = words_of(channel.name)
    return next((axis for axis, names in AXES.items() if any(word in names for word in parts)), "")


def on_seat(channel: Channel) -> bool:
    """Return True if the name of a channel is that of a seat or its rail."""
    return _within(words_of(f"{channel.name} {channel.place}"), SEAT)


def of_wheel_or_engine(channel: Channel) -> bool:
    """Return True if the name of a channel is that of a knuckle or of an engine, on which nobody sits."""
    return not {*KNUCKLE, *ENGINE}.isdisjoint(words_of(f"{channel.name} {channel.place}"))


def point_of(channel: Channel) -> tuple[str, ...]:
    """Return the words of the name and the place of a channel without those of its axis."""
    along = {word for axis in AXES.values() for word in axis}
    return tuple(word for word in words_of(f"{channel.name} {channel.place}") if word not in along)


def _within(parts: Iterable[str], ends: Sequence[str]) -> bool:
    return any(end in word for word in parts for end in ends)


def of_receiver(channels: Sequence[Channel]) -> bool:
    """Return True if channels include latitude and longitude: their heights are those of a satellite receiver.

    A receiver gives the height above the sea in steps of 10 mm at best, with an error of metres: no road.
    """
    names = [set(words_of(channel.name)) for channel in channels]
    return any(each & LATITUDE for each in names) and any(each & LONGITUDE for each in names)


def may_be_plate(channel: Channel, channels: Sequence[Channel]) -> bool:
    """Return True if a displacement may be that of a plate or a road: no altitude, distance or travel of a spring."""
    terms = set(words_of(channel.name))
    if terms & (ROUTE | SPRING):
        return False
    return not of_receiver(channels) or bool(
        wheel_of(channel.name) or terms & {"plate", "displacement", "left", "right"}
    )


def suggested_channels(channels: Sequence[Channel], model_channels: Collection[str] | None = None) -> dict[str, str]:
    """Return the model channels that names and units of measured channels suggest, each with name or number.

    A suggestion for the user, never a choice: "Stempel VL" in mm suggests plate_fl_displacement, "Hub RL z" in g
    knuckle_rl_acc_z.

    Args:
        model_channels: names of the model; by default those of a car with four wheels.
    """
    names = [channel.name for channel in channels]
    suggested: dict[str, str] = {}
    for number, channel in enumerate(channels, 1):
        model = _suggested(channel)
        if not model or model in suggested or (model_channels is not None and model not in model_channels):
            continue
        plain = names.count(channel.name) == 1 and not channel.name.isdecimal() and not set(channel.name) & set("*?[=")
        suggested[model] = channel.name if plain and channel.name else str(number)
    return suggested


def main_channels(suggested: dict[str, str]) -> dict[str, str]:
    """Return the main ones of suggested channels: plates, vertical accelerations of knuckles and seat, then others.

    Args:
        suggested: result of `suggested_channels`; at most `MAPPED` of them are returned, in their order.
    """
    order = sorted(
        suggested, key=lambda name: (not name.startswith("plate_"), not name.endswith("_z"), name.startswith("engine"))
    )
    return {name: suggested[name] for name in suggested if name in order[:MAPPED]}


def map_words(mapped: Mapping[str, str]) -> tuple[str, ...]:
    """Return the options --map of channels of the model and their channels in a file, as words of a command line."""
    return tuple(word for model, name in mapped.items() for word in ("--map", f"{model}={name}"))


def map_options(suggested: dict[str, str]) -> str:
    """Return the options `--map` of the main ones of `suggested_channels`, as typed."""
    return shlex.join(map_words(main_channels(suggested)))


def _suggested(channel: Channel) -> str:
    """Return the model channel that a name and a unit suggest; empty if none."""
    parts = set(words_of(f"{channel.name} {channel.place}"))
    wheel, axis = wheel_of(channel.name), axis_of(channel)
    if channel.quantity == "displacement":
        return f"plate_{wheel}_displacement" if wheel and not parts & SPRING else ""
    if channel.quantity != "acceleration" or not axis:
        return ""
    if on_seat(channel):
        return f"seat_rail_acc_{axis}" if _within(parts, RAIL) else f"seat_acc_{axis}"
    if parts & ENGINE:
        return f"engine_acc_{axis}"
    return f"knuckle_{wheel}_acc_{axis}" if wheel and parts & KNUCKLE else ""
