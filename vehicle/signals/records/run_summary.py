"""Types of the content of `summary.json` in the folder of a run, and its only reader; `output.run_files` writes it."""

# No postponed annotations: Python 3.11 would then take every NotRequired key for a required one.
import json
from pathlib import Path
from types import UnionType
from typing import Any, NotRequired, TypedDict, get_args, get_origin, get_type_hints, is_typeddict

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.comfort import COMFORT_BAND

SUMMARY_FILE = "summary.json"

ByWheel = dict[str, float]
TimeByWheel = dict[str, float | None]


class PlacedLoad(TypedDict):
    """Load on a part of the car: mass [kg], position [m] and the part."""

    mass_kg: float
    at_m: list[float]
    on: str


class VehicleSummary(TypedDict):
    """Origin of the vehicle parameters, and notes on the inertia and the body model."""

    name: str
    file: str | None
    overrides: list[str]
    inertia_about: str
    inertia: str
    loads: NotRequired[dict[str, PlacedLoad]]
    superelement: str


class InputSummary(TypedDict):
    """Displacement of the plates: file, levels [m], duration [s]; `road` has the settings of a road."""

    file: str
    sha256: str | None
    rms_m: float
    plate_rms_m: ByWheel
    duration_s: float
    highest_hz: float | None
    wheel: str
    wheel_text: str
    road: NotRequired[dict[str, Any] | None]


class PeakSummary(TypedDict):
    """Resonance of an FRF: frequency [Hz], magnitude and its standard error [m/s2 per m], coherence [-]."""

    frequency_hz: float
    magnitude: float
    coherence: float | None
    random_error: float | None


Peaks = dict[str, list[PeakSummary]]


class ComfortSummary(TypedDict):
    """Comfort at one output point; `iso2631` is the result of `analysis.evaluation.evaluate`.

    `rms_of_band` replaces `rms_2_50_hz`, then null, where the band of the signal ends below 50 Hz. `half_interval`:
    half of the 95 % interval of both overall values over roads of a class [m/s2], for a run on one of them.
    """

    rms_2_50_hz: dict[str, float | None]
    rms_of_band: NotRequired[dict[str, Any]]
    half_interval: NotRequired[dict[str, float]]
    iso2631: dict[str, Any]


class RimSummary(TypedDict):
    """Comfort at the rim of the steering wheel, by axis and overall [m/s2]: RMS in a band [Hz], and weighted RMS."""

    rms: dict[str, float]
    band_hz: list[float]
    weighted_rms: dict[str, float]
    weighting: str
    standard: str


class SeatSummary(TypedDict):
    """SEAT value by RMS and by dose [-], with the name of the weighting."""

    rms: float
    vdv: float
    weighting: str


class ObstacleSummary(TypedDict):
    """Values of a run over an obstacle: times [s], peak-to-peak and peak accelerations [m/s2], doses [m/s^1.75]."""

    obstacle: str
    from_s: float
    to_s: float
    peak_to_peak: dict[str, dict[str, float]]
    vdv: dict[str, dict[str, float]]
    settling_s: dict[str, float | None]
    knuckle_peak: ByWheel


class LineSummary(TypedDict):
    """Harmonic of an applied force: order of its angle, frequency [Hz], amplitude, phase [deg]."""

    order: float
    frequency_hz: float
    amplitude: float
    phase_deg: float


class ForceSummary(TypedDict):
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


class OrderSummary(TypedDict):
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
    stuck_range: NotRequired[dict[str, tuple[float, float]]]
    without_friction_range: NotRequired[dict[str, tuple[float, float]]]
    frictions: NotRequired[str]
    floor: NotRequired[float]


class RunUpSummary(TypedDict):
    """Largest amplitude of each channel in an order of the crankshaft in a run-up, and its speed [1/min].

    Amplitudes up to `floor` are below the accuracy of the engine.
    """

    order: float
    peak: dict[str, float]
    rpm: dict[str, float]
    floor: NotRequired[float]


class StaticSummary(TypedDict):
    """Static loads [N], and the largest displacement that remains after the trim [m]."""

    tyre_load_n: ByWheel
    rear_support_load_n: dict[str, float]
    residual_m: float


class SolverSummary(TypedDict):
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


class MotionSummary(TypedDict):
    """Input of FRFs: plates that move together with their factors, its name, its columns in `frf.csv`, its resonances.

    `peaks` of the summary are those of the first input.
    """

    plates: dict[str, float]
    input: NotRequired[str]
    columns: str
    peaks: NotRequired[Peaks]


class FrfSummary(TypedDict):
    """Estimate of the FRFs."""

    estimator: str
    window: str
    resolution_hz: float
    degrees_of_freedom: float | None
    degrees_of_freedom_range: list[float] | None
    to: NotRequired[list[MotionSummary]]


class MeasuredSummary(TypedDict):
    """Measurement that the run was compared with: file, rows of the table of differences, notices."""

    file: str
    table: list[dict[str, Any]]
    notices: list[str]


class RunSummary(TypedDict):
    """Content of `summary.json`; a value that does not exist is null. Earlier versions lack the keys not required."""

    frame: str
    vehicle: VehicleSummary
    input: InputSummary
    evaluated_s: NotRequired[list[float]]
    slip_share: ByWheel
    first_slip_s: TimeByWheel
    friction_saturated_share: ByWheel
    first_friction_saturated_s: TimeByWheel
    saturated_velocity: float
    peaks: Peaks
    comfort: dict[str, ComfortSummary]
    seat_value: NotRequired[SeatSummary | None]
    steering_wheel_rim: NotRequired[RimSummary]
    obstacle: NotRequired[ObstacleSummary | None]
    forces: NotRequired[dict[str, ForceSummary]]
    orders: NotRequired[list[OrderSummary]]
    run_up: NotRequired[list[RunUpSummary]]
    static: StaticSummary
    solver: SolverSummary
    frf: FrfSummary | None
    notices: list[str]
    files: dict[str, str]
    measured: NotRequired[MeasuredSummary | None]
    tyre: NotRequired[str]
    command: NotRequired[str | None]


def slip_shares(summary: RunSummary) -> ByWheel:
    """Return the share of the time in slip [-] by wheel, without the velocity that counts as slip."""
    return {wheel: share for wheel, share in summary["slip_share"].items() if wheel != "slip_velocity"}


def unweighted_rms(comfort: ComfortSummary) -> tuple[dict[str, Any], tuple[float, float]]:
    """Return the unweighted RMS [m/s2] by axis and "overall", and the edges of its band [Hz]."""
    rms: dict[str, Any] = comfort.get("rms_of_band", comfort["rms_2_50_hz"])
    low, high = rms.get("band_hz", COMFORT_BAND)
    return rms, (low, high)


def comfort_band(summary: RunSummary) -> tuple[float, float]:
    """Return the band of the unweighted RMS of a run [Hz], which a slow input narrows."""
    return next((unweighted_rms(comfort)[1] for comfort in summary["comfort"].values()), COMFORT_BAND)


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
        content = json.loads(path.read_text(encoding="utf-8"))
        fault = _fault(content, RunSummary, "")
    except (OSError, ValueError, RecursionError) as error:
        fault = f"{type(error).__name__}: {error}"
    if fault:
        raise DataError(f"{path}: is damaged ({fault}); run the simulation again")
    checked: RunSummary = content
    return checked


def available_summary(folder: Path) -> RunSummary | None:
    """Return the summary of a run; None if the folder has none, or a damaged one."""
    try:
        return read_summary(folder)
    except (ConfigurationError, DataError):
        return None


def _fault(value: object, expected: Any, path: str) -> str:
    """Return the first missing key or value of another type, with its path; empty if there is none."""
    if is_typeddict(expected):
        if not isinstance(value, dict):
            return f"{path or 'content'}: must be an object"
        if missing := sorted(expected.__required_keys__ - set(value)):
            return f"{path}{missing[0]}: missing"
        hints = get_type_hints(expected)
        return next((f for key in hints if key in value and (f := _fault(value[key], hints[key], f"{path}{key}."))), "")
    kinds = get_args(expected)
    if isinstance(expected, UnionType):
        faults = [_fault(value, expected_type, path) for expected_type in kinds]
        return "" if "" in faults else faults[0]
    if get_origin(expected) in (dict, list):
        if not isinstance(value, get_origin(expected)):
            return f"{path.rstrip('.')}: must be {'an object' if get_origin(expected) is dict else 'a list'}"
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return next((f for key, item in items if (f := _fault(item, kinds[-1], f"{path}{key}."))), "")
    matches = expected is Any or isinstance(value, (int, float) if expected is float else expected)
    return "" if matches else f"{path.rstrip('.')}: found {value!r}, must be {expected.__name__}"
