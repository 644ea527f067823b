"""Quadratic part of the equations of motion of a car over patterns of its linear motion.

The equations in MuJoCo's coordinates, R(u, u', u'', f_b, l, z, z') = 0 with gaps g(u) of the joints, rates r of the
Maxwell branches, output points y(u) and tyre deflections d(u), are expanded about the design position. Their part of
second order is a quadratic form of the linear motion w. With w = sum of c_k w_k over P patterns,

    Q(w) = sum over j, k of c_j c_k B_jk,    B_jk = (Q(w_j + w_k) - Q(w_j) - Q(w_k)) / 2,

one evaluation of the equations for each pair. The patterns are the principal components of the motion on plates
with independent velocities of equal level at all frequencies, as on roads and over edges, and with independent forces
of dampers and laws. Each pattern is a motion with its forces, in equilibrium.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.linear.equations_of_motion import Equations
from vehicle.engines.reduced.linear_motion import BAND, RATE, input_effects, motion_rows, state_spectra
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.row_layout import places_of

PATTERNS = 88
"""Number of patterns. What is stated of 319 channels over obstacles and on classes C and D differs from that with all
patterns beyond rounding, 100 to 160, by at most 0.4 points; with 80 patterns by 1.3, with 72 by 4.7, with 64 by 9."""

PERIOD = 4096
"""Samples of the motion that gives the patterns."""

FORCE_LEVEL = 1000.0
"""RMS of the forces of dampers and laws over the RMS of the plate velocities, for the patterns [N s/m]."""

AMPLITUDE = 1e-4
"""Largest coordinate of a pattern in an evaluation [rad, m]. The third order moves what is stated of an RMS by up to
0.6 points at 1e-3 and a tenth of this here; below, rounding grows."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class QuadraticForms:
    """Second order of the equations over patterns.

    Attributes:
        metrics: squares of rotations, their rates, inertia, branch and joint forces over c; (5, P, P).
        projection: coordinates c of the patterns over the state of the linear motion; (P, states).
        forms: B; (P, P, rows): forces along the free motions, gaps, branch rates, positions of the output points,
            vertical deflections of the tyres, displacements of the laws.
        sizes: numbers of rows of each kind; (6,).
        channels: names of the positions.
    """

    metrics: Vector
    projection: Vector
    forms: npt.NDArray[np.float32]
    sizes: tuple[int, ...]
    channels: tuple[str, ...]


def quadratic_forms(car: CarModel, model: PoleModel) -> QuadraticForms:
    """Return the second order of the equations of motion of a car over the patterns of its linear motion."""
    rows, system, matrices = motion_rows(model), model.matrices.system, model.matrices
    whole, sums = np.vstack(rows), _state_products(model)
    # What must be right in a pattern, over the state: rotations, their rates, inertia and joint forces.
    turns = np.vstack([body[3:] for name, body in matrices.body_rows.items() if name not in matrices.spinning])
    inertia = np.sqrt(np.diag(system.mass))[:, None] * rows.acceleration
    seen = [turns @ rows.displacement, turns @ rows.velocity, inertia, rows.branch, rows.joints]
    levels = [np.sqrt(np.sum((part @ sums) * part)) for part in seen]
    # Each kind has the level 1, so that angles and forces count alike.
    seen = [part / max(level, 1e-30) for part, level in zip(seen, levels, strict=True)]
    usual, projection = _components(np.vstack(seen), sums)
    # Motion and forces of a pattern: those of the states that belong to its coordinate.
    # Regression of the state on a coordinate, E(S c)/E(c^2): the motion that goes with it on average.
    of_patterns = sums @ projection.T / usual**2
    patterns = whole @ of_patterns
    bounds = np.cumsum([0, *(len(part) for part in rows)])
    # Coordinates in which each pattern has its largest size in an evaluation.
    # At most its RMS: a pattern of forces that hardly moves would become far too large.
    size = AMPLITUDE / np.maximum(np.max(np.abs(patterns[: bounds[1]]), axis=0), 1e-30)
    size = np.minimum(size, usual)
    patterns = patterns * size
    equations = Equations(car, model.matrices)

    def at(vectors: Vector) -> Vector:
        return equations.at(tuple(np.split(vectors, bounds[1:-1])))

    at_rest, ahead, back = at(0.0 * patterns[:, :1]), at(patterns), at(-patterns)
    # R(w) = R(0) + odd + even: the even part is Q(w) to the third order, which is odd.
    odd, even = 0.5 * (ahead - back), 0.5 * (ahead + back) - at_rest
    forms = np.zeros((patterns.shape[1], patterns.shape[1], len(at_rest)), dtype=np.float32)
    for k in range(patterns.shape[1]):
        # B_kk = Q(w_k), over the square of its size.
        forms[k, k], others = even[:, k] / size[k] ** 2, slice(k + 1, None)
        if k + 1 == patterns.shape[1]:
            break
        pairs = at(patterns[:, others] + patterns[:, [k]])
        # (Q(w_j + w_k) - Q(w_j) - Q(w_k))/2, with the linear parts of both taken out of R(w_j + w_k).
        mixed = 0.5 * (pairs - at_rest - odd[:, others] - odd[:, [k]] - even[:, others] - even[:, [k]])
        forms[k, others] = (mixed / (size[k] * size[others])).T
        forms[others, k] = forms[k, others]
    points = tuple(f"{point}_acc_{axis}" for point in places_of(car.model) for axis in "xyz")
    parts = [part @ of_patterns for part in seen]
    # Square of each kind over the coordinates: |part c|^2 = c' metric c.
    metrics = np.array([part.T @ part for part in parts])
    sizes = (
        equations.basis.shape[1],
        len(equations.joints),
        int(np.count_nonzero(equations.present)),
        len(points),
        len(system.inputs),
        len(model.laws),
    )
    return QuadraticForms(metrics=metrics, projection=projection, forms=forms, sizes=sizes, channels=points)


def _components(rows: Vector, sums: Vector) -> tuple[Vector, Vector]:
    """Return the RMS values of the coordinates of the patterns, (P,), and the coordinates over the state, (P, states).

    The coordinates are the principal components of the rows: c = V' rows S with rows E(S S') rows' = V diag(w) V'. In
    as many dimensions as there are states, with E(S S') = F F': F' rows' rows F = U diag(w) U', V = rows F U / sqrt(w).
    """
    levels = np.sqrt(np.maximum(np.diag(sums), 1e-300))
    # E(S S') = F F' with F = root; scaled to equal diagonals first, since states have different units.
    shares, turn = np.linalg.eigh(sums / np.outer(levels, levels))
    root = levels[:, None] * turn * np.sqrt(np.maximum(shares, 0.0))
    # V' rows S with V = rows F U / sqrt(w).
    seen = rows @ root
    squares, components = np.linalg.eigh(seen.T @ seen)
    # Below this they are rounding.
    count = min(PATTERNS, np.count_nonzero(squares > 1e-12 * squares[-1]))
    usual, components = np.sqrt(squares[::-1][:count]), components[:, ::-1][:, :count]
    projection = (seen @ components / usual).T @ rows
    # A component has either sign.
    # The largest entry decides, so that equal cars have equal patterns.
    largest = np.argmax(np.abs(projection), axis=1)
    return usual, projection * np.sign(projection[np.arange(len(projection)), largest])[:, None]


def _state_products(model: PoleModel) -> Vector:
    """Return the means of the products of the states in the motion that gives the patterns; (states, states)."""
    random = np.random.Generator(np.random.PCG64(0))
    wheels, count = len(model.matrices.system.inputs), input_effects(model).shape[1]
    frequency = np.arange(PERIOD // 2 + 1) * RATE / PERIOD
    noise = np.fft.rfft(random.standard_normal((count - wheels, PERIOD)), axis=1)
    # White velocity of the plates: the displacement falls with 1/w.
    noise[:wheels] /= 2.0 * np.pi * np.maximum(frequency, frequency[1])
    # Histories of applied forces have unit amplitude.
    # Forces of dampers and laws fall with 1/f above 20 Hz.
    noise[wheels + model.slope.shape[1] : len(noise) - len(model.matrices.lines)] *= FORCE_LEVEL / (
        1.0 + frequency / 20.0
    )
    spectra = state_spectra(model, noise, 1.0 / RATE, PERIOD)[:, (frequency > 0.0) & (frequency <= BAND)]
    parts = np.hstack([spectra.real, spectra.imag])
    # Parseval for a one-sided spectrum: mean(x y) = 2/N^2 sum Re(X Y*).
    return np.asarray(parts @ parts.T * (2.0 / PERIOD**2))
