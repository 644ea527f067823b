"""Least squares, standard errors and identifiability on a system with closed-form FRFs."""

from typing import Any

import numpy as np
import pytest

from tests.studies.tuning.two_masses import FREQUENCY, SIGMA, TRUE, MeasuredMasses, response
from tests.validation import validated
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.least_squares import fit

PARAMETERS = (
    Range(path="lower", low=5e4, high=1e6, start=1.6e5),
    Range(path="upper", low=5e3, high=2e5, start=5e4),
    Range(path="damping", low=2e2, high=1e4, start=700.0),
)


def fitted(target, parameters=PARAMETERS):
    return fit(parameters, [target], dict)


def test_exact_data_give_the_exact_values():
    result = fitted(MeasuredMasses(sigma=0.0))
    assert result.converged
    for path, value in TRUE.items():
        # Gauss-Newton ends at rounding; a relative 1e-6 is far below every standard error.
        validated(
            "Sweeps, tuning and optimisation", f"fit of {path} to exact FRFs", result.values[path], value, rel=1e-6,
            source="closed form: the value that the FRFs were computed with",
        )  # fmt: skip
    assert result.unidentified == () and result.at_bound == ()


def test_values_that_make_no_model_together_are_left_out():
    """Each value lies within its bounds; a step of one alone leaves the thin set of possible models.

    As mass and moment of inertia about the origin: I - m r2 must be that of a body. The fit ended at its first step.
    """

    def build(values):
        ratio = values["lower"] / values["upper"]
        if not 0.99 * TRUE["lower"] / TRUE["upper"] < ratio < 1.01 * TRUE["lower"] / TRUE["upper"]:
            raise ConfigurationError("no real spring")
        return values

    scale = 1.3
    start = [Range(path=path, low=0.2 * value, high=5.0 * value, start=scale * value) for path, value in TRUE.items()]
    result = fit(start, [MeasuredMasses(sigma=0.0)], build)
    assert {path: result.values[path] / value for path, value in TRUE.items()} == pytest.approx(
        dict.fromkeys(TRUE, 1.0), rel=1e-6
    )
    assert result.converged
    start[0] = Range(path="lower", low=5e4, high=1e6, start=1.5 * scale * TRUE["lower"])
    with pytest.raises(ConfigurationError, match=r"^no real spring$"):
        fit(start, [MeasuredMasses(sigma=0.0)], build)


def test_a_fit_that_ends_beside_impossible_models_has_not_converged():
    def build(values):
        if values["upper"] > 0.8 * TRUE["upper"]:
            raise ConfigurationError("no real spring")
        return values

    start = [Range(path=path, low=0.2 * value, high=5.0 * value, start=0.5 * value) for path, value in TRUE.items()]
    result = fit(start, [MeasuredMasses(sigma=0.0)], build)
    assert 0.75 < result.values["upper"] / TRUE["upper"] < 0.8 and not result.converged
    assert result.message.endswith("(no real spring)")


def test_covariance_is_that_of_the_linearised_problem():
    result = fitted(MeasuredMasses(seed=3))
    # Second derivation: analytic perturbation of ln H by central differences, inverse of the normal matrix.
    columns = []
    for path in TRUE:
        shifted = [response({**result.values, path: result.values[path] * np.exp(step)}) for step in (1e-5, -1e-5)]
        change = np.log(shifted[0] / shifted[1]) / 2e-5 / SIGMA
        columns.append(np.concatenate([change.real.ravel(), change.imag.ravel()]))
    expected = np.sqrt(np.diag(np.linalg.inv(np.array(columns) @ np.array(columns).T)))
    # The noise is estimated from 60 values in each row: its standard deviation is known to 9 % there, 5 % overall;
    # a row whose neighbours happen to be correlated beyond 3 sigma would add more.
    for deviation, path in zip(expected, TRUE, strict=True):
        validated(
            "Statistics and intervals", f"relative standard error of the fitted {path}",
            result.standard_errors[path] / result.values[path], deviation, rel=0.15,
            source="second derivation: normal matrix of analytic perturbations",
        )  # fmt: skip


def test_standard_errors_are_those_of_repeated_measurements():
    results = [fitted(MeasuredMasses(seed=seed)) for seed in range(60)]
    for path, value in TRUE.items():
        away = np.array([result.deviation(path, value) for result in results])
        # 60 repetitions know a standard deviation to 1/sqrt(120) = 9 %: three times that, and the mean to 0.13.
        validated(
            "Statistics and intervals", f"scatter of the fitted {path} in 60 repetitions, in standard errors",
            np.std(away), 1.0, abs=0.27, source="second derivation: repeated measurements",
        )  # fmt: skip
        validated(
            "Statistics and intervals", f"mean deviation of the fitted {path} in 60 repetitions, in standard errors",
            np.mean(away), 0.0, abs=0.39, source="second derivation: repeated measurements",
        )  # fmt: skip
    upper, damping = (np.array([result.values[path] for result in results]) for path in ("upper", "damping"))
    observed = np.corrcoef(np.log(upper), np.log(damping))[0, 1]
    predicted = np.mean([result.correlation[1, 2] for result in results])
    # Standard error of a correlation from 60 pairs: 0.13 at most.
    assert observed == pytest.approx(predicted, abs=0.39)


def test_noise_that_all_channels_share_counts_once():
    class Shared(MeasuredMasses):
        def __init__(self, seed):
            super().__init__(sigma=0.0)
            real, imaginary = np.random.default_rng(seed).standard_normal((2, 1, FREQUENCY.size))
            self.data = self.data * np.exp(SIGMA * (real + 1j * imaginary))

    results = [fitted(Shared(seed)) for seed in range(60)]
    # With the assumption of independent noise in the channels the standard errors would be 1.4 times too small.
    away = np.array([result.deviation("lower", TRUE["lower"]) for result in results])
    assert 0.73 < np.std(away) < 1.27  # as above


def test_noise_is_found_from_the_residuals_whatever_was_assumed():
    right, wrong = fitted(MeasuredMasses(seed=1)), fitted(MeasuredMasses(seed=1, assumed=10 * SIGMA))
    assert [row.rms for row in right.rows] == pytest.approx([1.0] * 4, abs=0.3)  # three times 9 %
    assert [row.rms for row in wrong.rows] == pytest.approx([row.rms / 10 for row in right.rows], rel=1e-3)
    for path in TRUE:
        assert wrong.standard_errors[path] == pytest.approx(right.standard_errors[path], rel=1e-3)
        assert wrong.values[path] == pytest.approx(right.values[path], rel=1e-4)


def test_correlated_residuals_weigh_less():
    class Smeared(MeasuredMasses):
        def __init__(self):
            super().__init__(sigma=0.0)
            white = np.random.default_rng(5).standard_normal((2, 2, FREQUENCY.size + 8))
            smooth = np.apply_along_axis(lambda row: np.convolve(row, np.ones(9) / 3.0, "valid"), 2, white)
            self.data = self.data * np.exp(SIGMA * (smooth[0] + 1j * smooth[1]))

    plain, smeared = fitted(MeasuredMasses(seed=5)), fitted(Smeared())
    assert all(row.inflation == 1.0 for row in plain.rows)
    # A moving mean over nine values: neighbours correlate by 8/9, 17 of them make one independent value. 60 values and
    # three parameters leave the estimate lower; it must at least reach 4, so the errors double.
    assert min(row.inflation for row in smeared.rows) > 3.0
    assert all(smeared.standard_errors[path] > 1.7 * plain.standard_errors[path] for path in TRUE)


def test_of_a_pair_with_one_common_effect_one_parameter_is_held():
    rim = Range(path="rim", low=2e5, high=5e6, start=5e5)
    target = MeasuredMasses({**TRUE, "rim": 5e5, "lower": 5e5}, seed=2)
    tyre = Range(path="lower", low=5e4, high=2e6, start=4e5)
    result = fitted(target, (tyre, *PARAMETERS[1:], rim))
    assert len(result.unidentified) == 1
    held = result.unidentified[0]
    assert {held.path, *held.partners} == {"lower", "rim"}
    # Exactly singular but for the second order of the forward differences, a thousandth of the first.
    assert held.spread > 10.0
    assert result.values[held.path] == held.held_at
    assert np.isnan(result.standard_errors[held.path])
    assert held.path not in result.free and result.correlation.shape == (3, 3)
    assert held.path in held.message() and held.partners[0] in held.message()
    # The springs in series are identifiable.
    total = 1.0 / (1.0 / result.values["lower"] + 1.0 / result.values["rim"])
    assert total == pytest.approx(2.5e5, rel=0.02)  # about three standard errors


def test_a_parameter_without_influence_is_held_alone():
    result = fitted(MeasuredMasses(seed=2), (*PARAMETERS, Range(path="colour", low=1.0, high=9.0, start=2.0)))
    assert [(held.path, held.partners, held.spread) for held in result.unidentified] == [("colour", (), np.inf)]
    assert result.values["colour"] == 2.0


def test_a_bound_in_the_way_is_named():
    tight = (Range(path="lower", low=5e4, high=2e5, start=1.6e5), *PARAMETERS[1:])
    result = fitted(MeasuredMasses(seed=2), tight)
    assert result.at_bound == ("lower",)
    assert result.values["lower"] == pytest.approx(2e5, rel=1e-3)
    assert np.isnan(result.standard_errors["lower"])
    assert result.free == ("upper", "damping")


def test_two_targets_weigh_as_their_residuals_say():
    good, bad = MeasuredMasses(seed=6), MeasuredMasses(seed=7, sigma=1.0 / 3.0, assumed=SIGMA)
    both = fit(PARAMETERS, [good, bad], dict)
    only_good = fitted(good)
    for path in TRUE:
        # A measurement with eleven times the noise adds 1/120 of the information: half a percent of the error.
        assert both.standard_errors[path] == pytest.approx(only_good.standard_errors[path], rel=0.03)
        assert abs(both.values[path] - only_good.values[path]) < 0.5 * only_good.standard_errors[path]


def test_progress_is_called():
    calls = []
    fit(PARAMETERS, [MeasuredMasses()], dict, progress=lambda count, rms: calls.append((count, rms)))
    assert [count for count, _ in calls] == sorted(count for count, _ in calls)
    assert calls[0][1] > 3.0 * calls[-1][1]


def test_invalid_parameters_and_targets_are_rejected():
    colour: dict[str, Any] = {"path": "colour", "low": 1.0, "high": 9.0}
    one = [MeasuredMasses()]
    for parameters, targets, message in (
        ([], one, "parameters to fit are missing"), (PARAMETERS, [], "targets: .*missing"),
        ((*PARAMETERS, PARAMETERS[0]), one, "lower: .*2 times"),
        ((*PARAMETERS, Range(**colour)), one, "colour: has no start"),
    ):  # fmt: skip
        with pytest.raises(ConfigurationError, match=message):
            fit(parameters, targets, dict)
    with pytest.raises(ConfigurationError, match=r"determine no parameter: .* colour"):
        fit([Range(**colour, start=2.0)], one, lambda _: TRUE)


@pytest.mark.parametrize(
    ("residuals", "error", "message"),
    [
        (np.full((4, 3), np.nan), SimulationError, r"lower=1.6e\+05"),
        (np.ones((1, 2)), ConfigurationError, "found 2 .*3 parameters"),
    ],
)
def test_a_model_with_bad_residuals_is_rejected(residuals, error, message, monkeypatch):
    monkeypatch.setattr(MeasuredMasses, "residuals", lambda target, values: residuals)
    with pytest.raises(error, match=message):
        fitted(MeasuredMasses())


@pytest.mark.parametrize(
    ("lower", "upper", "start"), [(0.0, 2.0, 1.0), (1.0, 2.0, 1.0), (2.0, 1.0, 1.5), (1.0, np.inf, 2.0)]
)
def test_invalid_bounds_are_rejected(lower, upper, start):
    with pytest.raises(ConfigurationError, match=r"parameter a: found bounds .*0 < lower < start < upper"):
        Range(path="a", low=lower, high=upper, start=start)
