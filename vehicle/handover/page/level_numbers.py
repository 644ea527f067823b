"""Numbers from which a page computes the periodic states of a car over frequency and level (`Car.levels`).

The page takes cars whose only nonlinear laws are friction lines and curves of dampers, on standing tyres. It has the
poles of the car with their residues for the forces of the dampers and for all plates in phase.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.car_table import damper_nodes
from vehicle.engines.reduced.pole_model import Outputs
from vehicle.engines.steady.car_ports import require_ports
from vehicle.engines.steady.channel_rows import channel_rows, plain_rows
from vehicle.errors import ConfigurationError
from vehicle.handover.page.packed_numbers import text
from vehicle.model.laws.damper import damper_curve
from vehicle.signals.excitation.signal import Signal

if TYPE_CHECKING:
    from vehicle.runs.car import Car

FREQUENCY = (1.0, 30.0, 48)
"""Lowest and highest frequency [Hz], and their number, in equal ratios."""

LEVEL = (1e-5, 1e-2, 20)
"""Lowest and highest amplitude of the plates [m], and their number, in equal ratios."""

CHANNEL = "seat_rail_acc_z"

MOST_DAMPERS, MOST_KNOTS = 4, 60
"""Dampers, and breakpoints of a curve, for which web_levels.c has room."""


def level_numbers(car: Car, signal: Signal) -> dict[str, Any] | None:
    """Return the numbers of the section of levels; None for a car with other laws, or rolling tyres.

    Args:
        car: the car.
        signal: displacement of its plates; the chart marks the amplitude sqrt(2) RMS of the plate that moves most.
    """
    model, dampers = car.poles, [damper.law for damper in car.vehicle.composition.dampers]
    curves = [damper_curve(damper) for damper in dampers]
    try:
        require_ports(model, dampers)
    except ConfigurationError:
        return None
    coulomb = all(damper.friction_law == "coulomb" for damper in dampers) and len(dampers) <= MOST_DAMPERS
    if not coulomb or model.slope.size or model.laws or max(len(curve.knots) for curve in curves) > MOST_KNOTS:
        return None
    return {
        "numbers": text(plant_numbers(car).tobytes()),
        "laws": [
            {
                "curve": [*curve.knots.tolist(), *curve.slopes.tolist()],
                "viscous": curve.least_slope,
                "full": damper_nodes(damper)[1],
            }
            for damper, curve in zip(dampers, curves, strict=True)
        ],
        "frequency": np.geomspace(*FREQUENCY).tolist(),
        "level": np.geomspace(*LEVEL).tolist(),
        "amplitude": float(np.sqrt(2.0) * max(np.std(plate) for plate in signal.displacement.values())),
    }


def plant_numbers(car: Car) -> Vector:
    """Return the numbers of `open_levels` in web_levels.c, without plates that move out of phase.

    Numbers of poles, of pairs and of dampers; the poles; residues of the damper velocities, of the channel, of the
    damper forces, of heights and velocities of the plates; direct parts of both on the rows.
    """
    model = car.poles
    still = np.zeros((len(model.slip), model.height.shape[1]))
    slip = plain_rows(model, Outputs(poles=model.slip, height=still, velocity=still))
    rows = (slip + channel_rows(model, [CHANNEL], car.load_rows)).outputs
    residues = np.vstack([rows.poles, model.force.T, model.height.sum(axis=1), model.velocity.sum(axis=1)])
    counts = np.array([len(model.poles), model.pairs, len(model.slip)], dtype=float)
    parts = [counts, model.poles, residues.ravel(), rows.height.sum(axis=1), rows.velocity.sum(axis=1)]
    return np.concatenate([np.ascontiguousarray(part).view(float) for part in parts])
