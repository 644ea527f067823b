"""Parameters and superelement into a MuJoCo specification of the car on its rig."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.assembly.connections import Connection, connections
from vehicle.flexbody.attached_mass import with_attached_masses
from vehicle.flexbody.rigid_body import rigid_body
from vehicle.flexbody.superelement import Superelement, require_nodes
from vehicle.names import BODY_OUTPUTS, WHEELS, body_nodes
from vehicle.parameters.hardpoints import mirrored
from vehicle.parameters.vehicle import Vehicle

Vector = npt.NDArray[np.float64]

MODAL_BODY_MASS = 1e-9
"""Mass [kg] of the bodies that carry the modal coordinates; MuJoCo needs one, the armature of 1 is the modal mass."""

JOINT_TIME_STEPS = 4.0
"""Time constant of the ideal joints in steps; below 2 MuJoCo's reference would be unstable."""

JOINT_IMPEDANCE = 0.9999
"""Impedance of the ideal joints; the residue 1e-4 of the constraint acceleration stays unanswered."""

VIEWER_IMPEDANCE = 0.99
"""Impedance of the bushings where no callback gives them their laws."""

LEAST_FRICTION = 1e-9
"""Friction [N] written where a damper has none, so that its row exists."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Assembly:
    """What the generator made.

    Attributes:
        spec: the specification; `spec.compile()` gives the model.
        vehicle: the parameters it was made from.
        superelement: the flexible body with the masses that are fixed to it.
        origins: where each body frame sits in the design position [m], by body name.
    """

    spec: mujoco.MjSpec
    vehicle: Vehicle
    superelement: Superelement
    origins: Mapping[str, Vector]


def assemble(vehicle: Vehicle, trimmed_body: Superelement) -> Assembly:
    """Build the car: trimmed body, engine, torque arm, two MacPherson corners, stabilizer, plates.

    Every body frame is parallel to the vehicle frame in the design position and sits at the part's centre of gravity.

    Args:
        vehicle: parameters.
        trimmed_body: modal model of the trimmed body.

    Returns:
        The assembly; `spec.compile()` gives the model.

    Raises:
        DataError: the superelement lacks a node of the car or has it elsewhere.
    """
    points = {name: np.array(point) for name, point in vehicle.hardpoints.all_points().items()}
    require_nodes(trimmed_body, {name: points[name] for name in body_nodes()})
    seats = {f"strut_top_{wheel}": vehicle.body.spring_seat_mass for wheel in WHEELS}
    carries = vehicle.body.flexible and vehicle.body.spring_seat_mass > 0.0
    superelement = with_attached_masses(trimmed_body, seats) if carries else trimmed_body
    spec = _empty_spec(vehicle)
    builder = _Builder(spec, vehicle, superelement, points)
    builder.add_body()
    builder.add_modes()
    builder.add_engine()
    for wheel in WHEELS:
        builder.add_corner(wheel)
    builder.add_stabilizer()
    builder.add_plates()
    for connection in connections(vehicle, superelement):
        builder.connect(connection)
    for wheel in WHEELS:
        builder.add_main_spring(wheel)
    for wheel in WHEELS:
        builder.add_damper(wheel)
    builder.add_places()
    return Assembly(spec=spec, vehicle=vehicle, superelement=superelement, origins=builder.origins)


def _empty_spec(vehicle: Vehicle) -> mujoco.MjSpec:
    """Specification with the options that the element laws need."""
    spec = mujoco.MjSpec()
    spec.modelname = vehicle.name
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    # Compiled callbacks find their arrays through the user data of a state.
    spec.nuserdata = 4
    option = spec.option
    option.timestep = vehicle.solver.timestep
    option.gravity = [0.0, 0.0, -vehicle.gravity]
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    # Modal columns are written into the rows, and a sparse pattern would not hold them.
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.iterations = 50
    option.tolerance = 1e-12
    disable = mujoco.mjtDisableBit
    option.disableflags |= int(
        disable.mjDSBL_ISLAND | disable.mjDSBL_CONTACT | disable.mjDSBL_EULERDAMP | disable.mjDSBL_AUTORESET
    )
    return spec


class _Builder:
    """Adds the parts of the car to a specification; knows where each body sits in the design position."""

    def __init__(
        self, spec: mujoco.MjSpec, vehicle: Vehicle, superelement: Superelement, points: Mapping[str, Vector]
    ) -> None:
        self.spec = spec
        self.vehicle = vehicle
        self.superelement = superelement
        self.points = points
        self.bodies: dict[str, mujoco.MjsBody] = {"world": spec.worldbody}
        self.origins: dict[str, Vector] = {"world": np.zeros(3)}

    def _add(
        self, name: str, parent: str, origin: Vector, mass: float, inertia: npt.ArrayLike, *, mocap: bool = False
    ) -> mujoco.MjsBody:
        """Add a body; `inertia` holds three principal moments or the six of the full tensor [kg m2]."""
        body = self.bodies[parent].add_body(name=name, pos=origin - self.origins[parent])
        if mocap:
            body.mocap = True
        else:
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

    def _add_part(self, part: str, parent: str, wheel: str | None = None) -> mujoco.MjsBody:
        """Add a rigid part of the parameter set."""
        parameters = self.vehicle.parts[part]
        cog = parameters.cog(self.vehicle.hardpoints)
        name = part if wheel is None else f"{part}_{wheel}"
        if wheel is not None:
            cog = mirrored(cog, 1.0 if wheel == "fr" else -1.0)
        return self._add(name, parent, np.array(cog), parameters.mass, parameters.inertia)

    def _joint(self, body: str, kind: mujoco.mjtJoint, name: str, point: str, axis: Vector | None = None) -> None:
        """Add a joint at a hardpoint to a body."""
        arguments = {"name": name, "type": kind, "pos": self.points[point] - self.origins[body]}
        if axis is not None:
            arguments["axis"] = axis
        self.bodies[body].add_joint(**arguments)

    def _site(self, name: str, body: str, point: Vector) -> None:
        self.bodies[body].add_site(name=name, pos=point - self.origins[body], size=[0.012, 0.012, 0.012], group=4)

    def _numeric(self, name: str, data: npt.ArrayLike) -> None:
        self.spec.add_numeric(name=name, data=np.atleast_1d(np.asarray(data, dtype=float)).ravel())

    def _node_shape(self, name: str, node: str) -> None:
        """Write the modal displacement of a node, (3, modes) row by row [kg^-1/2]."""
        if self.vehicle.body.flexible:
            index = self.superelement.node_index(node)
            self._numeric(f"shape/{name}", self.superelement.shapes[:, index, :].T)

    def add_body(self) -> None:
        """Trimmed body with the upper spring seats fixed to it, their inertia that of the lower ones."""
        body = rigid_body(self.vehicle.body)
        self._add("body", "world", body.cog, body.mass, body.full_inertia)
        self.bodies["body"].add_freejoint(name="body")
        mass = self.vehicle.body.spring_seat_mass
        if mass > 0.0:
            inertia = self.vehicle.parts["main_spring_lower"].inertia
            for wheel in WHEELS:
                self._add(f"main_spring_upper_{wheel}", "body", self.points[f"strut_top_{wheel}"], mass, inertia)

    def add_modes(self) -> None:
        """Mass-normalised modal coordinates q as slide joints: q'' + 2 zeta w q' + w2 q = force."""
        if not self.vehicle.body.flexible:
            return
        scale = self.vehicle.body.frequency_scale
        for number, (frequency, ratio) in enumerate(
            zip(self.superelement.frequencies, self.superelement.damping_ratio, strict=True), start=1
        ):
            omega = 2.0 * np.pi * frequency * scale
            name = f"mode_{number}"
            self._add(name, "world", np.zeros(3), MODAL_BODY_MASS, np.full(3, MODAL_BODY_MASS))
            # Along x, so that gravity does not act on it.
            self.bodies[name].add_joint(
                name=name,
                type=mujoco.mjtJoint.mjJNT_SLIDE,
                axis=[1.0, 0.0, 0.0],
                armature=1.0 - MODAL_BODY_MASS,
                stiffness=omega**2,
                damping=2.0 * ratio * omega,
            )

    def add_engine(self) -> None:
        """Engine with gearbox, and the torque arm between engine and body."""
        for part in ("engine", "torque_arm"):
            self._add_part(part, "world")
            self.bodies[part].add_freejoint(name=part)

    def add_corner(self, wheel: str) -> None:
        """A-arm, knuckle with all that is fixed to it, damper top and steering rod of one side."""
        kind = mujoco.mjtJoint
        self._add_part("a_arm", "world", wheel)
        self.bodies[f"a_arm_{wheel}"].add_freejoint(name=f"a_arm_{wheel}")
        knuckle = f"knuckle_{wheel}"
        self._add_part("knuckle", f"a_arm_{wheel}", wheel)
        self._joint(knuckle, kind.mjJNT_BALL, f"lower_ball_{wheel}", f"lower_ball_{wheel}")
        for part in ("tyre", "brake_disc", "caliper", "damper_bottom", "main_spring_lower"):
            self._add_part(part, knuckle, wheel)
        self._add_part("damper_top", knuckle, wheel)
        self._joint(
            f"damper_top_{wheel}", kind.mjJNT_SLIDE, f"damper_{wheel}", f"strut_top_{wheel}", self._strut_axis(wheel)
        )
        self._add_part("suspension_mount", f"damper_top_{wheel}", wheel)
        self._add_part("steering_rod", knuckle, wheel)
        self._cardan(f"steering_rod_{wheel}", f"tie_outer_{wheel}", f"tie_inner_{wheel}")

    def add_stabilizer(self) -> None:
        """Two halves of the bar, joined by a cylindrical joint with a torsion spring, and the two rods."""
        self._add_part("stabilizer_half", "world", "fl")
        self.bodies["stabilizer_half_fl"].add_freejoint(name="stabilizer_half_fl")
        self._add_part("stabilizer_half", "stabilizer_half_fl", "fr")
        half = self.bodies["stabilizer_half_fr"]
        position = self.points["stab_body_fr"] * np.array([1.0, 0.0, 1.0]) - self.origins["stabilizer_half_fr"]
        kind, axis = mujoco.mjtJoint, [0.0, 1.0, 0.0]
        half.add_joint(name="stabilizer_slide", type=kind.mjJNT_SLIDE, axis=axis, pos=position)
        half.add_joint(
            name="stabilizer_torsion",
            type=kind.mjJNT_HINGE,
            axis=axis,
            pos=position,
            stiffness=self.vehicle.stabilizer.torsional_stiffness,
        )
        for wheel in WHEELS:
            self._add_part("stabilizer_rod", f"stabilizer_half_{wheel}", wheel)
            self._cardan(f"stabilizer_rod_{wheel}", f"stab_end_{wheel}", f"stab_rod_top_{wheel}")

    def add_plates(self) -> None:
        """Plates under the front tyres; both are mocap bodies, so either can be driven."""
        for wheel in WHEELS:
            patch = self.points[f"tyre_patch_{wheel}"]
            self._add(f"plate_{wheel}", "world", patch, 0.0, (), mocap=True)

    def connect(self, connection: Connection) -> None:
        """Add the rows of a bushing or of a loop-closing ball joint, and the constants of its law."""
        point = self.points[connection.hardpoint]
        sites = (f"{connection.name}/moving", f"{connection.name}/carrier")
        self._site(sites[0], connection.moving, point)
        self._site(sites[1], connection.carrier, point)
        row = self.spec.add_equality(
            name=connection.name,
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            name1=sites[0],
            name2=sites[1],
        )
        if connection.law is None:
            # Ideal joint: MuJoCo's own reference, critically damped, as stiff as the step allows.
            row.solref = [JOINT_TIME_STEPS * self.vehicle.solver.timestep, 1.0]
            row.solimp = [JOINT_IMPEDANCE, JOINT_IMPEDANCE, 0.001, 0.5, 2.0]
        law = connection.law
        if law is not None:
            # Only for a viewer without the callbacks: stiffer than MuJoCo's own, so that the car sags by 4 mm.
            row.solimp = [VIEWER_IMPEDANCE, VIEWER_IMPEDANCE, 0.001, 0.5, 2.0]
            # The damper of a branch, not its time: MJCF text keeps six digits but drops numbers below 1e-5.
            branch_damping = law.branch_stiffness * law.branch_time
            constants = np.concatenate([law.stiffness, law.damping, law.branch_stiffness, branch_damping])
            self._numeric(f"law/{connection.name}", [*constants, law.rotational_stiffness, float(law.averaged)])
        if connection.node is not None:
            self._node_shape(connection.name, connection.node)

    def add_main_spring(self, wheel: str) -> None:
        """Main spring as a tendon between its seats, held by an equality row that the callback gives its law."""
        name = f"main_spring_{wheel}"
        lower, upper = f"{name}/lower", f"{name}/upper"
        self._site(lower, f"main_spring_lower_{wheel}", self.points[f"spring_lower_{wheel}"])
        self._site(upper, "body", self.points[f"strut_top_{wheel}"])
        tendon = self.spec.add_tendon(name=name)
        tendon.wrap_site(lower)
        tendon.wrap_site(upper)
        self.spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_TENDON, objtype=mujoco.mjtObj.mjOBJ_TENDON, name1=name)
        self._numeric(f"law/{name}", [self.vehicle.main_spring.stiffness])
        self._node_shape(name, f"strut_top_{wheel}")

    def add_damper(self, wheel: str) -> None:
        """Damper as a user actuator on its slide joint; the joint's friction row holds the set-valued part."""
        name, damper = f"damper_{wheel}", self.vehicle.damper
        # MuJoCo makes no friction row for a joint without friction; the callback sets the limit anyway.
        self.spec.joint(name).frictionloss = max(damper.coulomb_friction, LEAST_FRICTION)
        # The equality row carries the half step of the viscous part; in a plain viewer it holds the damper.
        self.spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT, name1=name)
        stribeck = damper.friction_law == "stribeck"
        degressive = damper.viscous_law == "degressive" and damper.degressive_viscous > damper.viscous
        valve = damper.degressive_viscous - damper.viscous if degressive else 0.0
        if degressive:
            # What the valve adds below its velocity is a second friction row, which a joint cannot have: a tendon.
            tendon = self.spec.add_tendon(name=f"valve_{wheel}")
            tendon.wrap_joint(name, 1.0)
            tendon.frictionloss = valve * damper.degressive_velocity
        parameters = np.zeros(10)
        parameters[:8] = (
            damper.viscous,
            damper.smoothing,
            damper.coulomb_friction,
            damper.stribeck_friction if stribeck else damper.coulomb_friction,
            damper.stribeck_velocity,
            damper.stribeck_exponent,
            valve,
            valve * damper.degressive_velocity,
        )
        actuator = self.spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
        actuator.gaintype = mujoco.mjtGain.mjGAIN_USER
        actuator.biastype = mujoco.mjtBias.mjBIAS_USER
        actuator.biasprm = parameters

    def add_places(self) -> None:
        """Sites and acceleration sensors of all recorded places.

        The channel of a knuckle is taken at the clamp of the damper on it, where its bottom is fixed.
        """
        places = {
            **{f"knuckle_{wheel}": (f"knuckle_{wheel}", f"damper_bottom_{wheel}") for wheel in WHEELS},
            **{f"damper_top_{wheel}": (f"damper_top_{wheel}", f"strut_top_{wheel}") for wheel in WHEELS},
            **{f"suspension_mount_{wheel}": ("body", f"strut_top_{wheel}") for wheel in WHEELS},
            "engine": ("engine", "engine_cog"),
            **{place: ("body", place) for place in BODY_OUTPUTS},
        }
        for place, (body, point) in places.items():
            self._site(f"place/{place}", body, self.points[point])
            self.spec.add_sensor(
                name=f"{place}_acc",
                type=mujoco.mjtSensor.mjSENS_FRAMELINACC,
                objtype=mujoco.mjtObj.mjOBJ_SITE,
                objname=f"place/{place}",
            )
            if body == "body":
                self._node_shape(f"place/{place}", point)

    def _strut_axis(self, wheel: str) -> Vector:
        axis = self.points[f"strut_top_{wheel}"] - self.points[f"damper_bottom_{wheel}"]
        return np.asarray(axis / np.linalg.norm(axis))

    def _cardan(self, body: str, point: str, other_end: str) -> None:
        """Two hinges at `point`, square to the rod and to each other: the rod cannot turn about its own axis."""
        rod = self.points[other_end] - self.points[point]
        rod = rod / np.linalg.norm(rod)
        reference = np.array([1.0, 0.0, 0.0])
        first = np.cross(rod, reference)
        first /= np.linalg.norm(first)
        second = np.cross(rod, first)
        for number, axis in enumerate((first, second), start=1):
            self._joint(body, mujoco.mjtJoint.mjJNT_HINGE, f"{body}_cardan_{number}", point, axis)
