"""Load channels of a run: element forces in axes of the carriers, torques of joint springs, suspension travel.

The force of a constraint row is the sum of solver force and explicit force, preload included. A connection has three
rows in world axes; with the frame R of its carrier f = R' (f_solved + f_explicit). This force acts on the moving part,
its opposite on the carrier. A main spring has one row along its line, positive in compression.

The force along x of a rolling tyre is that of the slip, by the row, and that of the slope of the road, F_z tan(beta)
with the load of the row (`vehicle.engines.simulation.rolling_tyres`); `tyre_<wheel>_force_x` is their sum.
"""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.element_records import Index, Indices, Layout
from vehicle.engines.simulation.row_layout import equality_rows
from vehicle.engines.simulation.rows import Rows, joint_dampers, joint_springs
from vehicle.names import AXES


class LoadPlaces:
    """Rows, bodies and joints from which the load channels of a car are computed.

    Args:
        car: compiled car in static equilibrium.
        rows: rows of the run.
        names: names of the requested load channels; all by default.

    Attributes:
        names: names of the channels.
        connections: name, rows in world axes, and id of the carrier of each connection.
        oblique: direction matrix P of oblique elements by their first row.
        springs: name and row of each main spring.
        joints: channel, stiffness, damping [N/m or N m/rad, N s/m or N m s/rad] and unstrained position of each
            joint spring.
        wheels: channel, id of the part, the wheel centre in the frame of the part, its height above the origin of the
            body in the design position [m].
        bodies: ids of the bodies whose frames `channels` needs: car body, carriers, parts of wheels; (b,).
    """

    def __init__(self, car: CarModel, rows: Rows, names: Sequence[str] | None = None) -> None:
        model, composition = rows.model, car.vehicle.composition
        self.names = car.vehicle.load_channels if names is None else tuple(names)
        equalities = equality_rows(model)
        self.connections: list[tuple[str, Index, int]] = []
        for name, indices in equalities.items():
            if len(indices) == 3:
                carrier = int(model.site_bodyid[model.eq_obj2id[model.equality(name).id]])
                self.connections.append((name.rpartition("/")[2], np.array(indices), carrier))
        own_rows = rows.layout.bushings.rows
        self.oblique = {int(own_rows[index, 0]): way for index, way in rows.directions.items()}
        self.springs = [(spring.name, equalities[spring.name].start) for spring in composition.springs]
        self.joints = []
        for spring in composition.joint_springs:
            generated = car.model.joint(spring.joint)  # the model of a run may have fewer modal coordinates
            ends = f"{spring.joint}_torque", f"{spring.joint}_spring_force"
            # Read the generated model: the damping of a prepared model is weighted for its step.
            stiffness, damping = (read(car.model)[generated.dofadr[0]] for read in (joint_springs, joint_dampers))
            unstrained = float(car.model.qpos_spring[generated.qposadr[0]])
            self.joints.append((ends[generated.type[0] == mujoco.mjtJoint.mjJNT_SLIDE], stiffness, damping, unstrained))
        self.wheels = []
        for wheel in composition.wheels:
            part = int(model.body(wheel.part).id)
            # In the design position all frames are parallel to that of the car.
            offset = np.asarray(wheel.center) - car.origins[wheel.part]
            height = float(wheel.center[2] - car.origins["body"][2])
            self.wheels.append((f"suspension_travel_{wheel.name}", part, offset, height))
        carriers, parts = (connection[2] for connection in self.connections), (wheel[1] for wheel in self.wheels)
        bodies = [rows.layout.modes.body, *carriers, *parts]
        self.bodies: Index = np.array(list(dict.fromkeys(bodies)), dtype=np.int64)

    def channels(
        self, total: Vector, frames: Vector, springs: Vector, stops: Mapping[str, Vector], slopes: Mapping[str, Vector]
    ) -> dict[str, Vector]:
        """Compute the requested load channels of samples, by name; (samples,) each.

        Args:
            total: forces of all rows [N]; (samples, rows).
            frames: position [m] and axes of `bodies`; (samples, 12 b).
            springs: position and velocity of the joints with a spring; (samples, 2 j).
            stops: force of the stop of each damper [N] by the name of the damper; (samples,) each.
            slopes: force of each rolling tyre on the slope of the road [N] by wheel; (samples,) each.
        """
        frames_by_body = dict(zip(self.bodies, np.split(frames, len(self.bodies), axis=1), strict=True))
        channels: dict[str, Vector] = {}
        for name, rows, carrier in self.connections:
            if int(rows[0]) in self.oblique:
                # P' f: the rows are along the directions of the law.
                force = total[:, rows] @ self.oblique[int(rows[0])]
            else:
                # R' f: the rows are in world axes.
                force = np.einsum("nji,nj->ni", frames_by_body[carrier][:, 3:].reshape(-1, 3, 3), total[:, rows])
            for column, axis in enumerate(AXES):
                # A hydromount has the forces of rubber and fluid.
                channel = f"{name}_force_{axis}"
                channels[channel] = channels.get(channel, 0.0) + force[:, column]
        channels |= {f"{damper}_stop_force": force for damper, force in stops.items()}
        for wheel, force in slopes.items():
            slip, slope = (f"tyre_{wheel}_{term}_force_x" for term in ("slip", "slope"))
            whole = f"tyre_{wheel}_force_x"
            # The row has the force of the slip; the sum takes its name.
            channels[slip], channels[slope], channels[whole] = channels[whole], force, channels[whole] + force
        channels |= {f"{name}_force": total[:, row] for name, row in self.springs}
        for number, (name, stiffness, damping, unstrained) in enumerate(self.joints):
            position, velocity = springs[:, 2 * number], springs[:, 2 * number + 1]
            channels[name] = -stiffness * (position - unstrained) - damping * velocity
        body = frames_by_body[self.bodies[0]]
        for name, part, offset, height in self.wheels:
            centre = frames_by_body[part][:, :3] + frames_by_body[part][:, 3:].reshape(-1, 3, 3) @ offset
            # Wheel centre in the axes of the body.
            apart = np.einsum("nji,nj->ni", body[:, 3:].reshape(-1, 3, 3), centre - body[:, :3])
            channels[name] = apart[:, 2] - height
        return {name: channels[name] for name in self.names}


def spring_coordinates(car: CarModel, model: mujoco.MjModel) -> Indices:
    """Return position and velocity coordinate of each joint with a spring in the model of a run; (j, 2)."""
    joints = [model.joint(spring.joint) for spring in car.vehicle.composition.joint_springs]
    return np.array([(joint.qposadr[0], joint.dofadr[0]) for joint in joints], dtype=np.int64).reshape(-1, 2)


def slope_forces(explicit: Vector, slope_velocity: Vector, layout: Layout) -> Vector:
    """Return the force of each rolling tyre along x on the slope of the road [N], (samples, r).

    Args:
        explicit: explicit forces of all rows [N]; (samples, rows).
        slope_velocity: speed times slope of the road at each plate [m/s]; (samples, w).
        layout: elements of the model.
    """
    rolling = layout.rolling
    load = explicit[:, layout.bushings.rows[rolling.tyres, 2]]
    return np.asarray(np.maximum(load, 0.0) * slope_velocity[:, rolling.plates] / rolling.speeds)
