"""`python -m vehicle` lists the commands; `python -m vehicle modes --damper sliding` runs one of them."""

import sys
from collections.abc import Sequence
from importlib import import_module

from vehicle.commands import COMMANDS, module_of
from vehicle.commands.command_line import begin_process, run_command
from vehicle.errors import ConfigurationError
from vehicle.wording import did_you_mean


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; without one, print the list of commands.

    Args:
        arguments: name of the command and its options; the arguments of the process by default.

    Returns:
        Exit code, see `run_command`.
    """
    typed = sys.argv[1:] if arguments is None else list(arguments)
    if arguments is None:
        begin_process()
    if typed and typed[0] in COMMANDS:
        code: int = import_module(module_of(typed[0])).main(typed[1:])
        return code
    return run_command(lambda: _print(typed))


def _print(typed: Sequence[str]) -> None:
    """Print the list of commands, the version, a JSON Schema or a completion script.

    Raises:
        ConfigurationError: the first word is no command and no option.
    """
    if typed[:1] == ["--version"]:
        from vehicle.core.library import variant
        from vehicle.version import package_version

        print(f"{package_version()}, core {variant()}")
        return
    if typed[:1] == ["--schema"]:
        from vehicle.commands.schema_text import schema_text

        print(schema_text(typed[1:]))
        return
    if typed[:1] == ["--print-completion"]:
        from vehicle.commands.completion import completion_script

        print(completion_script("".join(typed[1:2])), end="")
        return
    if typed and typed[0] not in ("-h", "--help"):
        nearest = did_you_mean(typed[0], COMMANDS, cutoff=0.6)
        raise ConfigurationError(f"unknown command {typed[0]!r}; must be one of {', '.join(COMMANDS)}{nearest}")
    print("usage: python -m vehicle COMMAND [options]; `COMMAND --help` lists the options of a command\n")
    for name in COMMANDS:
        print(f"  {name:<11} {import_module(module_of(name)).parser().description}")
    print("\nfirst run: python -m vehicle shaker --input low.csv --report, then open runs/low/report.html")
    print(
        "--version prints the version; --print-completion bash|zsh prints a script that completes commands and options"
    )
    print("--schema prints the JSON Schema of a vehicle file; --schema template prints the schema of a template")


if __name__ == "__main__":
    raise SystemExit(main())
