"""Statements about random roads: figures 2.6, 2.14 and 2.21, and table B.1."""

import itertools

import numpy as np

from scenarios.claims import NOT_TESTABLE, PREDICTED, Claim, placed, spread_claim
from scenarios.quarter_car.linear_claims import ABOUT
from scenarios.quarter_car.runs import HIGH, LEVELS, LOW, SEED, STEEP, Runs, peak, rms, rough_road
from vehicle.arrays import Vector
from vehicle.engines.linear.response import frequency_response

FIRST, SECOND = (1.0, 8.0), (8.0, 35.0)
"""Bands [Hz] where the first (body) and the second (wheel) resonance are looked for."""

SWINGS = 100
"""Roads of 30 s whose swing is compared with figure 2.6."""


def swing_claim() -> Claim:
    """Return the row on the road of figure 2.6."""
    swings = [float(np.ptp(rough_road(SEED + i))) for i in range(SWINGS)]
    return spread_claim(
        f"rough road, RMS {1e3 * HIGH:g} mm: swing in 30 s [m]",
        (0.1, 0.2),
        swings,
        f"labels of the axis from 0.15 to -0.05 m: highest 0.1 to 0.15, lowest -0.05 to 0; {SWINGS} roads",
    ).at("figure 2.6", "figure_2_6.png")


def level_claims(runs: Runs) -> list[Claim]:
    """Return the rows on the resonances over the road level."""
    responses = [response(runs, "no engine", 0, level) for level in LEVELS]
    first = [peak(f, s, FIRST) for f, s in responses]
    second = [peak(f, s, SECOND) for f, s in responses]
    text = ", ".join(
        f"{1e3 * level:g} mm: {a[0]:.1f} and {_inside(b[0])} Hz"
        for level, a, b in zip(LEVELS, first, second, strict=True)
    )
    claims = [
        PREDICTED.number("road 0.5 mm: first resonance [Hz]", 4.8, first[0][0], 0.25, ABOUT),
        PREDICTED.number("road 0.5 mm: second resonance [Hz]", 25.0, second[0][0], 1.25, ABOUT),
        PREDICTED.number("road 50 mm: first resonance [Hz]", 2.0, first[-1][0], 0.25, "read from a figure: 0.25 Hz"),
        PREDICTED.number("road 50 mm: second resonance [Hz]", 12.5, second[-1][0], 1.25, _flat_top(runs)),
        PREDICTED.statement(
            "resonances move down as the level grows",
            "yes",
            text,
            all(b[0] < a[0] + 1.5 * runs.resolution for a, b in itertools.pairwise(first))
            and second[-1][0] < second[0][0],
            "the first rises by less than the 1.5 lines a Hann window resolves; - : no top inside the band",
        ),
        PREDICTED.statement(
            "resonances become damped as the level grows",
            "yes",
            f"peaks fall to {100 * first[-1][1] / first[0][1]:.1g} % and {100 * second[-1][1] / second[0][1]:.1g} %",
            first[-1][1] < first[0][1] and second[-1][1] < second[0][1],
            "height over the road velocity PSD, highest against lowest level",
        ),
    ]
    return placed(claims, "figures 2.14 and 2.15", "figure_2_14.png")


def _inside(frequency: float) -> str:
    """Return the frequency of the second resonance as a text; a dash if the largest line is at an edge of the band."""
    return f"{frequency:.1f}" if SECOND[0] < frequency < SECOND[1] else "-"


def response(runs: Runs, family: str, variant: int, level: float) -> tuple[Vector, Vector]:
    """Return the spectrum per road velocity for the search of resonances."""
    return runs.spectrum(family, level, variant, resolution=runs.resolution, per_road=True)


def _flat_top(runs: Runs) -> str:
    """Return a text on the difference between the second resonance of the body spectrum and the wheel mode."""
    frequency = np.arange(SECOND[0], SECOND[1], 0.05)
    linear = frequency_response(runs.model(damper="slip"), frequency, "body", "velocity")
    top, _ = peak(frequency, np.abs(linear), SECOND)
    return f"10 %; damped by 23 %: the linear slip model itself has the top of its body spectrum at {top:.1f} Hz"


def engine_road_claims(runs: Runs) -> list[Claim]:
    """Return the rows on the engine mass and the two mounts."""
    claims = []
    for name, level, published in (("low", LOW, (4.5, 3.5)), ("high", HIGH, (2.0, 1.5))):
        families = {"no engine": "no engine", "engine": "linear mount"}
        for (label, family), value in zip(families.items(), published, strict=True):
            first_peak = peak(*response(runs, family, 0, level), FIRST)[0]
            why = "read from a figure with lines of 0.5 Hz"
            claims.append(PREDICTED.number(f"{name} road, {label}: first resonance [Hz]", value, first_peak, 0.5, why))
        frequency, linear = runs.spectrum("linear mount", level)
        _, bare = runs.spectrum("no engine", level)
        lower = linear < bare
        claims.append(
            PREDICTED.statement(
                f"{name} road, body: PSD with engine against without",
                "lower at certain frequencies",
                f"lower at {100.0 * lower.mean():.0f} % of the lines from 1 to 50 Hz, among them "
                f"{100.0 * lower[(frequency >= 4.0) & (frequency <= 30.0)].mean():.0f} % of those from 4 to 30 Hz",
                bool(0.0 < lower.mean() < 1.0),
                "rule: at some lines but not at all",
            )
        )
        _, viscoelastic = runs.spectrum("elastomer", level)
        for band, less in (((12.5, 16.0), True), ((16.0, 30.0), False)):
            inside = (frequency >= band[0]) & (frequency <= band[1])
            ratio = float(np.sqrt(viscoelastic[inside].sum() / linear[inside].sum()))
            claims.append(
                PREDICTED.statement(
                    f"{name} road, body {band[0]:g} to {band[1]:g} Hz, elastomer against linear mount",
                    "more damped" if less else "less damped",
                    f"RMS in the band x {ratio:.3f}",
                    (ratio < 1.0) == less,
                    "sign of the change",
                )
            )
    return placed(claims, "figure 2.21", "figure_2_21.png")


def steepness_claims(runs: Runs) -> list[Claim]:
    """Return the untestable rows on table B.1: small mass on the body, three steepnesses, with an unprinted input."""
    sines = {
        f"sine {1e3 * a:g} mm": rms(runs.sine(a, STEEP, small_mass=True).acceleration("small_mass"))
        for a in (LOW, HIGH)
    }
    roads = {
        f"road {1e3 * level:g} mm": [rms(runs.marched("small mass", level, i).acceleration) for i in range(3)]
        for level in (LEVELS[0], HIGH)
    }
    sizes = ", ".join(f"{name} {value:.3g}" for name, value in [*sines.items(), *((n, v[0]) for n, v in roads.items())])
    lost = [", ".join(f"{name} {100.0 * (1.0 - v[i] / v[0]):.1f}" for name, v in roads.items()) for i in range(3)]
    why = (
        "the input is not printed, and none of four candidates gives the printed size: no row of the table can be "
        "tested"
    )
    published = ((1e6, 0.0175, None), (1e5, 0.0169, 3.0), (1e4, 0.0165, 5.6))
    claims = []
    for index, (eps, size, error) in enumerate(published):
        label = f"table B.1, eps {eps:.0e}"
        ours = f"at eps 1e6: {sizes}" if index == 0 else "see eps 1e6"
        claims.append(NOT_TESTABLE.statement(f"{label}: RMS of the small mass [m/s2]", f"{size:g}", ours, False, why))
        if error is not None:
            claims.append(
                NOT_TESTABLE.statement(f"{label}: error against eps 1e6 [%]", f"{error:g}", lost[index], False, why)
            )
    times = "87.82 % at 1e4, 89.95 % at 1e5"
    claims.append(
        NOT_TESTABLE.statement(
            "table B.1, run time against eps 1e6", times, "another solver", False, f"{why}; so is the solver"
        )
    )
    return placed(claims, "table B.1", "figure_b_1.png")
