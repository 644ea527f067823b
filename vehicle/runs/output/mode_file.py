"""The modes of a car as a universal file: places, lines between them, and a mode shape for each mode."""

from pathlib import Path

import numpy as np

from vehicle.runs.car import Car
from vehicle.runs.comparison.mode_comparison import shapes_at
from vehicle.runs.output.run_formats import geometry
from vehicle.signals.formats import uff_writer
from vehicle.signals.formats.geometry import ModeShape


def mode_shapes(car: Car, damper: str = "stuck") -> tuple[ModeShape, ...]:
    """Return the complex modes of a car at its output points; the maximum translation of each mode is 1."""
    points = tuple(output.name for output in car.vehicle.composition.outputs)
    modes = [mode for mode in car.modes(damper) if mode.frequency > 0.0 and not mode.grows]
    shapes = []
    for number, (mode, at) in enumerate(zip(modes, shapes_at(car, modes, points), strict=True), 1):
        description, scale = mode.description, at.ravel()[np.argmax(np.abs(at))] or 1.0
        shape = np.zeros((len(points), 6), dtype=np.complex128)
        shape[:, :3] = at / scale
        shapes.append(
            ModeShape(
                number=number,
                frequency=mode.frequency,
                damping_ratio=mode.damping_ratio,
                modal_a=mode.modal_a / scale**2,
                points=points,
                shape=shape,
                # A line of a universal file has 80 characters: the leading motion with its share where two do not fit.
                name=description if len(description) <= 80 else f"{description.partition(' with ')[0]} with others",
                is_complex=True,
            )
        )
    return tuple(shapes)


def write_modes(path: Path, car: Car, damper: str = "stuck") -> None:
    """Write datasets 151, 164, 15, 82 and 55 of a car; arguments like `mode_shapes`."""
    title = f"{car.vehicle.name}; modes, dampers {damper}; x to the rear, y to the driver's right, z up"
    uff_writer.write(path, (), title, geometry(car), mode_shapes(car, damper))
