"""Tyre of a vehicle of Chrono: stiffness, damping and slip stiffnesses at its static load.

    TMeasy, TMsimple:  F(z) = d1 z + d2 z^2 for the deflection z;  slip stiffness by a parabola through 0, P_N and 2 P_N
    Fiala:             F(z) = k z, or lines through points;        slip stiffnesses CSLIP and CALPHA

A TMeasy tyre of a load index alone is estimated as by Chrono: the maximum load at 16 % of the height of the section,
half of it as nominal load, a damping ratio of 0.5 on the mass of the tyre, and slip stiffnesses in proportion.
Sources: ChTMeasyTire.cpp, ChTMsimpleTire.cpp, FialaTire.cpp of Chrono; load indices: ISO 4000-1.
"""

import math
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.studies.design.chrono_json import ChronoFile

LOAD_INDEX = (
    250, 257, 265, 272, 280, 290, 300, 307, 315, 325, 335, 345, 355, 365, 375, 387, 400, 412, 425, 437, 450, 462, 475,
    487, 500, 515, 530, 545, 560, 580, 600, 615, 630, 650, 670, 690, 710, 730, 750, 775, 800, 825, 850, 875, 900, 925,
    950, 975, 1000, 1030, 1060, 1090, 1120, 1150, 1180, 1215, 1250, 1285, 1320, 1360, 1400, 1450, 1500, 1550, 1600,
    1650, 1700, 1750, 1800, 1850, 1900,
)  # fmt: skip
"""Largest load of a tyre [kg] by its load index, from `FIRST_INDEX` on."""
FIRST_INDEX = 60

GRAVITY, SQUEEZED, DAMPING_RATIO = 9.81, 0.16, 0.5
"""Chrono's gravity [m/s2], deflection at the largest load as a share of the section height, and damping ratio."""

SLOPES = {
    ("TMeasyTire", "Passenger"): ((18.3741, 2 * 19.4669), (15.9826, 2 * 12.8509)),
    ("TMeasyTire", "Truck"): ((17.7764, 2 * 14.5301), (7.4013, 2 * 6.8505)),
    ("TMsimpleTire", "Passenger"): ((19.9774, 2 * 20.8424), (16.7895, 2 * 12.9866)),
}
"""Slopes of longitudinal and lateral force over slip, each at P_N and 2 P_N, divided by P_N [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ChronoTyre:
    """Tyre of a car of Chrono.

    Attributes:
        file: its file.
        mass: [kg].
        inertia: moments about x, y, z [kg m2].
        radius: unloaded [m].
        force: d1 [N/m] and d2 [N/m2], or points of deflection [m] and force [N], (n, 2).
        damping: vertical [N s/m].
        slip: functions of load by "slip_stiffness" [N] and "cornering_stiffness" [N/rad]: values at P_N and 2 P_N.
        nominal: P_N [N]; infinite for slopes that are the same at every load.
        estimated: how the numbers are estimated; empty if the file has them.
    """

    file: ChronoFile
    mass: float
    inertia: Vector
    radius: float
    force: Vector
    damping: float
    slip: dict[str, tuple[float, float]]
    nominal: float
    estimated: str

    def deflection(self, load: float) -> float:
        """Return the deflection under a static load [m]."""
        if self.force.ndim == 2:
            z, f = self.force.T
            if load > f[-1]:
                return float(z[-1] + (load - f[-1]) * (z[-1] - z[-2]) / (f[-1] - f[-2]))
            return float(np.interp(load, f, z))
        d1, d2 = self.force
        if (square := d1 * d1 + 4.0 * d2 * load) < 0.0:
            raise DataError(
                f"{self.file.path}: d1 z + d2 z^2 through its vertical curve reaches {-0.25 * d1 * d1 / d2:.0f} N, "
                f"must carry {load:.0f} N; mend the curve, or name another tyre with --chrono-tyre FILE.json"
            )
        return float(2.0 * load / (d1 + math.sqrt(square)))

    def stiffness(self, load: float) -> float:
        """Return dF/dz at a static load [N/m]."""
        z = self.deflection(load)
        if self.force.ndim == 2:
            slopes = np.diff(self.force[:, 1]) / np.diff(self.force[:, 0])
            return float(slopes[min(int(np.searchsorted(self.force[1:, 0], z)), slopes.size - 1)])
        return float(self.force[0] + 2.0 * self.force[1] * z)

    def slip_stiffness(self, name: str, load: float) -> float:
        """Return the slope of a horizontal force over slip at a static load [N or N/rad].

        Quadratic in the load, with the slopes of `slip` at the nominal load and at twice that load, as in TMeasy.
        """
        low, high = self.slip[name]
        if math.isinf(self.nominal):
            return low
        q = load / self.nominal
        return q * (2.0 * low - 0.5 * high - (low - 0.5 * high) * q)


def chrono_tyre(file: ChronoFile) -> ChronoTyre:
    """Return the tyre of a JSON file.

    Raises:
        DataError: a tyre without a vertical stiffness, or a wrong or missing value.
    """
    template = file.text("Template")
    if template == "FialaTire":
        return _fiala(file)
    if template in ("TMeasyTire", "TMsimpleTire"):
        return _tmeasy(file, template)
    raise DataError(f"{file.path}: found a tyre of type {template!r}, must be TMeasyTire, TMsimpleTire or FialaTire; "
        "name the file of another tyre with --chrono-tyre FILE.json")  # fmt: skip


def _fiala(file: ChronoFile) -> ChronoTyre:
    numbers = file.section("Fiala Parameters")
    force = np.array([numbers.number("Vertical Stiffness"), 0.0])
    if "Vertical Curve Data" in numbers:
        force = numbers.curve("Vertical Curve Data")
        if np.any(np.diff(force[:, 1]) <= 0.0):
            raise DataError(f"{file.path}: Fiala Parameters / Vertical Curve Data: the forces must rise")
    slip, cornering = numbers.number("CSLIP"), numbers.number("CALPHA")
    return ChronoTyre(
        file=file,
        mass=file.number("Mass"),
        inertia=file.array("Inertia", 3),
        radius=numbers.number("Unloaded Radius"),
        force=force,
        damping=numbers.number("Vertical Damping"),
        slip={"slip_stiffness": (slip, slip), "cornering_stiffness": (cornering, cornering)},
        nominal=math.inf,
        estimated="",
    )


def _tmeasy(file: ChronoFile, template: str) -> ChronoTyre:
    design = file.section("Design")
    radius, mass = design.number("Unloaded Radius [m]"), design.number("Mass [kg]")
    estimated = ""
    if "Parameters" in file:
        parameters = file.section("Parameters")
        vertical = parameters.section("Vertical")
        nominal, damping = (
            vertical.number("Nominal Vertical Force [N]"),
            vertical.number("Tire Vertical Damping [Ns/m]"),
        )
        if "Vertical Tire Stiffness [N/m]" in vertical:
            force = np.array([vertical.number("Vertical Tire Stiffness [N/m]"), 0.0])
        else:
            z, f = vertical.curve("Tire Spring Curve Data").T
            force = np.linalg.lstsq(np.column_stack([z, z * z]), f, rcond=None)[0]
        slip = {
            name: tuple(parameters.section(way).array(f"Initial Slopes dF{axis}/ds{axis} [N]", 2).tolist())
            for name, way, axis in (
                ("slip_stiffness", "Longitudinal", "x"),
                ("cornering_stiffness", "Lateral", "y"),
            )
        }
    else:
        vehicle_type = file.text("Vehicle Type")
        if (template, vehicle_type) not in SLOPES:
            raise DataError(f"{file.path}: the {template} of a {vehicle_type!r} has no Parameters; add them, or name "
                "the file of another tyre with --chrono-tyre FILE.json")  # fmt: skip
        largest = _largest_load(file)
        height = radius - design.number("Rim Radius [m]")
        pressure = 1.0
        if "Inflation Pressure Use [Pa]" in file and "Inflation Pressure Design [Pa]" in file:
            pressure = file.number("Inflation Pressure Use [Pa]") / file.number("Inflation Pressure Design [Pa]")
        nominal = 0.5 * largest * pressure**0.8
        force = np.array([largest / (SQUEEZED * height), 0.0])
        damping = 2.0 * DAMPING_RATIO * math.sqrt(force[0] * mass)
        slopes = SLOPES[template, vehicle_type]
        slip = {
            name: (low * nominal, high * nominal)
            for name, (low, high) in zip(("slip_stiffness", "cornering_stiffness"), slopes, strict=True)
        }
        estimated = f"estimated as by Chrono from a largest load of {largest:.0f} N"
    return ChronoTyre(
        file=file,
        mass=mass,
        inertia=design.array("Inertia [kg.m2]", 3),
        radius=radius,
        force=force,
        damping=damping,
        slip=slip,
        nominal=nominal,
        estimated=estimated,
    )


def _largest_load(file: ChronoFile) -> float:
    """Return the largest load of a tyre by its load index, or its bearing capacity [N]."""
    if "Load Index" not in file:
        return file.number("Maximum Bearing Capacity [N]")
    index = int(file.number("Load Index")) - FIRST_INDEX
    if not 0 <= index < len(LOAD_INDEX):
        raise DataError(f"{file.path}: Load Index {index + FIRST_INDEX}, must be {FIRST_INDEX} to "
                        f"{FIRST_INDEX + len(LOAD_INDEX) - 1}")  # fmt: skip
    return LOAD_INDEX[index] * GRAVITY
