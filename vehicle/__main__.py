"""`python -m vehicle` lists the commands; `python -m vehicle modes --damper sliding` runs one of them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module

from vehicle.commands import COMMANDS
from vehicle.commands.command_line import begin_process, run_command
from vehicle.errors import ConfigurationError


def main(arguments: Sequence[str] | None = None) -> int:
    """List the commands, or run one.

    Args:
        arguments: name of a command and its options; those of the process by default.

    Returns:
        Exit code, as of `run_command`.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        begin_process()
    if given and given[0] in COMMANDS:
        code: int = import_module(f"vehicle.commands.{given[0]}").main(given[1:])
        return code
    return run_command(lambda: _list(given))


def _list(given: Sequence[str]) -> None:
    """Print a JSON Schema, or a line for each command; raise for an unknown command."""
    if given and given[0] == "--schema":
        from vehicle.commands.schema_text import schema_text

        print(schema_text(given[1:]))
        return
    if given and given[0] not in ("-h", "--help"):
        close = get_close_matches(given[0], COMMANDS, n=1)
        nearest = f"; did you mean {close[0]}?" if close else ""
        raise ConfigurationError(f"no command {given[0]!r}; allowed are {', '.join(COMMANDS)}{nearest}")
    print("usage: python -m vehicle COMMAND [options]; --help behind a command lists its options\n")
    for name in COMMANDS:
        print(f"  {name:<11} {import_module(f'vehicle.commands.{name}').parser().description}")
    print("\n--schema prints the JSON Schema of a vehicle file, --schema template that of a template")


if __name__ == "__main__":
    raise SystemExit(main())
