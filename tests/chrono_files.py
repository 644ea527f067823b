"""Two vehicles in the JSON format of Project Chrono, made for the tests: wishbones, and struts in front."""

import copy
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

WHEEL: dict[str, Any] = {"Name": "Wheel", "Type": "Wheel", "Template": "Wheel", "Mass": 9.0, "Inertia": [0.3, 0.5, 0.3]}

CHASSIS: dict[str, Any] = {
    "Name": "Chassis", "Type": "Chassis", "Template": "RigidChassis",
    "Components": [
        {
            "Centroidal Frame": {"Location": [-1.2, 0.01, 0.3], "Orientation": [1, 0, 0, 0]},
            "Mass": 900.0, "Moments of Inertia": [300.0, 1100.0, 1250.0], "Products of Inertia": [5.0, -12.0, 3.0],
            "Void": False,
        },
        {
            # Turned by 90 degrees about z.
            "Centroidal Frame": {"Location": [0.1, -0.02, 0.2], "Orientation": [0.70710678118654752, 0, 0,
                                                                               0.70710678118654752]},
            "Mass": 180.0, "Moments of Inertia": [9.0, 6.0, 8.0], "Products of Inertia": [0, 0, 0], "Void": False,
        },
    ],
    "Driver Position": {"Location": [-1.1, 0.38, 0.9], "Orientation": [1, 0, 0, 0]},
}  # fmt: skip

TMEASY: dict[str, Any] = {
    "Name": "Tyre", "Type": "Tire", "Template": "TMeasyTire",
    "Design": {"Unloaded Radius [m]": 0.31, "Mass [kg]": 9.0, "Inertia [kg.m2]": [0.4, 0.75, 0.4], "Width [m]": 0.19,
               "Rim Radius [m]": 0.19},
    "Coefficient of Friction": 0.8, "Rolling Resistance Coefficient": 0.015, "Vehicle Type": "Passenger",
    "Load Index": 91,
}  # fmt: skip

FIALA: dict[str, Any] = {
    "Name": "Tyre", "Type": "Tire", "Template": "FialaTire", "Mass": 9.0, "Inertia": [0.4, 0.75, 0.4],
    "Coefficient of Friction": 0.8,
    "Fiala Parameters": {
        "Unloaded Radius": 0.31, "Width": 0.19, "Vertical Damping": 400.0, "Vertical Stiffness": 200000.0,
        "Vertical Curve Data": [[0.0, 0.0], [0.01, 1800.0], [0.02, 3900.0], [0.03, 6300.0]],
        "Rolling Resistance": 0.015, "CSLIP": 80000.0, "CALPHA": 45000.0, "UMIN": 0.6, "UMAX": 0.9,
        "X Relaxation Length": 0.3, "Y Relaxation Length": 0.3,
    },
}  # fmt: skip

SPINDLE: dict[str, Any] = {
    "Mass": 6.0,
    "COM": [0.01, 0.74, 0.02],
    "Inertia": [0.02, 0.035, 0.021],
    "Radius": 0.1,
    "Width": 0.05,
}

WISHBONE: dict[str, Any] = {
    "Name": "Wishbones", "Type": "Suspension", "Template": "DoubleWishbone",
    "Camber Angle (deg)": 0, "Toe Angle (deg)": 0,
    "Spindle": SPINDLE,
    "Upright": {"Mass": 11.0, "COM": [0.0, 0.69, 0.03], "Moments of Inertia": [0.09, 0.1, 0.04],
                "Products of Inertia": [0.002, -0.003, 0.001], "Radius": 0.03},
    "Upper Control Arm": {
        "Mass": 2.0, "COM": [-0.03, 0.56, 0.25], "Moments of Inertia": [0.02, 0.012, 0.03],
        "Products of Inertia": [0, 0, 0], "Radius": 0.02, "Location Chassis Front": [0.11, 0.46, 0.27],
        "Location Chassis Back": [-0.14, 0.47, 0.24], "Location Upright": [-0.02, 0.66, 0.26],
    },
    "Lower Control Arm": {
        "Mass": 4.0, "COM": [0.0, 0.54, -0.11], "Moments of Inertia": [0.05, 0.04, 0.085],
        "Products of Inertia": [0.001, 0, 0], "Radius": 0.02, "Location Chassis Front": [0.17, 0.36, -0.09],
        "Location Chassis Back": [-0.19, 0.37, -0.1], "Location Upright": [0.02, 0.7, -0.13],
    },
    "Tierod": {"Location Chassis": [-0.13, 0.38, 0.0], "Location Upright": [-0.12, 0.68, -0.02]},
    "Spring": {"Location Chassis": [0.01, 0.49, 0.36], "Location Arm": [0.02, 0.57, -0.09], "Free Length": 0.55,
               "Spring Coefficient": 48000.0},
    "Shock": {"Location Chassis": [-0.03, 0.5, 0.37], "Location Arm": [-0.02, 0.58, -0.09],
              "Damping Coefficient": 3500.0},
    "Axle": {"Inertia": 0.4},
}  # fmt: skip

STRUT: dict[str, Any] = {
    "Name": "Strut", "Type": "Suspension", "Template": "MacPhersonStrut",
    "Spindle": SPINDLE,
    "Upright": {"Mass": 12.0, "COM": [0.0, 0.68, 0.04], "Inertia": [0.09, 0.1, 0.04], "Radius": 0.03},
    "Control Arm": {
        "Mass": 3.5, "COM": [-0.02, 0.52, -0.1], "Inertia": [0.03, 0.05, 0.06], "Radius": 0.02,
        "Location Chassis Front": [0.05, 0.36, -0.07], "Location Chassis Back": [-0.28, 0.38, -0.08],
        "Location Upright": [0.02, 0.69, -0.12],
    },
    "Strut": {"Mass": 4.0, "Inertia": [0.04, 0.04, 0.006], "Radius": 0.02},
    "Tierod": {"Location Chassis": [-0.15, 0.36, -0.01], "Location Upright": [-0.13, 0.66, -0.03]},
    "Spring": {
        "Location Chassis": [-0.05, 0.55, 0.53], "Location Upright": [0.0, 0.62, 0.1], "Free Length": 0.5,
        "Spring Curve Data": [[-0.25, -9000], [-0.15, -4200], [-0.08, -2000], [0.0, 0.0], [0.1, 2500]],
        "Minimum Length": 0.2, "Maximum Length": 0.5,
    },
    "Shock": {
        "Location Chassis": [-0.05, 0.55, 0.53], "Location Upright": [0.0, 0.62, 0.1],
        "Damping Coefficient": 4000.0, "Degressivity Compression": 2.0, "Degressivity Expansion": 0.5,
    },
    "Axle": {"Inertia": 0.4},
}  # fmt: skip


def vehicle_of(front: str, rear: str) -> dict[str, Any]:
    """Return a vehicle file whose axles are the named suspension files."""
    axles = [
        {"Suspension Input File": f"small/{name}.json", "Suspension Location": location,
         "Left Wheel Input File": "small/wheel.json", "Right Wheel Input File": "small/wheel.json",
         "Left Brake Input File": "small/brake.json", "Right Brake Input File": "small/brake.json", **more}
        for name, location, more in ((front, [0.02, 0, 0.03], {"Steering Index": 0}), (rear, [-2.53, 0, 0.05], {}))
    ]  # fmt: skip
    return {
        "Name": "Small car", "Type": "Vehicle", "Template": "WheeledVehicle",
        "Chassis": {"Input File": "small/chassis.json"},
        "Axles": axles,
        "Steering Subsystems": [{"Input File": "small/rack.json", "Location": [0, 0, 0], "Orientation": [1, 0, 0, 0]}],
        "Wheelbase": 2.55,
        "Driveline": {"Input File": "small/driveline.json", "Suspension Indexes": [0]},
    }  # fmt: skip


FILES: dict[str, dict[str, Any]] = {
    "wheel": WHEEL,
    "chassis": CHASSIS,
    "tmeasy": TMEASY,
    "fiala": FIALA,
    "wishbones": WISHBONE,
    "strut": STRUT,
    "wishbone_car": vehicle_of("wishbones", "wishbones"),
    "strut_car": vehicle_of("strut", "wishbones"),
    "strut_model": {
        "Name": "Small car", "Vehicle": {"Input File": "small/strut_car.json"},
        "Tire": {"Input File": "small/tmeasy.json"},
    },
}  # fmt: skip


def write_chrono(folder: Path, changes: Mapping[str, Any] | None = None) -> Path:
    """Write the files below `folder`/vehicle/small, as in Chrono's data; return that folder.

    Args:
        folder: folder to write into.
        changes: new values by "file/name/name"; None removes a value.
    """
    files = copy.deepcopy(FILES)
    for path, value in (changes or {}).items():
        name, *names, last = path.split("/")
        table: Any = files[name]
        for key in names:
            table = table[int(key) if isinstance(table, list) else key]
        if value is None:
            del table[last]
        else:
            table[last] = value
    target = folder / "vehicle" / "small"
    target.mkdir(parents=True)
    for name, table in files.items():
        text = "// A comment, as Chrono allows it.\n" + json.dumps(table, indent=2)
        (target / f"{name}.json").write_text(text, encoding="utf-8")
    return target
