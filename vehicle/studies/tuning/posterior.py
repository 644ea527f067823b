"""Posterior distribution of parameters given measured FRFs: emulator, sampling, evidence.

ln p(y | u) = -1/2 sum_k [(y_k - e_k(u))^2 / s_k^2 + ln(2 pi s_k^2)],   s_k^2 = noise_k^2 + left_out_k^2 + discrepancy^2

y_k are the means of ln|H| in bands, e_k(u) the emulator, left_out_k its leave-one-out error, and u the parameters,
logarithmic between their bounds, -1 to 1, with a uniform prior. The discrepancy is the standard deviation of ln|H| by
which the model differs from the real car in each band; without it the intervals are too narrow.

Sources: Kennedy and O'Hagan, Bayesian calibration of computer models, J. Royal Statistical Society B 63 (2001), 425-464
(discrepancy); Foreman-Mackey et al., emcee: the MCMC hammer, PASP 125 (2013), 306-312 (sampler).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, MissingPartError, SimulationError
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range, checked_ranges
from vehicle.runs.car import Car
from vehicle.studies.tuning.annealing import annealed, bounded, fitted_mixture
from vehicle.studies.tuning.convergence import effective_samples, r_hat
from vehicle.studies.tuning.emulator import Emulator, fitted_emulator
from vehicle.studies.tuning.fit_settings import CARS, DISCREPANCY
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.response_cells import ResponseCells, evaluated_cars, response_cells, signals_of
from vehicle.threads import one_blas_thread

TAIL = 50.0 * (1.0 - 0.9)
ENDS = (TAIL, 50.0, 100.0 - TAIL)
"""Percentiles at the lower end, the median and the upper end of an interval of 90 %."""

WALKERS = 40
"""Number of walkers of the ensemble; more than twice any usual number of parameters."""

BLOCK, MOST_BLOCKS = 500, 40
"""Steps between two checks of the convergence, and maximum number of blocks. With independent proposals a posterior of
six parameters needs 500 to 2500 steps, 1 to 2 s; ensemble moves alone needed more than a minute."""

REFIT, FITTED = 5, 5000
"""Blocks after which the proposal is fitted again and the chains begin anew, and samples to which it is fitted."""

CONVERGED = 1.01
"""Maximum R-hat, the limit of Vehtari et al. (2021)."""

DRAWS = 20_000
"""Draws of the importance sampling of the evidence."""

EVIDENCE_BOUND = 10.0
"""Minimum ratio of the evidences of two laws for a decision: "strong" in Kass and Raftery, JASA 90 (1995), 773-795,
begins at 10 to 20."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class EmulatedCar:
    """Polynomials of the measured quantities and of the comfort over the parameters."""

    parameters: tuple[Range, ...]  # fitted parameters with bounds
    cells: ResponseCells  # data
    emulator: Emulator  # means of ln|H|, a column for each cell
    comfort: Emulator | None  # logarithm of the comfort value on each signal [ln m/s2]; None without a signal
    signals: tuple[str, ...]  # names of the signals
    cars: int  # number of cars


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Posterior:
    """Samples of the parameters given the data."""

    car: EmulatedCar  # the emulator
    chains: Vector  # samples of u, (walkers, n, parameters)
    # r_hat, effective: rank-normalised split R-hat and bulk effective sample size of each parameter
    r_hat: tuple[float, ...]
    effective: tuple[float, ...]
    log_evidence: tuple[float, float]  # ln of the evidence p(y), and its standard error
    discrepancy: float  # standard deviation of the discrepancy [-]
    misfit: float  # root of the mean square of (y - e) / s at the sample with the highest likelihood [-]

    def values(self) -> Vector:
        """Return the samples in the units of the parameters, (samples, parameters)."""
        return values_at(self.car.parameters, self.chains.reshape(-1, self.chains.shape[2]))

    def interval(self) -> Vector:
        """Return lower end, median and upper end of the central intervals, (3, parameters)."""
        return np.asarray(np.percentile(self.values(), ENDS, axis=0))

    def comfort(self) -> Vector:
        """Return lower end, median and upper end of the comfort on each signal [m/s2], (3, signals)."""
        if self.car.comfort is None:
            return np.zeros((3, 0))
        predictions = self.car.comfort(self.chains.reshape(-1, self.chains.shape[2]))
        errors = np.random.default_rng(1).standard_normal(predictions.shape) * self.car.comfort.left_out
        return np.asarray(np.exp(np.percentile(predictions + errors, ENDS, axis=0)))


def require_posterior(targets: Sequence[FrfTarget]) -> None:
    """Check before a fit that its FRFs have a known noise and that emcee is installed.

    Raises:
        DataError: no FRFs, or FRFs without a known noise.
        MissingPartError: emcee is not installed.
    """
    response_cells(targets)
    _emcee()


def values_at(parameters: Sequence[Range], points: Vector) -> Vector:
    """Return values at points v in [-1, 1], (points, parameters): ln(value) = (ln(low high) + v ln(high / low)) / 2.

    A coordinate is (low + high + v (high - low)) / 2.
    """
    linear = np.array([parameter.is_linear for parameter in parameters])
    ends = np.array([(parameter.low, parameter.high) for parameter in parameters]).T
    low, high = np.where(linear, ends, np.log(np.where(linear, 1.0, ends)))
    inside = 0.5 * (low + high + points * (high - low))
    return np.where(linear, inside, np.exp(np.where(linear, 0.0, inside)))


@one_blas_thread()
def emulated_car(
    car: Car,
    parameters: Sequence[Range],
    targets: Sequence[FrfTarget],
    *,
    cars: int = CARS,
    progress: Callable[[float], None] | None = None,
) -> EmulatedCar:
    """Fit an emulator to cars at Sobol points between the bounds.

    Raises:
        ConfigurationError: too few cars, or bounds that are not above 0.
        DataError: no FRFs, or FRFs without a known noise.
    """
    checked = checked_ranges(parameters)
    cells = response_cells(targets)
    sequence = scipy.stats.qmc.Sobol(len(checked), seed=1)
    points = 2.0 * sequence.random_base2(max(cars - 1, 1).bit_length())[:cars] - 1.0
    paths = [parameter.path for parameter in checked]
    done = progress or (lambda fraction: None)
    built = []
    for index, row in enumerate(values_at(checked, points)):
        built.append(car.with_(overrides_of(car.vehicle, dict(zip(paths, row, strict=True)))))
        _ = built[-1].poles
        done(0.6 * (index + 1) / cars)
    means, comfort = evaluated_cars(built, cells, lambda fraction: done(0.6 + 0.4 * fraction))
    return EmulatedCar(
        parameters=checked,
        cells=cells,
        emulator=fitted_emulator(points, means),
        comfort=fitted_emulator(points, np.log(comfort)) if comfort.size else None,
        signals=tuple(signal.source for signal in signals_of(cells)),
        cars=cars,
    )


@one_blas_thread()
def posterior_of(
    car: EmulatedCar, *, discrepancy: float = DISCREPANCY, data: Vector | None = None, seed: int = 1
) -> Posterior:
    """Sample the posterior distribution until R-hat of all parameters is below `CONVERGED`.

    Args:
        discrepancy: standard deviation of ln|H| between model and car in each band [-].
        data: data that replace the cells, (cells,).

    Raises:
        ConfigurationError: a negative discrepancy.
        MissingPartError: emcee is not installed.
        SimulationError: R-hat stays above the limit.
    """
    if not 0.0 <= discrepancy < 1.0:
        raise ConfigurationError(
            f"discrepancy {discrepancy:g}: must be at least 0 and below 1, for example 0.1 for 10 %"
        )
    emcee = _emcee()
    data = car.cells.data if data is None else data
    variance = car.cells.noise**2 + car.emulator.left_out**2 + discrepancy**2
    constant = -0.5 * float(np.sum(np.log(2.0 * np.pi * variance)))
    size = len(car.parameters)

    def log_likelihood(points: Vector) -> Vector:
        misfit = np.sum((data - car.emulator(bounded(points))) ** 2 / variance, axis=1)
        return np.asarray(constant - 0.5 * misfit)

    random = np.random.default_rng(seed)
    population = annealed(log_likelihood, size, random)
    state = population[random.choice(population.shape[0], WALKERS, replace=False)]
    for block in range(MOST_BLOCKS):
        if block % REFIT == 0:  # a proposal that missed a mode is fitted again to the walkers that are in it
            moves = [(emcee.moves.MHMove(fitted_mixture(population)), 0.7), (emcee.moves.DEMove(), 0.3)]
            sampler = emcee.EnsembleSampler(
                WALKERS, size, lambda points: log_likelihood(points) + _log_prior(points), moves=moves, vectorize=True
            )
            sampler.random_state = np.random.RandomState(seed + block).get_state()
        state = sampler.run_mcmc(state, BLOCK)
        kept = np.swapaxes(sampler.get_chain(discard=sampler.iteration // 4), 0, 1)
        population = kept.reshape(-1, size)[:: max(kept.shape[0] * kept.shape[1] // FITTED, 1)]
        factors = tuple(r_hat(kept[:, :, index]) for index in range(size))
        if max(factors) < CONVERGED:
            break
    else:
        worst = int(np.argmax(factors))
        raise SimulationError(
            f"posterior of {car.parameters[worst].path}: the sampling has not converged: R-hat "
            f"{factors[worst]:.3f} after {BLOCK * MOST_BLOCKS} steps, must be below {CONVERGED:g}; narrow the "
            "bounds, or leave out parameters that the data do not determine"
        )
    samples = kept.reshape(-1, size)[:: max(kept.shape[0] * kept.shape[1] // DRAWS, 1)]
    best = float(np.max(log_likelihood(samples)))
    return Posterior(
        car=car,
        chains=bounded(kept),
        r_hat=factors,
        effective=tuple(effective_samples(kept[:, :, index]) for index in range(size)),
        log_evidence=_log_evidence(log_likelihood, samples, random),
        discrepancy=discrepancy,
        misfit=float(np.sqrt(2.0 * (constant - best) / data.size)),
    )


def _log_prior(points: Vector) -> Vector:
    """Return ln of the standard normal density, (points, p) -> (points,): a uniform prior of u = 2 Phi(v) - 1."""
    return np.asarray(-0.5 * np.sum(points**2, axis=1) - 0.5 * points.shape[1] * np.log(2.0 * np.pi))


def _log_evidence(
    log_likelihood: Callable[[Vector], Vector], samples: Vector, random: np.random.Generator
) -> tuple[float, float]:
    """Return ln of the mean likelihood over the prior by importance sampling, and its standard error.

    Proposal: 0.9 of the mixture of t distributions fitted to the samples, 0.1 of the prior.
    """
    proposal = fitted_mixture(samples)
    from_prior = random.uniform(size=DRAWS) < 0.1
    draws = proposal.draw(DRAWS, random)
    draws[from_prior] = random.standard_normal((int(from_prior.sum()), samples.shape[1]))
    prior = _log_prior(draws)
    density = np.logaddexp(np.log(0.9) + proposal.log_density(draws), np.log(0.1) + prior)
    logarithm = log_likelihood(draws) + prior - density
    top = float(np.max(logarithm))
    ratio = np.exp(logarithm - top)
    mean = float(np.mean(ratio))
    return top + float(np.log(mean)), float(np.std(ratio) / mean / np.sqrt(DRAWS))


def verdict(first: tuple[str, Posterior], second: tuple[str, Posterior]) -> str:
    """Return the ratio of the evidences of two laws in words, "undecided" below `EVIDENCE_BOUND`.

    Args:
        first, second: name of a law and its posterior, given the same data.
    """
    difference = first[1].log_evidence[0] - second[1].log_evidence[0]
    better, other = (first[0], second[0]) if difference > 0.0 else (second[0], first[0])
    ratio = float(np.exp(min(abs(difference), 600.0)))
    statement = f"{better} is {ratio:.3g} times as probable as {other}"
    if ratio < EVIDENCE_BOUND:
        return (
            f"the data do not separate {first[0]} and {second[0]}: {statement}, a decision needs at least "
            f"{EVIDENCE_BOUND:g} times"
        )
    return statement


def _emcee() -> Any:
    try:
        return import_module("emcee")
    except ImportError:
        raise MissingPartError(
            "the posterior needs emcee, which is not installed; install it with: pip install "
            "'vehicle-on-shaker[posterior]'"
        ) from None
