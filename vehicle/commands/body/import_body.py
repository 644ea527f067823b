"""`python -m vehicle body import`: a body model of matrices, computed modes or a modal test."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import origin_of, output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, setting_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.sources import FOLLOWING, LENGTHS, MASSES, METHODS
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.model.flexbody.mass_properties import MassProperties
    from vehicle.model.flexbody.sources.body_units import Units
    from vehicle.model.flexbody.sources.mode_shapes import GivenModes
    from vehicle.model.parameters.hardpoints import Point
    from vehicle.model.parameters.vehicle import Vehicle

_ANSYS = (
    "type these lines in ANSYS: '/AUX2', 'FILE,JOB,full', 'HBMAT,k,matrix,,ASCII,STIFF,NO,YES', "
    "'HBMAT,m,matrix,,ASCII,MASS,NO,NO'. Then import k.matrix with --mass m.matrix, --dofs k.mapping and --nodes "
    "FILE"
)
REFUSED = {
    ".op2": "Nastran OP2 files are not supported; export the modes as a universal file (datasets 15, 55) through the "
    "pre-processor, or punch K and M with PARAM,EXTOUT,DMIGPCH and give JOB.pch with --nodes JOB.bdf",
    ".op4": "Nastran OP4 files do not state the directions of its rows; punch K and M with PARAM,EXTOUT,DMIGPCH and "
    "give JOB.pch with --nodes JOB.bdf",
    ".rst": f"ANSYS result files are not supported; use JOB.full of the same modal analysis instead: {_ANSYS}",
    ".full": f"ANSYS full files must first be converted to text: {_ANSYS}",
    ".odb": "Abaqus databases are not supported; write K and M with *MATRIX GENERATE, STIFFNESS, MASS and *MATRIX "
    "OUTPUT",
    ".mnf": "Adams modal neutral files are not supported; export the modes as a universal file from the FE program",
}


MATRICES, FILES, MODES, UNITS = (
    "stiffness and mass matrices",
    "further files that belong to the matrices",
    "modes",
    "units",
)
"""Titles of the groups of options that act on one type of source."""


FOLLOWS = ", ".join(f"{mass} with {length}" for length, mass in FOLLOWING.items())
"""Unit of mass that fits each unit of length."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ImportSettings(Settings):
    """Settings of the import of a body model.

    Attributes:
        car: car with the points of the body.
        destination: file of the body model.
    """

    file: Path = setting(
        "matrices: JOB.sti from CalculiX (.mas, .dof and .inp in the same folder), JOB.pch from Nastran (DMIG), "
        "or K as Matrix Market, Harwell-Boeing, FILE.mat:K or text, with --mass, --dofs and --nodes. Modes: .frd from "
        "CalculiX, or a universal file (datasets 55, 2414)",
        flag="file",
        type=Path,
        metavar="FILE",
    )
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    name: str | None = setting("name of the body; default: name of the file")
    mass: Path | None = setting(
        "file of the mass matrix that belongs to the stiffness matrix", type=Path, metavar="FILE"
    )
    dofs: Path | None = setting(
        "file with the node and direction (1 to 6) of each matrix row (node,direction), or the mapping file from ANSYS",
        type=Path,
        metavar="FILE",
    )
    nodes: Path | None = setting(
        "positions of the nodes: table node,x,y,z, input deck with *NODE, or .bdf with GRID", type=Path, metavar="FILE"
    )
    method: str = setting(
        "reduction: free-free (default) keeps the modes of the free body and the residual flexibility; "
        "rubin adds modes of its points with the mass that moves with them; craig-bampton keeps the modes "
        "of the body held at its points",
        METHODS[0],
        choices=METHODS,
    )
    residual: Path | None = setting(
        "static stiffness that the modes of the file leave out, at the attachments: table point,x [N/m],y "
        "[N/m],z [N/m], or flexibilities in [m/N]",
        type=Path,
        metavar="FILE",
    )
    length_unit: str | None = setting("unit of length in the matrices or the .frd file; default: m", choices=LENGTHS)
    mass_unit: str | None = setting(
        "unit of mass in the matrices or the .frd file. Default: the unit that fits N (or lbf), s and the "
        f"unit of length: {FOLLOWS}. Example: a stiffness in N/mm needs masses in t",
        choices=MASSES,
    )
    axes: str = setting(
        "axes of the source file that point to the rear, to the driver's right and up. Example: -x,-y,z if "
        "its x points forward and its y to the left. Default: x,y,z",
        "x,y,z",
        metavar="X,Y,Z",
    )
    origin: str = setting(
        "position of the origin of the source file in the car [m]; default: 0,0,0", "0,0,0", metavar="X,Y,Z"
    )
    point_nodes: Path | None = setting(
        "table point,node that chooses the node of a point of the car", type=Path, metavar="FILE"
    )
    modal_mass: float | None = setting(
        "modal mass of the mode shapes, where the file states none [kg]", within="(0, inf)", type=float, metavar="KG"
    )
    attachment_modes: float | None = setting(
        "highest mode that rubin adds or craig-bampton keeps [Hz]; default: 5 times --up-to",
        within="(0, inf)",
        type=float,
        metavar="HZ",
    )
    up_to: float = setting(
        "keep modes up to this frequency [Hz]; default: 100", 100.0, within="(0, inf)", type=float, metavar="HZ"
    )
    damping: float = setting(
        "damping ratio of every mode; default: 0.02", 0.02, within="[0, 0.3]", type=float, metavar="RATIO"
    )
    point_distance: float = setting(
        "largest allowed distance between a point of the car and its node [mm]; default: 1",
        1.0,
        within="(0, 50]",
        type=float,
        metavar="MM",
    )
    spread: float = setting(
        "connect a point to all nodes within this radius [mm]; default: 0, the nearest node only",
        0.0,
        within="[0, inf)",
        type=float,
        metavar="MM",
    )

    def __post_init__(self) -> None:
        """Check the values."""
        Settings.__post_init__(self)
        highest = self.attachment_modes
        if highest is not None and highest < self.up_to:
            raise ConfigurationError(f"--attachment-modes {highest:g}: must be at least --up-to, {self.up_to:g} Hz")


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    parser = tasks.add_parser(
        "import", help="make a body model from FE matrices, from computed modes or from a modal test"
    )
    setting_options(parser, ImportSettings, "file", "name")
    output_options(parser)
    _add_matrix_options(parser)
    modes = parser.scoped_group(MODES, needs="modes; the file holds stiffness and mass", active=None)
    setting_options(modes, ImportSettings, "modal_mass", "residual")
    units = parser.scoped_group(
        UNITS, needs="matrices or .frd; a universal file states its units in dataset 164", active=None
    )
    setting_options(units, ImportSettings, "length_unit", "mass_unit")
    _add_model_options(parser)
    vehicle_options(parser)
    message_options(parser, quiet=True)


def _add_matrix_options(parser: Parser) -> None:
    """Add the options that act on stiffness and mass matrices."""
    files = parser.scoped_group(FILES, needs="stiffness and mass in separate files", active=None)
    setting_options(files, ImportSettings, "mass", "dofs", "nodes")
    matrices = parser.scoped_group(MATRICES, needs="stiffness and mass; the file holds modes", active=None)
    setting_options(matrices, ImportSettings, "method")
    more = parser.scoped_group(
        "modes of the points",
        needs="--method rubin or craig-bampton",
        active=lambda options: options.method != METHODS[0],
    )
    setting_options(more, ImportSettings, "attachment_modes")


def _add_model_options(parser: Parser) -> None:
    """Add the options of the position, the modes and the points of the body model."""
    frame = parser.add_argument_group("position in the vehicle")
    setting_options(frame, ImportSettings, "axes", "origin")
    model = parser.add_argument_group("modes of the model")
    setting_options(model, ImportSettings, "up_to", "damping")
    points = parser.add_argument_group("points of the car")
    parser.former(
        "--tolerance",
        "--tolerance: no such option; set the largest allowed distance between a point of the car and its "
        "node with --point-distance MM",
    )
    parser.former(
        "--map", "--map: no such option; give the table of nodes for the points of the car with --point-nodes FILE"
    )
    setting_options(points, ImportSettings, "point_distance", "spread", "point_nodes")


def run(settings: ImportSettings, console: Console) -> None:
    """Read the source, write the body model, and print its properties and the node of each point of the car.

    Raises:
        ConfigurationError: an option is out of range, without effect on this source, or missing.
        DataError: the source, or its size, mass or first mode in the units of the options, is wrong.
    """
    from vehicle.model.flexbody.sources.body_units import require_first_mode, require_mass, require_size, units_of
    from vehicle.model.flexbody.sources.interfaces import interfaces, read_map
    from vehicle.model.flexbody.sources.residual_table import read_residuals
    from vehicle.model.flexbody.sources.superelement_of import modes_of_matrices, superelement_of

    vehicle = settings.car.load()
    output = require_output(settings.destination, settings.file, settings.car.vehicle)
    points = vehicle.composition.attachments()
    near: dict[str, Any] = {
        "tolerance": 1e-3 * settings.point_distance,
        "spread": 1e-3 * settings.spread,
        "named": read_map(settings.point_nodes) if settings.point_nodes else {},
    }
    origin = origin_of(settings.origin)
    matrices = _matrices(settings)
    idle: tuple[str, ...] = (MODES,) if matrices is not None else (MATRICES, FILES)
    if matrices is not None and settings.file.suffix == ".sti":
        idle = (MODES, FILES)
    elif matrices is None and settings.file.suffix != ".frd":
        idle = (MATRICES, FILES, UNITS)
    for title in idle:
        console.refuse_idle(title)
    units, weight = units_of(settings.length_unit, settings.mass_unit), _vehicle_mass(vehicle)
    notices = []
    if matrices is not None:
        body = matrices.scaled(*units.sizes).placed(settings.axes, origin)
        body = replace(body, source=f"{body.source}, {units.words}")
        notices.append(units.words)
        require_size(body.positions, points, units)
        require_mass(body.mass_properties().mass, weight.mass, units)
        attached = interfaces(body, points, **near)
        modes = modes_of_matrices(body, settings.up_to, attached, settings.method, settings.attachment_modes)
        require_first_mode(float(modes.frequencies[0]), units)
    else:
        from vehicle.model.flexbody.sources.mode_shapes import normalised

        shapes = _given_modes(settings, units, weight.mass, points).placed(settings.axes, origin)
        notices += [units.words] if settings.file.suffix == ".frd" else []
        attached = interfaces(shapes.body, points, **near)
        residual = read_residuals(settings.residual, points) if settings.residual else {}
        modes = normalised(shapes, weight, settings.modal_mass, settings.up_to, residual)
    model = superelement_of(modes, attached, name=settings.name or settings.file.stem, damping=settings.damping)
    write(output, model)
    if console.quiet:
        return
    print("\n".join([*(f"note: {notice}" for notice in (*notices, *modes.notices)), *report(model, vehicle)]))
    print("points of the car")
    for interface in attached:
        which = f"{interface.nodes} nodes, the nearest" if interface.nodes > 1 else "a node"
        print(f"  {interface.name:<28} {which} {1e3 * interface.distance:.2f} mm away")


def _matrices(settings: ImportSettings) -> Any:
    """Read the stiffness and mass matrices in the units of the source; None for a file of modes."""
    file: Path = settings.file
    if file.suffix.lower() in REFUSED:
        raise DataError(f"{file}: {REFUSED[file.suffix.lower()]}.")
    if file.suffix == ".sti":
        from vehicle.model.flexbody.sources.calculix import read_calculix

        return read_calculix(file)
    from vehicle.model.flexbody.sources.nastran import is_bulk_data

    if not is_bulk_data(file):
        if settings.mass is None:
            if settings.file.suffix in (".mtx", ".mat"):
                raise ConfigurationError(f"{settings.file}: is a stiffness matrix; give --mass, --dofs and --nodes too")
            return None
        if settings.nodes is None:
            raise ConfigurationError("--mass: the positions of the nodes are missing; set --nodes FILE too")
    from vehicle.model.flexbody.sources.matrix_files import read_matrices

    return read_matrices(file, settings.mass, settings.dofs, settings.nodes)


def _given_modes(settings: ImportSettings, units: Units, mass: float, points: Mapping[str, Point]) -> GivenModes:
    """Read modes: from CalculiX (.frd) in the units of the options, or from a universal file."""
    from vehicle.model.flexbody.sources.body_units import require_level, require_size
    from vehicle.model.flexbody.sources.frd import read_frd
    from vehicle.model.flexbody.sources.mode_shapes import modes_of_measurement
    from vehicle.signals.formats.reader import read_record

    if settings.file.suffix == ".frd":
        modes = read_frd(settings.file, *units.sizes)
        require_size(modes.body.positions, points, units)
        require_level(modes.vectors, modes.modal_mass, mass, units)
        return modes
    return modes_of_measurement(read_record(settings.file))


def _vehicle_mass(vehicle: Vehicle) -> MassProperties:
    """Return the mass properties of the trimmed body in the vehicle file."""
    from vehicle.model.flexbody.mass_properties import MassProperties
    from vehicle.model.flexbody.rigid_body import rigid_body

    body = rigid_body(vehicle.body)
    return MassProperties(mass=body.mass, cog=body.cog, inertia=body.inertia)


SETTINGS = ImportSettings
