"""Axes of the points of a table: stated in words, or seen from the points themselves; left-handed axes are refused.

The vehicle frame has x to the rear, y to the right, z up; a table has any of the frames in use:

    ISO 8855   x forward, y left, z up          SAE J670   x forward, y right, z down
    Adams Car  x rearward, y right, z up
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle.errors import DataError

FRAMES = {"iso": ("forward", "left", "up"), "sae": ("forward", "right", "down"), "adams": ("rearward", "right", "up")}
"""Directions of x, y, z by a word for the frame."""

SIGNS = {"rearward": 1.0, "forward": -1.0, "right": 1.0, "left": -1.0, "up": 1.0, "down": -1.0}
"""Sign of a direction in the vehicle frame."""

_WORDS = {
    "x": {"forward": "forward front forwards ahead vorn vorne", "rearward": "rear rearward rearwards back backward "
          "backwards aft hinten"},
    "y": {"left": "left links", "right": "right rechts"},
    "z": {"up": "up upward upwards oben", "down": "down downward downwards unten"},
}  # fmt: skip

FRAME_NUMBERS = (None, "8855", "70000", "4130", "j670", "j670e")
"""Numbers of standards that define axes; None: none stated."""

_OF_AXES = re.compile(r"\b(axes|axis|frame|coordinates?|system|convention|achsen|koordinatensystem)\b|^.{0,12}$")
"""A remark on axes; or only the name of the frame."""

Vector3 = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Axes:
    """Directions of x, y and z in a table, and how each is known."""

    x: str
    y: str
    z: str
    origin: str

    @property
    def text(self) -> str:
        """Return the directions for people."""
        return f"x {self.x}, y {self.y}, z {self.z}"


def stated_axes(remarks: Sequence[str], file: str) -> dict[str, str]:
    """Return the stated directions by axis: "ISO 8855", "axes: SAE", "x forward, y to the left, z up".

    Raises:
        DataError: two remarks contradict each other.
    """
    content: dict[str, str] = {}

    def enter(axis: str, direction: str) -> None:
        if content.setdefault(axis, direction) != direction:
            raise DataError(f"{file}: states {axis} {content[axis]} and {axis} {direction}; correct one of both")

    for remark in remarks:
        text = remark.lower()
        for axis, directions_of in _WORDS.items():
            for match in re.finditer(rf"(?<![a-z])\+?{axis}\+?(?:[- ]axis)?(?: is| points|:|=|,)?(?: positive)?"
                                     rf"(?: to(?:wards)?| nach)?(?: the)?[ ,]+(?:driver's )?([a-zäöü]+)",
                                     text):  # fmt: skip
                for direction, terms in directions_of.items():
                    if match[1] in terms.split():
                        enter(axis, direction)
    for remark in () if content else remarks:
        # "SAE 2007-01-0818" is a paper.
        for match in re.finditer(r"\b(iso|sae|adams)\b(?:/car)?[ -]*(?P<number>[j\d][\d-]*)?", remark.lower()):
            if match["number"] in FRAME_NUMBERS and (match["number"] or _OF_AXES.search(remark.lower())):
                for axis, direction in zip("xyz", FRAMES[match[1]], strict=True):
                    enter(axis, direction)
    return content


def seen_axes(axles: Mapping[str, Mapping[str, Vector3]], sides: Mapping[str, str], file: str) -> dict[str, str]:
    """Return the directions that the points themselves show.

    x from the wheel centres of both axles or from the two body points of an arm, z from points above each other, y
    from points of a stated side.

    Args:
        axles: points by axle and name, in the axes of the table.
        sides: side of the points of each axle, "" if not stated.

    Raises:
        DataError: the points contradict each other.
    """
    votes: dict[str, dict[str, str]] = {"x": {}, "y": {}, "z": {}}
    centers = [axles[axle]["wheel_center"][0] for axle in ("front", "rear") if "wheel_center" in axles.get(axle, {})]
    if len(centers) == 2 and abs(centers[1] - centers[0]) > SEPARATE:
        votes["x"]["rearward" if centers[1] > centers[0] else "forward"] = "the wheel centres of both axles"
    for axle, points in axles.items():
        for level in ("lower_arm", "upper_arm"):
            pair = [points.get(f"{level}_{end}") for end in ("front", "rear")]
            if pair[0] is not None and pair[1] is not None and pair[0][0] != pair[1][0]:
                word = "rearward" if pair[1][0] > pair[0][0] else "forward"
                votes["x"].setdefault(word, f"the {level.replace('_', ' ')} points of the {axle} axle")
        for above, below in ABOVE:
            if above in points and below in points and abs(points[above][2] - points[below][2]) > 0.05:
                word = "up" if points[above][2] > points[below][2] else "down"
                votes["z"].setdefault(word, f"{above} and {below} of the {axle} axle")
        outer = max((point[1] for point in points.values()), key=abs, default=0.0)
        if sides.get(axle) in ("left", "right") and outer:
            positive = sides[axle] if outer > 0.0 else {"left": "right", "right": "left"}[sides[axle]]
            votes["y"].setdefault(positive, f"the points of the {sides[axle]} side of the {axle} axle")
    for axis, terms in votes.items():
        if len(terms) > 1:
            both = " but ".join(f"{why} show {axis} {word}" for word, why in terms.items())
            raise DataError(f"{file}: {both}; correct the names or the coordinates of these points")
    return {axis: word for axis, terms in votes.items() for word in terms}


SEPARATE = 0.5
"""Least distance of the wheel centres of two axles in one frame [m]; nearer: each axle has a separate origin."""

ABOVE = (
    ("strut_top", "lower_ball"),
    ("strut_top", "strut_bottom"),
    ("upper_ball", "lower_ball"),
    ("spring_upper", "spring_lower"),
    ("wheel_center", "tyre_patch"),
    ("strut_top", "wheel_center"),
)
"""Pairs of points, the upper first."""


def axes_of(stated: Mapping[str, str], seen: Mapping[str, str], file: str) -> Axes:
    """Return the axes of a table; y completes a right-handed frame where it is not known.

    Raises:
        DataError: x or z is not known, words and points contradict each other, or the axes are left-handed.
    """
    for axis in "xyz":
        if axis in stated and axis in seen and stated[axis] != seen[axis]:
            raise DataError(f"{file}: states {axis} {stated[axis]}, but its points show {axis} {seen[axis]}; correct "
                            "the remark or the points")  # fmt: skip
    content = {**seen, **stated}
    for axis, terms in (("x", "x forward or x rearward"), ("z", "z up or z down")):
        if axis not in content:
            raise DataError(f"{file}: states no direction of {axis}; add a row such as \"axes: x forward, y "
                            f"left, z up\" ({terms})")  # fmt: skip
    right_handed = "right" if SIGNS[content["x"]] * SIGNS[content["z"]] > 0.0 else "left"
    if content.get("y", right_handed) != right_handed:
        raise DataError(
            f"{file}: axes x {content['x']}, y {content['y']}, z {content['z']} are left-handed; turn the sign of one "
            "coordinate, or correct the names of the sides"
        )
    listed = {"stated": [axis for axis in "xyz" if axis in stated], "seen": [axis for axis in "xyz" if axis in content]}
    origin = "stated" if len(listed["stated"]) >= 2 else "seen from the points"
    return Axes(x=content["x"], y=right_handed, z=content["z"], origin=origin)
