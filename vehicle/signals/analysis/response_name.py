"""Name of an FRF, its output and its input, and the row of another set of FRFs with the same name."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle.errors import DataError
from vehicle.names import in_order

PLATE = "plate_"
"""Beginning of the name of the plate of a wheel, as "plate_fr"."""

NAMED = re.compile(r"(?P<output>.+?) ?/ ?(?P<input>plate_\w+(\+plate_\w+)*)")
"""Name of an FRF in a file: "knuckle_fr_acc_z/plate_fr", or "knuckle_fr_acc_z / plate_fr+plate_fl"."""


@dataclass(frozen=True, slots=True)
class ResponseName:
    """Name of an FRF: its output and its input.

    Plates that are driven by one signal are one input: the plate p moves by a_p times the first, a_first = 1, and the
    FRF H is that to the displacement of the first plate.

    Attributes:
        output: channel of the output, as "knuckle_fr_acc_z".
        motion: plates of the input in the order of files, each with its factor a_p [-], NaN if unknown; empty for an
            unknown input.
    """

    output: str
    motion: tuple[tuple[str, float], ...] = ()

    @property
    def input(self) -> str:
        """Return the name of the input, as "plate_fr" or "plate_fr+plate_fl"; empty if unknown."""
        return "+".join(plate for plate, _ in self.motion)

    def __str__(self) -> str:
        """Return output and input, as "knuckle_fr_acc_z/plate_fr"; the output alone if the input is unknown."""
        return f"{self.output}/{self.input}" if self.motion else self.output


def plates_of(motion: Mapping[str, float]) -> tuple[tuple[str, float], ...]:
    """Return the motion of a `ResponseName` from wheel to the factor of its plate; 1 for the first."""
    return tuple((PLATE + wheel, float(factor)) for wheel, factor in motion.items())


def parsed_name(text: str) -> ResponseName:
    """Return the name of an FRF from "<output>/<plate>"; the factors of plates that move together are unknown.

    Args:
        text: name in a file or an option; without a plate the input is unknown.
    """
    match = NAMED.fullmatch(text)
    if match is None:
        return ResponseName(text)
    wheels = in_order(plate.removeprefix(PLATE) for plate in match["input"].split("+"))
    return ResponseName(match["output"], plates_of({wheel: math.nan if n else 1.0 for n, wheel in enumerate(wheels)}))


def row_of(name: ResponseName, names: Sequence[ResponseName]) -> tuple[int, float] | None:
    """Return the row of the same FRF in another set, and the factor of its values; None if it has none.

    The FRF of an input to its plate p is H / a_p. The FRF of one plate also matches an input that moves further
    plates with it. An unknown input is the only one of the set.
    """
    rows = [row for row, other in enumerate(names) if other.output == name.output]
    if not rows:
        return None
    if not name.motion or not any(names[row].motion for row in rows):
        inputs = list(dict.fromkeys(names[row].input for row in rows))
        if len(rows) > 1:
            raise DataError(
                f"{name.output}: which of the {len(inputs)} plates ({', '.join(inputs)}) moves? Name it, for example "
                f"--map {name.output}/{inputs[0]}=NAME"
            )
        return rows[0], 1.0
    first = name.motion[0][0]
    for row in rows:
        factors = dict(names[row].motion)
        if all(plate in factors for plate, _ in name.motion) and math.isfinite(factors[first]):
            return row, 1.0 / factors[first]
    return None
