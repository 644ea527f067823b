"""Delays between the channels of a target that no drive can explain: more channels than plates must fit one drive.

At a line w the responses are Y = H U, with k channels and p < k plates. Of measured responses, channel i late by d_i,
the part outside the column space of H is

    r(d) = P S (E(d) Y - Z),   E = diag(exp(i w d_i)),   P = I - S H (S H)^+,   S = diag(1 / RMS of channel i),

with Z the response of the car to its best drive, for which the P S Z of a linear car is zero. The delays minimise the
sum of |r|^2 over the lines: a search channel by channel, then Gauss-Newton. A delay of all channels alike only moves
the drive: delays are those against the (lower) median of all channels. The estimate is as
accurate as the FRFs of the car: friction, of which H has the mean damping of the last run, moves it, and a second run
with the delay taken out is nearer. Its standard error takes stretches of lines as observations.

Source: Golub and Pereyra, SIAM J. Numerical Analysis 10(2), 1973, 413-432 (separable least squares: the drive is
projected out).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.digits import number
from vehicle.signals.records.counterpart import SHARE_OF_STEP, SIGNIFICANT
from vehicle.signals.records.finding import Finding
from vehicle.studies.replication.inverse import Lines

LARGEST_DELAY = 0.1
"""Maximum |delay| between two channels in the search [s]."""

PER_PERIOD = 12.0
"""Values of the search per period of the highest line."""

STRETCHES = 20
"""Number of stretches of lines as observations of the standard error; the misfit of a model varies over many lines."""

SEARCHES, ROUNDS = 3, 20
"""Number of searches of each channel, and maximum number of Gauss-Newton steps."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ChannelDelay:
    """Delay of a channel of the target against the median of all channels."""

    channel: str  # channel of the car
    delay: float  # delay in the file, with the part that was taken out [s]
    error: float  # standard error [s]
    taken_out: float  # part that was taken out [s]

    def summary(self) -> dict[str, Any]:
        """Return the entry of `summary.json`."""
        return {
            "channel": self.channel,
            "delay_s": self.delay,
            "delay_error_s": self.error,
            "taken_out_s": self.taken_out,
        }

    def advice(self, step: float) -> list[Finding]:
        """Return a finding with the option that takes the rest of the delay out; [] without a significant rest."""
        remainder = self.delay - self.taken_out
        if not abs(remainder) > max(SHARE_OF_STEP * step, SIGNIFICANT * self.error):
            return []
        option = f"{self.channel}={1e3 * self.delay:.5g}ms"
        text = (
            f"{self.channel} {'lags' if self.delay > 0.0 else 'leads'} the other channels by "
            f"{1e3 * abs(self.delay):.3g} ms (+- {number(1e3 * self.error, 1)} ms): a sensor delay? Remove it "
            f"with --delay {option}"
        )
        return [Finding(text, "delay", ("--delay", option))]


def against_median(delays: Vector) -> Vector:
    """Return delays against their median, for an even number against the lower of the two middle delays, (k,)."""
    return np.asarray(delays - np.sort(delays)[(delays.size - 1) // 2])


def delays_between(target: Vector, response: Vector, frf: Complex, lines: Lines) -> tuple[Vector, Vector]:
    """Return the delays of channels against their median, and their standard errors [s], (k,) each.

    Args:
        target: measured accelerations, (k, n).
        response: response of the car to its best drive, (k, n).
        frf: FRFs of the car at the lines, (k, p, m).
        lines: spectral lines of the record, with the band.

    Returns:
        NaN where channels are not more than plates: any delay is then met by another drive.
    """
    count, plates = frf.shape[:2]
    if count <= plates:
        return np.full(count, np.nan), np.full(count, np.nan)
    used = lines.inside[lines.used]
    omega = 2.0 * np.pi * lines.frequency[used]
    scale = 1.0 / np.std(lines.in_band(target), axis=1)
    y, z = (scale[:, None] * lines.spectrum(values)[:, used] for values in (target, response))
    table = np.moveaxis(scale[:, None, None] * frf[:, :, used], 2, 0)
    outside = np.eye(count) - table @ np.linalg.pinv(table)
    delays = np.zeros(count)

    def parts() -> Complex:
        """Return the contribution of each channel to r, (m, k, k): the last axis is the channel."""
        return np.asarray(outside * (np.exp(1j * omega * delays[:, None]) * y).T[:, None, :])

    offset = -np.einsum("mij,jm->mi", outside, z)
    step = 2.0 * np.pi / float(omega[-1]) / PER_PERIOD
    grid = step * np.arange(-np.ceil(LARGEST_DELAY / step), np.ceil(LARGEST_DELAY / step) + 1)
    for channel in [*range(1, count)] * SEARCHES:
        terms = parts()
        without = offset + terms.sum(axis=2) - terms[:, :, channel]
        still = terms[:, :, channel] * np.exp(-1j * omega * delays[channel])[:, None]
        product = np.sum(np.conj(without) * still, axis=1)
        delays[channel] = grid[np.argmin((np.exp(1j * grid[:, None] * omega) @ product).real)]
    for _ in range(ROUNDS):
        terms = parts()
        jacobian = (1j * omega[:, None, None] * terms)[:, :, 1:].reshape(-1, count - 1)
        residual = (offset + terms.sum(axis=2)).ravel()
        real, wanted = (np.concatenate([each.real, each.imag]) for each in (jacobian, residual))
        change = np.linalg.lstsq(real, -wanted, rcond=None)[0]
        delays[1:] += change
        if np.max(np.abs(change)) < 1e-9:
            break
    stretches = np.array_split(np.arange(omega.size), min(STRETCHES, omega.size))
    products = (np.conj(jacobian) * residual[:, None]).real.reshape(omega.size, count, -1).sum(axis=1)
    scores = np.array([products[stretch].sum(axis=0) for stretch in stretches])
    inverse = np.linalg.pinv(real.T @ real)
    covariance = np.zeros((count, count))
    covariance[1:, 1:] = inverse @ (scores.T @ scores) @ inverse * len(scores) / max(len(scores) - 1, 1)
    # Errors of the differences to the mean of all channels.
    centred = np.eye(count) - 1.0 / count
    return against_median(delays), np.sqrt(np.diag(centred @ covariance @ centred.T))
