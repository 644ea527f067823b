"""`python -m vehicle trust`: allow the native code of an FMU, list what is allowed, take it back."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.options import command_parser, message_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("trust", "Allow the native code of an FMU, list the allowed files, or remove one.")
    parser.add_argument(
        "files",
        nargs="*",
        type=Path,
        metavar="FMU",
        help="files that may run as native code, with all your rights; a changed file must be added again",
    )
    parser.add_argument("--list", action="store_true", help="print the SHA-256 and the path of each allowed file")
    parser.add_argument("--remove", metavar="DIGEST", help="remove the file whose SHA-256 begins with these digits")
    parser.add_argument("--json", action="store_true", help="print the list as JSON")
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.core.trusted_code import distrust, trust, trusted, trusted_list

    if not (options.files or options.list or options.remove is not None or options.json):
        raise ConfigurationError("name an FMU to allow, or type --list or --remove DIGEST")
    for file in options.files:
        digest = trust(file)
        if not options.json:
            print(f"trusted     {digest}  {file}")
    if options.remove is not None:
        digest, name = distrust(options.remove)
        if not options.json:
            print(f"removed     {digest}  {name}")
    entries = trusted()
    if options.json:
        print(json.dumps({"file": str(trusted_list()), "trusted": entries}, indent=2))
    elif options.list:
        print(f"list        {trusted_list()}, {len(entries) or 'no'} {'entry' if len(entries) == 1 else 'entries'}")
        for digest, name in entries.items():
            print(f"  {digest}  {name}")


main = command(parser, _job)
