"""Exercises of the course: data as on the pages, solutions by closed forms.

The pages compute with the program and with small scripts; here no part of the program computes.
"""

import math

from scenarios.course.exercise import Exercise, Slip

TURN = 2.0 * math.pi
"""Angular frequency over frequency [rad/s per Hz]."""

BODY, WHEEL, SPRING, TYRE = 320.0, 40.0, 22e3, 200e3
"""Quarter car of the course: body and wheel [kg], spring and tyre [N/m]."""

SERIES = SPRING * TYRE / (SPRING + TYRE)
"""Spring and tyre in series [N/m]."""

FRICTION = 60.0
"""Friction force of its damper [N]."""


def slip_amplitude() -> Exercise:
    """Return exercise 1.1: plate amplitude at 2 Hz from which the damper slips, Z = F / (m w^2)."""
    w = TURN * 2.0
    value = 1e3 * FRICTION / (BODY * w**2)
    return Exercise(
        value,
        "mm",
        0.02,
        (
            Slip(value * TURN**2, "2 Hz is a frequency f; the formula has w = 2 pi f"),
            Slip(value * w, "the acceleration of a sine is w^2 Z, not w Z"),
            Slip(value / math.sqrt(2.0), "that is an RMS; slip begins at the peak, and asked is the amplitude"),
            Slip(1e3 * FRICTION / SPRING, "while the damper sticks the spring keeps its length: its force is constant"),
        ),
        "while the damper sticks, friction alone moves the body: F = m w^2 Z at the peak",
    )


def equivalent_damping() -> Exercise:
    """Return exercise 1.2: viscous damping with the loss of friction, c = 4 F / (pi w X), X = 5 mm at 1.25 Hz."""
    w = TURN * 1.25
    value = 4.0 * FRICTION / (math.pi * w * 5e-3)
    return Exercise(
        value,
        "N s/m",
        0.02,
        (
            Slip(value * TURN, "1.25 Hz is a frequency f; the formula has w = 2 pi f"),
            Slip(value * math.sqrt(2.0), "X is the amplitude of the stroke, not its RMS"),
            Slip(FRICTION / (w * 5e-3), "equal peak forces are not equal losses: compare the work of a cycle"),
            Slip(value / 4.0, "a cycle has four quarter strokes: friction takes 4 F X"),
            Slip(value / 2.0, "a cycle goes there and back: friction takes 4 F X"),
        ),
        "friction takes 4 F X in a cycle, a viscous damper pi c w X^2",
    )


def random_error() -> Exercise:
    """Return exercise 2.1: relative standard error of |H|, sqrt((1 - g2) / (2 n g2)), coherence g2 0.8, 20 windows."""
    coherence, windows = 0.8, 20
    value = 100.0 * math.sqrt((1.0 - coherence) / (2 * windows * coherence))
    squared = coherence**2
    return Exercise(
        value,
        "%",
        0.02,
        (
            Slip(
                value * math.sqrt(2.0),
                "noise has two parts, in phase and a quarter period off; only one changes |H|: 2 n",
            ),
            Slip(100.0 * math.sqrt((1.0 - squared) / (2 * windows * squared)), "the coherence is g2 itself already"),
            Slip(value**2 / 100.0, "that is the variance; the standard error is its root"),
            Slip(value * math.sqrt(windows), "that is the error of one window; n windows make it smaller"),
        ),
        "put the coherence and n = 20 into the formula of the page, and take the root",
    )


def response_level() -> Exercise:
    """Return exercise 2.2: RMS of the response, |H| sqrt(G B), |H| = 1500 1/s2, G = 1e-8 m2/Hz from 4 to 8 Hz."""
    gain, density, band = 1500.0, 1e-8, 4.0
    value = gain * math.sqrt(density * band)
    return Exercise(
        value,
        "m/s2",
        0.02,
        (
            Slip(value * math.sqrt(2.0), "the density is one-sided: negative frequencies are in it already"),
            Slip(value / math.sqrt(2.0), "the density is one-sided: its integral over 4 to 8 Hz is the mean square"),
            Slip(math.sqrt(gain * density * band), "a density is a square: it passes with |H|^2"),
            Slip(gain**2 * density * band, "that is the mean square; the RMS is its root"),
        ),
        "mean square = |H|^2 times density times bandwidth, RMS = its root",
    )


def wheel_hop() -> Exercise:
    """Return exercise 3.1: natural frequency of the wheel with the body at rest, sqrt((k + kt) / mu) / 2 pi."""
    value = math.sqrt((SPRING + TYRE) / WHEEL) / TURN
    return Exercise(
        value,
        "Hz",
        0.01,
        (
            Slip(value * TURN, "that is w in rad/s; f = w / 2 pi"),
            Slip(math.sqrt(TYRE / WHEEL) / TURN, "the wheel moves between tyre and spring: both push it back"),
            Slip(math.sqrt(SERIES / WHEEL) / TURN, "the springs act side by side on the wheel: their stiffnesses add"),
            Slip(math.sqrt((SPRING + TYRE) / BODY) / TURN, "the wheel moves, not the body: use its mass"),
        ),
        "f = sqrt(stiffness / mass) / 2 pi, with the mass that moves and all springs that it compresses",
    )


def stuck_heave() -> Exercise:
    """Return exercise 3.2: heave with the damper stuck, body and wheel as one mass: sqrt(kt / (ms + mu)) / 2 pi."""
    value = math.sqrt(TYRE / (BODY + WHEEL)) / TURN
    return Exercise(
        value,
        "Hz",
        0.01,
        (
            Slip(value * TURN, "that is w in rad/s; f = w / 2 pi"),
            Slip(math.sqrt(TYRE / BODY) / TURN, "the wheel moves with the body: add its mass"),
            Slip(math.sqrt(SERIES / BODY) / TURN, "that is the heave of a sliding damper; here the strut is rigid"),
        ),
        "with a rigid strut one mass stands on one spring: which mass, which spring?",
    )


def weighting_k(frequency: float) -> float:
    """Return |Wk| at a frequency [Hz], from the four filters of ISO 2631-1."""
    s = 1j * TURN * frequency
    w1, w2, w3, w4, w5, w6 = (TURN * corner for corner in (0.4, 100.0, 12.5, 12.5, 2.37, 3.35))
    band = s**2 / (s**2 + math.sqrt(2.0) * w1 * s + w1**2) * w2**2 / (s**2 + math.sqrt(2.0) * w2 * s + w2**2)
    transition = (1.0 + s / w3) / (1.0 + s / (0.63 * w4) + (s / w4) ** 2)
    step = (1.0 + s / (0.91 * w5) + (s / w5) ** 2) / (1.0 + s / (0.91 * w6) + (s / w6) ** 2) * (w5 / w6) ** 2
    return abs(band * transition * step)


def weighted_sine() -> Exercise:
    """Return exercise 4.1: weighted RMS of a vertical sine of 0.8 m/s2 at 16 Hz: |Wk| A / sqrt(2)."""
    amplitude, gain = 0.8, weighting_k(16.0)
    value = gain * amplitude / math.sqrt(2.0)
    return Exercise(
        value,
        "m/s2",
        0.01,
        (
            Slip(gain * amplitude, "0.8 m/s2 is the peak of the sine; an RMS is asked"),
            Slip(amplitude / math.sqrt(2.0), "that is the RMS without the weighting"),
            Slip(gain**2 * amplitude / math.sqrt(2.0), "the weighting acts on the acceleration itself: once"),
            Slip(gain * amplitude / 2.0, "the RMS of a sine is its peak over the root of 2"),
        ),
        "first the RMS of the sine, then times |Wk| at 16 Hz from the table of the page",
    )


def two_roads() -> Exercise:
    """Return exercise 4.2: RMS over 15 min with 0.3 and 5 min with 0.9 m/s2, from the mean of the squares over time."""
    parts = ((15.0, 0.3), (5.0, 0.9))
    whole = sum(minutes for minutes, _ in parts)
    value = math.sqrt(sum(minutes * level**2 for minutes, level in parts) / whole)
    return Exercise(
        value,
        "m/s2",
        0.01,
        (
            Slip(sum(minutes * level for minutes, level in parts) / whole, "squares are averaged, not levels"),
            Slip(
                math.sqrt((0.3**2 + 0.9**2) / 2.0), "the smooth road lasts three times as long: weight with the times"
            ),
            Slip(0.6, "the parts last different times, and squares are averaged, not levels"),
            Slip(value**2, "that is the mean square; take its root"),
            Slip(math.hypot(0.3, 0.9), "squares of axes add up; squares of times in a row are averaged"),
        ),
        "the RMS of the whole is the root of the mean square over the whole time",
    )


def road_band() -> Exercise:
    """Return exercise 5.1: RMS height of class B from 1 to 2 Hz at 72 km/h, sqrt(G0 n0^2 (1/n1 - 1/n2))."""

    def height(speed: float, turn: float = 1.0) -> float:
        low, high = turn * 1.0 / speed, turn * 2.0 / speed
        return 1e3 * math.sqrt(64e-6 * 0.1**2 * (1.0 / low - 1.0 / high))

    value = height(20.0)
    return Exercise(
        value,
        "mm",
        0.01,
        (
            Slip(height(72.0), "km/h is no SI unit: V = 72 / 3.6 m/s"),
            Slip(value * math.sqrt(2.0), "the density is one-sided: nothing to double"),
            Slip(value / math.sqrt(2.0), "the density is one-sided: nothing to halve"),
            Slip(height(20.0, TURN), "n counts waves per metre, f / V, without 2 pi"),
            Slip(height(1.0), "frequencies over time become waves per metre: n = f / V"),
            Slip(value**2 * 1e-3, "that is the mean square; take its root"),
        ),
        "n = f / V for both ends of the band, then integrate G(n) from n1 to n2 and take the root",
    )


def quiet_speed() -> Exercise:
    """Return exercise 5.2: highest speed at which a wheelbase of 2.6 m moves the axles oppositely at 1.3 Hz: 2 f L."""
    frequency, wheelbase = 1.3, 2.6
    value = 3.6 * 2.0 * frequency * wheelbase
    return Exercise(
        value,
        "km/h",
        0.01,
        (
            Slip(value / 2.0, "after a whole wave both axles rise together; after half a wave they move oppositely"),
            Slip(value / 3.6, "that number is in m/s; 1 m/s = 3.6 km/h"),
            Slip(value * 3.6, "2 f L is in m/s, so its number times 3.6 is in km/h, once"),
            Slip(value * TURN, "no 2 pi here: a wave of length V / f passes in one period 1 / f"),
            Slip(value / 3.0, "that is the second speed, with one and a half waves; asked is the highest"),
        ),
        "the rear axle follows L / V later; for which V is that half a period?",
    )


def decay() -> Exercise:
    """Return exercise 6.1: damping ratio from two peaks three cycles apart, 10 and 2 mm: d / sqrt(4 pi^2 + d^2)."""
    decrement = math.log(10.0 / 2.0) / 3
    value = 100.0 * decrement / math.hypot(TURN, decrement)
    ten = math.log10(10.0 / 2.0) / 3
    once, fourth = math.log(5.0), math.log(5.0) / 4
    return Exercise(
        value,
        "%",
        0.01,
        (
            Slip(100.0 * ten / math.hypot(TURN, ten), "the decrement is a natural logarithm"),
            Slip(100.0 * once / math.hypot(TURN, once), "three cycles lie between the peaks: a third of the logarithm"),
            Slip(100.0 * fourth / math.hypot(TURN, fourth), "from peak 0 to peak 3 there are three cycles, not four"),
            Slip(100.0 * decrement, "that is the decrement; the damping ratio is about a 2 pi-th of it"),
        ),
        "decrement d = ln(first / last) / number of cycles, then zeta = d / sqrt(4 pi^2 + d^2)",
    )


SPEEDS, FORCES = (0.05, 0.10, 0.20, 0.40), (95.0, 160.0, 310.0, 610.0)
"""Readings of exercise 6.2: speed of a damper [m/s] and its force [N]."""


def fitted_line() -> Exercise:
    """Return exercise 6.2: slope of the line of least squares F + c v through `SPEEDS` and `FORCES`."""
    count = len(SPEEDS)
    speed, force = sum(SPEEDS) / count, sum(FORCES) / count
    cross = sum((v - speed) * (f - force) for v, f in zip(SPEEDS, FORCES, strict=True))
    value = cross / sum((v - speed) ** 2 for v in SPEEDS)
    origin = sum(v * f for v, f in zip(SPEEDS, FORCES, strict=True)) / sum(v**2 for v in SPEEDS)
    ratios = sum(f / v for v, f in zip(SPEEDS, FORCES, strict=True)) / count
    return Exercise(
        value,
        "N s/m",
        0.003,
        (
            Slip(origin, "that line goes through the origin; with friction the force at v = 0 is not zero"),
            Slip(ratios, "the mean of F / v counts the friction of slow readings as damping"),
            Slip((610.0 - 95.0) / 0.35, "that line has two of the four readings only"),
        ),
        "c = sum (v - mean v)(F - mean F) / sum (v - mean v)^2",
    )


def softest_ride() -> Exercise:
    """Return exercise 7.1: damping with the least acceleration of the body on a road, k sqrt((ms + mu) / kt)."""
    value = SPRING * math.sqrt((BODY + WHEEL) / TYRE)
    return Exercise(
        value,
        "N s/m",
        0.01,
        (
            Slip(SPRING * math.sqrt(BODY / TYRE), "both masses act on the tyre: ms + mu"),
            Slip(2.0 * math.sqrt(SPRING * BODY), "that is critical damping; a ride needs much less"),
            Slip(SPRING * math.sqrt(TYRE / (BODY + WHEEL)), "the fraction under the root is upside down"),
            Slip(SPRING * (BODY + WHEEL) / TYRE, "take the root of the fraction"),
        ),
        "set the derivative of the mean square of the page to zero: c^2 = k^2 (ms + mu) / kt",
    )


def lever() -> Exercise:
    """Return exercise 7.2: damper constant for 1500 N s/m at a wheel that moves 1 m for 0.6 m of stroke: c / i^2."""
    ratio, wheel_damping = 0.6, 1500.0
    value = wheel_damping / ratio**2
    return Exercise(
        value,
        "N s/m",
        0.01,
        (
            Slip(wheel_damping / ratio, "the lever acts twice: on the stroke, and on the force"),
            Slip(wheel_damping * ratio**2, "the damper moves less than the wheel, so it must be stronger"),
            Slip(wheel_damping * ratio, "the damper moves less than the wheel, so it must be stronger"),
        ),
        "equal power at the wheel and at the damper: c_w v_w^2 = c_d v_d^2, v_d = i v_w",
    )


def smallest_change() -> Exercise:
    """Return exercise 8.1: factor on c in the smallest change of c and k that raises c / (2 sqrt(k m)) by 20 %."""
    aim = math.log(1.2)
    value = math.exp(aim / (1.0 + 0.5**2))
    return Exercise(
        value,
        "-",
        0.01,
        (
            Slip(1.2, "the spring may change too; then the damper needs less"),
            Slip(math.exp(aim / 1.5), "equal parts are not the smallest change: the spring acts only with its root"),
            Slip(math.exp(-0.5 * aim / 1.25), "that is the factor on the spring k"),
            Slip(1.2**0.5, "equal parts of the aim are not the smallest change"),
        ),
        "ln c - (ln k) / 2 = ln 1.2; the shortest way goes along the gradient (1, -1/2)",
    )


def safe_value() -> Exercise:
    """Return exercise 8.2: largest value below 0.80 m/s2 at 95 %, standard error 4 %: u / (1 + 1.645 e)."""
    limit, error = 0.80, 0.04
    value = limit / (1.0 + 1.6449 * error)
    return Exercise(
        value,
        "m/s2",
        0.005,
        (
            Slip(limit / (1.0 + 1.96 * error), "only too large is a failure: one side, 1.645 standard errors"),
            Slip(limit * (1.0 - 1.96 * error), "only too large is a failure: one side, 1.645 standard errors"),
            Slip(limit / (1.0 + error), "one standard error leaves one car in six above the limit"),
            Slip(limit * (1.0 + 1.6449 * error), "the margin must lie below the limit"),
            Slip(limit, "at the limit itself every second car is above it"),
        ),
        "value + 1.645 standard errors = limit, with a standard error of 4 % of the value",
    )


EXERCISES = {
    "1.1": slip_amplitude(),
    "1.2": equivalent_damping(),
    "2.1": random_error(),
    "2.2": response_level(),
    "3.1": wheel_hop(),
    "3.2": stuck_heave(),
    "4.1": weighted_sine(),
    "4.2": two_roads(),
    "5.1": road_band(),
    "5.2": quiet_speed(),
    "6.1": decay(),
    "6.2": fitted_line(),
    "7.1": softest_ride(),
    "7.2": lever(),
    "8.1": smallest_change(),
    "8.2": safe_value(),
}
"""Number of an exercise to the exercise; the number before the point is the lesson."""
