"""`python -m vehicle fit-mount`: the law of a mount from measured dynamic stiffness and loss angle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import command_parser, message_options, output_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.drawing.rendering.mount_plot import MountCurve
    from vehicle.studies.mounts.measured_stiffness import MeasuredStiffness
    from vehicle.studies.mounts.mount_fit import MountFit

FILES = ("mount.toml", "mount.csv", "mount.png")
CURVE_POINTS = 400
"""Number of points of a fitted curve in the picture."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fit-mount", "Fit the force law of a mount to measured dynamic stiffness and loss angle.")
    setting_options(parser, MountFitSettings, "file", "law")
    output_options(parser, None, default=f"{', '.join(FILES)} in runs/mount")
    parser.add_argument("--json", action="store_true", help="print law, parameters and errors as JSON")
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class MountFitSettings(Settings):
    """Table of dynamic stiffness, law to fit ("auto" for the best one), and folder of the files."""

    file: Path = setting(
        "table with frequency [Hz], amplitude [mm] (half of peak to peak), stiffness [N/mm] and loss_angle [deg]",
        flag="file",
        type=Path,
        metavar="FILE",
    )
    law: str = setting(
        "rubber: spring with Maxwell branch and friction; hydro: hydromount with inertia track; decoupled: "
        "with a decoupler too; auto: the law that fits best for its number of parameters (least BIC). "
        "Default: %(default)s",
        "auto",
        choices=("auto", "rubber", "hydromount", "decoupler"),
    )
    destination: Destination = part(Destination)


def _job(settings: MountFitSettings, console: Console) -> None:
    from vehicle.drawing.rendering.mount_plot import plot_mount
    from vehicle.runs.output.folder import write_together
    from vehicle.studies.mounts.measured_stiffness import read_stiffness
    from vehicle.studies.mounts.mount_fit import fit_mount
    from vehicle.studies.mounts.mount_text import (
        TITLES,
        caption_of,
        fit_json,
        points_text,
        summary_lines,
        vehicle_lines,
    )

    data = read_stiffness(settings.file)
    paths = settings.destination.files(Path("runs/mount"), FILES)
    fits = fit_mount(data, None if settings.law == "auto" else (settings.law,))
    best, caption = fits[0], caption_of(data, settings.file.name)
    title = f"{TITLES[best.law.name].capitalize()}: points and fitted curves"
    picture = partial(plot_mount, curves=_curves(best, data), title=title, caption=caption)
    write_together(paths, (vehicle_lines(best, caption, data), points_text(best, data), picture))
    files = f"files: {paths[0].parent}: {', '.join(path.name for path in paths)}"
    console.result(fit_json(fits, caption, data), "\n".join([*summary_lines(fits, caption), files]))


def _curves(fit: MountFit, data: MeasuredStiffness) -> list[MountCurve]:
    """Return points and fitted curve of each amplitude."""
    import numpy as np

    from vehicle.drawing.rendering.mount_plot import MountCurve

    line = np.linspace(np.min(data.frequency), np.max(data.frequency), CURVE_POINTS)
    return [
        MountCurve(
            label=f"{1e3 * amplitude:.3g} mm",
            frequency=data.frequency[level],
            measured=data.stiffness[level],
            line=line,
            fitted=fit.stiffness(line, amplitude),
        )
        for amplitude, level in data.levels()
    ]


main = command(parser, MountFitSettings, _job)
