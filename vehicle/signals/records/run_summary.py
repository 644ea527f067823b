"""Content of `summary.json` in the folder of a run; `output.run_files` writes it."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.comfort_error import LEAST_EXPLAINED
from vehicle.signals.analysis.contact_vibration import ContactVibration
from vehicle.signals.analysis.seat_value import SeatValue
from vehicle.signals.records.law_band_summary import LawBandSummary
from vehicle.stored import Stored, omitted

SUMMARY_FILE = "summary.json"

ByWheel = dict[str, float]
TimeByWheel = dict[str, float | None]


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedLoad(Stored):
    """Load on a part of the car: mass [kg], position [m] and the part."""

    mass_kg: float
    at_m: list[float]
    on: str


@dataclass(frozen=True, kw_only=True, slots=True)
class VehicleSummary(Stored):
    """Origin of the vehicle parameters, and notes on the inertia and the body model."""

    name: str
    file: str | None
    overrides: list[str]
    inertia_about: str
    inertia: str
    loads: dict[str, PlacedLoad] | None = omitted()
    superelement: str


@dataclass(frozen=True, kw_only=True, slots=True)
class InputSummary(Stored):
    """Displacement of the plates: file, levels [m], duration [s]; `road` has the settings of a road."""

    file: str
    sha256: str | None
    rms_m: float
    plate_rms_m: ByWheel
    duration_s: float
    highest_hz: float | None
    wheel: str
    wheel_text: str
    road: dict[str, Any] | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class PeakSummary(Stored):
    """Resonance of an FRF: frequency [Hz], magnitude and its standard error [m/s2 per m], coherence [-]."""

    frequency_hz: float
    magnitude: float
    coherence: float | None
    random_error: float | None


Peaks = dict[str, list[PeakSummary]]


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortSummary(Stored):
    """Comfort at one output point; `iso2631` is the result of `analysis.evaluation.evaluate`.

    `rms_of_band` replaces `rms_2_50_hz`, then null, where the band of the signal ends below 50 Hz. `half_interval`:
    half of the 95 % interval over roads of a class [m/s2], of both overall values and of each axis ("weighted_x").
    `explained_by_linear_car`: share of the scatter over these roads that the linear car on the same road explains [-],
    by the same names, on a road that repeats after the evaluated span. `over_class`: on another road of a class,
    "unweighted" and "weighted" over all roads of the class, corrected by the linear car: `value` and `half_interval`
    [m/s2], `explained` [-].
    """

    rms_2_50_hz: dict[str, float | None]
    iso2631: ContactVibration
    rms_of_band: dict[str, Any] | None = omitted()
    half_interval: dict[str, float] | None = omitted()
    explained_by_linear_car: dict[str, float] | None = omitted()
    over_class: dict[str, dict[str, float]] | None = omitted()

    @property
    def weighted(self) -> float:
        """Vector sum of the weighted RMS accelerations [m/s2]."""
        return self.iso2631.overall

    @property
    def unweighted(self) -> tuple[dict[str, Any], tuple[float, float]]:
        """Unweighted RMS [m/s2] by axis and "overall", and the edges of its band [Hz]."""
        rms: dict[str, Any] = self.rms_of_band or self.rms_2_50_hz
        low, high = rms.get("band_hz", COMFORT_BAND)
        return rms, (low, high)


@dataclass(frozen=True, kw_only=True, slots=True)
class RimSummary(Stored):
    """Comfort at the rim of the steering wheel, by axis and overall [m/s2]: RMS in a band [Hz], and weighted RMS."""

    rms: dict[str, float]
    band_hz: list[float]
    weighted_rms: dict[str, float]
    weighting: str
    standard: str


@dataclass(frozen=True, kw_only=True, slots=True)
class ObstacleSummary(Stored):
    """Values of a run over an obstacle: times [s], peak-to-peak and peak accelerations [m/s2], doses [m/s^1.75]."""

    obstacle: str
    from_s: float
    to_s: float
    peak_to_peak: dict[str, dict[str, float]]
    vdv: dict[str, dict[str, float]]
    settling_s: dict[str, float | None]
    knuckle_peak: ByWheel


@dataclass(frozen=True, kw_only=True, slots=True)
class LineSummary(Stored):
    """Harmonic of an applied force: order of its angle, frequency [Hz], amplitude, phase [deg]."""

    order: float
    frequency_hz: float
    amplitude: float
    phase_deg: float


@dataclass(frozen=True, kw_only=True, slots=True)
class ForceSummary(Stored):
    """Applied force: part, joint or tyre that it acts on, point [m], directions, constant part, harmonics.

    `unit` is N or N m, or m of the run-out and m/s of the tread of a tyre.
    """

    on: str
    unit: str
    against: str
    at_m: list[float]
    force: list[float]
    moment: list[float]
    angle: str | None
    mean: float
    recorded: bool
    lines: list[LineSummary]


@dataclass(frozen=True, kw_only=True, slots=True)
class OrderSummary(Stored):
    """Amplitude of a channel at a frequency of the applied forces, with the standard error of both: see `order_lines`.

    `order` is that of the angle of `of`, "wheels", "crank" or "frequency". `stuck` and `without_friction` are the
    amplitudes of the linear car in which the friction of dampers and bushings holds, and without their friction; the
    ranges are theirs over the phases of the wheels among each other, if two or more wheels have this order. `frictions`
    names what has friction, and amplitudes up to `floor` are below the accuracy of the engine.
    """

    order: float
    of: str
    frequency_hz: float
    amplitude: dict[str, float]
    standard_error: dict[str, float]
    stuck: dict[str, float]
    without_friction: dict[str, float]
    frictions: str = "dampers"
    floor: float = 0.0
    stuck_range: dict[str, tuple[float, float]] | None = omitted()
    without_friction_range: dict[str, tuple[float, float]] | None = omitted()


@dataclass(frozen=True, kw_only=True, slots=True)
class RunUpSummary(Stored):
    """Largest amplitude of each channel in an order of the crankshaft in a run-up, and its speed [1/min].

    Amplitudes up to `floor` are below the accuracy of the engine.
    """

    order: float
    peak: dict[str, float]
    rpm: dict[str, float]
    floor: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class StaticSummary(Stored):
    """Static loads [N], and the largest displacement that remains after the trim [m]."""

    tyre_load_n: ByWheel
    rear_support_load_n: dict[str, float]
    residual_m: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SolverSummary(Stored):
    """Engine, time step, computing time and energy balance; the energies are null for the reduced engine."""

    engine: str
    callback: str
    timestep_s: float
    steps: int
    wall_s: float
    realtime_factor: float
    warnings: list[str]
    energy_residual: float | None
    work_in_j: float | None
    dissipated_j: float | None
    stored_j: float | None
    engine_reason: str


@dataclass(frozen=True, kw_only=True, slots=True)
class MotionSummary(Stored):
    """Input of FRFs: plates that move together with their factors, its name, its columns in `frf.csv`, its resonances.

    `peaks` of the summary are those of the first input.
    """

    plates: dict[str, float]
    input: str = ""
    columns: str
    peaks: Peaks | None = omitted()


@dataclass(frozen=True, kw_only=True, slots=True)
class FrfSummary(Stored):
    """Estimate of the FRFs."""

    estimator: str
    window: str
    resolution_hz: float
    degrees_of_freedom: float | None
    degrees_of_freedom_range: list[float] | None
    to: list[MotionSummary] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasuredSummary(Stored):
    """Measurement that the run was compared with: file, rows of the table of differences, notices."""

    file: str
    table: list[dict[str, Any]]
    notices: list[str]


@dataclass(frozen=True, kw_only=True, slots=True)
class RunSummary(Stored):
    """Content of `summary.json`; a value that does not exist is null. Earlier versions lack the keys not required.

    `slip_share` has the share of each wheel and, as "slip_velocity", the limit [m/s] of the first wheel. If the dampers
    differ, `slip_velocities` has the limit of each wheel; otherwise the key is absent.
    """

    frame: str
    vehicle: VehicleSummary
    input: InputSummary
    evaluated_s: list[float] = field(default_factory=list)
    slip_share: ByWheel
    slip_velocities: ByWheel | None = omitted()
    first_slip_s: TimeByWheel
    friction_saturated_share: ByWheel
    first_friction_saturated_s: TimeByWheel
    saturated_velocity: float
    peaks: Peaks
    comfort: dict[str, ComfortSummary]
    seat_value: SeatValue | None = None
    steering_wheel_rim: RimSummary | None = omitted()
    law_band: LawBandSummary | None = omitted()
    obstacle: ObstacleSummary | None = None
    forces: dict[str, ForceSummary] | None = omitted()
    orders: list[OrderSummary] | None = omitted()
    run_up: list[RunUpSummary] | None = omitted()
    static: StaticSummary
    solver: SolverSummary
    frf: FrfSummary | None
    notices: list[str]
    files: dict[str, str]
    measured: MeasuredSummary | None = None
    tyre: str = ""
    command: str | None = None

    @property
    def slip_shares(self) -> ByWheel:
        """Share of the time in slip [-] by wheel, without the velocity that counts as slip."""
        return {wheel: share for wheel, share in self.slip_share.items() if wheel != "slip_velocity"}

    @property
    def slip_limits(self) -> ByWheel:
        """Return the velocity above which each damper slips [m/s], by wheel."""
        return self.slip_velocities or dict.fromkeys(self.slip_shares, self.slip_share.get("slip_velocity", 0.0))

    @property
    def comfort_band(self) -> tuple[float, float]:
        """Band of the unweighted RMS [Hz], which a slow input narrows."""
        return next((comfort.unweighted[1] for comfort in self.comfort.values()), COMFORT_BAND)

    @property
    def evaluated_from(self) -> float:
        """Start of the evaluated span [s]."""
        return self.evaluated_s[0] if self.evaluated_s else 0.0


def read_summary(folder: Path) -> RunSummary:
    """Read `summary.json` in the folder of a run, and check its keys and types.

    Raises:
        ConfigurationError: the folder has no such file.
        DataError: the file is no JSON, a key is missing, or a value has another type.
    """
    path = folder / SUMMARY_FILE
    if not path.is_file():
        raise ConfigurationError(
            f"{folder}: contains no {SUMMARY_FILE}; give the folder of a run, for example runs/low"
        )
    try:
        return RunSummary.from_json(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, RecursionError) as error:
        fault = str(error) if type(error) is ValueError else f"{type(error).__name__}: {error}"
        raise DataError(f"{path}: is damaged ({fault}); run the simulation again") from None


def available_summary(folder: Path) -> RunSummary | None:
    """Return the summary of a run; None if the folder has none, or a damaged one."""
    try:
        return read_summary(folder)
    except (ConfigurationError, DataError):
        return None


def interval_words(summary: RunSummary, comfort: ComfortSummary) -> str:
    """Return the meaning of the intervals of comfort on a road of a class."""
    text = f"±: 95 % interval over roads of class {(summary.input.road or {}).get('class')}"
    share = (comfort.explained_by_linear_car or {}).get("weighted")
    if share is None:
        return text
    if share < LEAST_EXPLAINED:
        return f"{text}, of the run alone: the linear car on the same road explains less than half of the scatter"
    return f"{text}; the linear car on the same road explains {number(100.0 * share)} % of the scatter"
