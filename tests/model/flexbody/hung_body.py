"""Made test of a hung body: point masses joined by springs, on four soft springs; its FRFs are exact for all modes."""

from dataclasses import dataclass, field

import numpy as np

from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.geometry import Geometry
from vehicle.signals.formats.uff_writer import write

NODES = 30
UNIT = "(m/s2)/(N)"


@dataclass(frozen=True, kw_only=True)
class HungBody:
    """An engine of 220 kg, or another body, with points to measure."""

    seed: int = 0
    mass: float = 220.0
    extent: tuple[float, float, float] = (0.3, 0.25, 0.25)
    centre: tuple[float, float, float] = (0.66, 0.0, 0.86)
    first_elastic: float = 150.0
    support: float = 3.0
    rubber: float = 0.1
    points: int = 8
    inputs: tuple[tuple[int, int], ...] = ((0, 0), (1, 1), (2, 2), (3, 2), (4, 1), (5, 0))
    at: np.ndarray = field(init=False)
    masses: np.ndarray = field(init=False)

    def __post_init__(self):
        chance = np.random.default_rng(self.seed)
        box = chance.uniform(-1.0, 1.0, (NODES, 3)) * self.extent
        object.__setattr__(self, "at", np.array(self.centre) + box)
        object.__setattr__(self, "masses", self.mass * chance.dirichlet(np.full(NODES, 3.0)))

    @property
    def properties(self):
        return MassProperties.of_points(self.masses, self.at)

    def matrices(self):
        """Return mass (3 n,), and complex stiffness (3 n, 3 n) with a loss factor of 0.02, of rubber at the support."""
        stiffness = np.zeros((3 * NODES, 3 * NODES))
        for i in range(NODES):
            for j in range(i):
                way = self.at[i] - self.at[j]
                spring = np.outer(way, way) / np.linalg.norm(way) ** 3
                for a, b, sign in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
                    stiffness[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += sign * spring
        mass = np.repeat(self.masses, 3)
        squares = np.linalg.eigvalsh(stiffness / np.sqrt(np.outer(mass, mass)))
        stiffness *= (2.0 * np.pi * self.first_elastic) ** 2 / squares[6]
        hung = np.zeros(3 * NODES)
        for corner in ((1, 1, 0.3), (1, -1, 0.3), (-1, 1, 0.3), (-1, -1, 0.3)):
            node = 3 * int(np.argmax((self.at - self.centre) / self.extent @ corner))
            hung[node : node + 3] += self.mass * (2.0 * np.pi * self.support) ** 2 / 4.0 * np.array([0.4, 0.4, 1.0])
        return mass, stiffness * (1.0 + 0.02j) + np.diag(hung) * (1.0 + 1j * self.rubber)

    def accelerances(self, frequency, noise=0.0):
        """Return -w^2 (K - w^2 M)^-1 [m/s2/N] of the points, three directions each, to the inputs, (3 p, inputs, m).

        Args:
            noise: RMS of a complex random error over |H|.
        """
        mass, stiffness = self.matrices()
        force = np.zeros((len(mass), len(self.inputs)))
        for column, (node, axis) in enumerate(self.inputs):
            force[3 * node + axis, column] = 1.0
        squares = (2.0 * np.pi * frequency) ** 2
        exact = np.stack(
            [-w2 * np.linalg.solve(stiffness - w2 * np.diag(mass), force)[: 3 * self.points] for w2 in squares], axis=2
        )
        chance = np.random.default_rng(1000 + self.seed)
        errors = chance.standard_normal(exact.shape) + 1j * chance.standard_normal(exact.shape)
        return exact * (1.0 + noise * np.sqrt(0.5) * errors)


def channels(body, frequency, accelerances, unit=UNIT):
    """Return the FRFs as channels of a file."""
    return [
        Channel(
            name="",
            values=accelerances[row, column],
            unit=unit,
            axis=frequency,
            kind="frequency",
            function="frequency response",
            place=f"p{row // 3 + 1}",
            direction="+" + "XYZ"[row % 3],
            reference=f"p{node + 1}+{'XYZ'[axis]}",
        )
        for row in range(len(accelerances))
        for column, (node, axis) in enumerate(body.inputs)
    ]


def write_test(path, body, frequency, *, noise=0.05, unit=UNIT):
    """Write the test as a universal file with its points."""
    geometry = Geometry(points={f"p{n + 1}": body.at[n].tolist() for n in range(body.points)})
    write(path, channels(body, frequency, body.accelerances(frequency, noise), unit), "hung body", geometry)
    return path
