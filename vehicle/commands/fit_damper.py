"""`python -m vehicle fit-damper`: the law of a damper from records of a test machine."""

import itertools
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import record_options
from vehicle.commands.options import (
    CAR_HELP,
    command_parser,
    head_options,
    message_options,
    output_options,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting
from vehicle.signals.records.record_settings import RecordSettings

TABLE, REPORT = "damper_tests.csv", "report.html"
CONTROL = "damper_control.toml", "damper_control.png"


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fit-damper", "Fit the force law of a damper to records of a test machine.")
    setting_options(parser, DamperFitSettings, "files")  # fmt: skip
    record_options(
        parser, "channel with the time, displacement, force or velocity, for example force=Load", highpass=False
    )
    setting_options(parser, DamperFitSettings, "positive")  # fmt: skip
    setting_options(parser, DamperFitSettings, "condition")  # fmt: skip
    setting_options(parser, DamperFitSettings, "pattern")  # fmt: skip
    setting_options(parser, DamperFitSettings, "vehicle", type=vehicle_file)
    output_options(parser, None, default=f"damper.toml, damper_band.csv, {TABLE}, pictures and {REPORT} in runs/damper")
    head_options(parser)
    parser.add_argument("--json", action="store_true", help="print law, parameters and errors as JSON")
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class DamperFitSettings(Settings):
    """Settings of the fit of a damper.

    Attributes:
        record: channels, units and times of the records.
        author, project: names at the top of the report.
    """

    files: tuple[Path, ...] = setting(
        "record of a test: time, displacement, force and, if measured, velocity; all files are fitted together",
        flag="files",
        nargs="+",
        type=Path,
        metavar="FILE",
    )
    record: RecordSettings = part(RecordSettings)
    positive: str | None = setting(
        "positive direction of displacement, velocity and force in the files; default: extension; if it is wrong, gas "
        "force, bump and rebound are reversed",
        choices=("extension", "compression"),
    )
    condition: tuple[str, ...] = setting(
        "condition of the tests, for example current=1 for all files, current=0,0,1 for three files, or "
        "current=channel:I for channel I of each file: its mean, or its values over time if it changes during a test. "
        "Tests at equal conditions give one law. "
        "May be repeated",
        (),
        action="append",
        metavar="NAME=VALUE",
    )
    pattern: str = setting(
        "read conditions from the file names (without ending); braces contain the name, * stands for the rest, for "
        "example '*Hz{current}A'",
        "",
        metavar="PATTERN",
    )
    vehicle: Path | None = setting(
        f"{CAR_HELP}; default: no car, the next test counts each octave from 1 mm/s to 1 m/s alike. With a car it "
        "counts the velocities of its dampers on roads of class A, B and C at 80 km/h",
        metavar="FILE.toml",
    )
    destination: Destination = part(Destination)
    author: str = ""
    project: str = ""


def _job(settings: DamperFitSettings, console: Console) -> None:
    from vehicle.drawing.rendering.damper_plot import plot_band, plot_damper, plot_settings
    from vehicle.runs.output.folder import Content, write_together
    from vehicle.signals.records.choice import pairs
    from vehicle.studies.dampers.damper_band import band_of, band_text
    from vehicle.studies.dampers.damper_page import damper_page, loops_of
    from vehicle.studies.dampers.damper_text import (
        caption_of,
        fit_json,
        set_lines,
        summary_lines,
        tests_text,
        vehicle_lines,
    )
    from vehicle.studies.dampers.fitted_damper import fit_damper
    from vehicle.studies.dampers.next_tests import even_use, next_json, next_lines, next_tests
    from vehicle.studies.dampers.over_condition import control_lines, curve_lines
    from vehicle.studies.dampers.over_condition import settings_of as laws_of

    named = pairs("--unit", settings.record.units, "")  # by role, or by the name or number of a column
    fits = fit_damper(
        settings.files,
        settings.record.choice("", further=("time", "displacement", "force", "velocity", *named)),
        compression=None if settings.positive is None else settings.positive == "compression",
        conditions=pairs("--condition", settings.condition, ""),
        pattern=settings.pattern,
        progress=console.progress("fit       "),
    )
    use = even_use()
    if settings.vehicle is not None:
        from vehicle.runs.car import Car
        from vehicle.studies.dampers.use_in_car import use_in_car

        use = use_in_car(Car.load(settings.vehicle))
    further = next_tests(fits, use)
    console.accept(text for fitted in fits for test in fitted.tests for text in test.notices)
    contents: dict[str, Content] = {
        TABLE: tests_text(fits),
        REPORT: damper_page(
            fits,
            console.command("vehicle fit-damper"),
            further,
            use,
            author=settings.author,
            project=settings.project,
        ),
    }
    for fitted in fits:
        title = fitted.fit.law.title[:1].upper() + fitted.fit.law.title[1:]
        contents[f"damper{fitted.name}.toml"] = vehicle_lines(fitted)
        contents[f"damper{fitted.name}.png"] = partial(
            plot_damper, loops=loops_of(fitted), title=title, caption=caption_of(fitted)
        )
        band = band_of(fitted)
        contents[f"damper_band{fitted.name}.csv"] = band_text(band)
        contents[f"damper_band{fitted.name}.png"] = partial(plot_band, band=band, tested=fitted.speeds)
    if len(fits) > 1:
        lines, picture = CONTROL
        contents[lines] = control_lines(fits)
        laws = {each.words: (each.damping, each.friction) for each in laws_of(fits)}
        contents[picture] = partial(plot_settings, curves=curve_lines(fits), settings=laws)
    paths = settings.destination.files(Path("runs/damper"), list(contents))
    write_together(paths, contents.values())
    texts = [fit_json(fitted) for fitted in fits]
    again = [False, *(fit.tests is following.tests for fit, following in itertools.pairwise(fits))]
    summary = [line for fitted, same in zip(fits, again, strict=True) for line in summary_lines(fitted, same)]
    summary += next_lines(further, use)
    summary.append(f"files: {paths[0].parent}: {', '.join(path.name for path in paths)}")
    control = set_lines(control_lines(fits), "damper.control")
    result = texts[0] if len(texts) == 1 else {"dampers": texts, "control": control}
    console.result(result | next_json(further, use), "\n".join(summary))


main = command(parser, DamperFitSettings, _job)
