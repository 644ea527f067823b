"""Candidates of what Bommer 2006 leaves open: sides, inertia, damping and brackets of the body; edges, noise, velocity.

A mirror image of the whole rig gives the same numbers. So the seat keeps its side (y < 0), and the plate, the
hydromount, the roof point and the sign of the products of inertia take either: 2^4 rigs, no two of them alike.
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from scenarios.evidence import SLIP_STEP
from vehicle.model.parameters.shipped import vehicle_file as shipped_file
from vehicle.runs.output.folder import write_text

PLATES = {"+y": "fr", "-y": "fl"}
"""Side of the plate to its wheel: +y is the driver's right."""

IXX = (1000.0, 1080.0, 1200.0)
"""Ixx about the origin [kg m2]: printed (and repaired), value for a roll mode of 5.8 Hz, and value of section 3.4."""

DAMPING = (0.02, 0.03, 0.04)
"""Damping ratio of the body's modes."""

BRACKETS = {"as designed": 1.0, "half as stiff": 0.5, "twice as stiff": 2.0}
"""Factor on the stiffnesses of attachment that the body design assumes; what it fitted to modes stays."""

SLIP_VELOCITIES = tuple(1e-3 * v for v in (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13.5, 15))
"""Velocity that counts as slip [m/s]."""

SLIP_STEPS = (1.0, 1.0 - SLIP_STEP, 1.0 + SLIP_STEP)
"""Factors on the slip velocity at which the shares are read: the share, and both ends of its error."""

SHAKER_EDGES = (2.0, 2.5, 3.0, 4.0, 6.0)
"""Lower edge of the shaker inputs, and of the noise before and after the bump [Hz], half power."""

ROAD_EDGES = (0.015, 0.017, 0.019, 0.022, 0.029)
"""Lower edge of the roads [Hz]."""

NOISE_LEVELS = {"0.05 mm with both bumps": 1.0, "in proportion to the bump": 0.2}
"""Level of the noise with the 1.5 mm bump, over that with the 7.5 mm bump."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Rig:
    """Sides of unprinted positions, and parameters of the body."""

    plate: str = "+y"  # plate, hydromount, roof: side, "+y" or "-y"; the seat is at -y
    hydromount: str = "+y"
    roof: str = "-y"
    products: int = 1  # sign of Ixy and Iyz
    ixx: float = 1000.0  # moment of inertia about the origin [kg m2]
    damping: float = 0.03  # damping ratio of the body modes [-]
    brackets: str = "as designed"  # a key of `BRACKETS`

    def sides(self) -> str:
        """Return the sides as a text."""
        sign = "+" if self.products > 0 else "-"
        return f"plate {self.plate}, hydromount {self.hydromount}, roof point {self.roof}, Ixy {sign}"

    def body(self) -> str:
        """Return the parameters of the body as a text."""
        return f"Ixx {self.ixx:g}, damping {100 * self.damping:g} %, brackets {self.brackets}"

    def overrides(self) -> tuple[str, ...]:
        """Return the overrides of the car of `vehicle_file`."""
        return (
            f"body.inertia.ixx={self.ixx!r}",
            f"body.inertia.ixy={self.products * 82.03!r}",
            f"body.inertia.iyz={-self.products * 50.04!r}",
            *(f"body.modes.{number}.damping_ratio={self.damping!r}" for number in range(1, 10)),
        )


TODAY = Rig()
"""Rig and values shipped before the choice."""


def all_sides(rig: Rig) -> Iterator[Rig]:
    """Return the 16 rigs of all sides with the body of a rig."""
    for plate, mount, roof, products in itertools.product(("+y", "-y"), ("+y", "-y"), ("-y", "+y"), (1, -1)):
        yield replace(rig, plate=plate, hydromount=mount, roof=roof, products=products)


SWAPPED = {"fr": "fl", "fl": "fr", "right": "left", "left": "right"}


def vehicle_file(folder: Path, hydromount: str, brackets: str) -> Path:
    """Write the car with its mounts on given sides, and both points of the roof as outputs; returns its file."""
    name = f"mount_{'right' if hydromount == '+y' else 'left'}_{BRACKETS[brackets]:g}"
    path, sign = folder / f"{name}.toml", 1.0 if hydromount == "+y" else -1.0
    text = (shipped_file("focus").parent / "body_design.toml").read_text(encoding="utf-8")
    write_text(folder / f"{name}_body.toml", _with_brackets(_with_mounts(text, hydromount), BRACKETS[brackets]))
    write_text(
        path,
        f'name = "{name}"\nbase = "focus"\n\n'
        f"[hardpoints]\nroof_right_rear = [3.9, 0.5, 1.85]\n\n"
        f"[engine.hardpoints]\nhydromount = [0.8, {0.44 * sign!r}, 1.1]\n"
        f"linear_mount = [0.8, {-0.42 * sign!r}, 1.02]\n\n"
        f'[outputs]\nroof_right_rear = {{ on = "body", at = "roof_right_rear" }}\n\n'
        f'[body]\nsuperelement = "{name}_body.toml"\n',
    )
    return path


def _with_mounts(text: str, hydromount: str) -> str:
    """Return a body design whose members connect the mounts to their side."""
    if hydromount == "+y":
        return text
    lines = []
    for line in text.split("\n"):
        parts = line.strip().strip('",').split("-", 1)
        if parts[0] in ("hydromount", "linear_mount") and len(parts) == 2 and line.startswith('  "'):
            stem, side = parts[1].rsplit("_", 1)
            line = line.replace(parts[1], f"{stem}_{SWAPPED[side]}")
        lines.append(line)
    return "\n".join(lines)


def _with_brackets(text: str, factor: float) -> str:
    """Return a body design with other assumed stiffnesses of attachment."""
    lines = []
    for line in text.split("\n"):
        if line.startswith("attachment = [") and "fitted" not in line:
            values, remainder = line[len("attachment = [") :].split("]", 1)
            line = (
                f"attachment = [{', '.join(repr(factor * float(number)) for number in values.split(','))}]{remainder}"
            )
        lines.append(line)
    return "\n".join(lines)
