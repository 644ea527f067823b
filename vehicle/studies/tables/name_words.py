"""Words of a name in a table: split at signs and capitals, abbreviations written out, axle and side taken out.

"hpl_lca_front"                  arm lower front, left
"UpperWishboneFrontPivot FL"     arm upper front, axle front, left
"front lower control arm, rear"  arm lower rear, axle front
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle.errors import DataError

PLAIN: dict[str, str] = {
    # Parts.
    "lca": "lower arm", "uca": "upper arm", "lwb": "lower arm", "uwb": "upper arm", "wishbone": "arm", "aarm": "arm",
    "querlenker": "arm", "lenker": "arm", "dreieckslenker": "arm", "control": "", "trackrod": "tie", "tierod": "tie",
    "toelink": "tie", "spurstange": "tie", "steeringrod": "tie", "track-rod": "tie", "lbj": "lower ball",
    "ubj": "upper ball", "balljoint": "ball", "traggelenk": "ball", "kugelgelenk": "ball", "wc": "wheel center",
    "centre": "center", "mittelpunkt": "center", "mitte": "center", "rad": "wheel", "cp": "contact",
    "patch": "contact", "contactpatch": "contact", "radaufstandspunkt": "contact", "aufstandspunkt": "contact",
    "tire": "tyre", "tires": "tyre", "tyres": "tyre", "reifen": "tyre", "shock": "damper", "dampers": "damper",
    "absorber": "damper", "daempfer": "damper", "dämpfer": "damper", "stoßdämpfer": "damper",
    "shockabsorber": "damper", "federbein": "strut", "pherson": "", "mc": "", "feder": "spring", "springs": "spring",
    "coil": "spring", "arb": "bar", "stabilizer": "bar", "stabiliser": "bar", "stabi": "bar", "stabilisator": "bar",
    "antiroll": "bar", "antirollbar": "bar", "sway": "bar", "swaybar": "bar", "rollbar": "bar", "auxiliary": "bar",
    "droplink": "droplink", "endlink": "droplink", "pendelstütze": "droplink", "trailingarm": "trailing arm",
    "längslenker": "trailing arm", "lager": "", "punkt": "", "stützlager": "top", "domlager": "top",
    "upright": "knuckle", "radträger": "knuckle", "hub": "knuckle",
    # Places.
    "outboard": "outer", "outside": "outer", "aussen": "outer", "außen": "outer", "inboard": "inner",
    "inside": "inner", "innen": "inner", "upr": "upper", "oben": "upper", "top": "top", "tower": "top", "dom": "top",
    "lwr": "lower", "unten": "lower", "bottom": "bottom", "fore": "front", "forward": "front", "frt": "front",
    "vorn": "front", "vorne": "front", "va": "front axle", "fa": "front axle", "ra": "rear axle",
    "vorderrad": "front wheel", "rearward": "rear", "aft": "rear", "back": "rear", "rr_axle": "rear",
    "hinten": "rear", "ha": "rear axle", "rht": "right", "links": "left", "linke": "left", "rechts": "right",
    "lh": "left", "rh": "right",
    "rechte": "right", "achse": "axle", "achs": "axle", "suspension": "suspension", "fahrwerk": "suspension",
    "über": "above", "over": "above", "ober": "upper", "unter": "lower", "vorder": "front", "hinter": "rear",
    "inner": "inner", "äußer": "outer",
    # Quantities.
    "weight": "mass", "masse": "mass", "gewicht": "mass", "curb": "kerb", "leer": "kerb", "car": "vehicle",
    "fahrzeug": "vehicle", "whole": "total", "overall": "total", "gesamt": "total", "stiffness": "rate",
    "steifigkeit": "rate", "federrate": "spring rate", "radbezogen": "wheel", "constant": "rate", "konstante": "rate",
    "dämpfung": "damping", "dämpfungsmaß": "damping ratio", "dämpfungsgrad": "damping ratio", "damp": "damping",
    "ungefedert": "unsprung", "gefedert": "sprung", "aufbau": "body",
    "bereifung": "tyre", "wankfedersteifigkeit": "roll rate",
    "radstand": "wheelbase", "spurweite": "track", "spur": "track", "tread": "track", "width": "", "cg": "cog",
    "com": "cog", "schwerpunkt": "cog", "höhe": "height", "hoehe": "height", "abstand": "distance",
    "trägheit": "inertia", "massenträgheit": "inertia", "moment": "moment", "moi": "inertia", "last": "load",
    "rolling": "roll", "wank": "roll", "wanken": "roll", "nick": "pitch", "nicken": "pitch", "gieren": "yaw",
    "gier": "yaw", "halbmesser": "radius", "frequenz": "frequency", "eigenfrequenz": "frequency",
    "übersetzung": "ratio", "verteilung": "distribution", "bias": "distribution", "split": "distribution",
    "corners": "corner", "wheels": "wheel", "ibs": "", "frequencies": "frequency", "natural": "", "vertical": "",
    "vertikal": "", "radial": "", "installation": "motion", "bump": "compression", "jounce": "compression",
    "druckstufe": "compression", "druck": "compression", "extension": "rebound", "zugstufe": "rebound",
    "zug": "rebound", "statisch": "static", "gesamtgewicht": "permissible", "gvw": "permissible",
}  # fmt: skip
"""Word in small letters -> plain words; "" for a word without meaning here."""

ADJECTIVE = re.compile(r"(ober|unter|vorder|hinter|inner|äußer|ungefedert|gefedert|statisch)e[rsnm]?")
"""German adjectives with their endings."""

STEMS = sorted((*PLAIN, "wheel", "tyre", "spring", "track", "unsprung", "sprung", "center", "mass", "rate", "radius"),
               key=len, reverse=True)  # fmt: skip
"""Parts of a word of several words, the longest first: Aufbaufedersteifigkeit, wheelrate."""

OPTIMUM = {
    "chas_lowfor": "lower arm fore", "chas_lowaft": "lower arm aft", "chas_uppfor": "upper arm fore",
    "chas_uppaft": "upper arm aft", "upri_lowpnt": "lower ball", "upri_upppnt": "upper ball",
    "chas_tiepnt": "tie inner", "upri_tiepnt": "tie outer",
}  # fmt: skip
"""Names of points in files of OptimumKinematics."""

NOISE = frozenset({
    "hp", "pt", "point", "points", "joint", "location", "loc", "coordinate", "position", "pos", "mount", "mounting",
    "bushing", "bush", "pivot", "attachment", "attach", "the", "of", "at", "on", "to", "in", "a", "an", "and", "for",
    "from", "with", "per", "value", "its", "sub", "fixed", "about", "axis", "around", "der", "die", "das", "am",
    "im", "des", "je", "pro", "mdl", "model", "ground", "coefficient", "design", "nominal", "static", "zur", "zu",
    "boden", "straße", "road", "din",
})  # fmt: skip
"""Words without effect on the meaning of a name."""

CORNERS = {"fl": ("front", "left"), "fr": ("front", "right"), "lf": ("front", "left"), "rf": ("front", "right"),
           "rl": ("rear", "left"), "rr": ("rear", "right"), "vl": ("front", "left"), "vr": ("front", "right"),
           "hl": ("rear", "left"), "hr": ("rear", "right")}  # fmt: skip
PREFIX = {"hpl": "left", "hpr": "right", "hps": "single", "lhs": "left", "rhs": "right"}
SIDES = ("left", "right")
AXLES = ("front", "rear")

_PIECES = re.compile(r"[A-Z]+(?![a-zäöüß])|[A-Z]?[a-zäöüß]+|\d+")
_PAIRS = (
    (("ball", "joint"), "ball"), (("tie", "rod"), "tie"), (("track", "rod"), "tie"), (("toe", "link"), "tie"),
    (("toe", "control"), "tie"), (("steering", "rod"), "tie"), (("steering", "link"), "tie"), (("wheel", "base"),
    "wheelbase"), (("anti", "roll"), "bar"), (("bar", "bar"), "bar"), (("roll", "bar"), "bar"), (("drop", "link"),
    "droplink"), (("end", "link"), "droplink"), (("trailing", "arm"), "trailing"), (("track", "width"), "track"),
    (("center", "mass"), "cog"), (("center", "gravity"), "cog"), (("cog", "cog"), "cog"), (("bar", "link"), "droplink"),
    (("damper", "damper"), "damper"), (("twist", "beam"), "twistbeam"), (("torsion", "beam"), "twistbeam"),
    (("a", "arm"), "arm"), (("stub", "axle"), "knuckle"), (("shear", "center"), "beam"),
    (("without", "driver"), "empty"), (("with", "driver"), "occupied"), (("including", "driver"), "occupied"),
    (("incl", "driver"), "occupied"),
    (("half", "track"), "halftrack"),
)  # fmt: skip
"""Neighbours that are one word."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NameWords:
    """Words of a name.

    Attributes:
        text: name in the file.
        terms: plain words in order, without axle, side and noise; "front" and "rear" stay where they are a place.
        axle, side: "front" or "rear", "left", "right" or "single"; "" if the name has none.
    """

    text: str
    terms: tuple[str, ...]
    axle: str
    side: str

    def has(self, *terms: str) -> bool:
        """Return True if the name contains all terms."""
        return set(terms) <= set(self.terms)


def plain_words(piece: str) -> list[str]:
    """Return the plain words of a word in small letters, or of the parts of a compound."""
    if (adjective := ADJECTIVE.fullmatch(piece)) and piece not in PLAIN:
        piece = adjective[1]
    if piece in PLAIN:
        return PLAIN[piece].split()
    parts = _parts(piece) if len(piece) >= SHORTEST_COMPOUND else None
    return [piece] if parts is None else [word for part in parts for word in PLAIN.get(part, part).split()]


SHORTEST_COMPOUND = 7
"""Letters of the shortest word that is split: radlast."""


def _parts(word: str) -> list[str] | None:
    """Return the stems that make a word, with "s", "n" or "e" between them; None if something is left."""
    if not word:
        return []
    for stem in STEMS:
        if len(stem) > 2 and word.startswith(stem):
            tail = word[len(stem) :]
            for end in ("", "s", "n", "e", "en"):
                if tail.startswith(end) and (parts := _parts(tail[len(end) :])) is not None:
                    return [stem, *parts]
    return None


def words_of(text: str) -> list[str]:
    """Return the plain words of a name, in order."""
    plain = text.replace("CoG", "cog").replace("CoM", "com")
    for name, meaning in OPTIMUM.items():
        plain = re.sub(name, meaning, plain, flags=re.IGNORECASE)
    pieces = [piece.lower() for piece in _PIECES.findall(plain)]
    terms: list[str] = []
    for piece in pieces:
        terms += plain_words(piece)
    for pair, joined in _PAIRS:
        index = 0
        while index < len(terms) - 1:
            # "center of mass" has a word between.
            gap = 1 + (terms[index + 1] in ("of", "the") and index + 2 < len(terms))
            if (terms[index], terms[index + gap]) == pair:
                terms[index : index + gap + 1] = [joined]
            index += 1
    return terms


def name_words(text: str, *, right_letter: str, where: str = "") -> NameWords:
    """Split a name.

    Args:
        text: name in the file.
        right_letter: meaning of a single letter "r" in this file: "right", "rear" or "" for unknown.
        where: place in the file, for messages.

    Raises:
        DataError: the name has two places along the car, one of which may be its axle.
    """
    side = axle = ""
    terms: list[str] = []
    for word in words_of(text):
        if word in CORNERS:
            axle, side = CORNERS[word]
        elif word in PREFIX or word in SIDES:
            side = PREFIX.get(word, word)
        elif word == "l" and right_letter == "right":
            side = "left"
        elif word in ("f", "r"):
            terms.append({"f": "front", "r": right_letter or "r"}[word])
        elif word not in NOISE:
            terms.append(word)
    if "right" in terms:
        side = "right"
        terms.remove("right")
    ends = [index for index, word in enumerate(terms) if word in AXLES]
    # "front axle" names the axle at any place.
    for index in ends:
        if terms[index + 1 : index + 2] in (["axle"], ["suspension"]):
            axle = terms[index]
            terms[index : index + 2] = []
            break
    ends = [index for index, word in enumerate(terms) if word in AXLES]
    needs = "arm" in terms and not {"outer", "ball", "upper_ball"} & set(terms)
    if len(ends) > 1 and not axle:
        if ends[0] != 0 and len({terms[index] for index in ends}) > 1:
            raise DataError(f"{where}: {text!r} has two places, one of which is the axle; begin with the axle")
        axle = terms.pop(ends[0])
    elif len(ends) == 1 and not needs and not axle:
        axle = terms.pop(ends[0])
    return NameWords(text=text, terms=tuple(word for word in terms if word not in ("axle", "suspension_")), axle=axle,
                     side=side)  # fmt: skip


def right_letters(names: Sequence[str]) -> dict[str, str]:
    """Return by name what a single letter "r" in it means: "right" if the same name with "l" exists, "rear" with "f".

    A name that ends with a single "l" is one of the left side, so "right" too: WC_L, but not L_TRACK.
    """
    pieces = {name: tuple(piece.lower() for piece in _PIECES.findall(name)) for name in names}
    listed = set(pieces.values())

    def swapped(parts: tuple[str, ...], letter: str) -> tuple[str, ...]:
        return tuple(letter if part in ("l", "r") else part for part in parts)

    return {
        name: "right"
        if parts[-1:] == ("l",) or {swapped(parts, "l"), swapped(parts, "r")} <= listed
        else "rear"
        if swapped(parts, "f") in listed
        else ""
        for name, parts in pieces.items()
        if "r" in parts or "l" in parts
    }
