"""`python -m vehicle fit-damper`: the law of a damper from records of a test machine."""

import argparse
import shlex
from functools import partial
from pathlib import Path

from vehicle.commands.accepted_advice import accept
from vehicle.commands.command_line import ProgressLine, command, print_result
from vehicle.commands.destination import output_files_of
from vehicle.commands.input_options import record_choice, record_options
from vehicle.commands.options import command_parser, head_options, message_options, output_options
from vehicle.commands.parser import Parser

TABLE, REPORT = "damper_tests.csv", "report.html"
CONTROL = "damper_control.toml", "damper_control.png"


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fit-damper", "Fit the force law of a damper to records of a test machine.")
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE",
        help="record of a test: time, displacement, force and, if measured, velocity; all files are fitted together",
    )  # fmt: skip
    record_options(parser, "channel of time, displacement, force or velocity, for example force=Load", highpass=False)
    parser.add_argument(
        "--positive", choices=("extension", "compression"),
        help="direction in which displacement, velocity and force of the files are positive; default: extension; the "
            "gas force and bump against rebound show a wrong direction",
    )  # fmt: skip
    parser.add_argument(
        "--condition", action="append", default=[], metavar="NAME=VALUE",
        help="condition of the tests, for example current=1 for all files, current=0,0,1 for three files, or "
            "current=channel:I for the mean of channel I of each file. Tests at equal conditions give one law. "
            "May be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--pattern", default="", metavar="PATTERN",
        help="read conditions from the file names (without ending): name in braces, * for the rest, for example "
            "'*Hz{current}A'",
    )  # fmt: skip
    output_options(parser, None, default=f"damper.toml, {TABLE}, damper.png and {REPORT} in runs/damper")
    head_options(parser)
    parser.add_argument("--json", action="store_true", help="print law, parameters and errors as JSON")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.drawing.rendering.damper_plot import plot_damper, plot_settings
    from vehicle.runs.output.folder import Content, write_together
    from vehicle.signals.records.choice import pairs
    from vehicle.studies.dampers.damper_page import damper_page, loops_of
    from vehicle.studies.dampers.damper_text import caption_of, fit_json, summary_lines, tests_text, vehicle_lines
    from vehicle.studies.dampers.fitted_damper import fit_damper
    from vehicle.studies.dampers.over_condition import control_lines, curve_lines, settings_of

    named = pairs("--unit", options.units, "")  # by role, or by the name or number of a column
    fits = fit_damper(
        options.files,
        record_choice(options, "", known=("time", "displacement", "force", "velocity", *named)),
        compression=None if options.positive is None else options.positive == "compression",
        conditions=pairs("--condition", options.condition, ""),
        pattern=options.pattern,
        progress=ProgressLine("fit       ", enabled=not options.quiet),
    )
    accept(options, (text for fitted in fits for test in fitted.tests for text in test.notices))
    command_line = f"python -m vehicle fit-damper {shlex.join(options.words)}"
    contents: dict[str, Content] = {
        TABLE: tests_text(fits),
        REPORT: damper_page(fits, command_line, author=options.author, project=options.project),
    }
    for fitted in fits:
        title = fitted.fit.law.title[:1].upper() + fitted.fit.law.title[1:]
        contents[f"damper{fitted.name}.toml"] = vehicle_lines(fitted)
        contents[f"damper{fitted.name}.png"] = partial(
            plot_damper, loops=loops_of(fitted), title=title, caption=caption_of(fitted)
        )
    if len(fits) > 1:
        lines, picture = CONTROL
        contents[lines] = control_lines(fits)
        settings = {each.words: (each.damping, each.friction) for each in settings_of(fits)}
        contents[picture] = partial(plot_settings, curves=curve_lines(fits), settings=settings)
    paths = output_files_of(options, Path("runs/damper"), list(contents))
    write_together(paths, contents.values())
    texts = [fit_json(fitted) for fitted in fits]
    summary = [line for fitted in fits for line in summary_lines(fitted)]
    summary.append(f"files: {paths[0].parent}: {', '.join(path.name for path in paths)}")
    print_result(options, texts[0] if len(texts) == 1 else {"dampers": texts}, "\n".join(summary))


main = command(parser, _job)
