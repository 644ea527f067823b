"""`python -m vehicle body import`: a body model of matrices, computed modes or a modal test."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.options import finite_numbers, message_options, vehicle_options
from vehicle.commands.parser import Parser, refuse_idle
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.sources import FOLLOWING, LENGTHS, MASSES, METHODS

if TYPE_CHECKING:
    from vehicle.model.flexbody.mass_properties import MassProperties
    from vehicle.model.flexbody.sources.body_units import Units
    from vehicle.model.flexbody.sources.mode_shapes import GivenModes
    from vehicle.model.parameters.hardpoints import Point
    from vehicle.model.parameters.vehicle import Vehicle

_ANSYS = (
    "type in ANSYS: /AUX2, FILE,JOB,full, HBMAT,k,matrix,,ASCII,STIFF,NO,YES and "
    "HBMAT,m,matrix,,ASCII,MASS,NO,NO. Then import k.matrix with --mass m.matrix, --dofs k.mapping and --nodes "
    "FILE"
)
REFUSED = {
    ".op2": "Nastran OP2 cannot be read; export modes as a universal file (datasets 15, 55) through the "
    "pre-processor, or punch K and M with PARAM,EXTOUT,DMIGPCH and give JOB.pch with --nodes JOB.bdf",
    ".op4": "Nastran OP4 does not state the directions of its rows; punch K and M with PARAM,EXTOUT,DMIGPCH and "
    "give JOB.pch with --nodes JOB.bdf",
    ".rst": f"ANSYS results cannot be read; use JOB.full of the same modal analysis instead: {_ANSYS}",
    ".full": f"ANSYS full file: convert it to text first: {_ANSYS}",
    ".odb": "Abaqus database cannot be read; write K and M with *MATRIX GENERATE, STIFFNESS, MASS and *MATRIX OUTPUT",
    ".mnf": "Adams modal neutral file cannot be read; export the modes as a universal file from the FE program",
}


MATRICES, FILES, MODES, UNITS = (
    "stiffness and mass matrices",
    "further files that belong to the matrices",
    "modes",
    "units",
)
"""Titles of the groups of options that act on one type of source."""


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    parser = tasks.add_parser(
        "import", help="make a body model from FE matrices, from computed modes or from a modal test"
    )
    parser.add_argument(
        "file",
        type=Path,
        metavar="FILE",
        help="matrices: JOB.sti of CalculiX (.mas, .dof and .inp in the same folder), JOB.pch of Nastran (DMIG), "
        "or K as Matrix Market, Harwell-Boeing, FILE.mat:K or text, with --mass, --dofs and --nodes. Modes: "
        ".frd of CalculiX, or a universal file (datasets 55, 2414)",
    )
    parser.add_argument("--name", help="name of the body; default: name of the file")
    output_options(parser)
    _add_matrix_options(parser)
    modes = parser.scoped_group(MODES, needs="modes; the file holds stiffness and mass", active=None)
    modes.add_argument(
        "--modal-mass", type=float, metavar="KG", help="modal mass of the mode shapes, where the file states none [kg]"
    )
    modes.add_argument(
        "--residual",
        type=Path,
        metavar="FILE",
        help="static stiffness that the modes of the file leave out, at the attachments: table point,x [N/m],y "
        "[N/m],z [N/m], or flexibilities in [m/N]",
    )
    units = parser.scoped_group(
        UNITS, needs="matrices or .frd; a universal file states its units in dataset 164", active=None
    )
    units.add_argument(
        "--length-unit", choices=LENGTHS, help="unit of length in the matrices or the .frd file; default: m"
    )
    follows = ", ".join(f"{mass} with {length}" for length, mass in FOLLOWING.items())
    units.add_argument(
        "--mass-unit",
        choices=MASSES,
        help="unit of mass in the matrices or the .frd file. Default: the unit that fits N (or lbf), s and the "
        f"unit of length: {follows}. Example: a stiffness in N/mm needs masses in t",
    )
    _add_model_options(parser)
    vehicle_options(parser)
    message_options(parser, quiet=True)


def _add_matrix_options(parser: Parser) -> None:
    """Add the options that act on stiffness and mass matrices."""
    files = parser.scoped_group(FILES, needs="stiffness and mass in separate files", active=None)
    files.add_argument(
        "--mass", type=Path, metavar="FILE", help="file of the mass matrix that belongs to the stiffness matrix"
    )
    files.add_argument(
        "--dofs",
        type=Path,
        metavar="FILE",
        help="file with the node and direction (1 to 6) of each matrix row, as node,direction, or the mapping "
        "file of ANSYS",
    )
    files.add_argument(
        "--nodes",
        type=Path,
        metavar="FILE",
        help="positions of the nodes: table node,x,y,z, input deck with *NODE, or .bdf with GRID",
    )
    matrices = parser.scoped_group(MATRICES, needs="stiffness and mass; the file holds modes", active=None)
    matrices.add_argument(
        "--method",
        choices=METHODS,
        default=METHODS[0],
        help="reduction: free-free (default) keeps the modes of the free body and the residual flexibility; "
        "rubin adds modes of its points with the mass that moves with them; craig-bampton keeps the modes "
        "of the body held at its points",
    )
    more = parser.scoped_group(
        "modes of the points",
        needs="--method rubin or craig-bampton",
        active=lambda options: options.method != METHODS[0],
    )
    more.add_argument(
        "--attachment-modes",
        type=float,
        metavar="HZ",
        help="highest mode that rubin adds or craig-bampton keeps [Hz]; default: 5 times --up-to",
    )


def _add_model_options(parser: Parser) -> None:
    """Add the options of the position, the modes and the points of the body model."""
    frame = parser.add_argument_group("position in the vehicle")
    frame.add_argument(
        "--axes",
        default="x,y,z",
        metavar="X,Y,Z",
        help="axes of the source file that point to the rear, to the driver's right and up. Example: -x,-y,z if "
        "its x points forward and its y to the left. Default: x,y,z",
    )
    frame.add_argument(
        "--origin",
        default="0,0,0",
        metavar="X,Y,Z",
        help="where the origin of the source file lies in the car [m]; default: 0,0,0",
    )
    model = parser.add_argument_group("modes of the model")
    model.add_argument(
        "--up-to", type=float, default=100.0, metavar="HZ", help="keep modes up to this frequency [Hz]; default: 100"
    )
    model.add_argument(
        "--damping", type=float, default=0.02, metavar="RATIO", help="damping ratio of every mode; default: 0.02"
    )
    points = parser.add_argument_group("points of the car")
    parser.former(
        "--tolerance",
        "--tolerance is not an option here; set the largest allowed distance between a point of the car and its "
        "node with --point-distance MM",
    )
    parser.former(
        "--map",
        "--map is not an option here; give the table of nodes for the points of the car with --point-nodes FILE",
    )
    points.add_argument(
        "--point-distance",
        type=float,
        default=1.0,
        metavar="MM",
        help="largest allowed distance between a point of the car and its node [mm]; default: 1",
    )
    points.add_argument(
        "--spread",
        type=float,
        default=0.0,
        metavar="MM",
        help="connect a point to all nodes within this radius [mm]; default: 0, the nearest node only",
    )
    points.add_argument(
        "--point-nodes", type=Path, metavar="FILE", help="table point,node that chooses the node of a point of the car"
    )


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Read the source, write the body model, and print its properties and the node of each point of the car.

    Raises:
        ConfigurationError: an option is out of range, without effect on this source, or missing.
        DataError: the source, or its size, mass or first mode in the units of the options, is wrong.
    """
    from vehicle.model.flexbody.sources.body_units import require_first_mode, require_mass, require_size, units_of
    from vehicle.model.flexbody.sources.interfaces import interfaces, read_map
    from vehicle.model.flexbody.sources.residual_table import read_residuals
    from vehicle.model.flexbody.sources.superelement_of import modes_of_matrices, superelement_of

    require_output(options)
    _check_numbers(options)
    points = vehicle.composition.attachments()
    near = {
        "tolerance": 1e-3 * options.point_distance,
        "spread": 1e-3 * options.spread,
        "named": read_map(options.point_nodes) if options.point_nodes else {},
    }
    axes = finite_numbers(options.origin, ",")
    if len(axes) != 3:
        raise ConfigurationError(f"--origin {options.origin}: must be three numbers [m], for example 1.2,0,0.35")
    origin = (axes[0], axes[1], axes[2])
    matrices = _matrices(options)
    idle: tuple[str, ...] = (MODES,) if matrices is not None else (MATRICES, FILES)
    if matrices is not None and options.file.suffix == ".sti":
        idle = (MODES, FILES)
    elif matrices is None and options.file.suffix != ".frd":
        idle = (MATRICES, FILES, UNITS)
    for title in idle:
        refuse_idle(options, title)
    units, weight = units_of(options.length_unit, options.mass_unit), _vehicle_mass(vehicle)
    notices = []
    if matrices is not None:
        body = matrices.scaled(*units.sizes).placed(options.axes, origin)
        body = replace(body, source=f"{body.source}, {units.words}")
        notices.append(units.words)
        require_size(body.positions, points, units)
        require_mass(body.mass_properties().mass, weight.mass, units)
        attached = interfaces(body, points, **near)
        modes = modes_of_matrices(body, options.up_to, attached, options.method, options.attachment_modes)
        require_first_mode(float(modes.frequencies[0]), units)
    else:
        from vehicle.model.flexbody.sources.mode_shapes import normalised

        shapes = _given_modes(options, units, weight.mass, points).placed(options.axes, origin)
        notices += [units.words] if options.file.suffix == ".frd" else []
        attached = interfaces(shapes.body, points, **near)
        residual = read_residuals(options.residual, points) if options.residual else {}
        modes = normalised(shapes, weight, options.modal_mass, options.up_to, residual)
    model = superelement_of(modes, attached, name=options.name or options.file.stem, damping=options.damping)
    write(options, model)
    if options.quiet:
        return
    print("\n".join([*(f"note: {notice}" for notice in (*notices, *modes.notices)), *report(model, vehicle)]))
    print("points of the car")
    for interface in attached:
        which = f"{interface.nodes} nodes, the nearest" if interface.nodes > 1 else "a node"
        print(f"  {interface.name:<28} {which} {1e3 * interface.distance:.2f} mm away")


def _matrices(options: argparse.Namespace) -> Any:
    """Read the stiffness and mass matrices in the units of the source; None for a file of modes."""
    file: Path = options.file
    if file.suffix.lower() in REFUSED:
        raise DataError(f"{file}: {REFUSED[file.suffix.lower()]}.")
    if file.suffix == ".sti":
        from vehicle.model.flexbody.sources.calculix import read_calculix

        return read_calculix(file)
    from vehicle.model.flexbody.sources.nastran import is_bulk_data

    if not is_bulk_data(file):
        if options.mass is None:
            if options.file.suffix in (".mtx", ".mat"):
                raise ConfigurationError(f"{options.file}: is a stiffness matrix; give --mass, --dofs and --nodes too")
            return None
        if options.nodes is None:
            raise ConfigurationError("--mass: the positions of the nodes are missing; set --nodes FILE too")
    from vehicle.model.flexbody.sources.matrix_files import read_matrices

    return read_matrices(file, options.mass, options.dofs, options.nodes)


def _given_modes(options: argparse.Namespace, units: Units, mass: float, points: Mapping[str, Point]) -> GivenModes:
    """Read modes: from CalculiX (.frd) in the units of the options, or from a universal file."""
    from vehicle.model.flexbody.sources.body_units import require_level, require_size
    from vehicle.model.flexbody.sources.frd import read_frd
    from vehicle.model.flexbody.sources.mode_shapes import modes_of_measurement
    from vehicle.signals.formats.reader import read_record

    if options.file.suffix == ".frd":
        modes = read_frd(options.file, *units.sizes)
        require_size(modes.body.positions, points, units)
        require_level(modes.vectors, modes.modal_mass, mass, units)
        return modes
    return modes_of_measurement(read_record(options.file))


def _vehicle_mass(vehicle: Vehicle) -> MassProperties:
    """Return the mass properties of the trimmed body in the vehicle file."""
    from vehicle.model.flexbody.mass_properties import MassProperties
    from vehicle.model.flexbody.rigid_body import rigid_body

    body = rigid_body(vehicle.body)
    return MassProperties(mass=body.mass, cog=body.cog, inertia=body.inertia)


def _check_numbers(options: argparse.Namespace) -> None:
    """Check the numeric options of an import; NaN is outside every range."""
    from vehicle.model.flexbody.superelement_checks import HIGHEST_DAMPING, LARGEST_TOLERANCE

    limit = 1e3 * LARGEST_TOLERANCE
    for name, value, allowed, text in (
        ("--up-to", options.up_to, 0.0 < options.up_to < math.inf, "a frequency above 0 Hz"),
        (
            "--attachment-modes",
            options.attachment_modes,
            options.attachment_modes is None or options.up_to <= options.attachment_modes < math.inf,
            f"at least --up-to, {options.up_to:g} Hz",
        ),
        ("--damping", options.damping, 0.0 <= options.damping <= HIGHEST_DAMPING, f"0 to {HIGHEST_DAMPING:g}"),
        (
            "--point-distance",
            options.point_distance,
            0.0 < options.point_distance <= limit,
            f"above 0, up to {limit:g} mm",
        ),
        ("--spread", options.spread, 0.0 <= options.spread < math.inf, "0 mm or a radius"),
        (
            "--modal-mass",
            options.modal_mass,
            options.modal_mass is None or 0.0 < options.modal_mass < math.inf,
            "a mass above 0 kg",
        ),
    ):
        if not allowed:
            raise ConfigurationError(f"{name} {value:g}: must be {text}")
