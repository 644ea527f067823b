"""Builder that adds the elements of a car, with the constants of their laws, to a MuJoCo specification."""

from collections.abc import Mapping

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.assembly.element_numbers import (
    TURNING,
    connection_name,
    connection_numbers,
    damper_numbers,
    fluid_name,
    force_fields,
    hold_numbers,
    joint_numbers,
    mass_numbers,
    mode_numbers,
    spring_numbers,
)
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.composition import (
    JointSpring,
    PlacedConnection,
    PlacedDamper,
    PlacedOutput,
    PlacedPart,
    PlacedSpring,
    PlacedWheel,
)
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.model.parameters.vehicle import Vehicle

MODAL_BODY_MASS = 1e-9
"""Mass [kg] of the bodies of modal and fluid coordinates, required by MuJoCo; the armature is the actual mass."""

JOINT_TIME_STEPS = 4.0
"""Time constant of the ideal joints in steps; below 2 MuJoCo's reference would be unstable."""

JOINT_IMPEDANCE = 0.9999
"""Impedance of the ideal joints; the residue 1e-4 of the constraint acceleration is not corrected."""

VIEWER_IMPEDANCE = 0.99
"""Impedance of the bushings without the callbacks of their laws."""

MIN_FRICTION = 1e-9
"""Friction [N] of a damper without friction, so that its row exists."""

KINDS = {"ball": mujoco.mjtJoint.mjJNT_BALL, "hinge": mujoco.mjtJoint.mjJNT_HINGE, "slide": mujoco.mjtJoint.mjJNT_SLIDE}


class ElementBuilder:
    """Builder of the elements of a car, with the origin of each body in the design position.

    Args:
        spec: specification with the options of `vehicle.model.assembly.spec`.
        vehicle: parameters.
        superelement: the flexible body with the masses that are fixed to it.
        nodes: node name by point of the body.
    """

    def __init__(
        self, spec: mujoco.MjSpec, vehicle: Vehicle, superelement: Superelement, nodes: Mapping[Point, str]
    ) -> None:
        self.spec = spec
        self.vehicle = vehicle
        self.superelement = superelement
        self.nodes = nodes
        self.bodies: dict[str, mujoco.MjsBody] = {"world": spec.worldbody}
        self.origins: dict[str, Vector] = {"world": np.zeros(3)}

    def _add(self, name: str, parent: str, origin: Vector, mass: float, inertia: npt.ArrayLike) -> mujoco.MjsBody:
        """Add a body; `inertia` holds three principal moments or the six of the full tensor [kg m2]."""
        body = self.bodies[parent].add_body(name=name, pos=origin - self.origins[parent])
        body.explicitinertial = True
        body.mass = mass
        body.ipos = np.zeros(3)
        moments = np.asarray(inertia, dtype=float)
        if moments.size == 3:
            body.inertia = moments
        else:
            body.fullinertia = moments
        self.bodies[name] = body
        self.origins[name] = origin
        return body

    def _site(self, name: str, body: str, point: Point) -> None:
        position = np.array(point) - self.origins[body]
        self.bodies[body].add_site(name=name, pos=position, size=[0.012, 0.012, 0.012], group=4)

    def _numerics(self, numbers: Mapping[str, Vector]) -> None:
        for name, data in numbers.items():
            self.spec.add_numeric(name=name, data=data)

    def _node_shape(self, name: str, point: Point) -> None:
        """Write the modal displacement of the body node at a point, (3, modes) row by row [kg^-1/2]."""
        if self.vehicle.body.flexible:
            self._numerics({f"shape/{name}": self.superelement.shape_at(self.nodes[point]).ravel()})

    def _node_rotation(self, name: str, point: Point) -> None:
        """Write the modal rotation of the body node at a point, if its model contains it [rad m^-1 kg^-1/2]."""
        psi = self.superelement.rotations.get(self.nodes[point]) if self.vehicle.body.flexible else None
        if psi is not None:
            self._numerics({f"rotation/{name}": psi.T.ravel()})

    def add_body(self) -> None:
        """Add the trimmed body and its mass-normalised modal coordinates as slides: q'' + 2 zeta w q' + w2 q = f."""
        body = rigid_body(self.vehicle.body)
        self._add("body", "world", body.cog, body.mass, body.full_inertia).add_freejoint(name="body")
        if not self.vehicle.body.flexible:
            return
        for field, (stiffness, damping) in mode_numbers(self.vehicle.body, self.superelement).items():
            self._add_coordinate(field.removeprefix("joint/"), 1.0, stiffness, damping)

    def _add_coordinate(self, name: str, mass: float, stiffness: float, damping: float) -> None:
        """Add a scalar coordinate that is not the motion of a part, as a slide with the mass as armature."""
        # Along x, so that gravity does not act on the mass.
        self._add(name, "world", np.zeros(3), MODAL_BODY_MASS, np.full(3, MODAL_BODY_MASS)).add_joint(
            name=name,
            type=mujoco.mjtJoint.mjJNT_SLIDE,
            axis=[1.0, 0.0, 0.0],
            armature=mass - MODAL_BODY_MASS,
            stiffness=stiffness,
            damping=damping,
        )

    def add_part(self, part: PlacedPart) -> None:
        """Add a rigid part with its joints."""
        (numbers,) = mass_numbers(part).values()
        moments = numbers[1:] if numbers[4:].any() else numbers[1:4]
        body = self._add(part.name, part.parent, np.array(part.cog), float(numbers[0]), moments)
        for joint in part.joints:
            if joint.kind == "free":
                body.add_freejoint(name=joint.name)
            else:
                body.add_joint(
                    name=joint.name, type=KINDS[joint.kind], axis=joint.axis, pos=np.array(joint.at) - part.cog
                )

    def add_joint_spring(self, on_joint: JointSpring) -> None:
        """Set spring and damping of a hinge or slide, which MuJoCo computes."""
        joint, ((stiffness, damping),) = self.spec.joint(on_joint.joint), joint_numbers(on_joint).values()
        joint.stiffness, joint.damping = [stiffness, 0.0, 0.0], [damping, 0.0, 0.0]

    def add_plate(self, wheel: PlacedWheel) -> None:
        """Add the plate under a tyre as a mocap body with a prescribed motion."""
        self.origins[wheel.plate] = np.array(wheel.patch)
        self.bodies[wheel.plate] = self.spec.worldbody.add_body(name=wheel.plate, pos=wheel.patch, mocap=True)

    def connect(self, connection: PlacedConnection) -> None:
        """Add the rows of a bushing or of a loop-closing ball joint, and the constants of its law.

        The fluid of a hydromount is a further coordinate, with rows between the same sites.
        """
        numbers = connection_numbers(connection, self.vehicle.body, self.superelement)
        name = connection_name(connection)
        sites = (f"{name}/moving", f"{name}/carrier")
        self._site(sites[0], connection.moving, connection.at)
        self._site(sites[1], connection.carrier, connection.at)
        self._numerics(numbers)
        self._connect_rows(name, sites, connection, ideal=not numbers)
        if "body" in (connection.moving, connection.carrier) and numbers and numbers[f"law/{name}"][TURNING] > 0.0:
            self._node_rotation(name, connection.at)
        fluid = fluid_name(connection)
        if f"law/{fluid}" in numbers:
            for field, values in numbers.items():
                if field.startswith("inertia/"):
                    coordinate = field.removeprefix("inertia/")
                    self._add_coordinate(coordinate, float(values[0]), *numbers[f"joint/{coordinate}"].tolist())
            self._connect_rows(fluid, sites, connection, ideal=False)

    def _connect_rows(self, name: str, sites: tuple[str, str], connection: PlacedConnection, *, ideal: bool) -> None:
        """Add three rows between two sites, with the shape of the body node at the connection."""
        row = self.spec.add_equality(
            name=name, type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE, name1=sites[0], name2=sites[1]
        )
        if ideal:
            # Ideal joint: the reference acceleration of MuJoCo, critically damped, as stiff as the step allows.
            row.solref = [JOINT_TIME_STEPS * self.vehicle.solver.step, 1.0]
            row.solimp = [JOINT_IMPEDANCE, JOINT_IMPEDANCE, 0.001, 0.5, 2.0]
        else:
            # Only for a viewer without the callbacks: stiffer than the default, so that the car sags by 4 mm.
            row.solimp = [VIEWER_IMPEDANCE, VIEWER_IMPEDANCE, 0.001, 0.5, 2.0]
        if "body" in (connection.moving, connection.carrier):
            self._node_shape(name, connection.at)

    def add_spring(self, spring: PlacedSpring) -> None:
        """Add a spring as a tendon between its ends, with an equality row whose law the callback sets."""
        name = spring.name
        tendon = self.spec.add_tendon(name=name)
        for end, body, point in zip(("lower", "upper"), spring.parts, spring.at, strict=True):
            self._site(f"{name}/{end}", body, point)
            tendon.wrap_site(f"{name}/{end}")
            if body == "body":
                self._node_shape(name, point)
        self.spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_TENDON, objtype=mujoco.mjtObj.mjOBJ_TENDON, name1=name)
        self._numerics(spring_numbers(spring))

    def add_damper(self, placed: PlacedDamper) -> None:
        """Add a damper as a user actuator on its slide joint; the friction row of the joint has the set-valued part."""
        name, damper = placed.joint, placed.law
        # MuJoCo makes no friction row for a joint without friction; the callback sets the limit anyway.
        self.spec.joint(name).frictionloss = max(damper.coulomb_friction, MIN_FRICTION)
        # The equality row carries the half step of the viscous part; in a plain viewer it supports the damper.
        self.spec.add_equality(
            name=placed.name, type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT, name1=name
        )
        numbers = damper_numbers(placed)
        parameters = numbers.pop(f"actuator/{placed.name}")
        self._numerics(numbers)
        for field, piece in numbers.items():
            if field.startswith("law/valve/"):
                # Each steeper segment of the curve needs a further friction row: a joint has one, so use a tendon.
                tendon = self.spec.add_tendon(name=field.removeprefix("law/"))
                tendon.wrap_joint(name, 1.0)
                tendon.frictionloss = piece[2]
        elements = numbers.get(f"presliding/{placed.name}", np.zeros(0)).reshape(-1, 2)
        for number, (_, share) in enumerate(elements[1:].tolist(), start=1):
            # The friction row of the joint is that of the first element.
            tendon = self.spec.add_tendon(name=f"presliding/{placed.name}/{number}")
            tendon.wrap_joint(name, 1.0)
            tendon.frictionloss = max(share * damper.coulomb_friction, MIN_FRICTION)
        actuator = self.spec.add_actuator(name=placed.name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
        actuator.gaintype = mujoco.mjtGain.mjGAIN_USER
        actuator.biastype = mujoco.mjtBias.mjBIAS_USER
        actuator.biasprm = parameters[: len(actuator.biasprm)]
        if len(parameters) > len(actuator.biasprm):
            self._numerics({f"actuator/{placed.name}": parameters})
        # The forces of MuJoCo's actuator and rows are parts of it; the callback of a run writes their sum.
        self.spec.add_sensor(
            name=f"{placed.name}_force",
            type=mujoco.mjtSensor.mjSENS_USER,
            datatype=mujoco.mjtDataType.mjDATATYPE_REAL,
            needstage=mujoco.mjtStage.mjSTAGE_ACC,
            dim=1,
            objtype=mujoco.mjtObj.mjOBJ_ACTUATOR,
            objname=placed.name,
        )
        if damper.controlled is not None:
            for end, part, at in zip(("lower", "upper"), placed.sensors, placed.at, strict=True):
                self._site(f"sensor/{placed.name}/{end}", part, at)
                if part == "body":
                    self._node_shape(f"sensor/{placed.name}/{end}", at)

    def add_hold(self) -> None:
        """Write the constants of the hold of the course of a rolling car, which acts on the trimmed body."""
        self._numerics(hold_numbers(self.vehicle))

    def add_steady_forces(self) -> None:
        """Write horizontal forces of rolling tyres, zero until the trim, for a car that brakes, drives or turns."""
        if self.vehicle.driving.accelerates:
            rolling = (link for link in self.vehicle.composition.connections if link.rolling is not None)
            self._numerics({f"steady/{connection_name(link)}": np.zeros(2) for link in rolling})

    def add_force(self, force: PlacedForce) -> None:
        """Add the site of an applied force on each of its parts, and its directions; the callback of a run applies it.

        Raises:
            DataError: a moment acts on a flexible body at a node without rotations.
        """
        self._numerics(force_fields(force))
        for end, part in (("on", force.on), ("against", force.against)):
            name = f"force/{force.name}/{end}"
            if part:
                self._site(name, part, force.at)
            if part == "body":
                self._node_shape(name, force.at)
                self._node_rotation(name, force.at)
                if (
                    any(force.moment)
                    and self.vehicle.body.flexible
                    and force.at in self.nodes
                    and (self.superelement.rotations.get(self.nodes[force.at]) is None)
                ):
                    raise DataError(
                        f"{force.path}: a moment acts on the body at {list(force.at)} m, where its model has no "
                        "rotations; apply two opposite forces at two points, or use a body model with rotations "
                        "at this node"
                    )

    def add_output(self, output: PlacedOutput) -> None:
        """Add site and acceleration sensor of an output point."""
        name = f"place/{output.name}"
        self._site(name, output.on, output.at)
        self.spec.add_sensor(
            name=f"{output.name}_acc",
            type=mujoco.mjtSensor.mjSENS_FRAMELINACC,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=name,
        )
        if output.on == "body":
            self._node_shape(name, output.at)
