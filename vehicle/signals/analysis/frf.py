"""Estimate FRFs and coherence from one or several excitations to any number of responses (H1 estimator)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy
from numpy.typing import ArrayLike

from vehicle.errors import DataError
from vehicle.signals.analysis.samples import (
    Complex,
    Vector,
    checked_band,
    checked_names,
    checked_same_length,
    checked_signals,
    checked_time_step,
    is_constant,
    lines_in_band,
    refuse_constant,
)
from vehicle.signals.analysis.segments import MINIMUM_AVERAGES, cut_into_segments
from vehicle.threads import one_blas_thread

EXCITED = 1e-24
"""Minimum power of an excited line over the strongest line: amplitude ratio 1e-12, below which rounding of the
transform leaves fewer than three correct digits."""

CONSTANT = "{}: constant, so it has no FRF and no coherence"
"""Notice on a response that does not move."""

CORRELATED = "the inputs are fully correlated there, so their responses cannot be separated"
"""Cause of an undefined FRF at lines with dependent inputs."""

INDEPENDENCE = 1e-2
"""Minimum eigenvalue of the excitation matrix scaled to unit diagonal [-]: for two inputs 1 minus the modulus of their
coherence. Below it the error of the separated responses is more than seven times that of a single input."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FrequencyResponse:
    """FRF, response over excitation, with coherence and standard error."""

    frequency: Vector
    """frequency lines [Hz], shape (m,)"""
    response: Complex
    """H(f) [unit of response / unit of excitation], shape (k, m); NaN where undefined"""
    coherence: Vector
    """gamma^2 [-], shape (k, m); NaN where undefined"""
    random_error: Vector
    """standard error of |H| [unit of H], shape (k, m): 95 % of all estimates lie within 1.96 of it in magnitude, within
    2.45 in the complex plane; NaN where undefined"""
    averages: Vector
    """number of independent averages with which H1 has this error [-], shape (k, m)"""
    segments: int
    """overlapping segments averaged [-]"""
    window: str
    """name of the window"""
    estimator: str
    """name of the estimator"""
    resolution_hz: float
    """minimum half-power width of a resolved resonance [Hz]; for H1 the line spacing"""
    reasons: tuple[str, ...]
    """one message per cause of NaN; empty if all values are defined"""

    def __repr__(self) -> str:
        """One line."""
        return (
            f"FrequencyResponse({len(self.response)} responses, {len(self.frequency)} lines, {self.estimator}, "
            f"resolution {self.resolution_hz:.3g} Hz)"
        )


@one_blas_thread()
def frequency_responses(
    time_step: float,
    excitations: ArrayLike,
    responses: ArrayLike,
    *,
    window_s: float = 4.0,
    overlap: float = 0.5,
    band: tuple[float, float] = (1.0, 50.0),
    input_names: Sequence[str] | None = None,
    names: Sequence[str] | None = None,
    minimum_averages: float = MINIMUM_AVERAGES,
) -> tuple[FrequencyResponse, ...]:
    """Estimate H1 = Gxx^-1 Gxy and gamma^2 = Gxy^H Gxx^-1 Gxy / Gyy by Welch's method (Hann window, constant removed).

    Noise on the response does not bias H1; leakage does: a window must be long against the ringing of the resonance,
    because part of the response in a segment was excited before the segment began. With a flat excitation the
    expected estimate is the transform of h(tau) rho(tau): the impulse response times the autocorrelation of the
    window, rho = 1 - (2 pi^2/3) (tau/window_s)^2 + ... for Hann. So a peak with the time constant
    tau0 = 1/(2 pi zeta f) is low by about (4 pi^2/3) (tau0/window_s)^2 while that is small: 1.0 % at 28 Hz with 5 %
    damping and 4 s; at 20 Hz with 1 % it is 25 %, and 3 % with 16 s. The coherence drops there even without noise. Use
    a longer window.

    The standard error of |H_i| is sqrt((1 - gamma^2) Gyy (Gxx^-1)_ii / (2 (n - p + 1))) with n averages; for one input
    it is |H| sqrt((1 - gamma^2) / (2 n gamma^2)).

    A line without excitation (a band-limited input below its lower edge) contains only leakage of its neighbours;
    choose a band within the band of the input.

    Args:
        time_step: sampling interval [s].
        excitations: p simultaneous inputs, shape (p, n).
        responses: outputs, shape (n,) or (k, n).
        window_s: segment length [s]; the line spacing is 1 / window_s.
        overlap: overlap of successive segments over their length [-].
        band: lowest and highest returned line [Hz], both included.
        input_names: names of the excitations, for messages.
        names: names of the responses, for `reasons`.
        minimum_averages: required effective averages. For one input with fewer than 2, the coherence is NaN (a single
            average always gives 1); several inputs need at least p + 1.

    Returns:
        One FRF for each excitation, NaN where inputs or response are constant; the coherence is the multiple coherence
        with all excitations.

    Raises:
        DataError: too few averages (the message contains the required length), a constant excitation, fully correlated
            excitations (equal, scaled or delayed copies, named in the message), different lengths, sampling rate too
            low, values not finite.
        ConfigurationError: window, overlap or band out of range.

    Source: Bendat and Piersol, Random Data, 4th ed., chapters 6, 7 and 9; bad-inputs item 15.
    """
    step = checked_time_step(time_step)
    edges = checked_band(band, step)
    x = checked_signals("excitations", excitations)
    y = checked_signals("responses", responses)
    inputs = x.shape[0]
    checked_same_length("responses", y, "the excitation", x.shape[1])
    labels = checked_names("input", input_names, inputs)
    outputs = checked_names("response", names, y.shape[0])
    minimum = minimum_averages if inputs == 1 else max(minimum_averages, inputs + 1.0)
    cut = cut_into_segments(x.shape[1], step, window_s=window_s, overlap=overlap, minimum_averages=minimum)
    refuse_constant(x, labels)
    options = {"window": cut.window, "nperseg": cut.length, "noverlap": cut.overlap, "detrend": "constant"}
    lines, syy = scipy.signal.welch(y, 1.0 / step, **options)
    inside = lines_in_band(lines, edges)
    csd = partial(scipy.signal.csd, fs=1.0 / step, **options)
    gxx_all = np.moveaxis(csd(x[:, None], x[None, :])[1], -1, 0)  # conj(X) X, (lines, p, p)
    gxx = gxx_all[inside]  # (m, p, p)
    gxy = np.moveaxis(csd(x[:, None], y[None, :])[1][..., inside], -1, 0)  # (m, p, k)
    syy = syy[:, inside]
    power = np.real(np.einsum("mii->mi", gxx))  # (m, p)
    reached = (power > EXCITED * np.real(np.einsum("mii->mi", gxx_all)).max(axis=0)).all(axis=1)
    size = np.sqrt(np.where(reached[:, None], power, 1.0))
    # Inputs of unit power: D^-1 Gxx D^-1 with D = diag(size), so that its eigenvalues measure the dependence alone.
    scaled = gxx / (size[:, :, None] * size[:, None, :])  # unit diagonal, (m, p, p)
    independence = np.where(reached, np.linalg.eigvalsh(scaled)[:, 0].clip(0.0), 0.0)
    if inputs > 1:
        _refuse_dependent(scaled, independence, labels)

    separable = independence >= INDEPENDENCE
    still = is_constant(y)
    response = np.full((inputs, y.shape[0], separable.size), complex(np.nan, np.nan))
    coherence = np.full((y.shape[0], separable.size), np.nan)
    inflation = np.full(
        (inputs, separable.size), np.nan
    )  # what inputs have in common raises the error: (Gxx^-1)_ii (Gxx)_ii
    # H = Gxx^-1 Gxy = D^-1 (D^-1 Gxx D^-1)^-1 D^-1 Gxy.
    cross = gxy[separable] / size[separable][:, :, None]
    solution = np.linalg.solve(scaled[separable], cross)  # (m, p, k)
    response[:, :, separable] = np.moveaxis(solution / size[separable][:, :, None], (0, 1, 2), (2, 0, 1))
    response[:, still] = complex(np.nan, np.nan)
    inflation[:, separable] = np.real(np.einsum("mii->im", np.linalg.inv(scaled[separable])))
    reasons = [CONSTANT.format(outputs[i]) for i in np.flatnonzero(still)]
    if cut.averages < 2.0:
        reasons.append(f"no coherence with {cut.averages:.3g} averages: a single average always gives 1")
    else:
        # Gxy^H Gxx^-1 Gxy: power of the response that the inputs explain.
        explained = np.real(np.einsum("mpk,mpk->km", cross.conj(), solution))
        share = np.full(explained.shape, np.nan)
        np.divide(explained, syy[:, separable], out=share, where=(syy[:, separable] > 0.0) & ~still[:, None])
        coherence[:, separable] = share
    for lost, cause in (
        (~reached, "the input has no power there"),
        (reached & ~separable, f"{CORRELATED}; use one input"),
    ):
        if lost.any():
            where = lines[inside][lost]
            reasons.append(f"no FRF at {where.size} lines of {where[0]:.3g} to {where[-1]:.3g} Hz: {cause}")
    # n - p + 1 averages are left, and dependent inputs reduce them further.
    averages = (cut.averages - inputs + 1.0) / inflation  # (p, m)
    noise = np.sqrt((1.0 - np.minimum(coherence, 1.0)) * syy / 2.0)  # (k, m)
    # sqrt((1 - gamma^2) Gyy (Gxx^-1)_ii/(2 (n - p + 1))) with (Gxx^-1)_ii = inflation/Gxx_ii.
    error = noise / np.sqrt(averages * size.T**2)[:, None]  # (p, k, m)
    return tuple(
        FrequencyResponse(
            frequency=lines[inside],
            response=response[number],
            coherence=coherence,
            random_error=error[number],
            averages=np.broadcast_to(averages[number], coherence.shape),
            segments=cut.count,
            window="hann",
            estimator="H1" if inputs == 1 else f"H1, {inputs} inputs",
            resolution_hz=float(lines[1]),
            reasons=tuple(reasons),
        )
        for number in range(inputs)
    )


def _refuse_dependent(scaled: Complex, independence: Vector, labels: tuple[str, ...]) -> None:
    """Raise an error if an input depends linearly on the others over most of the band."""
    if np.median(independence) >= INDEPENDENCE:
        return
    coherence = np.median(np.abs(scaled) ** 2, axis=0)  # (p, p)
    limit = (1.0 - INDEPENDENCE) ** 2
    pairs = [
        f"{labels[i]} and {labels[j]} (coherence {coherence[i, j]:.6f})"
        for i in range(len(labels))
        for j in range(i + 1, len(labels))
        if coherence[i, j] > limit
    ]
    which = "copies: " + ", ".join(pairs) if pairs else f"one of {', '.join(labels)} depends linearly on the others"
    raise DataError(
        f"excitations: {which}, so their responses cannot be separated (smallest eigenvalue of the normalised Gxx "
        f"{np.median(independence):.3g}, must be at least {INDEPENDENCE:g}). Use one input, for the response to the "
        "common motion, or drive the inputs independently"
    )
