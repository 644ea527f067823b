"""`python -m vehicle trust`: allow the native code of an FMU, list what is allowed, take it back."""

import json
from dataclasses import dataclass
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import command_parser, message_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, setting


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("trust", "Allow the native code of an FMU, list the allowed files, or remove one.")
    setting_options(parser, TrustSettings, "files", "list", "remove")
    parser.add_argument("--json", action="store_true", help="print the list as JSON")
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class TrustSettings(Settings):
    """Files to allow, and the begin of the SHA-256 of a file to remove; `list` prints what is allowed."""

    files: tuple[Path, ...] = setting(
        "files that may run as native code, with all your rights; a changed file must be added again",
        (),
        flag="files",
        nargs="*",
        type=Path,
        metavar="FMU",
    )
    list: bool = setting("print the SHA-256 and the path of each allowed file", False, action="store_true")
    remove: str | None = setting("remove the file whose SHA-256 begins with these digits", metavar="DIGEST")


def _job(settings: TrustSettings, console: Console) -> None:
    from vehicle.core.trusted_code import distrust, trust, trusted, trusted_list

    if not (settings.files or settings.list or settings.remove is not None or console.json):
        raise ConfigurationError("name an FMU to allow, or type --list or --remove DIGEST")
    for file in settings.files:
        digest = trust(file)
        if not console.json:
            print(f"trusted     {digest}  {file}")
    if settings.remove is not None:
        digest, name = distrust(settings.remove)
        if not console.json:
            print(f"removed     {digest}  {name}")
    entries = trusted()
    if console.json:
        print(json.dumps({"file": str(trusted_list()), "trusted": entries}, indent=2))
    elif settings.list:
        print(f"list        {trusted_list()}, {len(entries) or 'no'} {'entry' if len(entries) == 1 else 'entries'}")
        for digest, name in entries.items():
            print(f"  {digest}  {name}")


main = command(parser, TrustSettings, _job)
