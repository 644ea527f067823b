"""Generate a two-track road of ISO 8608: the class determines the level, an isotropic surface the coherence.

    G(n) = G(n0) (n / n0)^-2,  n0 = 0.1 cycles/m,  from a lower to an upper wavenumber n [cycles/m]

The height over the wavenumber lines n_k = k / P of a length P is, with a mean and a difference of the tracks,

    z(x) = sum over k of A_k (sqrt((1 + g_k) / 2) cos(2 pi n_k x + phi_k)
                              +- sqrt((1 - g_k) / 2) cos(2 pi n_k x + psi_k))

right with +, left with -; A_k^2 / 2 = G(n_k) / P; g is the normalised cross spectrum. Only the phases are random. The
power of a track on a line, relative to G, is 1 +- sqrt(1 - g^2) cos(psi - phi), from 0 to 2; the mean of both tracks
and the real part of their cross spectrum, g, are exact. With phases in quadruples,

    psi_k = phi_k + theta_q + {0, pi, pi, 0},    theta_q a random phase for four lines

the terms with psi - phi add to zero over the four lines: then each track has the power of the class and the cross
spectrum g exactly, except for the second difference of sqrt(1 - g^2) within the four lines.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, Protocol

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.machine import physical_memory
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.road_level import REFERENCE
from vehicle.signals.excitation.band import positive, samples_of
from vehicle.signals.excitation.rest import half_cosine_at, half_cosine_rate_at
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.tyre_envelope import SAMPLES, TyreEnvelope
from vehicle.signals.formats.channel import uniform_axis

COPIES = 8
"""Number of arrays of the length of the record in memory, without height, slope and profile of each wheel: lines,
transform, its plan."""

LOWEST, HIGHEST = 0.011, 10.0
"""Minimum and maximum wavenumber [cycles/m]: lower end of ISO 8608 (waves of 91 m); waves of 0.1 m, a contact patch."""

RISE_S = 1.0
"""Time [s] of the rise of the road from the plane on which the car starts."""

Side = Literal["right", "left"]


Contact = tuple[Vector, Vector | None]
"""Heights of a track [m] and slopes tan(beta) [-]; None for slopes that are the derivatives of the heights."""


class Road(Protocol):
    """Heights of two tracks along a road."""

    @property
    def repeats(self) -> bool:
        """True if the heights repeat after the requested number of positions."""

    @property
    def words(self) -> str:
        """Description of the road, for messages and headers."""

    @property
    def bare(self) -> Road:
        """The road itself, with contact at a point."""

    def contact(self, start: float, step: float, steps: int, side: Side, highest: float) -> Contact:
        """Return the road as a tyre takes it at equally spaced positions; arguments see `IsoRoad.height`."""


def isotropic_coherence(wavenumber: Vector, track: float) -> Vector:
    """Return the cross spectrum of two tracks over their spectrum, g(n) = y K1(y) with y = 2 pi n b.

    The surface is isotropic: its two-dimensional spectrum depends on the length of the wave vector only, and falls
    with its third power if the spectrum of a track falls with the second. Then integral of cos(2 pi m b) / (n2 +
    m2)^(3/2) over m, divided by that at b = 0, is y K1(y) (Basset). The ordinary coherence is g^2.

    Args:
        wavenumber: wavenumbers n [cycles/m], above 0.
        track: distance b of the tracks [m].

    Source: Dodds and Robson, Journal of Sound and Vibration 31 (1973); Abramowitz and Stegun 9.6.25.
    """
    y = 2.0 * np.pi * np.asarray(wavenumber, dtype=np.float64) * track
    return np.asarray(y * scipy.special.k1(y))


@dataclass(frozen=True, kw_only=True, slots=True)
class IsoRoad:
    """Road of an ISO 8608 class; seed and length determine the road.

    Attributes:
        level: level G(n0) at 0.1 cycles/m [m3].
        seed: seed of the PCG64 generator of the phases.
        track: distance of the two tracks [m].
        lowest: minimum wavenumber [cycles/m].
        highest: maximum wavenumber [cycles/m].
        coherence: g of the tracks [-]; None for an isotropic surface, 1 for equal and 0 for independent tracks.
        patch: length a of the contact patch [m], over which the tyre averages the road: factor sinc(n a).
        quadruples: phases of mean and difference of the tracks in quadruples of lines; False: all independent.
        envelope: cams of the tyre, in place of the average over the contact patch.
    """

    level: float
    seed: int
    track: float
    lowest: float = LOWEST
    highest: float = HIGHEST
    coherence: float | None = None
    patch: float = 0.0
    quadruples: bool = True
    envelope: TyreEnvelope | None = None

    def __post_init__(self) -> None:
        positive("level of the road", self.level, "m3")
        positive("track", self.track, "m")
        if not 0.0 < self.lowest < self.highest < np.inf:
            raise ConfigurationError(f"wavenumbers {self.lowest!r} to {self.highest!r} cycles/m: must increase from 0")
        if self.coherence is not None and not 0.0 <= self.coherence <= 1.0:
            raise ConfigurationError(f"coherence {self.coherence!r}: must be 0 to 1, or none for an isotropic road")
        check_patch(self.patch)

    @property
    def repeats(self) -> bool:
        """True: a sum of waves is periodic."""
        return True

    @property
    def words(self) -> str:
        """Description of the road, for messages and headers."""
        related = "isotropic plane" if self.coherence is None else f"coherence {self.coherence:g}"
        return (
            f"road of ISO 8608, G(0.1 cycles/m) = {self.level:g} m3, {self.lowest:g} to {self.highest:g} cycles/m, "
            f"tracks {self.track:g} m apart ({related}), {contact_words(self.patch, self.envelope)}, seed {self.seed}"
        )

    @property
    def bare(self) -> IsoRoad:
        """The road itself, with contact at a point."""
        return replace(self, envelope=None, patch=0.0)

    def height(self, start: float, step: float, steps: int, side: Side, highest: float) -> Vector:
        """Return the heights of a track at equally spaced positions.

        Args:
            start: first position [m].
            step: distance of the positions [m].
            steps: number of positions N; the road repeats after P = N * step.
            side: right or left track.
            highest: maximum wavenumber for the sampling with `step` [cycles/m].

        Returns:
            Heights z [m], shape (N,).
        """
        if self.envelope is not None:
            return self.contact(start, step, steps, side, highest)[0]
        length = steps * step
        lines = np.arange(max(1, int(np.ceil(self.lowest * length))), int(min(self.highest, highest) * length) + 1)
        if lines.size == 0:
            shortest = 1.0 / min(self.highest, highest)
            raise ConfigurationError(
                f"road: repeats after {length:.3g} m, less than its shortest wave of {shortest:.3g} m; choose a longer "
                "--duration"
            )
        wavenumber = lines / length
        related = isotropic_coherence(wavenumber, self.track) if self.coherence is None else self.coherence
        # One phase pair for each line of the road, so that a longer road of the same seed has the same phases; (2,
        # lines).
        phase = 2.0 * np.pi * np.random.Generator(np.random.PCG64(self.seed)).random((int(lines[-1]), 2))[lines - 1].T
        if self.quadruples:
            # psi = phi + theta_q + {0, pi, pi, 0}: the signs + - - + cancel a linear change within the four, too.
            theta = np.repeat(phase[1, ::4], 4)[: lines.size]
            phase[1] = phase[0] + theta + np.pi * np.resize([0.0, 1.0, 1.0, 0.0], lines.size)
        sign = 1.0 if side == "right" else -1.0
        # z = sqrt((1 + g)/2) e^(i phi) +- sqrt((1 - g)/2) e^(i psi): both tracks have power 1 and the cross spectrum
        # g.
        numbers = np.sqrt(0.5 * (1.0 + related)) * np.exp(1j * phase[0])
        numbers = numbers + sign * np.sqrt(0.5 * (1.0 - related)) * np.exp(1j * phase[1])
        density = self.level * (wavenumber / REFERENCE) ** -2.0
        spectrum = np.zeros(steps // 2 + 1, dtype=np.complex128)
        # A = sqrt(2 G/P), average over the patch, shift to the start, and N/2 of irfft.
        spectrum[lines] = (
            numbers
            * np.sqrt(2.0 * density / length)
            * np.sinc(wavenumber * self.patch)
            * np.exp(2j * np.pi * wavenumber * start)
            * (0.5 * steps)
        )
        return np.fft.irfft(spectrum, steps)

    def contact(self, start: float, step: float, steps: int, side: Side, highest: float) -> Contact:
        """Return heights and, with cams, effective slopes of a track; arguments see `height`."""
        if self.envelope is None:
            return self.height(start, step, steps, side, highest), None
        parts = int(np.ceil(step / SAMPLES))
        fine, margin = step / parts, int(np.ceil(self.envelope.reach * parts / step)) + 1
        z = self.bare.height(start, fine, steps * parts, side, highest)
        # The road is periodic: wrapped around by the reach of the cams on both sides.
        x = uniform_axis(z.size + 2 * margin, fine, -margin * fine)
        return self.envelope.height_and_slope(x, np.pad(z, margin, mode="wrap"), uniform_axis(steps, step, 0.0))


def _repeated(values: Vector, count: int) -> Vector:
    """Return the first values of a periodic record; unlike `numpy.resize` without a second period in memory."""
    result = np.empty(count)
    for first in range(0, count, values.size):
        result[first : first + values.size] = values[: count - first]
    return result


def _finished(values: Vector) -> Vector:
    """Return values for a signal, which does not copy what is read-only."""
    values += 0.0  # avoids -0.0 in files
    values.setflags(write=False)
    return values


def check_patch(patch: float) -> None:
    """Reject a length of the contact patch [m] that is not from 0 to 1 m."""
    if not 0.0 <= patch < 1.0:
        raise ConfigurationError(f"contact patch {patch!r} m: must be at least 0 and below 1 m")


def contact_words(patch: float, envelope: TyreEnvelope | None) -> str:
    """Return the contact of the tyre in words: the contact patch that averages the road [m], or the cams."""
    return f"contact patch {patch:g} m" if envelope is None else envelope.words


def drive(
    road: Road,
    *,
    speed: float,
    wheels: Mapping[str, tuple[float, Side]],
    duration: float,
    rate: float = 1000.0,
    begin: float | None = None,
) -> Signal:
    """Generate the plate displacements of a car that drives over a road: z(t) = w(V t - d) z(V t - d).

    A wheel at the distance d behind the foremost wheel has the same displacement d / V later, exactly (the phases of
    the lines are shifted), including the rise w from the plane. With cams the slope is that of their plane on the road
    that rises, V tan(beta) w + w' z.

    Args:
        speed: speed V [m/s].
        wheels: name of each wheel to its distance d behind the foremost wheel [m], at least 0, and its track.
        duration: length of the record [s].
        rate: sampling rate [Hz].
        begin: start of the evaluated span [s]; a road that repeats then does so after this span, so that the lead-in
            is the end of the same period, and the span holds every wave of the road whole. None: no wheel reaches
            the repetition.

    Returns:
        Signal with duration * rate + 1 samples for all wheels.
    """
    positive("speed", speed, "m/s")
    steps = samples_of(duration, rate)
    needed, memory = 8.0 * steps * (3 * len(wheels) + COPIES), physical_memory()
    if needed > 0.5 * memory:
        raise ConfigurationError(
            f"duration {duration:g} s at {rate:g} Hz: needs {needed / 1e9:.3g} GB but may need at most half the "
            "memory of "
            f"this machine, {0.5 * memory / 1e9:.3g} GB; choose a shorter --duration or a lower --rate"
        )
    behind = [distance for distance, _ in wheels.values()]
    if not wheels or min(behind) < 0.0 or not np.isfinite(behind).all():
        raise ConfigurationError(f"distances of wheels {behind} m: must be 0 at the foremost axle, above 0 behind it")
    # Longer than the record by the delay of the last wheel: no wheel reaches the repetition of the road.
    period, repeats = steps + 1 + (int(np.ceil(max(behind) / speed * rate)) if road.repeats else 0), ""
    if road.repeats and begin is not None:
        period = steps - evaluated_span(steps + 1, 1.0 / rate, begin).start
        repeats = f", repeats after {period / rate:g} s"
    step, displacement, slopes, profile = speed / rate, {}, {}, {}
    for wheel, (distance, side) in wheels.items():
        # 0.8 of the Nyquist frequency, as for every generated signal. Heights modulo the period, or cut to the record.
        height, slope = road.contact(-distance, step, period, side, 0.4 / step)
        delayed_time = np.arange(steps + 1) / rate - distance / speed
        rise = half_cosine_at(delayed_time, RISE_S)
        if slope is not None:
            # d(w z)/dt = V tan(beta) w + w' z.
            rising = half_cosine_rate_at(delayed_time, RISE_S) * _repeated(height, steps + 1)
            slopes[wheel] = _finished(speed * _repeated(slope, steps + 1) * rise + rising)
        displacement[wheel] = _finished(_repeated(height, steps + 1) * rise)
        del delayed_time, height, slope  # a long road needs little memory beside its next transform
        profile[wheel] = _finished(
            _repeated(road.bare.contact(-distance, step, period, side, 0.4 / step)[0], steps + 1) * rise
        )
    return Signal(
        time=uniform_time(samples=steps + 1, timestep=1.0 / rate),
        displacement=displacement,
        source=f"{road.words}; {speed * 3.6:.6g} km/h, {RISE_S:g} s rise from rest{repeats}",
        slope_velocity=slopes,
        profile=profile,
    )
