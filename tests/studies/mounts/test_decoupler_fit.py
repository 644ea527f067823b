"""Hydromount with a decoupler: harmonic balance against time integration, and fitted to noisy synthetic points."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.studies.mounts.test_mount_fit import FREQUENCY, HYDRAULIC, hydraulic_point
from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.studies.mounts.decoupler_balance import DecouplerBalance, decoupled_stiffness, describing_function
from vehicle.studies.mounts.measured_stiffness import MeasuredStiffness
from vehicle.studies.mounts.mount_fit import fit_mount

VALUES = np.array([2e5, 150.0, 4e5, 80.0, 1200.0, 3e-4, 1.0, 60.0, 2e3, 5e5])
"""Mount of the theory page, with the seat of the example of the vehicle file."""

AMPLITUDE = np.array([0.1e-3, 0.5e-3, 1.5e-3])
"""One amplitude within the gap, two beyond it."""

SUBJECT = "Sweeps, tuning and optimisation"


def slopes(values, state, mount):
    """Rates of displacements and velocities of track and decoupler, and the force of the chamber, under a motion."""
    _, _, chamber, mass, flow, gap, disc, leak, membrane, seat = values
    x, y, x_rate, y_rate = state
    pressed = chamber * (mount - x - y)
    seated = seat * (y - np.clip(y, -gap, gap))
    return np.array(
        [x_rate, y_rate, (pressed - flow * x_rate) / mass, (pressed - leak * y_rate - membrane * y - seated) / disc]
    ), pressed


def complete(values, omega, amplitude, pressed):
    """Dynamic stiffness of the mount from the first harmonic of the force of its chamber."""
    return values[0] + 1j * omega * values[1] + pressed / amplitude


def stiff_solution(values, omega, amplitude):
    """Dynamic stiffness by an adaptive solver, over four periods after 1.6 s."""
    period = 2.0 * np.pi / omega
    times = period * (np.ceil(1.6 / period) + np.arange(1600) / 400)

    _, _, chamber, mass, flow, gap, disc, leak, membrane, seat = values.tolist()

    def rates(time, state):
        """`slopes` in plain numbers: the solver asks 100 000 times."""
        x, y, x_rate, y_rate = state.tolist()
        pressed = chamber * (amplitude * math.cos(omega * time) - x - y)
        seated = seat * (y - min(max(y, -gap), gap))
        return (
            x_rate,
            y_rate,
            (pressed - flow * x_rate) / mass,
            (pressed - leak * y_rate - membrane * y - seated) / disc,
        )

    state = solve_ivp(
        rates, (0.0, times[-1]), np.zeros(4), "DOP853", times, rtol=1e-7, atol=1e-11, max_step=period / 60
    )
    pressed = slopes(values, state.y, amplitude * np.cos(omega * times))[1]
    return complete(values, omega, amplitude, 2.0 * np.mean(pressed * np.exp(-1j * omega * times)))


def integrated(values, omega, amplitude, step=2e-4, settle=1.6):
    """Dynamic stiffness of all points by Runge and Kutta's method of order 4, over three periods after `settle`."""
    period = 2.0 * np.pi / omega
    per_period = np.ceil(period / step)
    h, first = period / per_period, per_period * np.ceil(settle / period)
    last, state, total = first + 3.0 * per_period, np.zeros((4, len(omega))), np.zeros(len(omega), dtype=complex)
    for count in range(int(np.max(last))):
        z = [amplitude * np.cos(omega * h * (count + part)) for part in (0.0, 0.5, 1.0)]
        k1, pressed = slopes(values, state, z[0])
        inside = (count >= first) & (count < last)
        total += np.where(inside, pressed * np.exp(-1j * omega * h * count), 0.0)
        k2 = slopes(values, state + 0.5 * h * k1, z[1])[0]
        k3 = slopes(values, state + 0.5 * h * k2, z[1])[0]
        k4 = slopes(values, state + h * k3, z[2])[0]
        state = state + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return complete(values, omega, amplitude, 2.0 * total / (3.0 * per_period))


@pytest.fixture(scope="module")
def points():
    """Frequencies, amplitudes and stiffness by time integration."""
    frequency, amplitude = (grid.ravel() for grid in np.meshgrid(FREQUENCY, AMPLITUDE))
    return frequency, amplitude, integrated(VALUES, 2.0 * np.pi * frequency, amplitude)


def noisy(points, seed):
    """Points with 3 % of noise on stiffness, and 0.03 rad on the loss angle."""
    frequency, amplitude, exact = points
    relative, angle = 0.03 * np.random.default_rng(seed).standard_normal((2, len(exact)))
    return MeasuredStiffness(frequency=frequency, amplitude=amplitude, stiffness=exact * np.exp(relative + 1j * angle))


def errors(found, exact):
    """Largest relative error of the stiffness, and largest error of the loss angle [deg]."""
    ratio = np.asarray(found / exact)
    return float(np.max(np.abs(np.abs(ratio) - 1.0))), float(np.max(np.abs(np.degrees(np.angle(ratio)))))


@pytest.mark.parametrize("ratio", [0.5, 1.01, 2.0, 50.0])
def test_the_describing_function_is_the_first_harmonic_of_the_gap(ratio):
    phase = 2.0 * np.pi * (np.arange(200_000) + 0.5) / 200_000
    y = ratio * np.cos(phase)
    exact = 2.0 * np.mean((y - np.clip(y, -1.0, 1.0)) * np.cos(phase)) / ratio
    validated(
        SUBJECT, f"describing function of a gap at {ratio:g} times the gap", describing_function(ratio, 1.0), exact,
        abs=1e-8, source="second derivation: Fourier integral by 200 000 points",
    )  # fmt: skip


@pytest.mark.parametrize("amplitude", [0.35e-3, 1e-3, 3e-3])
def test_the_harmonic_balance_is_the_steady_state_of_an_adaptive_solver(amplitude):
    # The stiff seat of the theory page: the decoupler bounces at 246 Hz, the 22nd multiple of the frequency.
    values, omega = np.array([*VALUES[:-1], 2e6]), 22.0 * np.pi
    exact = stiff_solution(values, omega, amplitude)
    found = decoupled_stiffness(values, np.array([omega]), np.array([amplitude]))[0]
    claim, source = f"decoupler by 16 odd harmonics, 11 Hz, {1e3 * amplitude:g} mm", foreign("scipy", "DOP853, 1e-7")
    validated(
        SUBJECT, f"{claim}: dynamic stiffness", abs(found), abs(exact), rel=1e-3, unit="N/m", source=source
    )  # fmt: skip
    validated(
        SUBJECT, f"{claim}: loss angle", np.degrees(np.angle(found)), np.degrees(np.angle(exact)), abs=0.05,
        unit="deg", source=source,
    )  # fmt: skip


def test_the_balance_agrees_with_time_integration_at_all_points(points):
    frequency, amplitude, exact = points
    stiffness, angle = errors(decoupled_stiffness(VALUES, 2.0 * np.pi * frequency, amplitude), exact)
    source = "second derivation: Runge and Kutta, steps of 0.2 ms"
    claim = "decoupler by 16 odd harmonics, 48 points, 1 to 50 Hz"
    validated(SUBJECT, f"{claim}: largest error of the stiffness", stiffness, 0.0, abs=1e-3, source=source)
    validated(SUBJECT, f"{claim}: largest error of the loss angle", angle, 0.0, abs=0.05, unit="deg", source=source)


def test_a_previous_solution_does_not_change_the_result(points):
    frequency, amplitude, _ = points
    omega, balance = 2.0 * np.pi * frequency, DecouplerBalance()
    balance(VALUES * 1.05, omega, amplitude)
    warm, cold = balance(VALUES, omega, amplitude), decoupled_stiffness(VALUES, omega, amplitude)
    np.testing.assert_allclose(warm, cold, rtol=1e-9)


def test_a_fit_finds_the_decoupler_in_noise(points):
    found = []
    for seed in range(2):
        data = noisy(points, seed)
        best, second, *_ = fit_mount(data)
        assert best.law.name == "decoupler" and best.criterion < second.criterion - 100.0
        assert best.determined[[*range(7), 9]].all(), "all but damping and membrane of the decoupler"
        deviation = np.max((np.abs(best.values - VALUES) / best.errors)[best.determined])
        found.append([*errors(best.stiffness(data.frequency, data.amplitude), points[2]), deviation])
    stiffness, angle, worst = np.max(found, axis=0)
    source = "closed form: parameters of the points, which are integrated in time; two seeds"
    noise = "decoupler fitted to 48 points at three amplitudes with 3 % noise"
    validated(SUBJECT, f"{noise}: largest error of the stiffness", stiffness, 0.0, abs=0.05, source=source)
    validated(SUBJECT, f"{noise}: largest error of the loss angle", angle, 0.0, abs=3.0, unit="deg", source=source)
    validated(SUBJECT, f"{noise}: deviation in standard errors", worst, 0.0, abs=3.0, source=source)


def test_a_mount_without_decoupler_gets_none():
    frequency, amplitude = (grid.ravel() for grid in np.meshgrid(FREQUENCY, AMPLITUDE))
    exact = np.array([hydraulic_point(f, None) for f in frequency])
    fits = {fit.law.name: fit for fit in fit_mount(noisy((frequency, amplitude, exact), 0))}
    assert next(iter(fits)) == "hydromount" and fits["decoupler"].criterion > fits["hydromount"].criterion + 5.0
    best = fits["hydromount"]
    assert np.max(np.abs(best.values - list(HYDRAULIC.values())) / best.errors) < 3.0


def test_a_decoupler_needs_two_amplitudes(points):
    frequency, amplitude, exact = points
    large = amplitude == AMPLITUDE[2]
    data = MeasuredStiffness(frequency=frequency[large], amplitude=amplitude[large], stiffness=exact[large])
    assert [fit.law.name for fit in fit_mount(data)] == ["hydromount", "rubber"]
    with pytest.raises(DataError, match=r"law 'decoupler': .*single amplitude"):
        fit_mount(data, ["decoupler"])
    with pytest.raises(ConfigurationError, match=r"law 'gap': .*rubber, hydromount, decoupler"):
        fit_mount(data, ["gap"])
