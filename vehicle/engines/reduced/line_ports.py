"""Linear twins of cars that differ from a reference car in a few directions, without new poles.

In the free motions y of the joints the reference car has Z_0(s) y = B_0(s) z + S' f at each line s = j 2 pi f, with the
plates z and the forces f of the dampers. Let the p rows R, the ports, contain all directions in which another car
differs:

    Z = Z_0 + R' S R,    B = B_0 + R' b,    S = S_K + s S_C + s^2 S_M.

With the responses T of the reference car to forces at its ports, the displacements q of the ports of the other car, the
forces w there and any output x are

    q = (I + T_pp S)^-1 (T_pz z + T_pp b z + T_pf f),    w = b z - S q,    x = T_xz z + T_xf f + T_xp w.

The car is stable if the reference car is stable and det(I + T_pp S) does not turn about 0 between s = 0 and j infinity
(Nyquist). Stiffnesses also shift preloads, a change in all directions, but a small one: D = P' dK P is the change with
the reference energy y'(K_0 + w0^2 M_0) y as unit, and directions below `KEPT` are left out.

Source: Woodbury identity; Golub and Van Loan, Matrix Computations, section 2.1.4; Nyquist criterion for systems of
several variables: Skogestad and Postlethwaite, Multivariable Feedback Control, section 4.9.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.reduced.linear_twin import LinearTwin, linear_twin
from vehicle.engines.reduced.pole_model import PoleModel

KEPT, LEFT = 3e-4, 1.5e-3
"""Least size of a direction of an example, and maximum rest of a car, in units of the reference energy: comfort and
tyre loads of random cars of `focus_road` and `sedan` are within 4e-5 of those by new poles."""

SMALLEST = 0.01
"""Minimum size of an example, to which smaller ones, for example of a parameter that is 0, are enlarged."""

MOST = 24
"""Maximum number of ports: with more, new poles take less time."""

UNIT = 2.0 * np.pi * 1.5
"""w0 [rad/s] of the unit of energy, the heave of a car: without K_0 the whole car can move."""

DAMPING_AT = 2.0 * np.pi * 10.0
"""Angular frequency at which changes of damping count [rad/s]: a wheel hop."""

LARGEST_TURN = 2.0
"""Maximum turn of the determinant between two lines [rad], below pi, so that its turns about 0 are counted."""


class LinePorts:
    """Twins of cars that differ from a reference car as a few examples do.

    Args:
        model: stable reference car.
        channels, plates: see `linear_twin`; the displacements of the laws of the car are further outputs.
        frequency: lines [Hz]; (m,).
        examples: cars that each differ from the reference car in one parameter.

    Raises:
        numpy.linalg.LinAlgError: a reference car that can move without resistance.
    """

    def __init__(
        self,
        model: PoleModel,
        channels: Sequence[str],
        frequency: Vector,
        plates: Complex,
        examples: Sequence[CarMatrices],
    ) -> None:
        self.reference, system = model.matrices, model.matrices.system
        self.channels, self.plates = tuple(channels), np.ascontiguousarray(np.moveaxis(plates, -1, 0))
        self.basis = free_basis(system)
        mass, stiffness = (self.basis.T @ part @ self.basis for part in (system.mass, system.stiffness))
        root = np.linalg.cholesky(0.5 * (stiffness + stiffness.T) + UNIT**2 * mass)
        # y = L^-T e has the energy e'e.
        self.scaled = self.basis @ scipy.linalg.solve_triangular(root, np.eye(len(root)), lower=True, trans=1)
        sides = [side for each in examples for part in self._enlarged(each) for side in (part, part.T)]
        directions, sizes, _ = np.linalg.svd(np.hstack(sides or [np.zeros((len(root), 1))]), full_matrices=False)
        self.directions = directions[:, sizes > KEPT]
        # The rows R = Q' L' of the ports.
        self.rows = self.directions.T @ root.T
        twin = linear_twin(model, channels, frequency, plates, further=model.law_outputs)
        self.reference_twin, self.count = twin, plates.shape[1]
        # Lines first, for the solution of all lines; inputs: plates, then dampers.
        self.outputs, self.slip = (
            np.ascontiguousarray(np.moveaxis(np.concatenate(parts, axis=1), -1, 0))
            for parts in ((twin.outputs, twin.outputs_by_force), (twin.slip, twin.slip_by_force))
        )
        # The first line is so low that the determinant is real there.
        self.s = 2j * np.pi * np.append(0.01 * frequency[0], frequency)
        self._respond()

    def _changes(self, matrices: CarMatrices) -> Iterator[tuple[Vector, int]]:
        """Yield the changes of K, C and M in units of the reference energy, with their powers of s."""
        for power, (name, unit) in enumerate((("stiffness", 1.0), ("damping", DAMPING_AT), ("mass", UNIT**2))):
            change = getattr(matrices.system, name) - getattr(self.reference.system, name)
            if change.any():
                yield unit * (self.scaled.T @ change @ self.scaled), power

    def _enlarged(self, matrices: CarMatrices) -> list[Vector]:
        """Return the changes of an example, those below 1 % of the energy enlarged to it."""
        changes = [change for change, _ in self._changes(matrices)]
        size = np.sqrt(sum(float(np.sum(change**2)) for change in changes))
        return [change * max(SMALLEST / size, 1.0) for change in changes] if size else []

    def _respond(self) -> None:
        """Compute the responses to forces at the ports, and of the ports to all inputs, by solution at each line."""
        system, basis, s = self.reference.system, self.basis, self.s
        mass, damping, stiffness = (basis.T @ part @ basis for part in (system.mass, system.damping, system.stiffness))
        effects, strains, slides = (part @ basis for part in (system.effects, system.branch_rows, system.slide_rows))
        drifts = np.zeros_like(strains) if system.branch_drifts is None else system.branch_drifts @ basis
        ports, size = self.rows, len(self.rows)
        self.by_port = np.empty((s.size, self.outputs.shape[1], size), dtype=complex)
        self.slip_by_port = np.empty((s.size, len(slides), size), dtype=complex)
        self.at_port = np.empty((s.size, size, self.outputs.shape[2]), dtype=complex)
        self.port_by_port = np.empty((s.size, size, size), dtype=complex)
        rows = self._output_rows() @ basis
        factors = self._factors(self.reference)
        for index, line in enumerate(s):
            transfer = (system.branch_stiffness / (line + 1.0 / system.branch_time))[:, None]
            whole = line**2 * mass + line * damping + stiffness + effects.T @ (transfer * (line * strains + drifts))
            driven = basis.T @ (system.input_stiffness + line * system.input_damping)
            driven = driven @ self.plates[max(index - 1, 0)]
            # The forces of the dampers act against their velocities.
            motion = np.linalg.solve(whole, np.hstack([ports.T, driven, slides.T]))
            moved, others = motion[:, :size], motion[:, size:]
            self.by_port[index] = factors[:, index, None] * (rows @ moved)
            self.slip_by_port[index] = line * (slides @ moved)
            self.port_by_port[index], self.at_port[index] = ports @ moved, ports @ others

    def _output_rows(self) -> Vector:
        """Return the rows of the displacements of channels, deflections of tyres and displacements of laws; (k, n)."""
        m = self.reference
        tyres = {f"tyre_{wheel}_force_z": -row for wheel, row in zip(m.system.inputs, m.tyre_rows, strict=True)}
        rows = [tyres[name] if name in tyres else m.system.output(name)[0] for name in self.channels]
        return np.array([*rows, *(law.row for law in m.laws)])

    def _factors(self, matrices: CarMatrices) -> Complex:
        """Return the factors of these rows: s^2 of accelerations, k + s c of tyres, 1 + s tau of laws; (k, lines)."""
        s = self.s
        tyres = {
            f"tyre_{wheel}_force_z": stiffness + s * damping
            for wheel, stiffness, damping in zip(
                matrices.system.inputs, matrices.tyre_stiffness, matrices.tyre_damping, strict=True
            )
        }
        factors = [tyres[name] if name in tyres else s**2 for name in self.channels]
        return np.array([*factors, *(1.0 + s * law.rate_time for law in matrices.laws)])

    def _same_form(self, matrices: CarMatrices) -> bool:
        """Return True if two cars differ in K, C, M, and in the forces of the plates, only."""
        system, other = self.reference.system, matrices.system
        names = ("branch_rows", "branch_stiffness", "branch_time", "branch_inputs", "constraints", "slide_rows")
        pairs = [(getattr(system, name), getattr(other, name)) for name in names]
        pairs += [(system.effects, other.effects), (self.reference.viscous, matrices.viscous)]
        if (system.branch_drifts is None) != (other.branch_drifts is None) or system.cyclic != other.cyclic:
            return False
        if system.branch_drifts is not None and other.branch_drifts is not None:
            pairs.append((system.branch_drifts, other.branch_drifts))
        pairs += [(system.outputs[name], other.outputs[name]) for name in self.channels if name in system.outputs]
        laws, others = self.reference.laws, matrices.laws
        if [(law.name, law.plate) for law in laws] != [(law.name, law.plate) for law in others]:
            return False
        pairs += [(law.row, each.row) for law, each in zip(laws, others, strict=True)]
        return all(first is second or np.array_equal(first, second) for first, second in pairs)

    def twin(self, matrices: CarMatrices) -> LinearTwin | None:
        """Return the twin of a car; None if it differs in more directions, or if its stability is not proven."""
        if len(self.rows) > MOST or not self._same_form(matrices):
            return None
        ports, system, before = self.directions, matrices.system, self.reference.system
        size, s = len(self.rows), self.s[:, None, None]
        added = np.zeros((s.size, size, size), dtype=complex)
        units = (1.0, 1.0 / DAMPING_AT, UNIT**-2)
        for change, power in self._changes(matrices):
            inner = ports.T @ change @ ports
            if np.linalg.norm(change - ports @ inner @ ports.T) > LEFT:
                return None
            added += units[power] * inner * s**power
        pushes = np.zeros((s.size - 1, size, self.count), dtype=complex)
        for power, name in enumerate(("input_stiffness", "input_damping")):
            force = self.scaled.T @ (getattr(system, name) - getattr(before, name))
            if not force.any():
                continue
            inner, whole = ports.T @ force, self.scaled.T @ getattr(before, name)
            if np.linalg.norm(force - ports @ inner) > LEFT * np.linalg.norm(whole):
                return None
            pushes += (inner * s[1:] ** power) @ self.plates
        coupling = np.eye(size) + self.port_by_port @ added
        signs, _ = np.linalg.slogdet(coupling)
        turns = np.angle(signs[1:] / signs[:-1])
        # 0 turns in all: from a positive real number to about 1.
        if signs[0].real < 0.99 or np.max(np.abs(turns)) > LARGEST_TURN or abs(turns.sum()) > 1.0:
            return None
        driven = self.at_port[1:].copy()
        driven[:, :, : self.count] += self.port_by_port[1:] @ pushes
        forces = -added[1:] @ np.linalg.solve(coupling[1:], driven)
        forces[:, :, : self.count] += pushes
        outputs = np.moveaxis(self.outputs + self.by_port[1:] @ forces, 0, -1)
        slip = np.moveaxis(self.slip + self.slip_by_port[1:] @ forces, 0, -1)
        outputs = outputs * (self._factors(matrices) / self._factors(self.reference))[:, None, 1:]
        return replace(
            self.reference_twin,
            outputs=outputs[:, : self.count],
            outputs_by_force=outputs[:, self.count :],
            slip=slip[:, : self.count],
            slip_by_force=slip[:, self.count :],
        )
