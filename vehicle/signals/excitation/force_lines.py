"""Histories of applied forces, which rise from rest like a road.

A force F(t) = w(t) sum_j Re(Z_j exp(i theta_j)) + c r(t) is a sum over w cos(theta_j) and w sin(theta_j) with the
coefficients Re Z_j and -Im Z_j, and over records r of files, so that any number of forces at one frequency has two
histories. theta = W t at a constant frequency. In a run-up the speed W of the angle is linear between points, from W_1
at t_1 to W_2 at t_2, and constant after the last:

    theta = order (theta_1 + W_1 (t - t_1) + (W_2 - W_1) (t - t_1)^2/(2 (t_2 - t_1))),

and a force that grows with the power p of the speed has the histories (W(t)/W_h)^p w cos(theta) and sin, W_h the
highest speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vehicle.signals.analysis.samples import Vector
from vehicle.signals.excitation.force_record import ForceRecord
from vehicle.signals.excitation.iso_road import RISE_S
from vehicle.signals.excitation.rest import half_cosine_at

NODES, WEIGHTS = (0.5 * (1.0 + np.polynomial.legendre.leggauss(4)[0]), 0.5 * np.polynomial.legendre.leggauss(4)[1])
"""Points and weights of Gauss and Legendre on a step of length 1; the error of the mean of exp(i x t) over it is
x^8/1.8e9: 1e-14 for 200 Hz at 0.2 ms."""


class SweptLine(NamedTuple):
    """Order of an angle in a run-up.

    Attributes:
        times: times between which the speed of the angle is linear, from 0 on [s]; afterwards it is constant.
        speeds: speeds of the angle at these times [rad/s].
        order: multiple of the angle.
        power: exponent p of the growth of the force with the speed.
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]
    order: float = 1.0
    power: float = 0.0

    def angle(self, time: Vector) -> tuple[Vector, Vector]:
        """Return the angle [rad] and its speed [rad/s], without the order, at some times [s]."""
        times, speeds = np.array(self.times), np.array(self.speeds)
        lengths, changes = np.diff(times), np.diff(speeds)
        # Angle at the ends of the pieces: mean speed times length, exact for a linear speed.
        turned = np.append(0.0, np.cumsum(lengths * (speeds[:-1] + 0.5 * changes)))
        rising = np.clip(time, times[0], times[-1])
        piece = np.clip(np.searchsorted(times, rising, side="right") - 1, 0, len(lengths) - 1)
        since, rate = rising - times[piece], (changes / lengths)[piece]
        angle = turned[piece] + (speeds[piece] + 0.5 * rate * since) * since
        # Constant speed before the first and after the last time.
        angle = angle + speeds[-1] * np.maximum(time - times[-1], 0.0) + speeds[0] * np.minimum(time - times[0], 0.0)
        return angle, speeds[piece] + rate * since

    @property
    def highest(self) -> float:
        """Highest frequency of the order [rad/s]."""
        return self.order * max(self.speeds)


History = float | SweptLine | ForceRecord
"""Key of a history: an angular frequency [rad/s], an order in a run-up, or a file."""


@dataclass(frozen=True, slots=True)
class ForceLines:
    """Histories of applied forces.

    Attributes:
        frequencies: W_j [rad/s], positive, each once; (j,).
        swept: orders of run-ups; (s,).
        records: files; (r,).
    """

    frequencies: tuple[float, ...] = ()
    swept: tuple[SweptLine, ...] = ()
    records: tuple[ForceRecord, ...] = ()

    @classmethod
    def of(cls, forces: Sequence[Mapping[History, complex]]) -> ForceLines:
        """Return the histories of some forces, see `coefficients`."""
        keys = list(dict.fromkeys(key for force in forces for key in force))
        return cls(
            tuple(sorted(key for key in keys if isinstance(key, float))),
            tuple(sorted(key for key in keys if isinstance(key, SweptLine))),
            tuple(key for key in keys if isinstance(key, ForceRecord)),
        )

    def __len__(self) -> int:
        """Return the number of histories: two for each frequency and each order of a run-up, one for each record."""
        return 2 * (len(self.frequencies) + len(self.swept)) + len(self.records)

    def coefficients(self, force: Mapping[History, complex]) -> Vector:
        """Return the coefficients of the histories of a force; (2 j + 2 s + r,).

        Args:
            force: complex amplitude Z_j of each frequency W_j and each order of a run-up, and factor of a record.
        """
        keys: list[History] = [*self.frequencies, *self.swept]
        amplitudes = np.array([force.get(key, 0.0j) for key in keys], dtype=complex)
        # Re(Z exp(jWt)) = Re Z cos(Wt) - Im Z sin(Wt).
        waves = np.column_stack([amplitudes.real, -amplitudes.imag]).ravel()
        return np.concatenate([waves, [complex(force.get(record, 0.0)).real for record in self.records]])

    def values(self, time: Vector) -> Vector:
        """Return the histories at some times [s], (m,): w cos(W_1 t), w sin(W_1 t), w cos(W_2 t) ...; (m, 2 j + ...).

        Before t = 0 they are zero, as w is.
        """
        angle = np.multiply.outer(time, np.array(self.frequencies))
        growth = np.ones_like(angle)
        if self.swept:
            turned = [line.angle(time) for line in self.swept]
            highest = [line.highest / line.order for line in self.swept]
            angle = np.concatenate(
                [angle, *((line.order * each)[..., None] for line, (each, _) in zip(self.swept, turned, strict=True))],
                axis=-1,
            )
            rates = [
                ((speed / top) ** line.power)[..., None]
                for line, (_, speed), top in zip(self.swept, turned, highest, strict=True)
            ]
            growth = np.concatenate([growth, *rates], axis=-1)
        both = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        if self.swept:
            both *= growth[..., None]
        both = both.reshape(*time.shape, 2 * angle.shape[-1]) * half_cosine_at(time, RISE_S)[..., None]
        return np.concatenate([both, *(record.values(time)[..., None] for record in self.records)], axis=-1)

    def means(self, start: Vector, step: float) -> Vector:
        """Return the means of the histories over steps.

        Args:
            start: beginning of each step [s]; (m,).
            step: length of the steps [s].
        """
        return np.asarray(np.einsum("g,mgk->mk", WEIGHTS, self.values(start[:, None] + step * NODES)))

    def sampled(self, time: Vector, step: float) -> tuple[Vector, Vector]:
        """Return the histories at uniform times, and their means from each to the next.

        Risen waves have the means (sin(W t1) - sin(W t0))/(W h) and (cos(W t0) - cos(W t1))/(W h).

        Args:
            time: times [s]; (m,).
            step: time between two of them [s].

        Returns:
            Values; (m, lines). Means; (m - 1, lines).
        """
        values = self.values(time)
        if self.swept or self.records or time[0] < RISE_S:
            return values, self.means(time[:-1], step)
        changes = np.diff(values, axis=0).reshape(len(time) - 1, len(self.frequencies), 2)
        # The mean of cos is a difference of sin, that of sin the negative difference of cos, over W h.
        changes = changes[:, :, ::-1] * [1.0, -1.0] / (step * np.array(self.frequencies))[:, None]
        return values, changes.reshape(len(time) - 1, len(self))

    def require_length(self, duration: float) -> None:
        """Check that every record is at least as long as a run [s]."""
        for record in self.records:
            record.require_length(duration)
