"""Stiffnesses, damping and radius of a tyre from a `.tir` file: MF-Tyre 5.2, PAC2002 and MF-Tyre 6.x, small slip.

    df = (F - F0) / F0                                 F0 = LFZO FNOMIN
    C_kappa = F (PKX1 + PKX2 df) exp(PKX3 df) (1 + PPX1 dp + PPX2 dp^2) LKX
    C_alpha = |PKY1| F0 (1 + PPY1 dp) sin(c atan(F / (F0 PKY2 (1 + PPY2 dp)))) LKY      c = 2; PKY4 in 6.x
    trail   = F (QDZ1 + QDZ2 df) (1 - PPZ1 dp) R0 / F0 LTR
    sigma_kappa = FNOMIN PTX1 R0 / F0 LSGKP,   sigma_alpha = PTY1 sin(2 atan(1 / PTY2)) R0 LSGAL   at FNOMIN

with dp = (INFLPRES - NOMPRES) / NOMPRES, without camber. The carcass is C / sigma at FNOMIN in 5.2 and PAC2002, and
LONGITUDINAL_STIFFNESS, LATERAL_STIFFNESS in 6.x.

Sources: Pacejka, Tyre and Vehicle Dynamics, 2nd ed. 2006, equations 4.E15, 4.E25, 4.E43 and section 9.3 (5.2), 3rd ed.
2012, the same equations (6.1, inflation pressure after Besselink, Schmeitz and Pacejka 2010).
"""

import itertools
import math
from dataclasses import dataclass, field
from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.formats.teim_orbit import PropertyFile, read_property_file

NEWER = ("60", "61", "62")
READ = {"5": "MF-Tyre 5", "51": "MF-Tyre 5.1", "52": "MF-Tyre 5.2", "6": "PAC2002", "60": "MF-Tyre 6.0",
        "61": "MF-Tyre 6.1", "62": "MF-Tyre 6.2"}  # fmt: skip
"""Models by FITTYP."""
FORMATS = {"MF_05": "52", "PAC2002": "6", "MF-TYRE": "52", "MF52": "52", "MF61": "61", "MF62": "62"}
"""FITTYP by PROPERTY_FILE_FORMAT, where FITTYP is missing."""

USED = frozenset({
    "FNOMIN", "PKX1", "PKX2", "PKX3", "PPX1", "PPX2", "PKY1", "PKY2", "PKY4", "PPY1", "PPY2", "QDZ1", "QDZ2", "PPZ1",
    "PTX1", "PTY1", "PTY2", "LFZO", "LKX", "LKY", "LTR", "LSGKP", "LSGAL", "LCZ", "UNLOADED_RADIUS",
    "VERTICAL_STIFFNESS", "VERTICAL_DAMPING", "LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS", "INFLPRES", "NOMPRES",
    "PFZ1",
})  # fmt: skip
"""Coefficients that are used."""

PRESSURES = ("PPX1", "PPX2", "PPY1", "PPY2", "PPZ1", "PFZ1", "INFLPRES", "NOMPRES", "IP", "IP_NOM")
"""Coefficients of the inflation pressure, used in MF-Tyre 6.x alone."""

OF_THE_FILE = ("VERTICAL", "STRUCTURAL", "DIMENSION", "INERTIA", "VERTICAL_FORCE_RANGE", "OPERATING_CONDITIONS",
               "MODEL", "TIRE_CONDITIONS")  # fmt: skip
"""Blocks without coefficients of slip."""

BLOCKS = ("COEFFICIENTS", "VERTICAL", "STRUCTURAL", "OVERTURNING", "ROLLING", "ALIGNING", "LATERAL", "LONGITUDINAL",
          "TURNSLIP", "CONTACT_PATCH", "DEFLECTION", "BOTTOMING", "DIMENSION", "INERTIA")  # fmt: skip
"""Parts of the names of blocks with coefficients of the model."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TyreFile:
    """Tyre of a `.tir` file in SI units.

    Attributes:
        file: name of the file.
        model: name of the model.
        coefficients: numbers by name in upper case.
        unused: names of unused coefficients that are not zero, by block.
        has_curve: True if the slope of a load curve replaces VERTICAL_STIFFNESS.
    """

    file: str
    model: str
    fit: str
    coefficients: dict[str, float]
    unused: dict[str, list[str]] = field(default_factory=dict)
    has_curve: bool = False

    def __getitem__(self, name: str) -> float:
        """Return a coefficient; missing: 1 for a scaling factor, 2 for PKY4, else 0."""
        default = 1.0 if name.startswith("L") and name not in SIZES else 2.0 if name == "PKY4" else 0.0
        return self.coefficients.get(name, default)

    @property
    def nominal_load(self) -> float:
        """Return FNOMIN [N]."""
        return self["FNOMIN"]

    @property
    def pressure(self) -> float:
        """Return the relative deviation of the inflation pressure from the nominal one [-]; 0 if not stated."""
        if self.fit not in NEWER or not self["NOMPRES"] or "INFLPRES" not in self.coefficients:
            return 0.0
        return self["INFLPRES"] / self["NOMPRES"] - 1.0

    @property
    def stiffness_origin(self) -> str:
        """Return the names from which the vertical stiffness follows."""
        name = "slope of DEFLECTION_LOAD_CURVE at FNOMIN" if self.has_curve else "VERTICAL_STIFFNESS"
        scaled = f" x LCZ {self['LCZ']:g}" if self["LCZ"] != 1.0 else ""
        return name + scaled + (" at INFLPRES" if self["PFZ1"] * self.pressure else "")

    @property
    def vertical_stiffness(self) -> float:
        """Return the vertical stiffness at the nominal load [N/m]."""
        return self["VERTICAL_STIFFNESS"] * self["LCZ"] * (1.0 + self["PFZ1"] * self.pressure)

    def longitudinal(self, load: float) -> float:
        """Return the slip stiffness C_kappa at a wheel load [N]."""
        df, dp = self._load(load), self.pressure
        by_pressure = 1.0 + self["PPX1"] * dp + self["PPX2"] * dp**2
        return load * (self["PKX1"] + self["PKX2"] * df) * math.exp(self["PKX3"] * df) * by_pressure * self["LKX"]

    def lateral(self, load: float) -> float:
        """Return the cornering stiffness C_alpha at a wheel load [N/rad]."""
        nominal, dp = self["LFZO"] * self.nominal_load, self.pressure
        shape = self["PKY4"] if self.fit in NEWER else 2.0
        angle = math.atan(load / (nominal * self["PKY2"] * (1.0 + self["PPY2"] * dp)))
        return abs(self["PKY1"] * nominal * (1.0 + self["PPY1"] * dp) * math.sin(shape * angle) * self["LKY"])

    def trail(self, load: float) -> float:
        """Return the pneumatic trail of small slip at a wheel load [m]."""
        by_load = (self["QDZ1"] + self["QDZ2"] * self._load(load)) * (1.0 - self["PPZ1"] * self.pressure)
        return load * by_load * self["UNLOADED_RADIUS"] / (self["LFZO"] * self.nominal_load) * self["LTR"]

    def carcass(self) -> tuple[float | None, float | None]:
        """Return the stiffness of the carcass along and across [N/m]; None if missing."""
        if self.fit in NEWER:
            return self["LONGITUDINAL_STIFFNESS"] or None, self["LATERAL_STIFFNESS"] or None
        load, radius = self.nominal_load, self["UNLOADED_RADIUS"]
        along = self["PTX1"] * radius / self["LFZO"] * self["LSGKP"]
        across = 0.0
        if self["PTY2"]:
            across = self["PTY1"] * math.sin(2.0 * math.atan(1.0 / (self["PTY2"] * self["LFZO"]))) * radius
            across *= self["LFZO"] * self["LSGAL"]
        return (
            self.longitudinal(load) / along if along else None,
            self.lateral(load) / abs(across) if across else None,
        )

    def _load(self, load: float) -> float:
        nominal = self["LFZO"] * self.nominal_load
        return (load - nominal) / nominal


SIZES = ("LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS")
"""Coefficients that begin like scaling factors."""


def read_tyre_file(path: Path) -> TyreFile:
    """Read a `.tir` file.

    Raises:
        ConfigurationError: the file is missing.
        DataError: it is of another tyre model, or a coefficient is missing or impossible.
    """
    content = read_property_file(path)
    model = content.blocks.get("MODEL")
    values = {} if model is None else model.values
    name = values.get("PROPERTY_FILE_FORMAT", "").upper().strip("'\"")
    fit = values.get("FITTYP", "").split(".")[0].strip() or FORMATS.get(name, "")
    if fit not in READ or name in OTHER_MODELS:
        raise DataError(
            f"{path}: is of the tyre model {name or fit or 'without FITTYP in [MODEL]'}, which is not read; fit or "
            f"export the tyre as one of {', '.join(READ.values())} (FITTYP {', '.join(READ)})"
        )
    coefficients, unused = _coefficients(content, fit)
    has_curve = bool((curve := content.blocks.get("DEFLECTION_LOAD_CURVE")) and curve.rows)
    tyre = TyreFile(
        file=path.name, model=READ[fit], fit=fit, coefficients=coefficients, unused=unused, has_curve=has_curve
    )
    for key, low, high, unit in (("FNOMIN", 500.0, 1e5, "N"), ("UNLOADED_RADIUS", 0.15, 1.0, "m"),
                                 ("VERTICAL_STIFFNESS", 2e4, 5e6, "N/m")):  # fmt: skip
        if not low <= coefficients.get(key, math.nan) <= high:
            raise DataError(f"{path}: {key} = {coefficients.get(key, 'missing')} {unit}, must be {low:g} to {high:g} "
                            f"{unit}; check it and [UNITS]")  # fmt: skip
    for key in ("PKX1", "PKY1", "PKY2"):
        if not coefficients.get(key):
            raise DataError(f"{path}: {key} is missing or 0, so the tyre has no slip stiffness; fit it at small slip")
    return tyre


OTHER_MODELS = ("PAC89", "PAC94", "FIALA", "UA", "FTIRE", "CTIRE", "5.2.1", "PAC_MC", "PAC-TIME")
"""Models of the same file format that are not read."""


def _coefficients(content: PropertyFile, fit: str) -> tuple[dict[str, float], dict[str, list[str]]]:
    """Return the coefficients that count in SI units, and names of unused coefficients by block."""
    length, force, time = (content.unit(name) for name in ("LENGTH", "FORCE", "TIME"))
    units = {"UNLOADED_RADIUS": length, "FNOMIN": force, "VERTICAL_STIFFNESS": force / length,
             "VERTICAL_DAMPING": force * time / length, "LONGITUDINAL_STIFFNESS": force / length,
             "LATERAL_STIFFNESS": force / length}  # fmt: skip
    coefficients: dict[str, float] = {}
    unused: dict[str, list[str]] = {}
    for block, entries in content.blocks.items():
        for name, text in entries.values.items():
            if name in PRESSURES and fit not in NEWER:
                if _not_zero(text):
                    unused.setdefault(block, []).append(name)
            elif name in USED and text:
                value = content.number(block, name)
                assert value is not None  # fmt: skip
                coefficients[name] = value * units.get(name, 1.0)
            elif any(part in block for part in BLOCKS) and _not_zero(text):
                unused.setdefault(block, []).append(name)
    if (curve := content.blocks.get("DEFLECTION_LOAD_CURVE")) is not None and curve.rows:
        if "VERTICAL_STIFFNESS" in coefficients:
            unused.setdefault("VERTICAL", []).append("VERTICAL_STIFFNESS")
        slope = _slope(content.points("DEFLECTION_LOAD_CURVE", length, force), coefficients.get("FNOMIN", 0.0))
        coefficients["VERTICAL_STIFFNESS"] = slope
    return coefficients, unused


def _slope(points: list[tuple[float, float]], load: float) -> float:
    """Return the slope of a curve of load over deflection at a load [N/m], which replaces VERTICAL_STIFFNESS."""
    for (x, f), (x_next, f_next) in itertools.pairwise(points):
        if f <= load <= f_next and f_next > f:
            return (f_next - f) / (x_next - x)
    return math.nan


def _not_zero(text: str) -> bool:
    try:
        return float(text.split()[0]) != 0.0
    except (ValueError, IndexError):
        return False
