"""Forces of an inline engine on its block over the crank angle: inertia of the pistons, and gas.

With the crank angle phi from the top dead centre, the piston is at

    x = r cos(phi) + sqrt(l^2 - r^2 sin(phi)^2)

from the crankshaft, r half the stroke, l the rod. At constant speed w a reciprocating mass m pushes the block by
F = -m w^2 x'' along the cylinder and the crankshaft by T = -m w^2 x' x''; the gas turns the crankshaft by
T = (p - p0) A (-x'). The block gets minus both torques, by the side thrust of the pistons, and the moments of the
forces of the cylinders about the axis across. Cylinder k is behind cylinder 1 by its angle of firing.

Gas: a measured pressure (`pressure_trace`), or a model: compression and expansion with the exponent `GAMMA`, combustion
by Wiebe's law, exhaust at ambient pressure. Charge and heat are proportional to the pressure at the inlet, which is set
so that the mean torque is the given one.
Sources: Taylor, The Internal-Combustion Engine in Theory and Practice, vol. 2, 1985, chapter 8; Heywood, Internal
Combustion Engine Fundamentals, 1988, chapter 9.
"""

from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.engine_orders import EngineOrders
from vehicle.model.parameters.pressure_trace import pressure_at

SAMPLES = 1440
"""Points of a cycle of two turns, half a degree each."""

AMBIENT = 1.013e5
"""Pressure p0 [Pa]."""

GAMMA = 1.30
"""Exponent of compression and expansion."""

WIEBE_A, WIEBE_M = 5.0, 2.0
"""Constants of Wiebe's law x_b = 1 - exp(-a ((phi - phi_0)/D)^(m + 1))."""

IGNITION, BURNING = np.radians(-15.0), np.radians(50.0)
"""Start of combustion phi_0 and its duration D [rad]."""

OPENING = np.radians(140.0)
"""Opening of the exhaust [rad]; the pressure falls to p0 until the bottom dead centre."""

HEAT = 24.0
"""Heat of a charge over inlet pressure and displaced volume [-], after losses to the walls: 35 of a stoichiometric
charge without them."""

LARGEST_INLET = 3.0
"""Largest pressure at the inlet over p0 [-]."""


class BlockForces(NamedTuple):
    """Complex amplitudes Z of Re(Z exp(i order phi)) by order: force along the cylinders [N], moment about the axis
    across and torque about the crankshaft [N m], all on the block."""

    force: dict[float, complex]
    moment: dict[float, complex]
    torque: dict[float, complex]


def crank_angles() -> Vector:
    """Return the crank angles of a cycle [rad], from the start of the intake at -2 pi; (n,)."""
    return np.asarray(np.arange(SAMPLES) * 4.0 * np.pi / SAMPLES - 2.0 * np.pi)


def piston(engine: EngineOrders, angle: Vector) -> tuple[Vector, Vector, Vector]:
    """Return position x [m] of a piston over the crank angle [rad], and its first two derivatives."""
    r, rod = 0.5 * engine.stroke, engine.rod
    sine, cosine = r * np.sin(angle), r * np.cos(angle)
    root = np.sqrt(rod**2 - sine**2)
    first = -sine - sine * cosine / root
    second = -cosine - (cosine**2 - sine**2) / root - (sine * cosine) ** 2 / root**3
    return cosine + root, first, second


def gas_pressure(engine: EngineOrders, inlet: float) -> Vector:
    """Return the pressure of a cylinder over a cycle [Pa]; (n,).

    Args:
        engine: numbers of the engine.
        inlet: pressure at the inlet [Pa].
    """
    angle, area = crank_angles(), 0.25 * np.pi * engine.bore**2
    x, _, _ = piston(engine, angle)
    swept = area * engine.stroke
    volume = swept / (engine.compression - 1.0) + area * (0.5 * engine.stroke + engine.rod - x)
    burned = np.clip((angle - IGNITION) / BURNING, 0.0, 1.0)
    fraction = (1.0 - np.exp(-WIEBE_A * burned ** (WIEBE_M + 1.0))) / (1.0 - np.exp(-WIEBE_A))
    # d(p V^g) = (g - 1) V^(g - 1) dQ: exact for polytropic parts.
    closed = (angle >= -np.pi) & (angle < OPENING)
    heat = HEAT * inlet * swept * np.diff(fraction, prepend=0.0)
    content = inlet * np.max(volume) ** GAMMA + np.cumsum((GAMMA - 1.0) * heat * volume ** (GAMMA - 1.0))
    pressure = np.where(closed, content / volume**GAMMA, AMBIENT)
    intake = angle < -np.pi
    pressure[intake] = inlet
    last = pressure[closed][-1]
    falling = (angle >= OPENING) & (angle < np.pi)
    share = (np.pi - angle[falling]) / (np.pi - OPENING)
    pressure[falling] = AMBIENT + (last - AMBIENT) * share
    return np.asarray(pressure)


def gas_torque(engine: EngineOrders) -> Vector:
    """Return the torque of the gas of one cylinder on the crankshaft over a cycle [N m]; (n,).

    Raises:
        ConfigurationError: the mean torque is more than the engine gives, or there is no file of the pressure.
        DataError: see `pressure_at`.
    """
    _, rate, _ = piston(engine, crank_angles())
    lever = -0.25 * np.pi * engine.bore**2 * rate
    if engine.pressure is not None:
        return np.asarray((pressure_at(engine.pressure, crank_angles()) - AMBIENT) * lever)
    # The pressure over p0 is a sum of a part for the inlet pressure and a part for p0.
    unit = gas_pressure(engine, 1.0e5) - AMBIENT
    double = gas_pressure(engine, 2.0e5) - AMBIENT
    mean, doubled = float(np.mean(unit * lever)), float(np.mean(double * lever))
    wanted = engine.torque / engine.cylinders
    inlet = 1.0e5 * (1.0 + (wanted - mean) / (doubled - mean))
    if inlet > LARGEST_INLET * AMBIENT:
        most = engine.cylinders * (mean + (doubled - mean) * (LARGEST_INLET * AMBIENT / 1.0e5 - 1.0))
        raise ConfigurationError(
            f"EngineOrders.torque: found {engine.torque:g} N m, must be at most {most:.0f} N m, the torque of this "
            f"engine with {LARGEST_INLET:g} times the ambient pressure at its inlet"
        )
    return np.asarray((gas_pressure(engine, inlet) - AMBIENT) * lever)


def block_forces(engine: EngineOrders, speed: float, highest: int) -> BlockForces:
    """Return the harmonics of the forces on the block, half orders included.

    Args:
        engine: numbers of the engine.
        speed: speed w of the crankshaft [rad/s].
        highest: highest order.
    """
    _, rate, second = piston(engine, crank_angles())
    mass, count = engine.reciprocating_mass, round(engine.cylinders)
    force = _harmonics(-mass * speed**2 * second, highest)
    torque = _harmonics(-gas_torque(engine) + mass * speed**2 * rate * second, highest)
    # Angle by which each cylinder is behind cylinder 1, and its place along the crankshaft from the middle.
    delays = {int(cylinder): 4.0 * np.pi * turn / count for turn, cylinder in enumerate(engine.firing)}
    offsets = {cylinder: engine.spacing * (0.5 * (count - 1) - (cylinder - 1)) for cylinder in delays}
    forces, moments, torques = dict[float, complex](), dict[float, complex](), dict[float, complex]()
    for order in force:
        turns = {cylinder: np.exp(-1j * order * delay) for cylinder, delay in delays.items()}
        forces[order] = complex(force[order] * sum(turns.values()))
        # a e x F c = a F (e x c), about the axis across.
        moments[order] = complex(force[order] * sum(offsets[cylinder] * turn for cylinder, turn in turns.items()))
        torques[order] = complex(torque[order] * sum(turns.values()))
    forces[2.0] *= 1.0 - engine.balance_share
    return BlockForces(force=forces, moment=moments, torque=torques)


def _harmonics(history: Vector, highest: int) -> dict[float, complex]:
    """Return the complex amplitudes of a history over a cycle by order, from 1/2 on."""
    spectrum = np.fft.rfft(history) * 2.0 / SAMPLES
    # The cycle begins at -2 pi: order k/2 is turned by k pi.
    return {0.5 * k: complex(spectrum[k]) * (-1.0) ** k for k in range(1, 2 * highest + 1)}
