"""Rows of chapter 4 on time histories: levels, cars with less motion, and wheel motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from scenarios.claims import NOT_TESTABLE, PREDICTED, Claim
from scenarios.comfort_runs import Changes, ComfortRuns, Point, Variation
from scenarios.comfort_sensitivity.claims import MOUNT_STIFFNESS, SOURCE, TITLES
from scenarios.evidence import LEVELS, evidence_of
from scenarios.evidence_claims import evidence_claim, reason
from scenarios.signals.exact_road import RATE_HZ, ROAD_RMS
from vehicle.arrays import Vector
from vehicle.signals.analysis.peaks import phase_resonance
from vehicle.signals.analysis.segments import window_extremes
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.studies.sweeps.case import signal_of
from vehicle.studies.sweeps.case_evaluation import recordings_of

WINDOW_S = 0.5
"""The figures show 27 to 27.5 s."""

SWING_S = 30.0
"""Length of the road in figure 2.6 [s]."""

SWING_RMS = 0.05
"""RMS of the road in figure 2.6 [m] (section 2.3.1)."""

WHEEL_BAND = (8.0, 35.0)
"""The peak of the wheel is looked for here [Hz]."""

SPECTRUM_WINDOW_S = 1.0
"""Windows of the spectra of the wheel [s]: lines 1 Hz apart, for a peak that is several times as wide."""


MEASURED_PEAKS = {"asphalt": 20.0, "cobbles": 13.0}
"""Largest line of the wheel's acceleration, measured on a car and roads that are not described (figure 2.1) [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadLevels:
    """Values of the time histories on one road, over all records."""

    # figure to the largest |vertical acceleration of the seat rail| over its cars in each 0.5 s [m/s2], (w,)
    largest: Mapping[str, Vector]
    # (parameter, value) to the RMS of the vertical acceleration of the seat rail in each record [m/s2], (records,)
    seat_rail: Mapping[tuple[str, float], Vector]
    # (parameter, value) to the RMS of the difference to the nominal car [m/s2], (records,)
    apart: Mapping[tuple[str, float], Vector]
    swing: Vector  # highest less lowest displacement of the road in each 30 s [m], (s,)
    # frequency, wheel: lines [Hz] and mean PSD of the vertical acceleration of the knuckle [(m/s2)2/Hz], (n,)
    frequency: Vector
    wheel: Vector


def ends_of(comfort: ComfortRuns, variation: Variation, base: Changes = ()) -> dict[float, Changes]:
    """Return value of the parameter to overrides, for the cars at both ends of a variation and the nominal car."""
    cars = comfort.cars(variation, base)
    kept = {variation.values[0], variation.values[-1]}
    return {value: car for value, car in cars.items() if value in kept or car == base}


def road_levels(comfort: ComfortRuns) -> dict[str, RoadLevels]:
    """Return the values of the histories on both roads, without the lead."""
    return {road: _levels_of(comfort, road) for road in ROAD_RMS}


def _levels_of(comfort: ComfortRuns, road: str) -> RoadLevels:
    record = slice(round(comfort.records.lead * RATE_HZ) + 1, None)
    variations = {variation.name: ends_of(comfort, variation) for variation in SOURCE}
    largest: dict[str, list[Vector]] = {}
    sizes: dict[tuple[str, float], list[float]] = {}
    apart: dict[tuple[str, float], list[float]] = {}
    swings, spectra, frequency = [], [], np.empty(0)
    for number in range(comfort.records.count):
        cars = list(dict.fromkeys(car for ends in variations.values() for car in ends.values()))
        rails = dict(zip(cars, comfort.histories(cars, road, record=number), strict=True))
        nominal = rails[()][record]
        for name, ends in variations.items():
            histories = [rails[car][record] for car in ends.values()]
            for value, rail in zip(ends, histories, strict=True):
                sizes.setdefault((name, value), []).append(float(np.std(rail)))
                apart.setdefault((name, value), []).append(float(np.std(rail - nominal)))
            for figure, *_ in (level for level in LEVELS if level[1:3] == (name, road)):
                values = [window_extremes(1.0 / RATE_HZ, rail, WINDOW_S) for rail in histories]
                largest.setdefault(figure, []).append(np.max(values, axis=0))
        case = comfort.cases((), road)[number]
        signal = signal_of(case.source)
        ((wheel, plate),) = signal.displacement.items()
        samples = min(round(SWING_S * RATE_HZ), plate[record].size)
        swings.append(np.ptp(plate[record][: plate[record].size // samples * samples].reshape(-1, samples), axis=1))
        channel = f"knuckle_{wheel}_acc_z"
        (recording,) = recordings_of([case], [channel])
        spectrum = power_spectral_density(1.0 / RATE_HZ, recording[channel][record], window_s=SPECTRUM_WINDOW_S)
        frequency = spectrum.frequency
        spectra.append(spectrum.density[0])
    return RoadLevels(
        largest={figure: np.concatenate(values) for figure, values in largest.items()},
        seat_rail={key: np.array(values) for key, values in sizes.items()},
        apart={key: np.array(values) for key, values in apart.items()},
        swing=np.concatenate(swings),
        frequency=frequency,
        wheel=np.mean(spectra, axis=0),
    )


def level_claims(levels: Mapping[str, RoadLevels], trials: Mapping[str, Mapping[str, float]]) -> list[Claim]:
    """Return the rows on the level of the seat rail on both roads, and on the swing of the road.

    Trials, label of a modification to the mean of each figure, are evidence for the reason of a disagreement.
    """
    rows = []
    for figure, name, road, *_ in LEVELS:
        key, ours = f"level_{figure.replace('.', '_')}", levels[road].largest[figure]
        row = f"largest |seat rail, vertical| in {WINDOW_S:g} s of all curves of figure {figure}, {road} road [m/s2]"
        why = f"nominal car and both ends of {TITLES[name]}; the label is that of an axis that holds all curves"
        claim = evidence_claim(key, row, ours, why).at(picture=f"{name}.png")
        if not claim.within and trials:
            means = {label: values[figure] for label, values in trials.items()}
            why += f"; means of {reason(evidence_of(key).interval, means)}"
            claim = evidence_claim(key, row, ours, why).at(picture=f"{name}.png")
        rows.append(claim)
    rough = levels["rough"].swing * SWING_RMS / ROAD_RMS["rough"]
    smooth = 1e3 * np.median(levels["smooth"].swing)
    rows.append(
        evidence_claim(
            "swing_2_6",
            f"swing of a road over {SWING_S:g} s, figure 2.6 [m]",
            rough,
            f"stretches of the rough road, brought to the {1e3 * SWING_RMS:g} mm RMS of its caption; the smooth road "
            f"of {1e3 * ROAD_RMS['smooth']:g} mm RMS swings by {smooth:.0f} mm and cannot be meant",
        )
    )
    return rows


def history_claims(levels: Mapping[str, RoadLevels]) -> list[Claim]:
    """Return the rows on the cars with less motion in the histories of figures 4.1 to 4.10."""
    friction, damping, stiffness = SOURCE
    return [
        _lower(levels, friction, "4.1", rising=True),
        _lower(levels, stiffness, "4.9", rising=False),
        _clearer(levels, friction, "4.2"),
        _clearer(levels, stiffness, "4.10"),
        _small(levels, damping, (friction, stiffness)),
    ]


def _lower(levels: Mapping[str, RoadLevels], variation: Variation, figure: str, *, rising: bool) -> Claim:
    values = sorted(value for name, value in levels["smooth"].seat_rail if name == variation.name)
    rows = np.array([levels["smooth"].seat_rail[variation.name, value] for value in values])
    steps = np.diff(rows, axis=0)
    return PREDICTED.statement(
        f"accelerations of the seat rail against {TITLES[variation.name]}, smooth road",
        "lower for a smaller value" if rising else "lower for a larger value",
        ", ".join(f"{value:g}: {np.mean(row):.3f}" for value, row in zip(values, rows, strict=True)) + " m/s2",
        bool(np.all(steps > 0.0) if rising else np.all(steps < 0.0)),
        "RMS of the vertical acceleration alone, unfiltered; in every record",
    ).at(f"figure {figure}", f"{variation.name}.png")


def _share(level: RoadLevels, name: str) -> float:
    """Return the largest RMS of the difference to the nominal car over its RMS, over the values of a parameter [-]."""
    ratios = [
        np.mean(ratio) / np.mean(_nominal(level, name))
        for (parameter, _), ratio in level.apart.items()
        if parameter == name
    ]
    return float(np.max(ratios))


def _nominal(level: RoadLevels, name: str) -> Vector:
    return next(
        level.seat_rail[key] for key, difference in level.apart.items() if key[0] == name and not difference.any()
    )


def _clearer(levels: Mapping[str, RoadLevels], variation: Variation, figure: str) -> Claim:
    smooth, rough = (_share(levels[road], variation.name) for road in ("smooth", "rough"))
    return PREDICTED.statement(
        f"differences of the seat rail's histories with {TITLES[variation.name]}, rough road",
        "cannot be observed that well as on the smooth road",
        f"{100.0 * rough:.0f} % of the nominal motion, {100.0 * smooth:.0f} % on the smooth road",
        rough < smooth,
        "RMS of the largest difference to the nominal car over its RMS",
    ).at(f"figure {figure}", f"{variation.name}.png")


def _small(levels: Mapping[str, RoadLevels], variation: Variation, others: Sequence[Variation]) -> Claim:
    shares = {road: _share(level, variation.name) for road, level in levels.items()}
    smallest = min(_share(level, other.name) for level in levels.values() for other in others)
    texts = ", ".join(f"{100.0 * value:.0f} % of the nominal motion ({road})" for road, value in shares.items())
    return PREDICTED.statement(
        f"differences of the seat rail's histories with {TITLES[variation.name]}",
        "very small",
        texts,
        max(shares.values()) < smallest,
        f"RMS as above; smaller on both roads than every difference with Fd or mount stiffness (at least "
        f"{100.0 * smallest:.0f} %)",
    ).at("figures 4.5 and 4.6", f"{variation.name}.png")


def wheel_modes(comfort: ComfortRuns) -> dict[float, float]:
    """Return mount stiffness [N/m] to frequency of the vertical wheel mode of the matrices, dampers stuck [Hz]."""
    lines, wheel = np.arange(10.0, 50.0, 0.02), comfort.runs.car().vehicle.shaker_wheel
    return {
        value: phase_resonance(
            lines, comfort.runs.car(car).matrix_frf([f"knuckle_{wheel}_acc_z"], lines, wheel=wheel)[0]
        )
        for value, car in comfort.cars(MOUNT_STIFFNESS).items()
    }


def amplification_claim(nominal: Mapping[str, Point]) -> Claim:
    """Return the row on the comfort value over the RMS of the road, for the nominal car on both roads."""
    amplification = {road: numbers.comfort / (1e3 * ROAD_RMS[road]) for road, numbers in nominal.items()}
    return PREDICTED.statement(
        "amplification from road to seat rail, smooth road against rough",
        "higher for a low level than for a high one",
        ", ".join(f"{road} {value:.4f} m/s2 per mm" for road, value in amplification.items()),
        amplification["smooth"] > amplification["rough"],
        "comfort value of the nominal car over the RMS of the road; one road at two levels",
    ).at("chapter 4")


def stiffness_claim(wheel_mode: Mapping[float, float]) -> Claim:
    """Return the row on the frequency of the vertical wheel mode, dampers stuck, over the mount stiffness."""
    values = sorted(wheel_mode)
    return PREDICTED.statement(
        "vertical wheel mode against mount stiffness",
        "higher for a larger value",
        ", ".join(f"{value:g} N/m: {wheel_mode[value]:.1f} Hz" for value in values),
        bool(np.all(np.diff([wheel_mode[value] for value in values]) > 0.0)),
        "matrices, dampers stuck: phase of the knuckle FRF through 90 degrees",
    ).at("section 4.3")


def wheel_claims(levels: Mapping[str, RoadLevels]) -> list[Claim]:
    """Return the rows on a car measured on undescribed roads, with our values on the roads of chapter 4."""
    peaks = {road: wheel_peak(level) for road, level in levels.items()}
    sizes = {road: _rms(level) for road, level in levels.items()}
    unknown = (
        "neither the car nor its roads nor the speed are described; our car is on one plate, and its road falls as 1/f2"
    )
    rows = [
        NOT_TESTABLE.number(
            f"peak of the wheel's vertical acceleration, measured on {surface} [Hz]",
            printed,
            peaks[road][0],
            1.0,
            f"{unknown} (the {road} road of chapter 4)",
        ).at("figure 2.1", "wheel.png")
        for (surface, printed), road in zip(MEASURED_PEAKS.items(), ROAD_RMS, strict=True)
    ]
    (low, narrow), (high, wide) = peaks["smooth"], peaks["rough"]
    rows.append(
        PREDICTED.statement(
            "peak of the wheel's vertical acceleration, rough road against smooth",
            "lower and more damped",
            f"{high:.1f} Hz, {wide:.1f} Hz wide at half its power against {low:.1f} Hz, {narrow:.1f} Hz wide",
            high < low and wide / high > narrow / low,
            "the trend of figure 2.1 and its reason, the friction of the damper, on the roads of chapter 4; more "
            "damped: a larger width over frequency",
        ).at("figure 2.1", "wheel.png")
    )
    rows.append(
        NOT_TESTABLE.statement(
            "RMS of the knuckle on the measured roads fixes the level of ours",
            "7.5 and 43 mm RMS give the measured values",
            ", ".join(f"{road} {value:.1f} m/s2" for road, value in sizes.items()),
            False,
            "the measured values are not printed",
        ).at("chapter 4", "wheel.png")
    )
    return rows


def wheel_peak(level: RoadLevels) -> tuple[float, float]:
    """Return frequency and half-power width of the largest line of the PSD of the wheel [Hz]."""
    inside = (level.frequency >= WHEEL_BAND[0]) & (level.frequency <= WHEEL_BAND[1])
    frequency, density = level.frequency[inside], level.wheel[inside]
    above = frequency[density >= 0.5 * np.max(density)]
    return float(frequency[np.argmax(density)]), float(above[-1] - above[0])


def _rms(level: RoadLevels) -> float:
    return float(np.sqrt(np.sum(level.wheel) * level.frequency[1]))
