"""Scene of a film: the car with its shapes, translucent shell, lights and floor."""

import mujoco
import numpy as np

from vehicle.drawing.rendering.body_outline import body_outline, drawn_body
from vehicle.drawing.rendering.body_wireframe import EMISSION, thickness
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.assembly.studio import add_studio
from vehicle.model.assembly.visuals import add_shapes, visible_shapes
from vehicle.model.shapes import SHELL, palette
from vehicle.model.shapes.shape import Shape
from vehicle.model.shapes.solids import joined, rod
from vehicle.model.shapes.surface import grid
from vehicle.signals.analysis.samples import Vector

SAMPLES = 0
"""Multisampling of the picture: four samples take twice as long on a processor; a film halves its colours anyway."""

HIDDEN = ("body_lining",)
"""Shapes that are drawn only with an opaque shell."""

OPACITY = {
    **dict.fromkeys(SHELL, 0.16),
    "body_trim": 0.10,
    "body_plates": 0.10,
    "body_front_structure": 0.30,
    "body_floor": 0.45,
    "body_seats": 0.45,
    "body_dashboard": 0.35,
    "body_exhaust": 0.6,
}
"""Opacity of the shapes that would hide suspension and wireframe; the close-up omits them."""


GROUND = -0.002
"""Height of the floor under a rig [m]."""

BELOW_ROAD = 0.30
"""Height of the road above the floor [m], more than the depth of the exaggerated road."""


def stage_model(car: CarModel, size: tuple[int, int], *, road: bool = False) -> mujoco.MjModel:
    """Compile the visible car: the same bodies and joints as the simulated one, plus shapes, lights and floor.

    Args:
        size: width and height of the largest picture [pixel].
        road: draw a driving car, without shakers and plates, and the floor below the road.
    """
    spec = car.spec.copy()
    shapes, still = shapes_of(car, rig=not road), frame_at_rest(car)
    shapes |= still
    add_shapes(spec, shapes, car.origins, car.vehicle.composition.springs)
    for name in shapes:
        material = spec.material(name)
        material.rgba = [*material.rgba[:3], OPACITY.get(name, 1.0) * material.rgba[3]]
    for name in still:
        spec.material(name).emission = EMISSION
    patch = min(wheel.patch[2] for wheel in car.vehicle.composition.wheels)
    add_studio(spec, size, SAMPLES, patch - BELOW_ROAD if road else GROUND)
    return spec.compile()


def shapes_of(car: CarModel, *, rig: bool) -> dict[str, Shape]:
    """Return the shapes of a picture by name; an outline replaces the sheet metal of the estate car on other bodies."""
    shapes = {name: shape for name, shape in visible_shapes(car.vehicle, rig=rig).items() if name not in HIDDEN}
    if not len(car.superelement.edges) and len(sheets := body_outline(car.vehicle)[0]):
        shapes = {name: shape for name, shape in shapes.items() if name not in SHELL}
        nose, tail = (grid(end[[[0, 5], [1, 4]]], flip=flip) for end, flip in ((sheets[0], False), (sheets[-1], True)))
        shapes["body_shell"] = Shape(mesh=joined(grid(sheets), nose, tail), rgba=palette.BODY, part="body")
    return shapes


REST_RADIUS, REST_COLOUR = 0.005, (0.35, 0.38, 0.42, 1.0)
"""Radius [m] and colour of the rods of a frame at rest."""


def frame_at_rest(car: CarModel) -> dict[str, Shape]:
    """Return the frame of the body in the design position, a reference for its motion, as one shape by name.

    Empty for a body without lines.
    """
    body = drawn_body(car)
    if not len(body.lines):
        return {}
    radius = thickness(len(body.lines)) * REST_RADIUS
    mesh = joined([rod(first, second, radius, sides=6) for first, second in body.points[body.lines]])
    return {"frame_at_rest": Shape(mesh=mesh, rgba=REST_COLOUR, part="world")}


def unveiled(model: mujoco.MjModel) -> Vector:
    """Return the opacity of all materials, (materials,), zero for shapes that would hide the suspension."""
    names = {model.mat(number).name: number for number in range(model.nmat)}
    opacity = model.mat_rgba[:, 3].copy()
    opacity[[names[name] for name in OPACITY if name in names]] = 0.0
    return np.asarray(opacity)
