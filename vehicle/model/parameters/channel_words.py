"""Channels of a run by words.

>>> channel_named("seat rail z", ["seat_rail_acc_x", "seat_rail_acc_z"])
'seat_rail_acc_z'
>>> channel_named("knuckle front left vertical", ["knuckle_fl_acc_z", "knuckle_fr_acc_z"])
'knuckle_fl_acc_z'
"""

from collections.abc import Iterable, Sequence

from vehicle.errors import ConfigurationError

SYNONYMS = {
    "front left": "fl",
    "front right": "fr",
    "rear left": "rl",
    "rear right": "rr",
    "vertical": "z",
    "lateral": "y",
    "longitudinal": "x",
    "acceleration": "acc",
    "cushion": "seat",
    "wheel carrier": "knuckle",
}
"""Words of an engineer to the words of the names."""


def channel_named(text: str, names: Iterable[str]) -> str:
    """Return the channel with a name, or the channel whose name contains all words and the fewest further words.

    Args:
        text: name of a channel, or words in any order, for example "seat rail z" or "knuckle front left vertical".
        names: names of the channels.

    Raises:
        ConfigurationError: no channel contains all words, or several channels contain them with equally few others.
    """
    channels = tuple(names)
    if text in channels:
        return text
    spoken_text = " ".join(text.lower().replace("_", " ").split())
    for spoken, written in SYNONYMS.items():
        spoken_text = f" {spoken_text} ".replace(f" {spoken} ", f" {written} ").strip()
    tokens = set(spoken_text.split())
    extras = {name: len(name.split("_")) for name in channels if tokens and tokens <= set(name.split("_"))}
    shortest = [name for name, count in extras.items() if count == min(extras.values())]
    if len(shortest) != 1:
        problem = "no channel has" if not extras else "several channels have"
        raise ConfigurationError(
            f"channel {text!r}: {problem} these words; choose from {', '.join(extras or channels)}"
        )
    return shortest[0]


def channels_named(texts: str | Sequence[str], names: Sequence[str]) -> tuple[str, ...]:
    """Return the channels of one text or several texts, see `channel_named`."""
    return tuple(channel_named(text, names) for text in ([texts] if isinstance(texts, str) else texts))
