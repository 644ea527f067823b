"""`python -m vehicle fit-damper`: the law of a damper from records of a test machine."""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_files_of
from vehicle.commands.input_options import record_choice, record_options
from vehicle.commands.options import command_parser, message_options, output_options
from vehicle.commands.parser import Parser

TABLE, CONTROL = "damper_tests.csv", "damper_control.toml"


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fit-damper", "Fit the law of a damper to records of a test machine.")
    parser.add_argument(
        "files", nargs="+", type=Path, metavar="FILE",
        help="record of a test: time, displacement, force, and velocity where it was measured; all are fitted together",
    )  # fmt: skip
    record_options(parser, "displacement, force and velocity, as force=Load", highpass=False)
    parser.add_argument(
        "--positive", choices=("extension", "compression"), default="extension",
        help="direction in which displacement, velocity and force of the files are positive; %(default)s by default",
    )  # fmt: skip
    parser.add_argument(
        "--condition", action="append", default=[], metavar="NAME=VALUE",
        help="condition of the tests, as current=1, or current=channel:I for the mean of a channel of each file; tests "
        "of equal conditions are fitted together. May be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--pattern", default="", metavar="PATTERN",
        help="conditions in the names of the files without ending, in braces, with * for the rest, as '*Hz{current}A'",
    )  # fmt: skip
    output_options(parser, None, default=f"damper.toml, {TABLE} and damper.png in runs/damper")
    parser.add_argument("--json", action="store_true", help="print JSON: law, parameters, errors of the tests")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.drawing.rendering.damper_plot import DamperLoop, plot_damper
    from vehicle.runs.output.folder import whole_files, write_text, write_whole
    from vehicle.signals.records.choice import pairs
    from vehicle.studies.dampers.damper_text import (
        caption_of,
        control_lines,
        fit_json,
        summary_lines,
        tests_text,
        vehicle_lines,
    )
    from vehicle.studies.dampers.fitted_damper import fit_damper

    named = pairs("--unit", options.units, "")  # by role, or by the name or number of a column
    fits = fit_damper(
        options.files,
        record_choice(options, "", known=("time", "displacement", "force", "velocity", *named)),
        compression=options.positive == "compression",
        conditions=pairs("--condition", options.condition, ""),
        pattern=options.pattern,
    )
    names = [TABLE, *(f"damper{each.name}.{ending}" for each in fits for ending in ("toml", "png"))]
    names += [CONTROL] if len(fits) > 1 else []
    paths = dict(zip(names, output_files_of(options, Path("runs/damper"), names), strict=True))
    with whole_files(list(paths.values())) as temporary:
        new = dict(zip(names, temporary, strict=True))
        write_text(new[TABLE], tests_text(fits))
        for fitted in fits:
            write_text(new[f"damper{fitted.name}.toml"], vehicle_lines(fitted))
            loops = [
                DamperLoop(f"{test.name}: error {error:.3f}, left out {outside:.3f}", test.displacement, test.velocity,
                           test.force, fitted.fit.force(test))
                for test, error, outside in zip(fitted.tests, fitted.fit.fitted, fitted.fit.left_out, strict=True)
            ]  # fmt: skip
            title = fitted.fit.law.title[:1].upper() + fitted.fit.law.title[1:]
            write_whole(new[f"damper{fitted.name}.png"],
                        partial(plot_damper, loops=loops, title=title, caption=caption_of(fitted)))  # fmt: skip
        if len(fits) > 1:
            write_text(new[CONTROL], control_lines(fits))
    if options.json:
        texts = [fit_json(fitted) for fitted in fits]
        print(json.dumps(texts[0] if len(texts) == 1 else {"dampers": texts}, indent=2, allow_nan=False))
    elif not options.quiet:
        for fitted in fits:
            print("\n".join(summary_lines(fitted)))
        print(f"files: {paths[TABLE].parent}: {', '.join(path.name for path in paths.values())}")


main = command(parser, _job)
