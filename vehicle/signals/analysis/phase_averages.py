"""FRF of a nonlinear system at the level of a record: periodic inputs with its density and random phases, averaged.

A periodic input has lines at k/T alone, so in the steady state H(k/T) = Y_k / U_k has neither leakage nor windows. In a
car with friction, H differs from line to line with the phases of the input: 18 % for the `focus` on the high level. The
mean over M inputs with the same amplitudes and independent phases is the best linear approximation,

    H = 1/M sum H_m,    var(H) = 1/(M (M - 1)) sum |H_m - H|^2,

and the spread is its error. For a linear system all H_m are equal.

Source: Pintelon and Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, section 4.3.1 (robust
method).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Indices
from vehicle.errors import DataError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.spectra import power_spectral_density

PERIOD = 4.0
"""Period of the inputs [s], the inverse of the distance of the lines."""

LEAD = 11.0
"""Time before each evaluated period, in which the response of the input before decays [s]. The slowest mode of the
`focus` car with sliding dampers, 3.2 Hz with a damping ratio of 0.027, decays to 0.3 %, and the FRFs of the linear car
agree with those of its matrices within 2e-5 from 2 to 50 Hz (6 s: 4e-4)."""

CHANGE = 0.5
"""Time of the smooth change from one input to the next [s]."""

PHASES = 4
"""Number M of inputs: the error of H is half the scatter of a line."""

HIGHEST = 50.0
"""Highest line [Hz]; the lowest is 1 / PERIOD."""

DRIVEN = 1e-6
"""Minimum density of an evaluated line over the largest density of a line, weighted by f^4, as for acceleration."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PhaseInputs:
    """Inputs with random phases one after the other, from rest, each LEAD + PERIOD long.

    Attributes:
        time_step: sampling interval [s].
        samples: input over time, (n,), by name.
        frequency: evaluated lines [Hz]; (m,).
        lines: their indices in the spectrum of a period; (m,).
        spectra: spectrum of each input at the lines, of the first name; (PHASES, m).
    """

    time_step: float
    samples: Mapping[str, Vector]
    frequency: Vector
    lines: Indices
    spectra: Complex

    def periods(self, responses: Vector) -> Vector:
        """Return the evaluated periods of responses (k, n); (k, PHASES, samples of a period)."""
        lead, period = (round(length / self.time_step) for length in (LEAD, PERIOD))
        blocks = responses[:, : PHASES * (lead + period)].reshape(len(responses), PHASES, lead + period)
        return np.asarray(blocks[:, :, lead:])

    def response(self, responses: Vector) -> FrequencyResponse:
        """Return the FRFs to the first input.

        Args:
            responses: responses to `samples`; (k, n).

        Returns:
            Mean over the inputs, with the standard error of |H| and the coherence of a single input.
        """
        each = np.fft.rfft(self.periods(responses), axis=2)[:, :, self.lines] / self.spectra
        mean = each.mean(axis=1)
        variance = np.sum(np.abs(each - mean[:, None]) ** 2, axis=1) / (PHASES - 1)
        explained = np.abs(mean) ** 2
        return FrequencyResponse(
            frequency=self.frequency,
            response=mean,
            coherence=explained / np.maximum(explained + variance, np.finfo(float).tiny),
            random_error=np.sqrt(0.5 * variance / PHASES),
            averages=np.full(mean.shape, float(PHASES)),
            segments=PHASES,
            window="none (whole periods)",
            estimator=f"{PHASES} periodic inputs with random phases",
            resolution_hz=1.0 / PERIOD,
            reasons=(),
        )


def phase_inputs(
    time_step: float,
    record: Mapping[str, Vector],
    delays: Mapping[str, float] | None = None,
    *,
    interval: float | None = None,
    seed: int = 1,
) -> PhaseInputs:
    """Return inputs with the density of a record and random phases; all inputs move alike, each after its delay.

    Args:
        time_step: sampling interval of the record [s].
        record: samples of each input, (n,); the density is their mean.
        delays: delay of each input to the first [s]; 0 by default.
        interval: sampling interval of the inputs and of the responses to them [s]; of the record by default.
        seed: seed of the phases.
    """
    interval = interval or time_step
    period, lead, change = (round(length / interval) for length in (PERIOD, LEAD, CHANGE))
    count = next(iter(record.values())).size
    if count * time_step <= PERIOD:
        raise DataError(f"record: found {count * time_step:g} s, must be longer than {PERIOD:g} s for an FRF")
    estimate = power_spectral_density(time_step, np.array(list(record.values())), window_s=PERIOD)
    highest = min(round(HIGHEST * PERIOD), period // 2 - 1, len(estimate.frequency) - 2)
    frequency = np.arange(1, highest + 1) / PERIOD
    density = np.interp(frequency, estimate.frequency, estimate.density.mean(axis=0))
    weighted = density * frequency**4
    if not weighted.max() > 0.0:
        raise DataError("record: no input moves, so there is no FRF; use an input that moves a plate")
    # A^2/2 = S df with df = 1/PERIOD.
    amplitude = np.sqrt(2.0 * density / PERIOD)
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (PHASES, highest))
    ramp = np.arange(change) / change
    # Polynomial from 0 to 1 with zero first and second derivatives at both ends.
    ramp = ramp**3 * (10.0 - 15.0 * ramp + 6.0 * ramp**2)
    # The periodic input from `lead` before its period.
    block = np.arange(-lead, period) % period
    samples = {}
    for name in record:
        shift = 2.0 * np.pi * frequency * (delays or {}).get(name, 0.0)
        spectra = np.zeros((PHASES, period // 2 + 1), dtype=complex)
        # rfft of A cos(2 pi k t/T + phase) is N/2 A exp(i phase) on line k.
        spectra[:, 1 : highest + 1] = 0.5 * period * amplitude * np.exp(1j * (phase - shift))
        waves = np.fft.irfft(spectra, period, axis=1)[:, block]
        before = np.vstack([np.zeros(change), waves[:-1][:, lead : lead + change]])  # goes on for a moment
        waves[:, :change] = (1.0 - ramp) * before + ramp * waves[:, :change]
        # One sample more: the end of the last period, which is its begin.
        samples[name] = np.append(waves.ravel(), waves[-1, lead])
    evaluated = np.flatnonzero(weighted >= DRIVEN * weighted.max()) + 1
    first = 0.5 * period * amplitude * np.exp(1j * phase)
    return PhaseInputs(
        time_step=interval,
        samples=samples,
        frequency=frequency[evaluated - 1],
        lines=evaluated,
        spectra=first[:, evaluated - 1],
    )
