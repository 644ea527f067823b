"""Statements about the degressive damper and the inclined strut: appendices C and D."""

import numpy as np

from scenarios.claims import PREDICTED, Claim, placed, spread_claim
from scenarios.quarter_car.road_claims import FIRST, response
from scenarios.quarter_car.runs import CONSTANT, DEGRESSIVE, HIGH, LOW, STEEP, Runs, peak, rms
from scenarios.verdict import common
from vehicle.arrays import Vector

SLIPS = 100.0 / STEEP["friction.steepness"]
"""A damper slips above this velocity, where the smooth law has 99.4 % of its friction [m/s]."""

SLOW = (1e-3, 5e-3)
"""Other velocities below which a damper may be counted as stuck [m/s]."""

SIGNIFICANT = 0.1
"""A significant change of an RMS [-]."""

SAME = 0.02
"""Two influences are the same within this share, the scatter of their estimate [-]."""

NEAR_20 = (18.0, 22.0)
"""Enlarged part of figures D.4 and D.5 [Hz]."""

ROADS = (("low", LOW), ("high", HIGH))


def degressive_claims(runs: Runs) -> list[Claim]:
    """Return the rows on degressive against constant damping, with elastomer and eps 1e6 s/m."""
    wheel, body = (
        [peak(*response(runs, *case, level), band) for case in ((*DEGRESSIVE,), (*CONSTANT,))]
        for level, band in ((LOW, (20.0, 30.0)), (HIGH, FIRST))
    )
    velocity = {
        name: [runs.marched(case[0], level, case[1]).sliding_velocity for case in (DEGRESSIVE, CONSTANT)]
        for name, level in ROADS
    }
    (bent, straight), slow_share = velocity["low"], runs.car.degressive.knee_velocity
    largest = [np.abs(velocities).max(axis=1) for velocities in (bent, straight)]
    share = {
        limit: [100.0 * float(np.mean(np.abs(velocities) <= limit)) for velocities in (bent, straight)]
        for limit in (SLIPS, *SLOW)
    }
    stuck = share[SLIPS]
    slow = ", ".join(
        f"{share[limit][0]:.1f} against {share[limit][1]:.1f} % below {1e3 * limit:g} mm/s" for limit in SLOW
    )
    high = [np.abs(velocities).max(axis=1) for velocities in velocity["high"]]
    influence = {name: _influence(runs, level, 0) for name, level in ROADS}
    less = {name: [_influence(runs, level, variant) for variant in (1, 2)] for name, level in ROADS}
    frequency, density = runs.spectrum(DEGRESSIVE[0], HIGH, DEGRESSIVE[1])
    _, constant = runs.spectrum(CONSTANT[0], HIGH, CONSTANT[1])
    above = frequency > 5.0
    ratio = float(np.sqrt(density[above].sum() / constant[above].sum()))
    figure, picture = "figure C.3", "figure_c_3.png"
    roads = f"{runs.roads} roads of {runs.duration:g} s"
    rows = [
        PREDICTED.statement(
            "degressive damper, low road: peak at 25 Hz",
            "less damped",
            f"height x {wheel[0][1] / wheel[1][1]:.2f}, at {wheel[0][0]:.2f} Hz",
            wheel[0][1] > wheel[1][1],
            "PSD of the body acceleration over that of the road velocity, largest line in 20 to 30 Hz",
        ),
        PREDICTED.statement(
            "degressive damper, low road: relative velocity of the damper",
            "smaller",
            f"RMS x {rms(bent) / rms(straight):.2f}, largest {1e3 * largest[0].max():.2g} against "
            f"{1e3 * largest[1].max():.2g} mm/s",
            rms(bent) < rms(straight),
            roads,
        ).at(figure, picture),
        PREDICTED.statement(
            "degressive damper, low road: share of sticking",
            "larger",
            f"{stuck[0]:.1f} against {stuck[1]:.1f} % of the time",
            common(degressive > constant for degressive, constant in share.values()),
            f"sticks: below 100 / eps = {1e3 * SLIPS:g} mm/s; the thesis does not define the count, and the definition "
            f"turns the row: {slow}; {roads}",
        ).at(figure, picture),
        PREDICTED.statement(
            "low road: relative velocity of the damper stays below the knee",
            f"below {slow_share:g} m/s",
            f"largest {largest[1].max():.4f} m/s with constant damping, below on {np.sum(largest[1] < slow_share)} of "
            f"{largest[1].size} roads",
            common(largest[1] < slow_share),
            "an assumption of the source, on every road; the level in 1 to 50 Hz depends on the band of the road, "
            f"which is not printed: velocities go with the square root of its lower edge, here 1/30 Hz; {roads}",
        ).at(figure, picture),
        spread_claim(
            "low road: largest relative velocity of the damper [m/s]",
            (0.01, 0.02),
            np.maximum(*largest),
            f"axis from -0.02 to 0.02 m/s with labels 0.01 apart; larger of both dampers; {roads}",
        ).at(figure, picture),
        spread_claim(
            "high road: largest relative velocity of the damper [m/s]",
            (0.5, 1.0),
            np.maximum(*high),
            f"axis to -1 m/s with labels 0.5 apart; larger of both dampers; {roads}",
        ).at(figure, picture),
        PREDICTED.statement(
            "degressive damper, high road: first resonance",
            "higher and more damped",
            f"{body[1][0]:.2f} to {body[0][0]:.2f} Hz, height x {body[0][1] / body[1][1]:.2f}",
            body[0][0] > body[1][0] and body[0][1] < body[1][1],
            "largest line of the response",
        ),
        PREDICTED.statement(
            "degressive damper, high road: higher frequencies",
            "less damped",
            f"RMS of the body acceleration from 5 to 50 Hz x {ratio:.2f}",
            ratio > 1.0,
            "rule: above the first resonance and its flank, 5 Hz",
        ),
        PREDICTED.statement(
            "degressive damper: influence on the low against the high road",
            "smaller on the low road",
            f"{influence['low']:.2f} against {influence['high']:.2f} dB",
            influence["low"] < influence["high"],
            "mean magnitude of the change of the PSD of the body acceleration, lines from 1 to 50 Hz",
        ),
        *(
            PREDICTED.statement(
                f"degressive damper with {change}: influence",
                "smaller",
                ", ".join(f"{name} road {less[name][i]:.2f} for {influence[name]:.2f} dB" for name, _ in ROADS),
                less["high"][i] < influence["high"] and less["low"][i] < (1.0 + SAME) * influence["low"],
                f"mean magnitude of the change of the PSD, as above; on the low road not larger by over {SAME:.0%}: "
                "there the damper hardly passes half the knee",
            )
            for i, change in enumerate(("half the knee velocity", "half the damping below the knee"))
        ),
    ]
    return placed(rows, "figure C.2", "figure_c_2.png")


def _influence(runs: Runs, level: float, variant: int) -> float:
    """Return the mean change of the PSD from constant to degressive damping [dB]."""
    _, bent = runs.spectrum(DEGRESSIVE[0], level, variant)
    _, straight = runs.spectrum(CONSTANT[0], level, CONSTANT[1])
    return float(np.mean(np.abs(10.0 * np.log10(bent / straight))))


def strut_claims(runs: Runs) -> list[Claim]:
    """Return the rows on an inclined strut, and on the longitudinal damping of the wheel."""
    angle, damping = ((f"figure D.{n}", f"figure_d_{n}.png") for n in (4, 5))
    claims = []
    for name, level in ROADS:
        frequency, upright = runs.spectrum(DEGRESSIVE[0], level, DEGRESSIVE[1])
        at = [runs.spectrum("inclined", level, variant)[1] for variant in range(4)]
        whole, near = (
            [_change(inclined, upright, frequency, band) for inclined in at] for band in ((1.0, 50.0), NEAR_20)
        )
        claims += [
            PREDICTED.statement(
                f"angle of the strut, {name} road: body acceleration 1 to 50 Hz",
                "no significant change",
                f"RMS {whole[0]:+.1f} % at 4.2 deg, {whole[1]:+.1f} % at 8.4 deg",
                max(abs(value) for value in whole[:2]) < 100.0 * SIGNIFICANT,
                "significant: 10 % of the RMS",
            ).at(*angle),
            PREDICTED.statement(
                f"angle of the strut, {name} road: near 20 Hz",
                "slight decrease",
                f"RMS 18 to 22 Hz {near[0]:+.1f} % at 4.2 deg, {near[1]:+.1f} % at 8.4 deg",
                max(near[:2]) < 0.0,
                "a decrease at both angles",
            ).at(*angle),
            PREDICTED.statement(
                f"longitudinal damping 0, {name} road: body acceleration near 20 Hz",
                "not significantly present",
                f"RMS 18 to 22 Hz {near[2]:+.1f} % against the upright strut",
                near[2] < 100.0 * SIGNIFICANT,
                f"the wheel alone on Kh has {_longitudinal(runs):.1f} Hz; significant: 10 % more",
            ).at(*damping),
            PREDICTED.statement(
                f"longitudinal damping 0, 550, 1100 N s/m, {name} road: near 20 Hz",
                "slight difference",
                f"RMS 18 to 22 Hz {near[2]:+.1f}, {near[0]:+.1f}, {near[3]:+.1f} % against the upright strut",
                0.0 < max(near[2], near[0], near[3]) - min(near[2], near[0], near[3]) < 100.0 * SIGNIFICANT,
                "slight: below 10 %, and some",
            ).at(*damping),
        ]
    return claims


def _change(density: Vector, against: Vector, frequency: Vector, band: tuple[float, float]) -> float:
    """Return the change of the RMS in a band [%]."""
    inside = (frequency >= band[0]) & (frequency <= band[1])
    return 100.0 * (float(np.sqrt(density[inside].sum() / against[inside].sum())) - 1.0)


def _longitudinal(runs: Runs) -> float:
    """Return the natural frequency of the wheel on its longitudinal stiffness [Hz]."""
    return float(np.sqrt(runs.car.strut.longitudinal_stiffness / runs.car.wheel.mass) / (2.0 * np.pi))
