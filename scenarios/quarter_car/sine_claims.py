"""Statements about sine roads of 1 and 50 mm at 1 Hz, without and with the engine: figures 2.12, 2.13, 2.17, 2.18."""

import numpy as np

from scenarios.claims import OWN_CHECK, PREDICTED, Claim, placed
from scenarios.lumped.history import History
from scenarios.lumped.quarter_car_parameters import QuarterCar
from scenarios.quarter_car.runs import HIGH, LOW, NO_FRICTION, Runs, rms
from vehicle.arrays import Vector
from vehicle.engines.linear.response import frequency_response

NEARLY = 0.1
""""Nearly equal" [-]."""

SLIPS = 1e-3
"""The friction is saturated above this velocity: it has 99.4 % of Fd [m/s]."""

START = 3.0
"""The figures show 3 to 5 s [s]."""


def stuck_bound(car: QuarterCar) -> float:
    """Return the maximum acceleration of the body by a stuck strut in steady motion [m/s2].

    With u = xb - xt and a stuck damper, Kd (u - s) is the force of the friction, at most Fd, and
    Mb xb'' = -Km u - Kd (u - s). A steady motion has no mean acceleration, so an offset s only uses up part of Fd: the
    largest |u| is Fd / Kd, at s = 0, and |xb''| is at most Fd (Km + Kd) / (Kd Mb).
    """
    both = car.spring.stiffness + car.mount.stiffness
    return car.friction.limit * both / (car.mount.stiffness * car.body.mass)


def sine_claims(runs: Runs) -> list[Claim]:
    """Return the rows on sines with and without friction."""
    return placed([*_low_claims(runs), *_high_claims(runs)], "figure 2.12", "figure_2_12.png")


def _low_claims(runs: Runs) -> list[Claim]:
    histories = {True: runs.sine(LOW), False: runs.sine(LOW, NO_FRICTION)}
    peak, lead = (
        {(mass, friction): of(late(history, mass)) for friction, history in histories.items() for mass in _PLACES}
        for of in (_largest, _dominant)
    )
    ratio = peak["body", True] / peak["body", False]
    wheel = peak["wheel", True] / peak["wheel", False]
    bound = stuck_bound(runs.car)
    slipping = frequency_response(runs.model(damper="slip"), np.array([1.0]), "body", "acceleration")
    sliding = LOW * float(np.abs(slipping[0]))
    time, started = runs.starts()
    reached = float(np.abs(started[time >= START]).max())
    stepped = _largest(late(runs.sine(LOW, phase=0.5 * np.pi))) / peak["body", False]
    velocity = histories[True].during(START).sliding_velocity()
    fast = float(np.mean(np.abs(velocity) > SLIPS))
    return [
        PREDICTED.number(
            "sine 1 mm, from rest: body acceleration with / without friction",
            10.0,
            ratio,
            2.5,
            "'about': 25 %; a stuck strut damps nothing, so its vibration of 4.8 Hz is that of the start, which is not "
            f"printed. No start gives 10: a stuck strut passes at most Fd (Km + Kd)/(Kd Mb) = {bound:.4f} m/s2, which "
            f"is {bound / sliding:.2f} times the {sliding:.4f} m/s2 of the sliding one; after a step of the road it is "
            f"{stepped:.2f}, the largest of {started.shape[1]} starts {reached / sliding:.2f}",
        ),
        OWN_CHECK.statement(
            "sine 1 mm: bound of the body acceleration of a stuck strut",
            "not printed",
            f"largest of {started.shape[1]} starts {reached:.4f} m/s2, bound {bound:.4f} m/s2",
            0.9 * bound < reached <= 1.005 * bound,
            "starts: eight phases of the road, eight velocities of the body up to 0.1 m/s; from 3 to 5 s. The bound "
            "must hold (0.5 %: the damper mass and the smooth law) and nearly be reached",
        ),
        PREDICTED.number(
            "sine 1 mm, from rest: frequency of the body [Hz]", 5.0, lead["body", True], 0.5, "lines 0.5 Hz apart"
        ),
        PREDICTED.statement(
            "sine 1 mm, from rest: wheel with against without friction",
            "larger acceleration, higher frequency",
            f"acceleration x {wheel:.1f}, {lead['wheel', True]:.1f} against {lead['wheel', False]:.1f} Hz",
            wheel > 1.0 + NEARLY and lead["wheel", True] > lead["wheel", False],
            f"largest acceleration, more than {NEARLY:.0%} above; largest line",
        ),
        PREDICTED.statement(
            "sine 1 mm: the damper sticks most of the time",
            "yes",
            f"slides {100 * fast:.0f} % of the time, largest velocity {np.abs(velocity).max():.1e} m/s",
            fast < 0.5,
            f"slides: above {SLIPS:g} m/s",
        ).at("figure 2.13", "figure_2_13.png"),
    ]


def _high_claims(runs: Runs) -> list[Claim]:
    braked, free = runs.sine(HIGH), runs.sine(HIGH, NO_FRICTION)
    extra = {mass: 100 * rms(late(braked, mass) - late(free, mass)) / rms(late(free, mass)) for mass in _PLACES}
    claims = [
        PREDICTED.number(
            f"sine 50 mm: {mass} acceleration RMS with / without friction",
            1.0,
            rms(late(braked, mass)) / rms(late(free, mass)),
            NEARLY,
            "'nearly equal': 10 %",
        )
        for mass in _PLACES
    ]
    velocity = braked.during(START).sliding_velocity()
    fast = float(np.mean(np.abs(velocity) > SLIPS))
    return [
        *claims,
        PREDICTED.statement(
            "sine 50 mm: extra wheel motion at each transition",
            "small, hardly any at the body",
            f"{extra['wheel']:.0f} % of the wheel's RMS, {extra['body']:.0f} % of the body's",
            extra["body"] < extra["wheel"],
            "RMS of the difference with and without friction; it must be smaller at the body",
        ),
        PREDICTED.statement(
            "sine 50 mm: the damper slips most of the time",
            "yes",
            f"slides {100 * fast:.0f} % of the time, largest velocity {np.abs(velocity).max():.2g} m/s",
            fast > 0.5,
            f"slides: above {SLIPS:g} m/s",
        ).at("figure 2.13", "figure_2_13.png"),
    ]


def engine_sine_claims(runs: Runs) -> list[Claim]:
    """Return the rows on sines with the engine on its linear mount against sines without engine."""
    unloaded = {a: runs.sine(a) for a in (LOW, HIGH)}
    loaded = {a: runs.sine(a, engine="linear") for a in (LOW, HIGH)}
    peaks = {a: [_largest(late(history[a])) for history in (unloaded, loaded)] for a in (LOW, HIGH)}
    low = loaded[LOW]
    body = late(low)
    engine, wheel = (
        np.fft.rfft(history - history.mean()) for history in (late(low, "engine") - body, late(low, "wheel") - body)
    )
    line = int(np.argmax(np.abs(wheel)))
    angle = abs(float(np.degrees(np.angle(engine[line] / wheel[line]))))
    extra = [rms(_beside_the_sine(late(history[HIGH]))) for history in (unloaded, loaded)]
    rows = [
        PREDICTED.statement(
            "sine 1 mm: body acceleration without against with engine",
            "much higher without engine",
            f"{peaks[LOW][0]:.3f} against {peaks[LOW][1]:.3f} m/s2",
            peaks[LOW][0] > (1.0 + 2.0 * NEARLY) * peaks[LOW][1],
            f"rule: by more than {2.0 * NEARLY:.0%}, twice what 'nearly equal' allows; from rest, 3 to 5 s",
        ),
        PREDICTED.statement(
            "sine 1 mm: engine and wheel, both relative to the body",
            "differ in phase",
            f"{angle:.0f} deg apart at {_hertz(line):.1f} Hz",
            angle > 90.0,
            "rule: more than 90 deg at the largest line of the wheel, so that the engine works against the wheel",
        ).at("figure 2.18", "figure_2_18.png"),
        PREDICTED.statement(
            "sine 50 mm: body acceleration with against without engine",
            "higher with engine",
            f"{peaks[HIGH][1]:.2f} against {peaks[HIGH][0]:.2f} m/s2",
            peaks[HIGH][1] > peaks[HIGH][0],
            "largest from 3 to 5 s",
        ),
        PREDICTED.statement(
            "sine 50 mm: effect of the transitions on the body, with against without engine",
            "smaller amplitude with engine",
            f"{extra[1]:.3f} against {extra[0]:.3f} m/s2 (RMS)",
            extra[1] < extra[0],
            "all that is not the sine of 1 Hz: a linear car would have nothing there",
        ),
    ]
    return placed(rows, "figure 2.17", "figure_2_17.png")


_PLACES = ("body", "wheel")


def late(history: History, output: str = "body") -> Vector:
    """Return the acceleration from 3 s to the end [m/s2]."""
    return history.during(START).acceleration(output)


def _largest(values: Vector) -> float:
    return float(np.abs(values).max())


def _hertz(line: int) -> float:
    """Return the frequency of a line of the shown two seconds [Hz]."""
    return 0.5 * line


def _dominant(values: Vector) -> float:
    """Return the frequency of the largest line [Hz]."""
    return _hertz(int(np.argmax(np.abs(np.fft.rfft(values - values.mean())))))


def _beside_the_sine(values: Vector) -> Vector:
    """Return a signal without its mean and its line of 1 Hz; sampled over whole periods, ends included."""
    spectrum = np.fft.rfft(values[:-1])
    spectrum[[0, 2]] = 0.0
    return np.asarray(np.fft.irfft(spectrum, values.size - 1))
