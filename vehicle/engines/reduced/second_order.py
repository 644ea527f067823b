"""Errors of a run by the linear geometry of the reduced engine: the second order of the equations of motion.

With the linear motion u1 of a finished run, the next term of the equations of motion is the linear car under forces
that are products of two motions (`quadratic_forms`):

    M u2'' + C u2' + K u2 + H' f_b2 - Jc' l2 = -R_2(u1),    Jc u2 = -g_2(u1),
    f_b2' = K2 (e u2' + g u2 + r_2(u1)) - f_b2/tau,    y_2 = L u2 + y_2(u1).

Every nonlinear element of the poles (`PoleModel.element_forces`: dampers, stops, tables, one-sided tyres, rubber
friction) responds like a spring and a viscous damper of equal energy (`equivalent_damping`). The error of
a channel is that of its RMS without the second order, RMS(y_1)/RMS(y_1 + y_2) - 1: the products need not be independent
of y_1, so it has either sign. Source: regular perturbation, Nayfeh and Mook, Nonlinear Oscillations, 1979, chapter 2.
Against MuJoCo: `docs/theory/reduced-engine.md`.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.linear.displacement_laws import law_rows
from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.reduced.equivalent_damping import equivalent_damping, equivalent_laws
from vehicle.engines.reduced.linear_motion import (
    BAND,
    RATE,
    continued,
    periodic_spectra,
    plate_inputs,
    run_inputs,
    slow_end,
    state_spectra,
)
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.quadratic_forms import QuadraticForms
from vehicle.engines.reduced.stated_errors import (
    SMALL_FORCE,
    comfort_axes,
    comfort_errors,
    comfort_points,
    weighted_squares,
)
from vehicle.mapped_table import release
from vehicle.model.parameters.force_elements import Damper
from vehicle.signals.excitation.signal import Signal

Complex = npt.NDArray[np.complex64]

WINDOW = 8.0
"""Length of the windows of a record of which those with most motion are evaluated [s]."""

SHARE = 60.0
"""Time of a record for which one window is evaluated, at least one in all [s]. Against the whole record, over 48 roads
of 30 and 60 s (three cars, classes A to D): errors above 2 % are stated 0.67 to 1.55 times as large (5 to 95 %, median
1.19: these windows move most), comfort is 0.23 points RMS apart, and the warning is the same in 46."""

SAMPLES_AT_ONCE = 512
"""Samples whose products are computed together: they fit into the cache."""

WEAK = 1e-4
"""Products of two patterns whose shares of the motion have a smaller product are left out. With 1e-3, forces that
balance were left out in part: the body of `sedan` along x was stated 17 % too low on class D, where it is 12 %."""

WEAK_ELEMENT = 1e-2
"""Elements that change their own displacement by less than this share act by their tangent. With 0 all that is
stated of `focus_road` with rubber friction in all bushings stays within 1e-5 points."""

HIGHEST = 1.45 * BAND
"""Highest frequency of the second order [Hz]."""

FADE = 0.1
"""Time after the end of a record in which its motion fades [s]."""


class SecondOrder:
    """Response of a car to the products of its linear motion.

    Args:
        model: pole model of the car.
        forms: second order of its equations.
        damping: damping constants of viscous dampers with the same energy [N s/m]; (d,).
    """

    def __init__(self, model: PoleModel, forms: QuadraticForms, damping: Vector) -> None:
        self.model, self.forms, self.damping = model, forms, damping
        matrices, system = model.matrices, model.matrices.system
        basis = free_basis(system)
        # Real parts above imaginary parts: a real matrix that multiplies complex spectra.
        effects = _force_effects(model, basis)
        self.effects = np.vstack([effects.real, effects.imag]).astype(np.float32)
        # Least-norm solution of Jc u = -g: u2 is the sum of this motion of the gaps and a free motion of the joints.
        fit = -np.linalg.pinv(system.constraints)
        drifts = np.zeros_like(system.branch_rows) if system.branch_drifts is None else system.branch_drifts
        # Forces of that motion along the free motions.
        inertia, drag, spring = (basis.T @ part @ fit for part in (system.mass, system.damping, system.stiffness))
        # Rows over gaps, their rates and second derivatives.
        self.gap_forces = np.hstack([spring, drag, inertia]).astype(np.float32)
        # Rates of the branches by the gaps and by their velocities.
        self.gap_rates = np.hstack([drifts @ fit, system.branch_rows @ fit]).astype(np.float32)
        rows = np.array([system.outputs[channel][: system.size] for channel in forms.channels])
        rows = np.vstack([rows, matrices.tyre_rows, system.slide_rows])
        modal = rows @ model.modal
        # Re(a xi) = (a xi + conj(a xi))/2.
        self.outputs = (0.5 * np.vstack([modal.real, modal.imag])).astype(np.float32)
        self.shifts = (rows @ fit).astype(np.float32)
        # Nonlinear elements: displacements over the poles and over the gaps, and effects of their forces.
        elements = np.vstack([system.slide_rows, law_rows(model.laws, system.size)])
        # Half of a pole and half of its conjugate, likewise.
        self.strains = (0.5 * model.element_outputs.poles).astype(np.complex64)
        self.strain_shifts = (elements @ fit).astype(np.float32)
        self.element_forces = model.element_forces.astype(np.complex64)
        self.channels = (
            *forms.channels,
            *(f"tyre_{wheel}_force_z" for wheel in system.inputs),
            *(f"{damper}_force" for damper in matrices.damper_names),
        )

    def response(self, coordinates: Vector, interval: float, laws: Vector | None = None) -> Vector:
        """Return the second order of all channels; (channels, samples).

        Args:
            coordinates: coordinates c of the patterns over a period; (P, samples).
            interval: sampling interval [s].
            laws: stiffness [N/m] and damping [N s/m] of the laws over displacement beyond their tangents; (2, l).
        """
        samples = coordinates.shape[1]
        spectra = np.asarray(np.fft.rfft(_products(self.forms, coordinates), axis=1), dtype=np.complex64)
        frequency = np.arange(spectra.shape[1]) / (samples * interval)
        # Without the mean: accelerations have none, and forces count from theirs.
        at = np.flatnonzero((frequency > 0.0) & (frequency <= HIGHEST))
        s = (2j * np.pi * frequency[at]).astype(np.complex64)
        force, gaps, rates, points, tyres, strains = np.split(spectra[:, at], np.cumsum(self.forms.sizes)[:-1])
        gap_rates = s * gaps
        # -R_2 less what the motion of the gaps takes: M, C, K on its second and first derivative and on itself.
        load = -force - _times(self.gap_forces, np.vstack([gaps, gap_rates, s * gap_rates]))
        rates = rates + _times(self.gap_rates, np.vstack([gaps, gap_rates]))
        # xi and the conjugate of its spectrum at -s.
        poles, at_s = self.model.poles[:, None], 2j * np.pi * frequency[at]
        ahead, back = ((1.0 / (at_s - pole)).astype(np.complex64) for pole in (poles, poles.conj()))
        # xi = b F/(s - p), and for the conjugate pole with the conjugate residue.
        real, imaginary = np.vsplit(_times(self.effects, np.vstack([load, rates])), 2)
        xi, mirrored = (real + 1j * imaginary) * ahead, (real - 1j * imaginary) * back
        shift = _times(self.shifts, gaps)
        drag, forces = self._element_forces(laws, s, ahead, back, xi, mirrored, gaps, strains)
        # The nonlinear elements resist the second order.
        xi -= (forces @ drag) * ahead
        mirrored -= (forces.conj() @ drag) * back
        modal, turned = np.vsplit(self.outputs, 2)
        # (a xi + conj(a) xi*)/2 with a = m + i t is m (xi + xi*)/2 + i t (xi - xi*)/2, plus the motion of the gaps.
        moved = _times(modal, xi + mirrored) + 1j * _times(turned, xi - mirrored) + shift
        first, end = len(points), len(points) + len(tyres)
        matrices = self.model.matrices
        result = np.zeros((len(self.channels), spectra.shape[1]), dtype=np.complex64)
        # Acceleration s^2 y; tyre force -(k + c s) d; damper force c s x.
        result[:first, at] = s * s * (moved[:first] + points)
        stiffness = matrices.tyre_stiffness[:, None] + matrices.tyre_damping[:, None] * s
        result[first:end, at] = -stiffness * (moved[first:end] + tyres)
        result[end:, at] = self.damping[:, None] * s * moved[len(moved) - len(self.damping) :]
        return np.asarray(np.fft.irfft(result, samples, axis=1))

    def _element_forces(
        self,
        laws: Vector | None,
        s: Complex,
        ahead: Complex,
        back: Complex,
        xi: Complex,
        mirrored: Complex,
        gaps: Complex,
        strains: Complex,
    ) -> tuple[Complex, Complex]:
        """Return the forces of the nonlinear elements that act at the lines, and their effects on the poles.

        Args:
            laws: see `response`.
            s: lines; (m,).
            ahead, back: 1/(s - p) and 1/(s - conj(p)); (p, m).
            xi, mirrored: the poles without these forces, and the conjugate at -s; (p, m).
            gaps, strains: second order of gaps and of the displacements of the laws; (..., m).
        """
        count, tau = len(self.damping), np.array([law.rate_time for law in self.model.laws]).reshape(-1, 1)
        # Dynamic stiffness beyond that in the poles; an element without acts by its tangent.
        beyond = np.zeros((len(self.strains), len(s)), dtype=np.complex64)
        # Dampers are s (c - D), laws k + s c.
        beyond[:count] = s * (self.damping - self.model.matrices.viscous)[:, None]
        if laws is not None:
            beyond[count:] = laws[0][:, None] + s * laws[1][:, None]
        strain = _times(self.strain_shifts, gaps)
        # x = d + tau d'.
        strain[count:] = (1.0 + s * tau) * (strain[count:] + strains)
        # Mobility of each element by the same force, times its dynamic stiffness: relative change of its strain.
        products = self.strains * self.element_forces.T
        change = np.abs((products @ ahead + products.conj() @ back) * beyond)
        acting = np.flatnonzero(np.max(change, axis=1, initial=0.0) > WEAK_ELEMENT)
        beyond, strain = beyond[acting], strain[acting]
        forces, rows, size = self.element_forces[:, acting], self.strains[acting], len(acting)
        # Mobility of each element by the force of each other one; (e, e, m).
        pairs = (rows[:, None] * forces.T).reshape(size**2, len(xi))
        mobility = (pairs @ ahead + pairs.conj() @ back).reshape(size, size, len(s))
        strain = strain + rows @ xi + rows.conj() @ mirrored
        # x = x_0 - Y Z x, so (1 + Y Z) x = x_0 at each line; (m, e, e).
        coupling = np.eye(size) + np.moveaxis(mobility * beyond, -1, 0)
        strain = np.linalg.solve(coupling, strain.T[:, :, None])[:, :, 0].T
        return np.asarray(beyond * strain, dtype=np.complex64), forces


def rms_errors_of(
    model: PoleModel,
    forms: QuadraticForms,
    dampers: Sequence[Damper],
    signal: Signal,
    time: Vector,
    record: Mapping[str, Vector],
    names: Sequence[str],
    tyre_load: Mapping[str, float],
    seated: bool = False,
) -> tuple[dict[str, float], frozenset[str]]:
    """Return the errors RMS(y_1)/RMS(y_1 + y_2) - 1 of a run, and the axes of comfort and forces that matter.

    The errors are those of the channels that have a second order, and of the comfort values of points whose axes are
    among them, see `comfort_errors`.

    Args:
        model, forms: the car.
        dampers: laws of its dampers.
        signal: motion of the plates.
        time: times of the n samples [s].
        record: all channels of dampers and tyres, "law_<index>" of the laws, and the channels; (n,) each.
        names: names of the channels.
        tyre_load: static tyre loads by wheel [N].
        seated: True for a car with a seat, on whose cushion comfort is read too.
    """
    damping = np.array(
        [
            equivalent_damping(law, record[f"{damper}_velocity"], record[f"{damper}_force"])
            for law, damper in zip(dampers, model.matrices.damper_names, strict=True)
        ]
    )
    second, channels = SecondOrder(model, forms, damping), {name: record[name] for name in names}
    interval = float(time[1] - time[0])
    # Samples from one product to the next: at least RATE.
    every = max(int(1.0 / (interval * RATE)), 1)
    names = [name for name in second.channels if name in channels]
    if not names:
        return {}, frozenset()
    rows = [second.channels.index(name) for name in names]
    # Windows of about WINDOW, of a whole number of these steps.
    windows = max(round(time.size * interval / WINDOW), 1)
    length = -(-time.size // (windows * every)) * every
    chosen = _most_motion([record[f"tyre_{wheel}_force_z"] for wheel in tyre_load], length, time[-1] / SHARE)
    # Forces count from their mean, which the second order shifts; the static load is a thousand times a weak motion.
    forces = np.array([not name.endswith(("_acc_x", "_acc_y", "_acc_z")) for name in names])
    reference = np.where(forces, [float(channels[name][0]) for name in names], 0.0)[:, None]
    points = comfort_points(names, seated)
    sums, weighted, count, start, end = np.zeros((4, len(names))), np.zeros((2, len(points))), 0, None, None
    for window in range(max(chosen) + 1):
        # In a window that is not evaluated only the slow poles move on, from every `every`-th sample.
        part = slice(window * length, min((window + 1) * length, time.size), 1 if window in chosen else every)
        block = {name: values[part] for name, values in record.items()}
        release(block[names[0]])
        plates = plate_inputs(model, signal, time[part], block, tyre_load)
        histories = run_inputs(model, plates, block, time[part])
        # The car is at rest at the first sample of the record.
        start = histories[:, :1] if start is None else start
        if window not in chosen:
            end = slow_end(second.model, histories - start, interval * every, end)
            continue
        spectra, samples = periodic_spectra(histories - start, interval, every)
        state = state_spectra(second.model, spectra, interval * every, samples)
        linear = np.array([channels[name][part][::every] for name in names]) - reference
        projection = second.forms.projection
        lacking, end = continued(second.model, state, interval * every, samples, linear.shape[1], end)
        gains = equivalent_laws(model, state, interval * every, samples)
        # Periodic motion, and what slow poles keep from the part before.
        coordinates = np.fft.irfft(projection @ state, samples, axis=1) + projection[:, : len(lacking)] @ lacking
        coordinates = _faded(coordinates, linear.shape[1], interval * every)
        # y_1 + y_2.
        more = linear + second.response(coordinates, interval * every, gains)[rows, : linear.shape[1]]
        # Sum and sum of squares of y_1, then of y_1 + y_2: forces count from their mean over all parts.
        sums += [np.sum(values**power, axis=1) for values in (linear, more) for power in (1, 2)]
        weighted += [
            [weighted_squares(point, values[axes], interval * every) for point, axes in points.items()]
            for values in (linear, more)
        ]
        count += linear.shape[1]
    linear, more = (sums[k + 1] - np.where(forces, sums[k] ** 2 / max(count, 1), 0.0) for k in (0, 2))
    moving = (linear > 0.0) & (more > 0.0)
    errors = np.sqrt(linear, where=moving, out=np.ones(len(names)))
    errors /= np.sqrt(more, where=moving, out=np.ones(len(names)))
    channel_errors = dict(zip(names, (errors - 1.0).tolist(), strict=True))
    large = forces & (linear > count * (SMALL_FORCE * max(tyre_load.values())) ** 2)
    read = comfort_axes(points, names, linear).union(np.array(names)[large].tolist())
    return channel_errors | comfort_errors(points, np.stack([linear, more]), weighted), read


def _most_motion(tyre_forces: Sequence[Vector], length: int, number: float) -> list[int]:
    """Return the indices of the windows with the largest mean square of the tyre forces, in the order of time.

    Args:
        tyre_forces: force of each tyre, (n,).
        length: samples of a window; the last may be shorter.
        number: number of windows; at least one is returned.
    """
    begins = np.arange(0, tyre_forces[0].size, length)
    squares = np.zeros(begins.size)
    for force in tyre_forces:
        squares += np.add.reduceat(np.square(force - force[0]), begins)
        release(force)
    levels = squares / np.diff(np.append(begins, tyre_forces[0].size))
    return sorted(np.argsort(-levels, kind="stable")[: max(round(number), 1)].tolist())


def _faded(coordinates: Vector, count: int, interval: float) -> Vector:
    """Return the coordinates of a record, (P, samples), which fade to those of its start after its `count` samples.

    After the end the friction of a damper that stuck no longer meets the motion that it stopped, and moves the car on
    its springs: further than a weak motion in the record.
    """
    fade = np.clip(np.arange(coordinates.shape[1] - count) * interval / FADE, 0.0, 1.0)
    weight = np.concatenate([np.ones(count), 0.5 * (1.0 + np.cos(np.pi * fade))])
    return np.asarray(coordinates * weight + coordinates[:, :1] * (1.0 - weight))


def _products(forms: QuadraticForms, coordinates: Vector) -> npt.NDArray[np.float32]:
    """Return the sum of c_j c_k B_jk at each sample, without weak products; (rows, samples)."""
    # In principal coordinates of this motion most products are weak.
    covariance = coordinates @ coordinates.T / coordinates.shape[1]
    levels = np.einsum("bij,ij->b", forms.metrics, covariance)
    if not np.any(levels > 1e-12):
        # At rest.
        return np.zeros((forms.forms.shape[2], coordinates.shape[1]), dtype=np.float32)
    # Each kind of quantity (rotations, rates, inertia, ...) is divided by its level in this motion.
    metric = np.tensordot(np.where(levels > 1e-12, 1.0 / np.maximum(levels, 1e-30), 0.0), forms.metrics, 1)
    # root = metric^1/2 and back = metric^-1/2; the floor keeps the inverse finite.
    usual, root = np.linalg.eigh(metric)
    usual = np.sqrt(np.maximum(usual, 1e-9 * usual[-1]))
    root, back = (root * usual) @ root.T, (root / usual) @ root.T
    # In c' = metric^1/2 c the principal components of the motion; shares: their RMS over that of all.
    shares, turn = np.linalg.eigh(root @ covariance @ root)
    shares = np.sqrt(np.maximum(shares, 0.0) / np.sum(shares))
    # Patterns with a product that counts: the strongest product of each is that with the strongest pattern, the last.
    kept = shares * shares[-1] > WEAK
    # c = back turn c', c' = turn' root c.
    shares, turn, coordinates = shares[kept], back @ turn[:, kept], turn[:, kept].T @ root @ coordinates
    first, other = np.triu_indices(len(shares))
    strong = shares[first] * shares[other] > WEAK
    first, other = first[strong], other[strong]
    count, rows = len(usual), forms.forms.shape[2]
    # B over the principal coordinates, turn' B turn, for the strong pairs alone; (pairs, rows).
    turned = turn.T.astype(np.float32) @ forms.forms.reshape(count, -1)
    turned = np.matmul(turn.T.astype(np.float32), turned.reshape(len(shares), count, rows))[first, other]
    # B is symmetric: a pair j, k counts twice.
    turned[first != other] *= 2.0
    turned, coordinates = np.ascontiguousarray(turned.T), coordinates.astype(np.float32)
    products = np.empty((rows, coordinates.shape[1]), dtype=np.float32)
    for begin in range(0, coordinates.shape[1], SAMPLES_AT_ONCE):
        block = coordinates[:, begin : begin + SAMPLES_AT_ONCE]
        products[:, begin : begin + SAMPLES_AT_ONCE] = turned @ (block[first] * block[other])
    return products


def _times(rows: npt.NDArray[np.float32], spectra: Complex) -> Complex:
    """Return the product of a real and a complex matrix."""
    # Complex columns seen as pairs of real columns.
    flat = np.ascontiguousarray(spectra, dtype=np.complex64)
    return np.asarray((rows @ flat.view(np.float32)).view(np.complex64))


def _force_effects(model: PoleModel, basis: Vector) -> npt.NDArray[np.complex128]:
    """Return the effects of forces along the free motions and of rates of the branches on the poles; (p, m + b)."""
    system, poles = model.matrices.system, model.poles
    # Eigenvectors V = (y, y', f_b) of all poles, from the displacements and branches of the stored poles.
    free, placed = basis.shape[1], basis.shape[1] - len(system.cyclic)
    # The vector of a stored pole of a pair is doubled, because the conjugate is left out.
    halves = np.where(np.arange(len(poles)) < model.pairs, 2.0, 1.0)
    vectors = np.vstack([basis[:, :placed].T @ model.modal, basis.T @ (model.modal * poles), model.branch]) / halves
    vectors = np.hstack([vectors, vectors[:, : model.pairs].conj()])
    inputs = np.zeros((len(vectors), free + len(model.branch)))
    # A force changes y' by (N' M N)^-1, a rate changes f_b by K2.
    inputs[placed : placed + free, :free] = np.linalg.inv(basis.T @ system.mass @ basis)
    inputs[placed + free :, free:] = np.diag(system.branch_stiffness)
    # V^-1 B, the rows of the stored poles.
    return np.asarray(np.linalg.solve(vectors, inputs)[: len(poles)])
