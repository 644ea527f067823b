"""Statements about the linear models and single elements: tables 2.1 and 2.3, figures 2.5, 2.9, 2.10 and 2.20."""

import numpy as np

from scenarios.claims import INFERRED, PREDICTED, Claim, placed
from scenarios.lumped.quarter_car_network import elastomer
from scenarios.quarter_car.runs import Runs
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.engines.linear.response import frequency_response

ABOUT = "printed with 'about', read from a figure: 5 %"

PHASE_READING = 25.0
"""A phase is read from an axis with labels 100 deg apart: a quarter of that [deg]."""

COINCIDE = 0.05
"""Two frequencies coincide within this share [-], equal to `ABOUT`."""

EQUAL = 0.1
"""Two amplitudes are "equal" within this share [-]."""


def mode_claims(runs: Runs) -> list[Claim]:
    """Return the rows on the natural frequencies of the slip and the stick model."""
    claims = []
    for damper, published in (("slip", (2.0, 12.5)), ("stick", (4.8, 25.0))):
        modes = natural_modes(runs.model(damper=damper))
        for index, (value, ours) in enumerate(zip(published, modes.frequency.tolist(), strict=True)):
            why = ABOUT
            if damper == "slip":
                why += f"; undamped frequency, the free decay has {modes.damped_frequency[index]:.2f} Hz"
            claims.append(PREDICTED.number(f"{damper} mode {index + 1} [Hz]", value, ours, 0.05 * value, why))
    return placed(claims, "figure 2.5", "figure_2_5.png")


def phase_claims(runs: Runs) -> list[Claim]:
    """Return the rows on phases and relative size of body and wheel at the four frequencies of the text."""
    reading = f"read from an axis with labels 100 deg apart: {PHASE_READING:g} deg"
    slow, hop = _pair(runs, "slip", 2.0), _pair(runs, "slip", 12.5)
    heave, wheel = _pair(runs, "stick", 4.8), _pair(runs, "stick", 25.0)
    nearby = ", ".join(f"{_degrees(_pair(runs, 'slip', f)[0]):.0f} deg at {f:g} Hz" for f in (1.8, 1.9))
    stiff = {"mount.stiffness": 10.0 * runs.car.mount.stiffness}
    stiffer = frequency_response(runs.model(stiff, damper="stick"), np.array([4.8]), "body") / frequency_response(
        runs.model(stiff, damper="stick"), np.array([4.8]), "wheel"
    )
    equal = abs(heave[0] / heave[1])
    apart = abs(_degrees(hop[1] / hop[0]))
    side = "just below the undamped resonance of 25.13 Hz; above it both turn over, and stay opposite to each other"
    rows = [
        PREDICTED.statement(
            "2 Hz, slip: body against wheel",
            "body moves more",
            f"{abs(slow[0]):.2f} against {abs(slow[1]):.2f} m/m",
            abs(slow[0]) > abs(slow[1]),
            "magnitudes of the response to the road",
        ),
        PREDICTED.number(
            "2 Hz, slip: body behind the road [deg]",
            50.0,
            -_degrees(slow[0]),
            PHASE_READING,
            f"printed with 'about', {reading}; it is {nearby}",
        ),
        PREDICTED.statement(
            "2 Hz, slip: wheel against the road",
            "in phase",
            f"{-_degrees(slow[1]):.0f} deg behind",
            abs(_degrees(slow[1])) < PHASE_READING,
            reading,
        ),
        PREDICTED.statement(
            "12.5 Hz, slip: wheel against body",
            "wheel moves much more",
            f"{abs(hop[1]):.2f} against {abs(hop[0]):.2f} m/m",
            abs(hop[1]) > 2.0 * abs(hop[0]),
            "rule: more than twice",
        ),
        PREDICTED.statement(
            "12.5 Hz, slip: wheel out of phase with road and body",
            "out of phase with both",
            f"{-_degrees(hop[1]):.0f} deg behind the road, {apart:.0f} deg from the body",
            min(abs(_degrees(hop[1])), apart) > PHASE_READING,
            f"no angle is printed; rule: more than {PHASE_READING:g} deg; a damped resonance has 90 deg, not 180",
        ),
        PREDICTED.statement(
            "4.8 Hz, stick: amplitude of body and wheel",
            "equal",
            f"body / wheel {equal:.2f}",
            abs(equal - 1.0) < EQUAL,
            f"rule: within {EQUAL:.0%}; 1 / (1 - (4.8 Hz / fa)^2) with the body on the stuck strut at fa = "
            f"{_strut_frequency(runs):.1f} Hz; with a mount ten times as stiff it would be {abs(stiffer[0]):.2f}",
        ),
        PREDICTED.statement(
            "4.8 Hz, stick: phase of body and wheel",
            "equal, 180 deg from the road",
            f"body {abs(_degrees(heave[0])):.0f}, wheel {abs(_degrees(heave[1])):.0f} deg",
            min(abs(_degrees(phase)) for phase in heave) > 180.0 - PHASE_READING,
            "just above the undamped resonance of 4.785 Hz, below it both are in phase with the road",
        ),
        PREDICTED.statement(
            "25 Hz, stick: wheel against body",
            "wheel moves much more",
            f"{abs(wheel[1]):.1f} against {abs(wheel[0]):.1f} m/m",
            abs(wheel[1]) > 2.0 * abs(wheel[0]),
            "rule: more than twice",
        ),
        PREDICTED.statement(
            "25 Hz, stick: body against road and wheel",
            "180 deg from both",
            f"{abs(_degrees(wheel[0])):.0f} deg from the road, {abs(_degrees(wheel[0] / wheel[1])):.0f} deg from the "
            "wheel",
            min(abs(_degrees(wheel[0])), abs(_degrees(wheel[0] / wheel[1]))) > 180.0 - PHASE_READING,
            side,
        ),
        _sharper(runs),
    ]
    return placed(rows, "figure 2.5", "figure_2_5.png")


def _sharper(runs: Runs) -> Claim:
    lines = np.geomspace(1.0, 50.0, 800)
    height = {
        damper: [float(np.abs(frequency_response(runs.model(damper=damper), lines, mass)).max()) for mass in _PLACES]
        for damper in ("slip", "stick")
    }
    text = "; ".join(f"{damper}: body {b:.3g}, wheel {w:.3g} m/m" for damper, (b, w) in height.items())
    return PREDICTED.statement(
        "peaks with the damper in stick against slip",
        "much higher",
        text,
        all(stick > 2.0 * slip for stick, slip in zip(height["stick"], height["slip"], strict=True)),
        "rule: more than twice; highest of 800 lines from 1 to 50 Hz, the stuck model has no damping at all",
    )


_PLACES = ("body", "wheel")


def _pair(runs: Runs, damper: str, frequency: float) -> tuple[complex, complex]:
    """Return the responses of body and wheel to the road at a frequency [Hz]."""
    model = runs.model(damper=damper)
    body, wheel = (complex(frequency_response(model, np.array([frequency]), mass)[0]) for mass in _PLACES)
    return body, wheel


def _degrees(value: complex) -> float:
    return float(np.degrees(np.angle(value)))


def _strut_frequency(runs: Runs) -> float:
    """Return the natural frequency of the body on spring and mount in parallel [Hz]."""
    car = runs.car
    return float(np.sqrt((car.spring.stiffness + car.mount.stiffness) / car.body.mass) / (2.0 * np.pi))


def element_claims(runs: Runs) -> list[Claim]:
    """Return the rows on the engine on its linear mount, and on the elastomer."""
    engine, mount, law, rubber = runs.car.engine, runs.car.engine_mount, elastomer(runs.car), runs.car.elastomer
    natural = np.sqrt(mount.stiffness / engine.mass)
    frequency, angle = law.loss_peak()
    at_nine = float(np.degrees(law.loss_angle(2.0 * np.pi * 9.0)))
    corner = float(rubber.branch_stiffness / (2.0 * np.pi * rubber.branch_damping))
    ratio, digits = float(50.0 * mount.damping / (engine.mass * natural)), "printed digits"
    hop = natural_modes(runs.model(damper="slip"))
    wheel, free = float(hop.frequency[1]), float(hop.damped_frequency[1])
    largest = (
        f"our largest angle, which the source does not print: {np.degrees(angle):.2f} deg at "
        f"{frequency / (2.0 * np.pi):.2f} Hz"
    )
    mass, rubbers, picture = "section 2.3.3.1", "figure 2.20", "figure_2_20.png"
    return [
        PREDICTED.number("engine alone [Hz]", 12.7, float(natural / (2 * np.pi)), 0.05, digits).at(mass),
        PREDICTED.number("engine alone, damping [%]", 15.0, ratio, 0.5, digits).at(mass),
        PREDICTED.statement(
            "engine alone against the wheel with the damper in slip",
            "frequencies coincide, 12.5 Hz",
            f"engine {natural / (2.0 * np.pi):.2f} Hz, wheel {wheel:.2f} Hz undamped, {free:.2f} Hz in its free decay",
            all(abs(natural / (2.0 * np.pi) / frequency - 1.0) <= COINCIDE for frequency in (wheel, free)),
            f"rule: within {COINCIDE:.0%} of both, as the frequencies that are printed with 'about'",
        ).at(mass),
        PREDICTED.number("elastomer, loss angle at 9 Hz [deg]", 10.0, at_nine, 0.5, f"{digits}; {largest}").at(
            rubbers, picture
        ),
        PREDICTED.number("elastomer, K2 / (2 pi De) [Hz]", 9.0, corner, 0.5, digits).at(rubbers, picture),
    ]


def mass_on_damper_claims(runs: Runs) -> list[Claim]:
    """Return the rows on both friction models with the mass of section 2.3.2.3."""
    p = runs.car.mass_on_damper
    smooth, switched = runs.mass_on_damper("smooth"), runs.mass_on_damper("switch")
    v, vs = smooth.sliding_velocity(), switched.sliding_velocity()
    fast = np.abs(v) > 5e-5
    gap = float(np.abs(v - vs)[fast].max())
    force_gap = float(np.abs(smooth.sliding_force - switched.sliding_force)[fast].max()) / p.friction_limit
    stuck = float(np.mean(np.abs(vs) <= p.stick_band))
    rows = [
        PREDICTED.statement(
            "switch and smooth law above 5e-5 m/s",
            "agree",
            f"velocities differ by at most {gap:.2g} m/s, forces by {100 * force_gap:.2g} % of Fd",
            gap < 5e-5 and bool(force_gap < 0.0128),
            "agree: closer than the velocity of the statement; the atan law lacks 2/(pi eps v) = 1.27 % there",
        ),
        INFERRED.number(
            "mass on damper, velocity peak [m/s]",
            (p.force_amplitude - p.friction_limit) / p.damping,
            float(np.abs(vs).max()),
            4e-6,
            "(F - Fd)/D; the inertia of 1 kg changes it by less than 0.1 %",
        ),
        PREDICTED.statement(
            "mass on damper sticks in intervals",
            "yes",
            f"{100 * stuck:.1f} % of the time",
            bool(abs(stuck - 2 / np.pi * np.arcsin(p.friction_limit / p.force_amplitude)) < 1e-3),
            "(2/pi) asin(Fd/F) = 30.0 % of the time without inertia",
        ),
    ]
    return placed(rows, "figures 2.9 and 2.10", "figure_2_9.png")
