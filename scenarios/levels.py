"""Low, mid and high random input under the wheel on the shaker: FRFs, slip shares, wheel mode (Bommer 2006, chapter 3).

python -m scenarios.levels [--output DIR] [--quick] [--jobs N] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.charts import LEVEL_COLOURS, FrfCurve, draw_frf, measured_curve
from scenarios.claims import NOT_TESTABLE, OWN_CHECK, PREDICTED, Claim, Findings
from scenarios.evidence import evidence_of
from scenarios.evidence_claims import evidence_claim
from scenarios.frf_claims import FRF_END, axis_claims, coherence_claim
from scenarios.inputs.make_inputs import LEVELS, QUICK_DURATION, level_signal
from scenarios.interval_probability import AGREES_ABOVE, interval_probability
from scenarios.slip_shares import slip_claims, slip_shares, slip_table
from scenarios.study import CarSettings, car_study, computed_by, estimator_text, setting
from scenarios.verdict import common
from vehicle.arrays import Vector
from vehicle.engines.linear.car_modes import Mode
from vehicle.names import across
from vehicle.runs.car import Run
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.peaks import phase_resonance
from vehicle.signals.excitation.slip_set import sets_text

QUICK_OUTPUTS = ("seat_rail_acc_z",)
"""Outputs drawn with --quick."""

TOO_SHORT = f"{QUICK_DURATION:g} s of signal tell it too coarsely"


def study(runs: CarRuns, folder: Path, settings: CarSettings) -> Findings:
    """Run the three levels, draw the figures into the folder, and compare."""
    results = runs([runs.case(level_signal(level, runs.wheel, quick=settings.quick)) for level in LEVELS])
    by_level = dict(zip(LEVELS, results, strict=True))
    responses = {level: run.frf(channels_of(runs.wheel)) for level, run in by_level.items()}
    level_figures(folder, by_level, responses, QUICK_OUTPUTS if settings.quick else tuple(OUTPUTS))
    values = {level: numbers(run, responses[level]) for level, run in by_level.items()}
    slip_velocity = runs.car().vehicle.damper.slip_velocity
    shares = slip_shares(runs, quick=settings.quick)
    shipped = {level: value.slip for level, value in values.items()}
    claims = [*slip_claims(shares, shipped, slip_velocity), *frequency_claims(values), *order_claims(values)]
    claims += [wheel_mode_claim(runs, values["low"]), other_damper_claim(by_level["low"])]
    claims.append(seat_claim(responses["low"]))
    claims += axis_claims(responses, channels_of(runs.wheel), None if settings.quick else rigid_lines(runs))
    trial = None if settings.quick else less_friction(runs)
    claims.append(coherence_claim(responses, CHANNELS.index(DAMPER[0]), trial))
    sure = {claim.name for claim in order_claims(values)}
    return Findings(
        title="Low, mid and high level (Bommer 2006, sections 3.2.1 and 3.3)",
        claims=claims,
        tyres=runs.car().vehicle.driving.words,
        unjudged={row.name: TOO_SHORT for row in claims if row.name not in sure} if settings.quick else {},
        notes=[slip_table(shares), sets_text(), *setting(runs, results[0], settings.quick)],
        data={"levels": {level: asdict(value) for level, value in values.items()}, "slip_velocity": slip_velocity},
    )


main = car_study("levels", study, CarSettings)


WHEEL_HZ = 28.0
"""Vertical wheel mode, dampers stuck [Hz] (section 3.2.1)."""

KNUCKLE = "knuckle_z.png"
"""Figure of the knuckle."""

WHEEL_BAND = (20.0, 35.0)
"""The vertical wheel mode is looked for here [Hz]."""

BODY_BAND = (3.0, 10.0)
"""The rigid body modes that the input drives [Hz]."""

DAMPER_BAND = (10.0, 50.0)
"""Damper top and knuckle are compared here [Hz]: below, both move with the body and differ by its rotation."""


SAME_FRF = 0.05
"""Two FRFs are equal in a figure with logarithmic axes within this share [-]."""


def rigid_lines(runs: CarRuns) -> Vector:
    """Return |H| of `CHANNELS` at 1 Hz, body rigid and dampers stuck [(m/s2)/m]."""
    car = runs.car(("body.flexible=false",))
    return np.abs(car.matrix_frf(channels_of(runs.wheel), [1.0], wheel=runs.wheel))[:, 0]


def less_friction(runs: CarRuns) -> FrequencyResponse:
    """Return the FRFs of the high level with a tenth of the friction, rows as `CHANNELS`."""
    friction = 0.1 * runs.car().vehicle.damper.coulomb_friction
    case = runs.case(
        level_signal("high", runs.wheel, quick=False), [f"damper.coulomb_friction={friction!r}"], engine="reduced"
    )
    return runs([case])[0].frf(channels_of(runs.wheel))


@dataclass(frozen=True, kw_only=True, slots=True)
class LevelNumbers:
    """Values of one excitation level."""

    slip: tuple[float, float]  # share of the time above the slip velocity, right and left damper [-]
    wheel_hz: float  # frequency [Hz] in `WHEEL_BAND` where the phase of the knuckle falls through 90 deg, or NaN
    wheel_peak_hz: float  # wheel_peak_hz, wheel_peak: largest line of the knuckle in `WHEEL_BAND` [Hz], [m/s2 per m]
    wheel_peak: float
    body_peak: float  # largest line of the knuckle in `BODY_BAND` [m/s2 per m]
    damper_ratio: float  # |H| of the damper top over |H| of the knuckle, geometric mean over `DAMPER_BAND` [-]


def numbers(run: Run, response: FrequencyResponse) -> LevelNumbers:
    """Read the numbers off one run and its FRFs (rows as `CHANNELS`)."""
    complex_knuckle, complex_top = (response.response[CHANNELS.index(name)] for name in DAMPER)
    knuckle, top = np.abs(complex_knuckle), np.abs(complex_top)
    frequency = response.frequency
    wheel, body, damper = (
        (frequency >= band[0]) & (frequency <= band[1]) for band in (WHEEL_BAND, BODY_BAND, DAMPER_BAND)
    )
    return LevelNumbers(
        slip=(run.slip_share(run.wheel), run.slip_share(across(run.wheel))),
        wheel_hz=phase_resonance(frequency[wheel], complex_knuckle[wheel]),
        wheel_peak_hz=float(frequency[wheel][np.nanargmax(knuckle[wheel])]),
        wheel_peak=float(np.nanmax(knuckle[wheel])),
        body_peak=float(np.nanmax(knuckle[body])),
        damper_ratio=float(np.exp(np.nanmean(np.log(top[damper] / knuckle[damper])))),
    )


def wheel_mode_claim(runs: CarRuns, low: LevelNumbers) -> Claim:
    """Return the row on four definitions of the vertical wheel mode."""
    car, evidence = runs.car(), evidence_of("wheel_mode")
    natural = max(car.modes("stuck"), key=_wheel_hop).frequency
    lines = np.arange(*WHEEL_BAND, 0.01)
    (knuckle,) = np.abs(car.matrix_frf([f"knuckle_{runs.wheel}_acc_z"], lines, wheel=runs.wheel))
    definitions = {
        "natural frequency of the mode with most energy in wheel hop (`vehicle modes`)": natural,
        "largest |H| of the knuckle by the matrices": float(lines[np.argmax(knuckle)]),
        "largest line of the simulated FRF of the knuckle": low.wheel_peak_hz,
        "phase of that FRF through 90 deg": low.wheel_hz,
    }
    return OWN_CHECK.statement(
        "vertical wheel mode, low, by four definitions",
        f"{WHEEL_HZ:g} Hz, no definition",
        "; ".join(f"{value:.2f} Hz {text}" for text, value in definitions.items()),
        common(
            interval_probability(value, evidence.interval, error=evidence.error) > AGREES_ABOVE
            for value in definitions.values()
        ),
        "rule: each as the row above, which has the last one. A mode near others (torsion, belt lines) has its peak "
        "and its phase beside its natural frequency",
    ).at(evidence.place, KNUCKLE)


def _wheel_hop(mode: Mode) -> float:
    """Return the share of the kinetic energy of a mode in the vertical motion of wheels [-]."""
    return sum(share for motion, share in mode.motions.items() if "wheel hop" in motion)


SEAT_FROM = 22.0
"""Model and measurement of the source differ at the seat above this frequency [Hz] (section 3.2.1.4)."""


def seat_claim(response: FrequencyResponse) -> Claim:
    """Return the row on the seat, whose own dynamics the source recommends to model."""
    seat, rail = (np.abs(response.response[CHANNELS.index(f"{name}_acc_z")]) for name in ("seat", "seat_rail"))
    above = response.frequency >= SEAT_FROM
    ratio = float(np.exp(np.nanmean(np.log(seat[above] / rail[above]))))
    return NOT_TESTABLE.statement(
        "seat above 22 Hz: a detailed seat model would improve it",
        "recommended, not computed",
        f"|H| of the seat over that of its rail, {SEAT_FROM:g} to {FRF_END:g} Hz: {ratio:.2f}",
        None,
        "the measured FRF of the seat is lost; here the seat is a point of the body, as in the source. The car "
        "`focus_road_seated` has a seat with an occupant",
    ).at("section 5.2", "seat_z.png")


def other_damper_claim(run: Run) -> Claim:
    """Return the row on the two ends of the damper that is not driven, low level."""
    response = run.frf(channels_of(across(run.wheel), DAMPER))
    knuckle, top = np.abs(response.response)
    shown = (response.frequency >= DAMPER_BAND[0]) & (response.frequency <= DAMPER_BAND[1])
    ratio = float(np.exp(np.nanmean(np.log(top[shown] / knuckle[shown]))))
    return PREDICTED.statement(
        "damper top against knuckle on the left, which is not driven, low",
        "equal",
        f"ratio {ratio:.3f}",
        abs(ratio - 1.0) <= SAME_FRF,
        f"mean of |H| over |H|, {DAMPER_BAND[0]:g} to {DAMPER_BAND[1]:g} Hz, both to the moving plate; rule as on the "
        "right",
    ).at("section 3.2.1.2")


def frequency_claims(levels: Mapping[str, LevelNumbers]) -> list[Claim]:
    """Return the rows on the frequency of the vertical wheel mode."""
    low, mid, high = (levels[level] for level in ("low", "mid", "high"))
    return [
        evidence_claim(
            "wheel_mode",
            "vertical wheel mode, low [Hz]",
            low.wheel_hz,
            "where the knuckle FRF passes 90 deg. Fitted to it: body torsion, with the plate on the other side, and "
            "the stiffness of the strut tops, with the plate on this side (docs/theory/source-choice.md)",
            printed=WHEEL_HZ,
        ).at(picture=KNUCKLE),
        PREDICTED.statement(
            "vertical wheel mode for mid and high against low",
            "lower frequency",
            f"{low.wheel_hz:.1f}, {mid.wheel_hz:.1f}, {high.wheel_hz:.1f} Hz",
            low.wheel_hz > mid.wheel_hz > high.wheel_hz,
            "where the knuckle FRF passes 90 deg; falling from level to level. Largest lines: "
            f"{low.wheel_peak_hz:.1f}, {mid.wheel_peak_hz:.1f}, {high.wheel_peak_hz:.1f} Hz",
        ).at("figures 3.29 and 3.30", KNUCKLE),
    ]


def order_claims(levels: Mapping[str, LevelNumbers]) -> list[Claim]:
    """Return the rows on damping over the level, and on the two ends of the damper."""
    low, mid, high = (levels[level] for level in ("low", "mid", "high"))
    return [
        PREDICTED.statement(
            "vertical wheel mode for mid and high against low, damping",
            "more damped",
            f"peak {low.wheel_peak:.3g}, {mid.wheel_peak:.3g}, {high.wheel_peak:.3g} (m/s2)/m",
            low.wheel_peak > mid.wheel_peak > high.wheel_peak,
            "the same input in larger: a lower peak is more damping",
        ).at("figures 3.29 and 3.30", KNUCKLE),
        PREDICTED.statement(
            "rigid body modes in the knuckle for mid and high against low",
            "less influence, more damped",
            f"peak {low.body_peak:.3g}, {mid.body_peak:.3g}, {high.body_peak:.3g} (m/s2)/m",
            low.body_peak > mid.body_peak > high.body_peak,
            f"largest line of the knuckle FRF in {BODY_BAND[0]:g} to {BODY_BAND[1]:g} Hz",
        ).at("figures 3.29 and 3.30", KNUCKLE),
        PREDICTED.statement(
            "damper top against knuckle, low",
            "equal",
            f"ratio {low.damper_ratio:.3f}",
            abs(low.damper_ratio - 1.0) <= SAME_FRF,
            f"mean of |H| over |H|, {DAMPER_BAND[0]:g} to {DAMPER_BAND[1]:g} Hz; equal in a figure with log axes: "
            f"{100.0 * SAME_FRF:g} %",
        ).at("figure 3.6", "damper_top_and_knuckle_z.png"),
        PREDICTED.statement(
            "damper top against knuckle, mid and high",
            "below for mid, further below for high",
            f"ratio {mid.damper_ratio:.3f}, {high.damper_ratio:.3f}",
            high.damper_ratio < mid.damper_ratio < low.damper_ratio,
            "falling from level to level",
        ).at("figures 3.27 and 3.28", "damper_top_and_knuckle_z.png"),
    ]


OUTPUTS = {
    "seat_rail_acc_z": ("seat_rail_z", "Seat rail, vertical (figures 3.3, 3.21, 3.22)"),
    "seat_acc_z": ("seat_z", "Seat, vertical (figures 3.4, 3.23, 3.24)"),
    "knuckle_{wheel}_acc_z": ("knuckle_z", "Right knuckle, vertical (figures 3.5, 3.25, 3.26, 3.29, 3.30)"),
    "engine_acc_z": ("engine_z", "Engine, vertical (figures 3.7, 3.31, 3.32)"),
    "roof_right_rear_acc_z": ("roof_rear_z", "Roof rear, driver's right, vertical (figures 3.8, 3.33, 3.34)"),
    "body_front_acc_z": ("body_front_z", "Body front, vertical (figure 3.9)"),
    "seat_rail_acc_x": ("seat_rail_x", "Seat rail, longitudinal (figures 3.11, 3.35)"),
    "seat_rail_acc_y": ("seat_rail_y", "Seat rail, lateral (figures 3.10, 3.36)"),
}
"""Channel to the name of its file and its title, with the figures of Bommer 2006 that show it."""

DAMPER = ("knuckle_{wheel}_acc_z", "damper_top_{wheel}_acc_z")

CHANNELS = (*OUTPUTS, DAMPER[1])
"""Channels whose FRFs are estimated, of the wheel on the shaker."""


def channels_of(wheel: str, names: Sequence[str] = CHANNELS) -> tuple[str, ...]:
    """Return the names of channels for the wheel on the shaker."""
    return tuple(name.format(wheel=wheel) for name in names)


def level_figures(
    folder: Path, runs: Mapping[str, Run], responses: Mapping[str, FrequencyResponse], outputs: Sequence[str]
) -> None:
    """Write a figure for each output, and a figure of damper top and knuckle."""
    run = next(iter(runs.values()))
    levels = ", ".join(f"{level} {1e3 * run.signal.rms(run.wheel):.3g} mm RMS" for level, run in runs.items())
    note = (
        f"FRFs to the plate under the {run.car.vehicle.wheel_text(run.wheel)}. {levels}; "
        f"{run.signal.duration:g} s each; "
        f"{estimator_text(next(iter(responses.values())))}; {computed_by(run)}"
    )
    lines = np.geomspace(1.0, 50.0, 800)
    for channel, row in zip(
        outputs, run.car.matrix_frf(channels_of(run.wheel, outputs), lines, wheel=run.wheel), strict=True
    ):
        name, title = OUTPUTS[channel]
        curves = [
            measured_curve(responses[level], CHANNELS.index(channel), level, colour)
            for level, colour in zip(runs, LEVEL_COLOURS, strict=True)
        ]
        label = "linear model, dampers stuck"
        curves.append(FrfCurve(label=label, frequency=lines, response=row, colour="#222222", style=":"))
        draw_frf(folder / f"{name}.png", title, note, [("", curves)])
    looks = (("knuckle", LEVEL_COLOURS[0], "-"), ("damper top", LEVEL_COLOURS[2], "--"))
    columns = [
        (
            level,
            [
                measured_curve(response, CHANNELS.index(channel), *look)
                for channel, look in zip(DAMPER, looks, strict=True)
            ],
        )
        for level, response in responses.items()
    ]
    title = "Right damper top and knuckle, vertical (figures 3.6, 3.27, 3.28)"
    draw_frf(folder / "damper_top_and_knuckle_z.png", title, note, columns)


if __name__ == "__main__":
    sys.exit(main())
