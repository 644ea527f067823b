"""Property files of a small car, in the format of Adams Car: a damper, a spring, a bushing and two stops."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle.model.parameters.shipped import vehicle_file

UNITS = {"LENGTH": "mm", "ANGLE": "degrees", "FORCE": "newton", "MASS": "kg", "TIME": "second"}

Rows = Sequence[tuple[float, float]]

DAMPER: Rows = [(-1000, -1300), (-300, -700), (-100, -400), (-50, -250), (0, 0), (50, 400), (100, 600), (300, 1000),
                (1000, 2100)]  # fmt: skip
SPRING: Rows = [(-100, -3000), (0, 0), (100, 3000), (150, 4500), (200, 8000)]
"""Positive in compression: 30 N/mm, and 70 N/mm beyond 150 mm."""
BUMP: Rows = [(0, 0), (10, 500), (20, 2000), (30, 6000)]
REBOUND: Rows = [(0, 0), (10, 3000)]
CURVES: Mapping[str, Rows] = {
    "FX": [(-2, -4000), (-1, -1000), (0, 0), (1, 1000), (2, 4000)],
    "FY": [(-2, -1600), (0, 0), (2, 1600)],
    "FZ": [(-2, -1000), (0, 0), (2, 1000)],
    "TX": [(-20, -20000), (0, 0), (20, 20000)],
    "TY": [(-20, -20000), (0, 0), (20, 20000)],
    "TZ": [(-20, -20000), (0, 0), (20, 20000)],
}


def property_file(
    kind: str, blocks: Mapping[str, Rows], extra: str = "", units: Mapping[str, str] | None = None
) -> str:
    """Return the text of a property file.

    Args:
        kind: type, as "dpr".
        blocks: rows by the name of their block.
        extra: further lines behind the units.
        units: lines of the block of units.
    """
    lines = ["$-------------------------------MDI_HEADER", "[MDI_HEADER]", f" FILE_TYPE     =  '{kind}'",
             " FILE_VERSION  =  4.0", " FILE_FORMAT   =  'ASCII'", "(COMMENTS)", "{comment_string}",
             "'made for a test'", "$-------------------------------UNITS", "[UNITS]"]  # fmt: skip
    lines += [f" {name}  =  '{unit}'" for name, unit in (UNITS if units is None else units).items()]
    lines += [extra] if extra else []
    for name, rows in blocks.items():
        lines += [f"$-------------------------------{name}", f"[{name}]", "{ x   force}"]
        lines += [f"{x!r}   {force!r}" for x, force in rows]
    return "\n".join(lines) + "\n"


DAMPING = "[DAMPING]\n FX_DAMPING = 0.4\n FY_DAMPING = 0.3\n FZ_DAMPING = 0.2"
FILES = {
    "front.dpr": property_file("dpr", {"CURVE": DAMPER}),
    "front.spr": property_file("spr", {"CURVE": SPRING}, "[SPRING_DATA]\n FREE_LENGTH = 300.0"),
    "arm.bus": property_file("bus", {f"{name}_CURVE": rows for name, rows in CURVES.items()}, DAMPING),
    "front.bum": property_file("bum", {"CURVE": BUMP}),
    "front.reb": property_file("reb", {"CURVE": REBOUND}),
}

FRONT_TABLES = {
    "main_spring": '[front.main_spring]\ncurve = "front.spr"',
    "damper": '[front.damper]\nviscous_law = "table"\ncurve = "front.dpr"\nfriction_law = "coulomb"\n'
    "coulomb_friction = 80.0\nsmoothing = 1.0e5\nslip_velocity = 0.006\n"
    '[front.damper.stop]\nbump = { curve = "front.bum", clearance = 0.05 }\n'
    'rebound = { curve = "front.reb", clearance = 0.06 }',
    "bushings.arm_front": '[front.bushings.arm_front]\ncurve = "arm.bus"',
}


def write_car(folder: Path, tables: Mapping[str, str] = FRONT_TABLES, files: Mapping[str, str] = FILES) -> Path:
    """Write the sedan with tables that name property files into a folder; return its vehicle file."""
    text = vehicle_file("sedan").read_text(encoding="utf-8")
    for name, table in tables.items():
        head = f"[front.{name}]"
        before, _, rest = text.partition(f"{head}\n")
        assert rest, head
        text = f"{before}{table}\n\n[{rest.partition(chr(10) + '[')[2]}"
    for name, content in files.items():
        (folder / name).write_text(content, encoding="latin-1")
    (folder / "vehicle.toml").write_text(text, encoding="utf-8")
    return folder / "vehicle.toml"
