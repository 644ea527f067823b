"""Posterior of parameters: convergence measures, emulator, and closed forms of a linear model."""

import dataclasses
import sys

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError, MissingPartError
from vehicle.model.parameters.ranges import Range
from vehicle.signals.analysis.response_name import parsed_name
from vehicle.signals.formats.frf_file import FrfData
from vehicle.studies.tuning.convergence import effective_samples, r_hat
from vehicle.studies.tuning.emulator import Emulator, fitted_emulator, legendre_terms
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.posterior import EmulatedCar, posterior_of, values_at, verdict
from vehicle.studies.tuning.posterior_text import posterior_sentences
from vehicle.studies.tuning.response_cells import ResponseCells, response_cells

SUBJECT = "Statistics and intervals"
PARAMETERS = (
    Range(path="damper.viscous", low=500.0, high=5000.0, start=2000.0),
    Range(path="damper.coulomb_friction", low=50.0, high=200.0, start=100.0),
)
SLOPES = np.array([[0.9, 0.1], [0.4, -0.6], [0.1, 0.8], [0.7, 0.7], [-0.5, 0.3], [0.2, 0.9]])
"""Six cells that depend linearly on two parameters."""


def autoregression(rho, *, chains=20, length=4000, seed=1):
    noise = np.random.default_rng(seed).standard_normal((chains, length + 500))
    return scipy.signal.lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], noise, axis=1)[:, 500:]


def test_convergence_of_chains_with_a_known_correlation():
    for rho in (0.0, 0.5, 0.9):
        chains = autoregression(rho)
        validated(
            SUBJECT, f"bulk effective sample size of chains with correlation {rho:g}, over the closed form",
            effective_samples(chains) / (chains.size * (1.0 - rho) / (1.0 + rho)), 1.0, abs=0.1,
            source="closed form: S (1 - rho) / (1 + rho) of a first-order autoregression",
        )  # fmt: skip
        assert 0.999 < r_hat(chains) < 1.01
    chains = autoregression(0.5)
    apart = chains + np.where(np.arange(20) < 10, 0.5, -0.5)[:, None]
    # Variance within 1, between chains 0.25: R-hat near sqrt(1.25); ranks compress it little.
    assert r_hat(apart) == pytest.approx(np.sqrt(1.25), abs=0.02)
    # Chains of equal location and different scale are detected by |sample - median|.
    assert r_hat(chains * np.where(np.arange(20) < 10, 1.0, 3.0)[:, None]) > 1.05


def test_emulator_is_exact_for_its_polynomials_and_states_the_error_of_others():
    random = np.random.default_rng(2)
    points = random.uniform(-1.0, 1.0, (60, 2))
    cubic = 1.0 + points[:, 0] ** 3 - 2.0 * points[:, 0] * points[:, 1] ** 2
    other = np.exp(1.5 * points[:, 0])
    emulator = fitted_emulator(points, np.stack([cubic, other], axis=1))
    assert emulator.powers.shape == (15, 2)  # total degree 4: 60 cars allow 24 terms
    new = random.uniform(-1.0, 1.0, (5, 2))
    expected = 1.0 + new[:, 0] ** 3 - 2.0 * new[:, 0] * new[:, 1] ** 2
    np.testing.assert_allclose(emulator(new)[:, 0], expected, rtol=0.0, atol=1e-12)
    assert emulator.left_out[0] < 1e-12
    left = []
    for index in range(60):
        others = np.arange(60) != index
        terms = legendre_terms(points, emulator.powers)
        fit = np.linalg.lstsq(terms[others], other[others], rcond=None)[0]
        left.append(other[index] - terms[index] @ fit)
    validated(
        SUBJECT, "left-out error of an emulator", emulator.left_out[1], np.sqrt(np.mean(np.square(left))), rel=1e-9,
        source="second derivation: fit repeated without each car",
    )  # fmt: skip
    for count, parameters in ((7, 2), (4, 1)):
        with pytest.raises(ConfigurationError, match=f"--samples {count}: .* {count + 1} for {parameters} "):
            fitted_emulator(points[:count, :parameters], other[:count, None])
    assert fitted_emulator(points[:5, :1], other[:5, None]).powers.tolist() == [[0], [1]]  # 2.5 cars a term


def linear_car(noise=0.2, left_out=0.0):
    """Return an emulator whose cells are linear in two parameters."""
    cells = ResponseCells(targets=(), weights=(), data=SLOPES @ [0.1, -0.2], noise=np.full(len(SLOPES), noise))
    emulator = Emulator(
        powers=np.array([[1, 0], [0, 1]]), coefficients=SLOPES.T.copy(), left_out=np.full(len(SLOPES), left_out)
    )
    return EmulatedCar(parameters=PARAMETERS, cells=cells, emulator=emulator, comfort=None, signals=(), cars=64)


def test_posterior_of_a_linear_model_is_the_closed_form():
    pytest.importorskip("emcee")
    noise = 0.1
    posterior = posterior_of(linear_car(noise), discrepancy=0.0)
    assert max(posterior.r_hat) < 1.01 and min(posterior.effective) > 1000.0
    samples = posterior.chains.reshape(-1, 2)
    covariance = np.linalg.inv(SLOPES.T @ SLOPES) * noise**2
    np.testing.assert_allclose(samples.mean(axis=0), [0.1, -0.2], atol=0.15 * np.sqrt(covariance.max()))
    validated(
        SUBJECT, "covariance of the posterior of a linear model", np.cov(samples.T), covariance, peak=0.1,
        source="closed form: sigma^2 (A' A)^-1",
    )  # fmt: skip
    # The data are exact, and the prior is uniform over an area of 4.
    count = len(SLOPES)
    evidence = 0.5 * np.log(np.linalg.det(2.0 * np.pi * covariance) / 16.0) - 0.5 * count * np.log(2 * np.pi * noise**2)
    validated(
        SUBJECT, "logarithm of the evidence of a linear model", posterior.log_evidence[0], evidence, abs=0.03,
        source="closed form: Gaussian integral over the prior",
    )  # fmt: skip
    assert posterior.log_evidence[1] < 0.02
    low, middle, high = posterior.interval()
    expected = values_at(PARAMETERS, np.array([[0.1, -0.2]]))[0]
    np.testing.assert_allclose(middle, expected, rtol=0.02)
    assert np.all(low < expected) and np.all(expected < high)


def nonlinear_car(powers, data, noise):
    """Return an emulator with one Legendre term for each cell."""
    size = len(data)
    cells = ResponseCells(targets=(), weights=(), data=np.array(data), noise=np.full(size, noise))
    emulator = Emulator(powers=np.array(powers), coefficients=np.eye(size), left_out=np.zeros(size))
    return EmulatedCar(parameters=PARAMETERS, cells=cells, emulator=emulator, comfort=None, signals=(), cars=64)


def test_two_separate_modes_have_their_probabilities():
    """Cells (3 u^2 - 1) / 2 and v: modes at u = 0.6 and -0.6, a hundredth wide. Walkers alone would stay in theirs."""
    pytest.importorskip("emcee")
    noise = 0.02
    posterior = posterior_of(nonlinear_car([[2, 0], [0, 1]], [0.04, 0.2], noise), discrepancy=0.0)
    assert max(posterior.r_hat) < 1.01
    samples = posterior.chains.reshape(-1, 2)
    validated(
        SUBJECT, "probability of one of two equal modes 55 standard deviations apart", np.mean(samples[:, 0] > 0.0),
        0.5, abs=0.05, source="closed form: symmetry",
    )  # fmt: skip
    assert np.all(np.abs(np.abs(samples[:, 0]) - 0.6) < 0.1)
    density = scipy.stats.norm(scale=noise).pdf
    grid = np.linspace(-1.0, 1.0, 40_001)
    evidence = 0.25 * np.trapezoid(density(0.04 - (1.5 * grid**2 - 0.5)), grid)
    validated(
        SUBJECT, "logarithm of the evidence of a posterior with two modes", posterior.log_evidence[0],
        np.log(evidence), abs=0.03, source="closed form: quadrature",
    )  # fmt: skip


def test_a_mode_at_a_bound():
    """Data that no value within the bounds follows, as those of another law: u presses on 1."""
    pytest.importorskip("emcee")
    noise, data = 0.1, (2.0, -0.1)
    posterior = posterior_of(nonlinear_car([[1, 0], [0, 1]], data, noise), discrepancy=0.0)
    assert max(posterior.r_hat) < 1.01
    truncated = scipy.stats.truncnorm(-3.0 / noise, -1.0 / noise, loc=data[0], scale=noise)
    validated(
        SUBJECT, "mean distance from a bound at which a posterior ends", np.mean(1.0 - posterior.chains[:, :, 0]),
        1.0 - truncated.mean(), rel=0.1, source="closed form: truncated normal distribution",
    )  # fmt: skip
    normal = scipy.stats.norm
    evidence = normal.logsf(1.0 / noise) + np.log(0.25)
    validated(
        SUBJECT, "logarithm of the evidence of a posterior at a bound", posterior.log_evidence[0], evidence, abs=0.03,
        source="closed form: integral of the normal distribution over the bounds",
    )  # fmt: skip


def test_errors_of_emulator_and_model_widen_the_intervals():
    pytest.importorskip("emcee")
    spreads = [
        np.std(posterior_of(linear_car(0.03, left_out), discrepancy=size).chains[:, :, 1])
        for left_out, size in ((0.0, 0.0), (0.04, 0.0), (0.04, 0.12))
    ]
    # Standard deviations of a cell: 0.03, 0.05 and 0.13.
    np.testing.assert_allclose(np.array(spreads) / spreads[0], [1.0, 5.0 / 3.0, 13.0 / 3.0], rtol=0.05)


def test_intervals_cover_hidden_values():
    """Noise and a discrepancy of known size in 16 synthetic cars drawn from the prior."""
    pytest.importorskip("emcee")
    random = np.random.default_rng(3)
    car, inside = linear_car(0.05), []
    for seed in range(16):
        hidden = random.uniform(-1.0, 1.0, 2)
        data = SLOPES @ hidden + random.standard_normal(len(SLOPES)) * np.hypot(0.05, 0.1)
        low, _, high = posterior_of(car, data=data, discrepancy=0.1, seed=seed).interval()
        truth = values_at(PARAMETERS, hidden[None])[0]
        inside.append((low <= truth) & (truth <= high))
    validated(
        SUBJECT, "share of hidden values in the 90 % intervals of 16 posteriors, both parameters", np.mean(inside), 0.9,
        # Three binomial standard deviations of 32 values.
        abs=3.0 * np.sqrt(0.9 * 0.1 / 32.0), source="closed form: probability of the intervals",
    )  # fmt: skip


def test_evidence_decides_only_above_ten():
    pytest.importorskip("emcee")
    right = posterior_of(linear_car(0.1))
    closer = dataclasses.replace(right, log_evidence=(right.log_evidence[0] - 1.0, 0.01))
    wrong = dataclasses.replace(right, log_evidence=(right.log_evidence[0] - 3.0, 0.01))
    undecided, decided = verdict(("a", right), ("b", closer)), verdict(("a", wrong), ("b", right))
    assert "a is 2.72 times" in undecided and "10 times" in undecided
    assert "b is 20.1 times" in decided and "10 times" not in decided
    assert undecided in posterior_sentences([("a", right), ("b", closer)])[-1]
    data = np.array([1.0, 1.0, -1.0, -1.0, 1.0, 1.0])
    far = posterior_of(linear_car(0.1), data=data, discrepancy=0.0)
    left = data - SLOPES @ np.linalg.lstsq(SLOPES, data, rcond=None)[0]
    assert far.misfit == pytest.approx(np.sqrt(np.mean(np.square(left))) / 0.1, rel=1e-3)
    assert [any("--discrepancy" in text for text in posterior_sentences([("a", each)])) for each in (far, right)] == [
        True, False
    ]  # fmt: skip


def frf_target(coherence):
    frequency = np.arange(4.0, 20.0, 0.25)
    response = 50.0 * np.exp(1j * frequency)[None]
    blank = np.full(response.shape, np.nan)
    data = FrfData(
        frequency=frequency,
        names=(parsed_name("seat_rail_acc_z/plate_fl"),),
        response=response,
        coherence=np.full(response.shape, coherence),
        random_error=blank,
    )
    return FrfTarget(name="level", data=data, signal=None, averages=9.0)


def test_cells_and_their_noise():
    cells = response_cells([frf_target(0.9)])
    assert cells.data.shape == cells.noise.shape == (8,)
    np.testing.assert_allclose(cells.data, np.log(50.0))
    lines = np.count_nonzero(cells.weights[0][0, 0])
    one = (1.0 - 0.9) / (2.0 * 0.9 * 9.0) + 0.005**2
    assert cells.noise[0] == pytest.approx(np.sqrt(one / lines))
    np.testing.assert_allclose(cells.of([100.0 * np.ones_like(cells.targets[0].data.response)]), np.log(100.0))
    with pytest.raises(DataError, match="coherence"):
        response_cells([frf_target(1.0)])
    with pytest.raises(DataError, match=r"--posterior .*--frf FILE"):
        response_cells([])


def test_missing_emcee_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "emcee", None)
    with pytest.raises(MissingPartError, match=r"emcee.*vehicle-on-shaker\[posterior\]"):
        posterior_of(linear_car())
