"""Records of the elements of a car for the core: constraint rows of each element and constants of its law.

Arrays are contiguous, of 64 bits. The types name their dimensions: `Vector` and `Index` one, `Table` and `Indices` two,
`Tables3` three.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector

Table = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]
Indices = npt.NDArray[np.int64]
Records = npt.NDArray[Any]
Settings = npt.NDArray[Any]
Laws = npt.NDArray[Any]


class Bushings(NamedTuple):
    """Elements with a force law along three axes, n of them.

    Attributes:
        rows: constraint rows of the translations; (n, 3).
        carriers: id of the body in whose axes the law acts; (n,).
        stiffness, damping: K, with rubber friction the tangent at rest [N/m], and B [N s/m]; (n, 3).
        branch_stiffness, branch_time: Maxwell branch K2 [N/m] and tau [s]; (n, 3).
        further: further numbers of the laws, padded with zeros; (n, those of the longest law).
        averaged: 1 for a stiffness averaged over three steps; (n,).
        one_sided: indices of the k elements that only push along z; (k,).
        oblique: indices of the elements with oblique directions; (k,).
        directions: direction matrices P of these elements in the axes of the carrier, row by row; (k, 9).
    """

    rows: Indices
    carriers: Index
    stiffness: Table
    damping: Table
    branch_stiffness: Table
    branch_time: Table
    further: Table
    averaged: Index
    one_sided: Index
    oblique: Index
    directions: Table


class AirSprings(NamedTuple):
    """Elements whose stiffness along z follows from their static load, k of them; see `parameters.air_spring`.

    No part of `Layout`: the core reads the stiffness that follows.

    Attributes:
        elements: indices among the bushings; (k,).
        bellows: stiffness of the bellows alone [N/m]; (k,).
        numbers: area [m2], volume [m3], growth of the area [m]; (k, 3).
    """

    elements: Index
    bellows: Vector
    numbers: Table


class Rotations(NamedTuple):
    """Elements with a rotational stiffness, m of them.

    Attributes:
        sites: sites on the moving part and on the carrier; (m, 2).
        stiffness: K_rot [N m/rad]; (m,).
        turning: rows of element, velocity coordinate, and 1 or -1 if it rotates the moving part or the carrier.
        nodes: element and side (0 moving, 1 carrier) of the k nodes with rotational mode shapes; (k, 2).
        shapes: rotations of these nodes in the modes, about x of all modes, y, z [rad m^-1 kg^-1/2]; (k, 3 modes).
    """

    sites: Indices
    stiffness: Vector
    turning: Indices
    nodes: Indices
    shapes: Table


class Springs(NamedTuple):
    """Main springs, s of them.

    Attributes:
        rows: constraint rows; (s,). stiffness: [N/m]; (s,). lengths: lengths in the design position [m]; (s,).
        sites: lower and upper site; (s, 2).
        shapes: modal shapes at the upper seats, x of all modes, y, z; (s, 3 modes).
        dofs: rows of spring, end (0 lower, 1 upper), velocity coordinate that moves the end, and its tree.
    """

    rows: Index
    stiffness: Vector
    lengths: Vector
    sites: Indices
    shapes: Table
    dofs: Indices


class Dampers(NamedTuple):
    """Dampers, w of them.

    Attributes:
        laws: records of `vehicle.model.laws.damper`; (w,).
        rows, frictions: equality and friction rows; (w,).
        dofs, places: velocity and position coordinates; (w,).
        valves: further friction row of each steeper segment of a damper curve, and the index of its damper.
        pieces: rows of e [N s/m], m [m/s] and limit [N] of these segments; see `vehicle.model.laws.curve`.
    """

    laws: Records
    rows: Index
    frictions: Index
    dofs: Index
    places: Index
    valves: Indices
    pieces: Table


class Presliding(NamedTuple):
    """Jenkins elements of the dampers with presliding friction, m of them.

    Attributes:
        rows: friction row of each element; (m,). dampers: index of its damper; (m,).
        stiffness: k [N/m]; (m,). share: share of the friction limit of the damper [-]; (m,).
    """

    rows: Index
    dampers: Index
    stiffness: Vector
    share: Vector


class RubberFriction(NamedTuple):
    """Jenkins elements of the bushings with rubber friction (`vehicle.model.laws.amplitude`), m of them.

    The displacement of an element is the residual r of its bushing along its axis; the stiffness of the record of the
    bushing is the tangent at rest, elastic part and all k together.

    Attributes:
        elements, axes: index of the bushing, and axis; (m,).
        stiffness: k [N/m]; (m,). limit: largest force [N]; (m,).
    """

    elements: Index
    axes: Index
    stiffness: Vector
    limit: Vector


class SideForces(NamedTuple):
    """Bushings at the rods of the dampers, whose forces across the slide are the side forces; k of them.

    Attributes:
        dampers: index of the damper; (k,). elements: index of the bushing; (k,).
        signs: 1 if the rod is the moving part of the bushing, -1 if it is the carrier; (k,).
        oblique: index among the oblique elements, -1 for others; (k,).
    """

    dampers: Index
    elements: Index
    signs: Vector
    oblique: Index


class Controls(NamedTuple):
    """Controlled dampers, k of the w dampers.

    Attributes:
        dampers: indices among the dampers; (k,).
        laws: records of `vehicle.model.laws.control_laws`; (k,).
        sites: sites of the sensors, on the wheel and on the body; (k, 2).
        shapes: modal shapes at the sensors, x of all modes, y, z; (2 k, 3 modes).
        dofs: rows of control, sensor (0 wheel, 1 body), velocity coordinate that moves the sensor, and its tree.
    """

    dampers: Index
    laws: Settings
    sites: Indices
    shapes: Table
    dofs: Indices


class OwnDampers(NamedTuple):
    """Dampers with a law by address, k of the w dampers.

    Attributes:
        dampers: indices among the dampers; (k,).
        laws: records of `vehicle.model.laws.law_by_address`; (k,).
    """

    dampers: Index
    laws: Laws


class Tables(NamedTuple):
    """Nonlinear laws over displacement (`vehicle.model.laws.curve`), t of them: F(at + x) - F(at) in place of K x.

    Attributes:
        kinds: 0 for an axis of a bushing, 1 for a spring, 2 for the bump stop of a damper, 3 for the
            seat of a decoupler, whose element is its first index among the fluids; (t,).
        elements, axes: index among the elements of this type, and axis; (t,).
        at: displacement at the operating point [m]; the record of the element contains the tangent K there; (t,).
        edges, slopes, offsets: upper edges (the last infinite), slopes and offsets of the segments; (t, segments).
    """

    kinds: Index
    elements: Index
    axes: Index
    at: Vector
    edges: Table
    slopes: Table
    offsets: Table


class Modes(NamedTuple):
    """Flexible body and constraint rows at its g nodes.

    Attributes:
        body: id of the body. size: number of modes.
        first_velocity, first_position: indices of the first modal coordinate.
        turns: velocity coordinates that rotate the body; (3,).
        rows: constraint rows of the connections at the nodes; (3, g).
        node_shapes: signed shapes of these nodes in body axes [kg^-1/2]; (3, g modes).
        mode_shapes: signed shapes with a row for each mode: x of all nodes, y, z; (modes, 3 g).
    """

    body: int
    size: int
    first_velocity: int
    first_position: int
    turns: Index
    rows: Indices
    node_shapes: Table
    mode_shapes: Table

    @property
    def velocities(self) -> slice:
        """Return the velocity coordinates of the modes."""
        return slice(self.first_velocity, self.first_velocity + self.size)

    @property
    def positions(self) -> slice:
        """Return the generalised positions of the modes."""
        return slice(self.first_position, self.first_position + self.size)


class ModalSpace(NamedTuple):
    """Modal coordinates that the callbacks integrate (`vehicle/core/source/modes.h`), n of them or 0.

    Attributes:
        mass, stiffness, damping, rest: modal parameters weighted for the step, and unstrained positions; (n,).
        spread: S, modal coordinates by the r coordinates of the model; (n, r).
    """

    mass: Vector
    stiffness: Vector
    damping: Vector
    rest: Vector
    spread: Table


class Rolling(NamedTuple):
    """Rolling tyres, w of them, and the course control; empty arrays on a shaker.

    Attributes:
        tyres, plates: indices among the bushings, and among the plates; (w,).
        sites, hubs: sites of the hubs at the contact points, and ids of the hubs; (w,).
        spins: velocity coordinates about the axles; (w,).
        arms: wheel centre from the patch in the axes of the hub [m]; (w, 3).
        speeds, trails, inertias: V [m/s], trail [m], inertia of the rotating parts about the axle [kg m2]; (w,).
        dofs: rows of wheel, velocity coordinate that moves its hub, and its tree.
        course: velocity coordinates of the body along x, y and in yaw, positions along x and y; (5,) or empty.
        rest: positions along x and y at rest, then the heading of each wheel, then the horizontal forces X and Y of
            each tyre in steady acceleration; (2 + 3 w,).
        hold: stiffness and damping of the course control along x, y and in yaw, and distance of the lateral force
            behind the body; (7,).
    """

    tyres: Index
    plates: Index
    sites: Index
    hubs: Index
    spins: Index
    arms: Table
    speeds: Vector
    trails: Vector
    inertias: Vector
    dofs: Indices
    course: Index
    rest: Vector
    hold: Vector

    def course_rows(self, size: int) -> Table:
        """Return the Jacobian of the displacements that the course control resists: x, y and yaw; (3, size)."""
        rows = np.zeros((3, size))
        rows[np.arange(3), self.course[:3]] = 1.0
        rows[1, self.course[2]] = self.hold[6]
        return rows


class RoundTyres(NamedTuple):
    """Round tyres at rest, k of them.

    Attributes:
        tyres: indices among the bushings; (k,).
        hubs: ids of the hubs; (k,).
        radii: loaded radii [m]; (k,).
        dofs: rows of tyre and velocity coordinate that moves its hub.
    """

    tyres: Index
    hubs: Index
    radii: Vector
    dofs: Indices


class Fluids(NamedTuple):
    """Displacements of fluids in the extensions of hydromounts along z: two for each coordinate, chamber and rubber.

    Attributes:
        elements: indices of the elements among the bushings; (k,).
        dofs, places: velocity and position coordinates of the fluids and decouplers; (k,).
        factors: extension per displacement of the coordinate [-]; (k,).
    """

    elements: Index
    dofs: Index
    places: Index
    factors: Vector


class Applied(NamedTuple):
    """Applied forces, e elements: one force on one part each.

    Attributes:
        sites: site of the point; (e,).
        directions: direction of the force, then of the moment, in world axes or those of a body; signed; (e, 6).
        frames: body with these axes; -1 for the world; (e,).
        forces: index of the force; (e,).
        dofs: rows of element, velocity coordinate that moves its part, and its tree.
        nodes: elements at nodes of the flexible body; (k,).
        shapes: displacement along x of all modes, y, z, then rotation, of these nodes; (k, 6 modes).
        torques: rows of velocity coordinate and force of the torques on joints.
        means: constant part of each force [N or N m]; (f,).
    """

    sites: Index
    directions: Table
    frames: Index
    forces: Index
    dofs: Indices
    nodes: Index
    shapes: Table
    torques: Indices
    means: Vector


class Layout(NamedTuple):
    """Elements of a car and their constraint rows.

    Attributes:
        bushings, rubber, rotations, springs, dampers, presliding, sides, controls, own, tables, modes, space,
            rolling, round, fluids, applied: records of the elements.
        joints: rows of the ideal ball joints without a law; (k, 3).
        tyres: indices among the bushings of the tyres, in the order of the plates; (t,).
        reach: nonzero columns of the rows with explicit forces: first row, number of rows (3 or 1), first column, end.
        row_count, velocity_count: number of constraint rows, and of velocity coordinates.
    """

    bushings: Bushings
    rubber: RubberFriction
    rotations: Rotations
    springs: Springs
    dampers: Dampers
    presliding: Presliding
    sides: SideForces
    controls: Controls
    own: OwnDampers
    tables: Tables
    modes: Modes
    space: ModalSpace
    rolling: Rolling
    round: RoundTyres
    fluids: Fluids
    applied: Applied
    joints: Indices
    tyres: Index
    reach: Indices
    row_count: int
    velocity_count: int
