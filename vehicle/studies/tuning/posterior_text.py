"""Posterior distribution in words and as plain data: intervals, comfort, convergence, rival laws."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from vehicle.digits import number
from vehicle.model.parameters.paths import unit_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.studies.tuning.posterior import CONVERGED, Posterior, verdict

UNEXPLAINED = 1.5
"""Maximum misfit of a model that follows its data: for 20 cells the 99 % point of sqrt(chi^2 / n) is 1.37."""

NamedPosterior = tuple[str, Posterior]
"""Name of a law and its posterior."""


def posterior_lines(posteriors: Sequence[NamedPosterior], vehicle: Vehicle) -> list[str]:
    """Return lines of the posterior of a law, and of its evidence against rival laws.

    Args:
        posteriors: the fitted law first, then its rivals.
    """
    posterior = posteriors[0][1]
    width = max(len(parameter.path) for parameter in posterior.car.parameters)
    rows = zip(posterior.car.parameters, posterior.interval().T, strict=True)
    lines = ["posterior: median, 90 % interval"]
    lines += [
        f"{parameter.path:<{width}}  {middle:.4g}, {low:.4g} to {high:.4g} {unit_of(vehicle, parameter.path)}"
        for parameter, (low, middle, high) in rows
    ]
    lines += [
        f"comfort on {name}: {middle:.4g}, {low:.4g} to {high:.4g} m/s2 (seat rail, 2 to 50 Hz, unweighted)"
        for name, (low, middle, high) in zip(posterior.car.signals, posterior.comfort().T, strict=True)
    ]
    return [*lines, *posterior_sentences(posteriors)]


def posterior_sentences(posteriors: Sequence[NamedPosterior]) -> list[str]:
    """Return sentences on emulator, discrepancy, convergence, misfit and rival laws; arguments: `posterior_lines`."""
    posterior = posteriors[0][1]
    left_out = 100.0 * posterior.car.emulator.left_out
    sentences = [
        f"replacement model from {posterior.car.cars} simulated cars: error of a third-octave mean "
        f"{number(np.median(left_out), 2)} % (median) to {number(np.max(left_out), 2)} % (largest), included in "
        f"the intervals; noise from coherence and averages, assumed model error {100 * posterior.discrepancy:g} "
        "% in each band",
        f"the sampling has converged: R-hat at most {max(posterior.r_hat):.3f} (limit {CONVERGED:g}), at least "
        f"{min(posterior.effective):.0f} independent samples",
    ]
    if posterior.misfit > UNEXPLAINED:
        sentences.append(
            f"the best car differs from the data by {number(posterior.misfit, 2)} standard deviations (RMS, limit "
            f"{UNEXPLAINED:g}), so the intervals are too narrow; add parameters or choose a larger --discrepancy"
        )
    sentences += [f"evidence: {verdict(posteriors[0], rival)}" for rival in posteriors[1:]]
    return sentences


def posterior_summary(posteriors: Sequence[NamedPosterior]) -> dict[str, Any]:
    """Return the posterior as plain data; arguments: `posterior_lines`."""
    posterior = posteriors[0][1]
    intervals = posterior.interval().T.tolist()
    return {
        "parameters": [
            {"path": parameter.path, "low": low, "median": middle, "high": high, "r_hat": factor, "effective": count}
            for parameter, (low, middle, high), factor, count in zip(
                posterior.car.parameters, intervals, posterior.r_hat, posterior.effective, strict=True
            )
        ],
        "comfort": {
            name: {"low": low, "median": middle, "high": high}
            for name, (low, middle, high) in zip(posterior.car.signals, posterior.comfort().T.tolist(), strict=True)
        },
        "discrepancy": posterior.discrepancy,
        "left_out_error": {
            "median": float(np.median(posterior.car.emulator.left_out)),
            "largest": float(np.max(posterior.car.emulator.left_out)),
        },
        "misfit": posterior.misfit,
        "log_evidence": {name: each.log_evidence[0] for name, each in posteriors},
        "sentences": posterior_sentences(posteriors),
    }
