"""Result of `evaluation.evaluate`: weighted RMS, maxima and doses of an acceleration, and their sums."""

import math
from dataclasses import dataclass, field

from vehicle.names import AXES
from vehicle.stored import Stored


@dataclass(frozen=True, kw_only=True, slots=True)
class AxisVibration(Stored):
    """Vibration along an axis, without the multiplying factor; a value that does not exist is None.

    `mtvv_ratio` (MTVV / a_w) above 1.5 or `vdv_ratio` (VDV / (a_w T^(1/4))) above 1.75 mean that the RMS alone
    understates the shocks.
    """

    weighting: str = ""
    """name of the weighting"""
    multiplying_factor: float | None = None
    """factor k for comfort [-]"""
    weighted_rms: float
    """weighted RMS acceleration a_w [m/s2]"""
    mtvv: float | None = None
    """maximum transient vibration value [m/s2]"""
    crest_factor: float | None = None
    """maximum over RMS of the settled span [-]"""
    vdv: float | None = None
    """vibration dose value [m/s^1.75]"""
    estimated_vdv: float | None = None
    """1.4 a_w T^(1/4) [m/s^1.75]"""
    msdv: float | None = None
    """motion sickness dose value [m/s^1.5]"""
    msdv_weighting: str | None = None
    """weighting of `msdv`"""
    mtvv_ratio: float | None = None
    """MTVV over the RMS of the settled span [-]"""
    vdv_ratio: float | None = None
    """VDV over a_w T^(1/4) [-]"""


@dataclass(frozen=True, kw_only=True, slots=True)
class VibrationSums(Stored):
    """Sums of x, y and z with the multiplying factors."""

    weighted_rms: float
    """vector sum for comfort [m/s2]"""
    vdv: float | None = None
    """sum of the doses in the fourth power [m/s^1.75]"""
    health_weighted_rms: float | None = None
    """vector sum for health [m/s2]"""


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactVibration(Stored):
    """Vibration at a point of contact, see `evaluation.evaluate`: the comfort values of a record and of a run.

    Only the weighted RMS values must be in a file: earlier versions may lack the others.
    """

    place: str = ""
    """point of contact, a name in `evaluation.APPLICATIONS`"""
    standard: str = ""
    """standard and clause"""
    duration_s: float = math.nan
    """evaluated duration T [s]"""
    sampling_rate_hz: float = math.nan
    """sampling rate [Hz]"""
    highest_hz: float | None = None
    """maximum frequency in the values [Hz]; None from the end of the range of the standard (80 Hz) on"""
    running_average: str = ""
    """running average of the MTVV, "linear" or "exponential\""""
    x: AxisVibration | None = None
    y: AxisVibration | None = None
    z: AxisVibration | None = None
    vector_sum: VibrationSums | None = None
    """None if an axis is missing"""
    reasons: list[str] = field(default_factory=list)
    """reasons for missing or uncertain values"""

    @property
    def axes(self) -> dict[str, AxisVibration]:
        """Values of the measured axes by name."""
        each = {axis: getattr(self, axis) for axis in AXES}
        return {axis: values for axis, values in each.items() if values is not None}

    @property
    def overall(self) -> float:
        """Vector sum of the weighted RMS accelerations for comfort [m/s2]; NaN if an axis is missing."""
        return math.nan if self.vector_sum is None else self.vector_sum.weighted_rms
