"""Words in the names of measured channels: wheel, axis, and the model channel that a name suggests.

A name suggests a channel only if all of its words are understood: "Wheel arch FL" is no wheel, "Seat belt anchor" no
seat, and a displacement is that of a plate only if a word says plate. Else the user decides.
"""

import re
import shlex
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.units import find_unit

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
    "x": ("longitudinal", "long", "fore", "laengs", "längs"),
    "y": ("lateral", "lat", "quer", "transverse"),
    "z": ("vertical", "vert", "vertikal", "hoch", "heave"),
}
"""Words for the axes."""

ACCELERATION = {"acc", "accel", "acceleration", "accelerations", "accelerometer", "beschleunigung", "beschl", "a"}
DIRECTION = {"axis", "achse", "dir", "direction", "richtung", "along"}
"""Words that declare an axis next to a letter: "acc_x", "X-Richtung"."""

SEAT = {"seat", "sitz", "sitzkissen", "sitzfläche", "sitzflaeche", "fahrersitz", "beifahrersitz", "rücksitz",
        "ruecksitz", "sitzschiene"}  # fmt: skip
RAIL = {"rail", "track", "schiene", "sitzschiene"}
KNUCKLE = {"knuckle", "upright", "hub", "wheel", "spindle", "radträger", "radtraeger", "rad", "nabe", "achsschenkel"}
ENGINE = {"engine", "motor", "powertrain"}
"""Words for the points of the model channels."""

CUSHION = {"driver", "fahrer", "cushion", "kissen", "pad", "surface"}
CENTRE = {"center", "centre", "mitte", "carrier", "block"}
"""Further words in names of a seat, and of a knuckle or engine."""

OTHER_SEAT = {"passenger", "beifahrer", "beifahrersitz", "rücksitz", "ruecksitz", "rear", "hinten"}
"""Words for seats other than the driver's, which is that of the model."""

PLACES = SEAT | RAIL | KNUCKLE | ENGINE | {"floor", "boden", "roof", "dach", "body", "cab", "cabin"}
"""Words for points; a letter next to a point is an axis: "Seat Z left", "z_seat"."""

NEUTRAL = {"raw", "filt", "filtered", "signal", "sensor", "channel", "ch", "kanal", "can", "rx", "tx", "imu", "dcu",
           "ecu", "daq", "mux", "node", "in", "of", "on", "at", "the"}  # fmt: skip
"""Words without a point or a direction."""

PLATE = {"plate", "platte", "shaker", "poster", "actuator", "aktuator", "aktor", "stempel", "stößel", "stoessel", "ram",
         "rüttler", "ruettler", "prüfstand", "pruefstand", "prüfstempel", "pruefstempel", "prüfzylinder", "hydropuls",
         "hydropulser", "hydropulszylinder", "pulser", "pulsator", "exciter", "erreger", "wheelpan", "radplatte",
         "excitation", "anregung", "fußpunkt", "fusspunkt", "fußpunktanregung", "fusspunktanregung",
         "fußpunkterregung", "fusspunkterregung"}  # fmt: skip
"""Words for the plate of a shaker under a wheel, in English and German."""

PLATE_MOTION = {"displacement", "disp", "displ", "position", "pos", "motion", "height", "weg", "lvdt", "hydraulic",
                "servo", "post", "four", "wheel", "rad", "road", "test", "rig", "stand", "ist", "actual", "measured",
                "act", "feedback", "fbk", "fb", "response", "meas", "mess", "gemessen", "input", "mts", "servotest",
                "instron", "moog", "zylinder", "cylinder"}  # fmt: skip
"""Further words in names of a plate; "ride", "damper", "tyre" are not among them."""

DEFAULT_PLATE = re.compile(r"(plate_)?displacement(_[fr][lr])?|plate_[fr][lr]_displacement")
"""Names of the program's own files of plates."""

LATITUDE = {"lat", "latitude", "breite", "breitengrad"}
LONGITUDE = {"lon", "long", "lng", "longitude", "länge", "laenge", "längengrad"}
"""Words for the position of a satellite receiver."""

MAPPED = 10
"""Maximum number of channels in a printed command: plates and knuckles of four wheels, seat and seat rail."""

_TOKEN = re.compile(r"0[xX][0-9A-Fa-f]+(?![^\W_])|[A-ZÄÖÜ]?[a-zäöüß]+|[A-ZÄÖÜ]+(?![a-zäöüß])|\d+")
_BRACKETS = re.compile(r"\([^()]*\)|\[[^\[\]]*\]")
_POINT = "|".join(sorted((ACCELERATION | PLACES) - {"a"}, key=len, reverse=True))
_JOINED = re.compile(
    rf"(?:(?:{_POINT})\d*|a|g)(?P<after>[xyz])\d?|(?P<before>[xyz])(?:{_POINT}|achse|axis|richtung|dir)"
)
_COMPOUND = re.compile(r"(längs|laengs|quer|vertikal|hoch)(?:beschleunigung|beschl|achse|richtung|acc)")
_BRACKETED = re.compile(
    r"[\[(]\s*[+-]?(?P<axis>\w+)(?:[\s-]*(?:axis|achse|dir|direction|richtung))?\s*[\])]", re.IGNORECASE
)


class Token(NamedTuple):
    """Word, number or hexadecimal number of a name, in small letters, with its span; `capital`: begins with one."""

    text: str
    begin: int
    end: int
    capital: bool


class Mention(NamedTuple):
    """Letter or word of an axis in a name; `declared`: at the end of the name or next to a word for axes."""

    axis: str
    begin: int
    end: int
    declared: bool


def tokens_of(name: str) -> list[Token]:
    """Return the words and numbers of a channel name, split at signs, digits and capitals: "accSeatZ" has three."""
    return [Token(each[0].lower(), *each.span(), each[0][0].isupper()) for each in _TOKEN.finditer(name)]


def words_of(name: str) -> list[str]:
    """Return the words of a channel name such as "accSeatZ" in small letters, without numbers."""
    return [token.text for token in tokens_of(name) if not token.text[0].isdigit()]


def wheel_of(name: str) -> str:
    """Return the wheel in a channel name: "FR", "VL", "rear left", "LeftFront"; empty if none or several."""
    parts = words_of(name)
    pairs = {PAIRS[word] for word in parts if word in PAIRS}
    if pairs:
        return pairs.pop() if len(pairs) == 1 else ""
    end = next((letter for letter, names in (("f", FRONT), ("r", REAR)) if _any(parts, names)), "")
    side = next((letter for letter, names in (("r", RIGHT), ("l", LEFT)) if _any(parts, names)), "")
    return end + side if end and side else ""


def _any(parts: Sequence[str], names: Sequence[str]) -> bool:
    """Return True if a word of more than one letter is among the names."""
    return any(word in names for word in parts if len(word) > 1)


def axis_of(channel: Channel) -> str:
    """Return the axis of a channel, from its direction or its name; empty if there is none, or several."""
    if channel.direction:
        return channel.direction[-1].lower() if channel.direction[-1] in "XYZxyz" else ""
    mentions = _mentions(channel.name)
    axes = {mention.axis for mention in mentions}
    return axes.pop() if len(axes) == 1 and any(mention.declared for mention in mentions) else ""


def _mentions(name: str) -> list[Mention]:
    """Return the mentions of axes in a name; axes in brackets count only if the bracket contains nothing else."""
    text = _BRACKETS.sub(lambda match: " " * len(match[0]), name)
    mentions = []
    for run in re.finditer(r"[^\W_]+", text):  # "accz", "ACCX1", "zAccel"
        if joined := _JOINED.fullmatch(run[0].lower()):
            begin = run.start() + joined.start("after" if joined["after"] else "before")
            mentions.append(Mention(text[begin].lower(), begin, begin + 1, True))
    tokens = tokens_of(text)
    for at, token in enumerate(tokens):
        word = _axis_word(token.text)
        if word:
            mentions.append(Mention(word, token.begin, token.end, True))
        elif token.text in ("x", "y", "z") and _is_letter(tokens, at):
            mentions.append(Mention(token.text, token.begin, token.end, _is_declared(tokens, at)))
    if not mentions:
        for match in _BRACKETED.finditer(name):
            word = match["axis"].lower()
            if axis := word if word in ("x", "y", "z") else _axis_word(word):
                mentions.append(Mention(axis, *match.span("axis"), True))
    return mentions


def _axis_word(word: str) -> str:
    """Return the axis of a word such as "lateral" or "Querbeschleunigung"; empty for other words."""
    compound = _COMPOUND.fullmatch(word)
    word = compound[1] if compound else word
    return next((axis for axis, names in AXES.items() if word in names), "")


def _is_letter(tokens: Sequence[Token], at: int) -> bool:
    """Return True if a letter x, y or z is a word ("AccX", "Z1"), not in "0x1F", "x1000", "4x", "xDCU"."""
    token = tokens[at]
    before = tokens[at - 1] if at else None
    after = tokens[at + 1] if at + 1 < len(tokens) else None
    joined = before is not None and before.end == token.begin
    if before is not None and joined and before.text[0].isdigit():
        return False
    if after is None or (after.begin > token.end and not (after.text.isdigit() and token.text == "x")):
        return True
    if after.text.isdigit():  # the number of a sensor; x10 is a factor, X5 a car or a plug
        of_axis = before is not None and before.text in ACCELERATION | DIRECTION
        return len(after.text) == 1 and (token.text != "x" or (token.capital and of_axis))
    return after.text in ACCELERATION | DIRECTION or (token.capital and (joined or after.text in PLACES))


def _is_declared(tokens: Sequence[Token], at: int) -> bool:
    """Return True if a letter is an axis by its neighbours, or only words without meaning follow it."""
    before = tokens[at - 1].text if at else ""
    after = tokens[at + 1].text if at + 1 < len(tokens) else ""
    return (
        before in ACCELERATION | DIRECTION | PLACES
        or before in PAIRS
        or after in ACCELERATION | DIRECTION
        or (at == 0 and after in PLACES)
        or (at > 0 and tokens[at - 1].end == tokens[at].begin)
        or all(_is_neutral(token) for token in tokens[at + 1 :])
    )


def _is_neutral(token: Token) -> bool:
    """Return True for numbers, letters, units, sides, and words without a point or a direction."""
    word = token.text
    sides = word in PAIRS or (word in (*FRONT, *REAR, *LEFT, *RIGHT) and word != "back")  # of a seat: its back
    return word[0].isdigit() or len(word) == 1 or sides or word in NEUTRAL or find_unit(word) is not None


def _significant(text: str) -> set[str]:
    """Return the words for the point in a name, without codes of sensors ("MP12")."""
    tokens = tokens_of(text)
    along = [(mention.begin, mention.end) for mention in _mentions(text)]
    return {
        token.text
        for token, after in zip(tokens, [*tokens[1:], None], strict=True)
        if not _is_neutral(token)
        and token.text not in ACCELERATION | DIRECTION
        and not any(begin <= token.begin < end for begin, end in along)
        and not (after and after.text[0].isdigit() and after.begin == token.end and len(token.text) < 4)
    }


def _is_point(channel: Channel, needed: Collection[str], allowed: Collection[str]) -> bool:
    """Return True if the name, or the name with its place, has a needed word and otherwise allowed words only."""
    for text in (channel.name, f"{channel.name} {channel.place}"):
        terms = _significant(text)
        if not terms.isdisjoint(needed):
            return terms <= {*needed, *allowed}
    return False


def on_seat(channel: Channel) -> bool:
    """Return True if the name of a channel means a seat or its rail."""
    return _is_point(channel, SEAT, RAIL | CUSHION | OTHER_SEAT)


def of_wheel_or_engine(channel: Channel) -> bool:
    """Return True if the name of a channel means a wheel, an engine or a part of them: nobody sits there."""
    return not {*KNUCKLE, *ENGINE}.isdisjoint(words_of(f"{channel.name} {channel.place}"))


def by_point(channels: Sequence[tuple[int, Channel]]) -> list[list[tuple[int, Channel]]]:
    """Group numbered channels by points: by the words other than the axis, and by numbers if an axis repeats."""
    groups: dict[tuple[str, ...], list[tuple[int, Channel]]] = {}
    for pair in channels:
        groups.setdefault(_point(pair[1], numbers=False), []).append(pair)
    points: dict[tuple[str, ...], list[tuple[int, Channel]]] = {}
    for key, group in groups.items():
        axes = [axis_of(channel) for _, channel in group]
        for pair in group:
            points.setdefault(key if len(axes) == len(set(axes)) else _point(pair[1], numbers=True), []).append(pair)
    return list(points.values())


def _point(channel: Channel, *, numbers: bool) -> tuple[str, ...]:
    """Return the words of the name and the place of a channel without the axis."""
    along = [(mention.begin, mention.end) for mention in _mentions(channel.name)]
    name = [token for token in tokens_of(channel.name) if not any(b <= token.begin < e for b, e in along)]
    return tuple(token.text for token in (*name, *tokens_of(channel.place)) if numbers or not token.text[0].isdigit())


def of_receiver(channels: Sequence[Channel]) -> bool:
    """Return True if channels include latitude and longitude: their heights are from a satellite receiver.

    A receiver gives the height above the sea in steps of 10 mm at best, with an error of metres: no road.
    """
    names = [set(words_of(channel.name)) for channel in channels]
    return any(each & LATITUDE for each in names) and any(each & LONGITUDE for each in names)


def is_plate(channel: Channel) -> bool:
    """Return True if the name of a displacement contains a word for the plate under a wheel.

    A ride height, the travel of a suspension or the deflection of a tyre is a relative motion of two parts, and the
    actuator of a road wheel steers it.
    """
    if {"road", "wheel"} <= set(words_of(channel.name)):
        return False
    default = DEFAULT_PLATE.fullmatch(channel.name.strip().rstrip(".").lower())
    return channel.quantity == "displacement" and (default is not None or _is_point(channel, PLATE, PLATE_MOTION))


def suggested_channels(channels: Sequence[Channel], model_channels: Collection[str] | None = None) -> dict[str, str]:
    """Return the model channels that names and units of measured channels suggest, each with name or number.

    A suggestion for the user, never a choice: "Stempel VL" in mm suggests plate_fl_displacement, "Hub RL z" in g
    knuckle_rl_acc_z.

    Args:
        model_channels: names of the model; by default of a car with four wheels.
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
    if wheel and is_plate(channel):
        return f"plate_{wheel}_displacement"
    if channel.quantity != "acceleration" or not axis:
        return ""
    if on_seat(channel):
        other = parts & OTHER_SEAT or wheel[:1] == "r"
        return "" if other else f"seat_rail_acc_{axis}" if parts & RAIL else f"seat_acc_{axis}"
    if _is_point(channel, ENGINE, CENTRE):
        return f"engine_acc_{axis}"
    return f"knuckle_{wheel}_acc_{axis}" if wheel and _is_point(channel, KNUCKLE, CENTRE) else ""
