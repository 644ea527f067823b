"""Dynamic stiffness of a hydromount with inertia track and decoupler, by harmonic balance.

Under z = A cos(w t) the displacement x of the fluid in the track is linear and is eliminated: at s = i k w, with the
track Z = mt s^2 + ct s, the chamber gives the force G (z - y), G = Kb Z/(Kb + Z). For the displacement y of the
decoupler,

    (md s^2 + cd s + Km + G) Y_k + [seat(y)]_k = G A at k = 1, 0 at k = 3, 5, ...,    seat(y) = Ks (y -+ g) beyond g,

and K = K1 + i w D1 + G (1 - Y_1/A) at k = 1. With the first harmonic alone, the seat is Ks N(a), with the describing
function of a gap,

    N(a) = 1 - 2/pi (asin(g/a) + g/a sqrt(1 - (g/a)^2)),  a > g,

a solution always exists: |L + Ks N(a)| a is continuous and unbounded, L being the bracket above. It is up to a quarter
off near the gap, where the decoupler bounces on its seat. `HARMONICS` odd harmonics, with the seat force sampled
over half a period, are solved by Newton's method with a line search, from the first harmonic, else by raising the seat
stiffness step by step.

Source: Gelb and Vander Velde, Multiple-Input Describing Functions (1968), dead zone; Krack and Gross, Harmonic Balance
for Nonlinear Vibration Problems (2019), alternating frequency and time.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Indices, Mask, Vector

HARMONICS = 16
"""Number of odd harmonics."""

SAMPLES = 8
"""Samples of half a period for each harmonic, and at least `FEWEST_SAMPLES`."""

FEWEST_SAMPLES = 32

RAISES = (4, 10, 28)
"""Numbers of seat stiffnesses from a thousandth to the whole, until Newton's method converges."""

ITERATIONS, HALVINGS, CLOSED = 25, 6, 1e-12
"""Maximum numbers of Newton steps and halvings of a step, and relative residual of a solution."""

DOUBLINGS, BISECTIONS = 60, 40
"""Doublings of the upper limit of an amplitude, and halvings of the interval: 1e-12 of it at the end."""


def describing_function(amplitude: npt.ArrayLike, gap: float) -> Vector:
    """Return N(a) [-] of a spring beyond a gap g [m] at peak amplitudes a of its displacement [m]; 0 within the gap."""
    ratio = np.minimum(gap / np.maximum(amplitude, 1e-300), 1.0)
    return np.asarray(1.0 - 2.0 / np.pi * (np.arcsin(ratio) + ratio * np.sqrt(1.0 - ratio**2)))


class DecouplerBalance:
    """Function K [N/m], (m,), of the decoupler law that starts from its previous solution.

    A point at which Newton's method does not converge has K of the describing function.

    Args:
        harmonics: number of odd harmonics; 1 is the describing function.
    """

    def __init__(self, harmonics: int = HARMONICS) -> None:
        self.harmonics = harmonics
        self.previous: Vector | None = None

    def __call__(self, values: Vector, omega: Vector, amplitude: Vector) -> Complex:
        """Return K.

        Args:
            values: K1, D1, Kb, mt, ct, g, md, cd, Km, Ks, see above, SI units; (10,).
            omega: angular frequencies [rad/s]; (m,).
            amplitude: peak amplitudes of the mount A [m]; (m,).
        """
        static, dashpot, chamber, mass, flow, gap, disc, leak, membrane, seat = values
        omega, amplitude = np.atleast_1d(omega), np.atleast_1d(amplitude)
        s = 1j * omega[:, None] * np.arange(1, 2 * self.harmonics, 2)
        track = mass * s**2 + flow * s
        fluid = chamber * track / (chamber + track)
        linear, load = disc * s**2 + leak * s + membrane + fluid, fluid[:, 0] * amplitude
        first = load / (linear[:, 0] + seat * describing_function(_first_amplitude(linear[:, 0], load, gap, seat), gap))
        touched = np.flatnonzero(np.abs(load / linear[:, 0]) > gap)
        if self.harmonics > 1:
            motion = np.concatenate([first[:, None], np.zeros_like(linear[:, 1:])], axis=1)
            starts = [motion] if self.previous is None or len(self.previous) != len(omega) else [self.previous, motion]
            balance = _Balance(linear[touched], load[touched], gap, seat)
            motion[touched] = balance.solve([_split(start[touched]) for start in starts])
            first, self.previous = motion[:, 0], motion
        return np.asarray(static + 1j * omega * dashpot + fluid[:, 0] * (1.0 - first / amplitude))


def decoupled_stiffness(values: Vector, omega: Vector, amplitude: Vector) -> Complex:
    """Return K [N/m], (m,), of a `DecouplerBalance` without a previous solution; same arguments."""
    return DecouplerBalance()(values, omega, amplitude)


def describing_stiffness(values: Vector, omega: Vector, amplitude: Vector) -> Complex:
    """Return K [N/m], (m,), with the describing function; same arguments."""
    return DecouplerBalance(1)(values, omega, amplitude)


def _first_amplitude(linear: Complex, load: Complex, gap: float, seat: float) -> Vector:
    """Return a with |L + Ks N(a)| a = |load| [m], by bisection between the amplitudes of both limits."""

    def force(a: Vector) -> Vector:
        return np.asarray(np.abs(linear + seat * describing_function(a, gap)) * a)

    low, high, size = np.zeros(len(load)), np.full(len(load), 2.0 * gap), np.abs(load)
    for _ in range(DOUBLINGS):
        low_force = force(high) < size
        if not low_force.any():
            break
        high = np.where(low_force, 2.0 * high, high)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        above = force(middle) > size
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.asarray(0.5 * (low + high))


def _split(motion: Complex) -> Vector:
    """Return the real parts, then the imaginary parts; (m, 2 n)."""
    return np.concatenate([motion.real, motion.imag], axis=1)


class _Balance:
    """Balance of the odd harmonics q of the decoupler, real parts before imaginary parts; (m, 2 n).

    Args:
        linear: bracket of the balance at each harmonic [N/m]; (m, n).
        load: force at the first harmonic [N]; (m,).
        gap: g [m].
        seat: Ks [N/m].
    """

    def __init__(self, linear: Complex, load: Complex, gap: float, seat: float) -> None:
        m, n = linear.shape
        samples = max(SAMPLES * n, FEWEST_SAMPLES)
        waves = np.exp(1j * np.outer(np.pi * np.arange(samples) / samples, np.arange(1, 2 * n, 2)))
        self.to_time = _split(np.conj(waves))
        self.to_harmonics, self.gap, self.seat = 2.0 / samples * self.to_time.T, gap, seat
        self.matrix, index = np.zeros((m, 2 * n, 2 * n)), np.arange(n)
        self.matrix[:, index, index] = self.matrix[:, index + n, index + n] = linear.real
        self.matrix[:, index, index + n], self.matrix[:, index + n, index] = -linear.imag, linear.imag
        self.load = np.zeros((m, 2 * n))
        self.load[:, 0], self.load[:, n] = load.real, load.imag
        self.closed = CLOSED * np.linalg.norm(self.load, axis=1)

    def solve(self, starts: Sequence[Vector]) -> Complex:
        """Return the harmonics [m], (m, n), by Newton's method from each start in turn, else the last start."""
        harmonics, size = np.array(starts[-1]), self.load.shape[1] // 2
        waiting = np.arange(len(harmonics))
        for start, raises in [*((each, 1) for each in starts), *((None, raises) for raises in RAISES)]:
            if not waiting.size:
                break
            if start is None:
                q = np.linalg.solve(self.matrix[waiting], self.load[waiting, :, None])[..., 0]
            else:
                q = start[waiting]
            for stiffness in self.seat * np.geomspace(1.0 if raises == 1 else 1e-3, 1.0, raises):
                converged = self._newton(q, waiting, float(stiffness))
            harmonics[waiting[converged]] = q[converged]
            waiting = waiting[~converged]
        return np.asarray(harmonics[:, :size] + 1j * harmonics[:, size:])

    def _residual(self, q: Vector, points: Indices, seat: float) -> tuple[Vector, Vector]:
        """Return residuals [N], (p, 2 n), and displacements over half a period [m], (p, samples)."""
        y = q @ self.to_time.T
        pressed = seat * (y - np.clip(y, -self.gap, self.gap))
        linear = np.einsum("pij,pj->pi", self.matrix[points], q)
        return linear + pressed @ self.to_harmonics.T - self.load[points], y

    def _newton(self, q: Vector, points: Indices, seat: float) -> Mask:
        """Improve the harmonics q of points, (p, 2 n) [m], in place; return True for the points that converge, (p,)."""
        live = np.arange(len(points))
        residual, y = self._residual(q, points, seat)
        for _ in range(ITERATIONS):
            left = np.linalg.norm(residual, axis=1) > self.closed[points[live]]
            live, residual, y = live[left], residual[left], y[left]
            if not live.size:
                break
            seated = seat * (np.abs(y) > self.gap)
            tangent = self.matrix[points[live]] + (self.to_harmonics * seated[:, None, :]) @ self.to_time
            change = np.linalg.solve(tangent, residual[..., None])[..., 0]
            norm, step, before = np.linalg.norm(residual, axis=1), np.ones(len(live)), q[live]
            for _ in range(HALVINGS):
                q[live] = before - step[:, None] * change
                residual, y = self._residual(q[live], points[live], seat)
                worse = np.linalg.norm(residual, axis=1) > (1.0 - 1e-4 * step) * norm
                if not worse.any():
                    break
                step[worse] *= 0.5
        converged = np.ones(len(points), dtype=bool)
        converged[live] = np.linalg.norm(residual, axis=1) <= self.closed[points[live]]
        return converged
