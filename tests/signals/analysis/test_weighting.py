import numpy as np
import pytest
from scipy.signal import lsim

from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.evaluation import evaluate
from vehicle.signals.analysis.weighting import WEIGHTINGS, weighted_record, weighting


def row(text):
    return [None if word == "-" else float(word) for word in text.split()]


CENTRES = row(
    "0.1 0.125 0.16 0.2 0.25 0.315 0.4 0.5 0.63 0.8 1 1.25 1.6 2 2.5 3.15 4 5 6.3 8 10 12.5 16 20 25 31.5 40 50 63 80"
)
SICKNESS_CENTRES = [*row("0.02 0.025 0.0315 0.04 0.05 0.063 0.08"), *CENTRES[:14]]

PRINTED = {
    "Wk": row(
        "31.2 48.6 79.0 121 182 263 352 418 459 477 482 484 494 531 631 804 967 1039 1054 1036 "
        "988 902 768 636 513 405 314 246 186 132"
    ),
    "Wd": row(
        "62.4 97.3 158 243 365 530 713 853 944 992 1011 1008 968 890 776 642 512 409 323 253 "
        "- 161 125 100 80.0 63.2 49.4 38.8 29.5 21.1"
    ),
    "Wc": row(
        "62.4 97.2 158 243 364 527 708 843 929 972 991 1000 1007 1012 1017 1022 1024 1013 974 891 "
        "776 647 512 409 325 256 199 156 118 84.4"
    ),
    "We": row(
        "62.5 97.5 159 245 368 536 723 862 939 941 880 772 632 512 409 323 253 202 160 125 "
        "100 80.1 62.5 50.0 39.9 31.6 24.7 19.4 14.8 10.5"
    ),
    "Wj": row(
        "31.0 48.3 78.5 120 181 262 351 417 458 478 484 485 483 482 489 524 - 793 946 1017 "
        "1030 1026 1018 1012 1007 1001 991 972 931 843"
    ),
    "Wf": row("24.2 37.7 59.7 97.1 157 267 461 695 895 1006 992 854 619 384 224 116 53.0 23.5 9.98 3.77 1.55"),
}
"""Factors times 1000 of ISO 2631-1:1997, tables 3 and 4. Two entries are left out. Wd at 10 Hz: the factor is printed
as 212, but its neighbours 253 and 161 and the decibel column (-13.9 dB = 202) show a misprint. Wj at 4 Hz: read as 528
from a copy, between 524 and 793; 628 is what a smooth curve needs, so the copy is not a witness."""


@pytest.mark.parametrize("name", PRINTED)
def test_factors_are_those_printed_in_the_standard(name):
    """ISO 2631-1:1997, tables 3 and 4: at the nominal frequencies the rounded digits agree within 0.7 %."""
    centres = SICKNESS_CENTRES if name == "Wf" else CENTRES
    assert len(centres) == len(PRINTED[name])
    pairs = [(f, p) for f, p in zip(centres, PRINTED[name], strict=True) if p is not None]
    found = 1000 * weighting(name).spectrum_factor([f for f, _ in pairs])
    # three printed digits are up to 0.5 % of a value, two (1.55 and below are left) a little more; the issue asks 1 %
    validated(
        "Comfort, ISO 2631", f"factors of {name} times 1000 at the third octaves", found,
        np.array([p for _, p in pairs]), rel=0.007,
        source="standard: ISO 2631-1:1997, {}".format("table 4" if name in ("Wc", "We", "Wj") else "table 3"),
    )  # fmt: skip


def test_the_omitted_entries_lie_between_their_neighbours():
    # the decibel column of the table prints -13.91 dB for Wd at 10 Hz
    validated(
        "Comfort, ISO 2631", "factor of Wd at 10 Hz", weighting("Wd").spectrum_factor(10.0), 10 ** (-13.91 / 20),
        rel=1e-3, source="standard: ISO 2631-1:1997, table 3, decibel column",
    )  # fmt: skip
    assert weighting("Wj").spectrum_factor(4.0) == pytest.approx(0.628, rel=1e-3)


def test_the_weighting_of_a_steering_wheel_follows_its_straight_lines():
    """Giacomin et al. 2004: slopes in decibel an octave between corners, 0 dB from 3 to 6.3 Hz."""
    corners, slopes = [3.0, 6.3, 50.0, 160.0, 315.0], [0.0, -6.0, 0.0, -10.0]
    levels = np.concatenate([[0.0], np.cumsum(slopes * np.diff(np.log2(corners)))])
    frequency = np.geomspace(3.0, 315.0, 300)
    validated(
        "Comfort, ISO 2631", "level of Ws of a steering wheel from 3 to 315 Hz",
        20.0 * np.log10(weighting("Ws").spectrum_factor(frequency)),
        np.interp(np.log2(frequency), np.log2(corners), levels),
        abs=0.53, unit="dB",  # the filter rounds the corners of the lines; ISO 8041 allows 1 dB
        source="publication: Giacomin et al., Int. J. Industrial Ergonomics 33 (2004) 527-541",
    )  # fmt: skip


def test_a_vibration_of_a_steering_wheel_has_its_weighted_rms():
    rate, levels = 1000.0, {6.3: 0.0, 12.6: -6.0, 25.2: -12.0}
    for frequency, level in levels.items():
        record = np.sin(2.0 * np.pi * frequency * np.arange(int(60 * rate)) / rate)
        found = evaluate(1.0 / rate, np.array([record, record, 0.0 * record]), contact="steering_wheel", skip=5.0)
        # Within 0.53 dB of the lines, and no dose values.
        assert found.axes["y"].weighted_rms * np.sqrt(2.0) == pytest.approx(10.0 ** (level / 20.0), rel=0.065)
        assert (found.axes["y"].weighting, found.axes["y"].vdv) == ("Ws", None)


NONE = np.inf
PARAMETERS = {
    "Wk": (0.4, 100.0, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91),
    "Wd": (0.4, 100.0, 2.0, 2.0, 0.63, NONE, NONE, NONE, NONE),
    "Wf": (0.08, 0.63, NONE, 0.25, 0.86, 0.0625, 0.80, 0.10, 0.80),
    "Wc": (0.4, 100.0, 8.0, 8.0, 0.63, NONE, NONE, NONE, NONE),
    "We": (0.4, 100.0, 1.0, 1.0, 0.63, NONE, NONE, NONE, NONE),
    "Wj": (0.4, 100.0, NONE, NONE, NONE, 3.75, 0.91, 5.32, 0.91),
    "Wb": (0.4, 100.0, 16.0, 16.0, 0.55, 2.5, 0.90, 4.0, 0.95),
}
"""f1, f2, f3, f4 [Hz], Q4, f5 [Hz], Q5, f6 [Hz], Q6: ISO 2631-1:1997, tables A.1 and A.2; Wb: BS 6841:1987."""

GAIN = {"Wb": 0.4 * (4.0 / 2.5) ** 2}
"""Factor of a weighting: K (f6/f5)^2 of BS 6841; 1 in ISO 2631-1."""


def printed_polynomials(name):
    """Numerator and denominator in s from the printed parameters: nothing of the program is in them."""
    return multiplied_out(PARAMETERS[name], GAIN.get(name, 1.0))


def polynomials(name):
    """Numerator and denominator in s from the parameters of the program."""
    w = weighting(name)
    return multiplied_out((w.f1, w.f2, w.f3, w.f4, w.q4, w.f5, w.q5, w.f6, w.q6), w.gain)


def multiplied_out(parameters, gain):
    """Numerator and denominator in s, multiplied out: a second derivation, from polynomials instead of ratios."""
    f1, f2, f3, f4, q4, f5, q5, f6, q6 = parameters
    w1, w2, w3, w4, w5, w6 = (2 * np.pi * f for f in (f1, f2, f3, f4, f5, f6))
    numerator = np.polymul([1.0, 0.0, 0.0], [w2**2])
    denominator = np.polymul([1.0, np.sqrt(2) * w1, w1**2], [1.0, np.sqrt(2) * w2, w2**2])
    if np.isfinite(w4):
        numerator = np.polymul(numerator, [w4**2 / w3, w4**2] if np.isfinite(w3) else [w4**2])
        denominator = np.polymul(denominator, [1.0, w4 / q4, w4**2])
    if np.isfinite(w5):
        numerator = np.polymul(numerator, [1.0, w5 / q5, w5**2])
        denominator = np.polymul(denominator, [1.0, w6 / q6, w6**2])
    return gain * np.atleast_1d(numerator), denominator


@pytest.mark.parametrize("name", WEIGHTINGS)
def test_the_transfer_function_is_the_quotient_of_its_polynomials(name):
    frequency = np.geomspace(0.01, 400.0, 200)
    numerator, denominator = polynomials(name)
    expected = np.polyval(numerator, 2j * np.pi * frequency) / np.polyval(denominator, 2j * np.pi * frequency)
    validated(
        "Comfort, ISO 2631", f"transfer function of {name}, 0.01 to 400 Hz",
        weighting(name).transfer_function(frequency), expected, rel=1e-9,
        source="second derivation: polynomials in s, multiplied out",
    )  # fmt: skip
    assert weighting(name).transfer_function(0.0) == 0.0


def test_wb_in_the_form_of_bs_6841():
    """BS 6841:1987 writes the step as (s^2 + w5 s/Q + w5^2) / (s^2 + w6 s/Q + w6^2) * (f6/f5)^2 with K = 0.4."""
    frequency = np.geomspace(0.1, 200.0, 100)
    s = 2j * np.pi * frequency
    w = [2 * np.pi * f for f in (0.4, 100.0, 16.0, 16.0, 2.5, 4.0)]
    band = s**2 * w[1] ** 2 / ((s**2 + w[0] / 0.71 * s + w[0] ** 2) * (s**2 + w[1] / 0.71 * s + w[1] ** 2))
    transition = (s + w[2]) / (s**2 + w[3] / 0.55 * s + w[3] ** 2) * 2 * np.pi * 16.0
    step = 0.4 * (s**2 + w[4] / 0.9 * s + w[4] ** 2) / (s**2 + w[5] / 0.95 * s + w[5] ** 2) * (4.0 / 2.5) ** 2
    # the British standard rounds 1/sqrt(2) to 0.71
    validated(
        "Comfort, ISO 2631", "factors of Wb, 0.1 to 200 Hz", weighting("Wb").spectrum_factor(frequency),
        np.abs(band * transition * step), rel=0.005, source="standard: BS 6841:1987, transfer functions",
    )  # fmt: skip


ANNEX = ("ISO 2631-1:1997, annex A", "BS 6841:1987")
"""Standards that print the transfer functions."""


@pytest.mark.parametrize("rate", [1000, 500])
@pytest.mark.parametrize("name", ["Wk", "Wd", "Wc", "We", "Wj", "Wb"])
def test_the_record_of_a_sine_is_weighted_like_the_analogue_filter(name, rate):
    time = np.arange(30 * rate) / rate
    ratios = []
    for frequency in (f for f in CENTRES if f >= 0.5):
        phase = 2 * np.pi * frequency * time
        # after 15 s the transient has fallen by exp(-26); a sine and a cosine are fitted to the ten seconds from there
        steady = slice(15 * rate, 25 * rate)
        found = weighted_record(1 / rate, np.sin(phase), name)[steady]
        basis = np.column_stack((np.sin(phase), np.cos(phase)))[steady]
        (real, imaginary), *_ = np.linalg.lstsq(basis, found)
        # 1 % is asked, in modulus; the method is exact but for the ringing of the broken-off end, 5 s away
        numerator, denominator = (np.polyval(p, 2j * np.pi * frequency) for p in printed_polynomials(name))
        ratios.append((real + 1j * imaginary) * denominator / numerator)
    validated(
        "Comfort, ISO 2631", f"sines of 0.5 to 80 Hz weighted with {name} at {rate} Hz, over the analogue filter",
        np.array(ratios), 1.0, abs=1e-4, source=f"standard: {ANNEX[name == 'Wb']}, from its printed parameters",
    )  # fmt: skip


def test_motion_sickness_weighting_of_a_slow_record():
    rate = 10
    time = np.arange(4000 * rate) / rate
    for frequency in (0.05, 0.1, 0.2, 0.5):
        found = weighted_record(1 / rate, np.sin(2 * np.pi * frequency * time), "Wf")[1000 * rate :]
        expected = 1e-3 * PRINTED["Wf"][SICKNESS_CENTRES.index(frequency)] / np.sqrt(2)
        validated(
            "Comfort, ISO 2631", f"RMS of a sine of {frequency:g} Hz weighted with Wf", np.sqrt(np.mean(found**2)),
            expected, rel=0.007, source="standard: ISO 2631-1:1997, table 3",
        )  # fmt: skip


def bump(time):
    """A smooth bump from 1 to 1.4 s: its content above 100 Hz is below 1e-6 of its peak."""
    inside = (time > 1.0) & (time < 1.4)
    return np.where(inside, np.sin(np.pi * (time - 1.0) / 0.4) ** 6, 0.0)


@pytest.mark.parametrize("rate", [1000, 500])
@pytest.mark.parametrize("name", ["Wk", "Wd", "Wj", "Wf", "Wb"])
def test_a_weighted_bump_solves_the_differential_equation_and_is_causal(name, rate):
    # second derivation: the filter's differential equation, integrated exactly for a 20 times finer input
    numerator, denominator = printed_polynomials(name)
    fine = np.arange(round(4.0 * 10_000)) / 10_000
    scale = 2 * np.pi  # time in radians of 1 Hz: keeps the coefficients of s^8 within reach
    order = denominator.size - 1
    shrink = scale ** -np.arange(order, -1.0, -1.0)
    numerator = numerator * scale ** np.arange(numerator.size - 1.0, -1.0, -1.0)
    _, expected, _ = lsim((numerator, denominator / shrink), bump(fine), fine * scale)
    expected = expected[:: 10_000 // rate]
    found = weighted_record(1 / rate, bump(np.arange(4 * rate) / rate), name)
    peak = np.abs(expected).max()
    # linear interpolation at 10 kHz is good to 1e-5; rounding of the companion form 1e-6
    validated(
        "Comfort, ISO 2631", f"a bump weighted with {name} at {rate} Hz", found, expected, peak=1e-4,
        source=foreign("scipy", "lsim of the differential equation of the standard at 10 kHz"),
    )  # fmt: skip
    # causal: at rest until the bump begins
    assert np.abs(found[:rate]).max() < 1e-5 * peak


def test_an_unknown_weighting_is_rejected_with_the_known_names():
    with pytest.raises(ConfigurationError) as refusal:
        weighting("Wx")
    assert str(refusal.value) == "weighting: must be one of Wk, Wd, Wf, Wc, We, Wj, Wb, Wb_en12299, Wh, Ws, not 'Wx'"


def test_a_frequency_that_is_not_finite_is_rejected():
    with pytest.raises(ConfigurationError, match="Wk: frequencies must be finite"):
        weighting("Wk").spectrum_factor(np.nan)


@pytest.mark.parametrize("name", WEIGHTINGS)
def test_a_filter_has_settled_when_its_step_response_stays_below_a_hundredth(name):
    curve, rate = weighting(name), 250
    response = np.abs(weighted_record(1 / rate, np.ones(80 * rate), name))
    last = np.flatnonzero(response[: 79 * rate] > 0.01 * response.max())[-1] / rate  # the end rings for Wj
    assert 0.5 * curve.settling_s < last < curve.settling_s
    # the range of the standard, and one over the width of its lowest third octave
    lowest, shortest = {"Wf": (0.1, 43.2), "Wh": (7.887, 0.5475), "Ws": (3.0, 1.439)}.get(name, (0.5, 8.64))
    assert curve.lowest_frequency == pytest.approx(lowest, rel=1e-3)
    assert curve.shortest_record_s == pytest.approx(shortest, rel=1e-3)
    assert curve.highest_frequency == {"Wf": 0.5, "Wh": 1000.0, "Ws": 320.0}.get(name, 80.0)
