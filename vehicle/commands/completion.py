"""Shell completion of all commands: a script for bash or zsh, made from their parsers."""

import argparse
from collections.abc import Iterator
from importlib import import_module

from vehicle.commands import COMMANDS, module_of
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import CARS
from vehicle.signals.excitation.input_files import shipped_inputs

SHELLS = {
    "bash": """
complete -o default -F _vehicle vehicle
for _name in python python3; do complete -p $_name > /dev/null 2>&1 || complete -o default -F _vehicle $_name; done
""",
    "zsh": """
autoload -Uz compinit bashcompinit && compinit && bashcompinit
complete -o default -F _vehicle vehicle
""",
}
"""Lines that register the completion. An existing completion of python stays as it is, and in zsh python has one."""

SCRIPT = """_vehicle_words() {
  case "$1" in
%s
    *) return 1 ;;
  esac
}
_vehicle() {
  local current="${COMP_WORDS[COMP_CWORD]}" first=1 name= words= next
  COMPREPLY=()
  case "${COMP_WORDS[0]##*/}" in python*)
    [[ "${COMP_WORDS[1]}" == -m ]] || return 0
    first=3
    case "${COMP_WORDS[2]}" in
      vehicle) ;;
      vehicle.*) name="${COMP_WORDS[2]#vehicle.}" ;;
      *) return 0 ;;
    esac ;;
  esac
  while [[ $first -lt $COMP_CWORD ]]; do
    next="${name:+$name }${COMP_WORDS[$first]}"
    [[ "${COMP_WORDS[$first]}" != -* ]] && _vehicle_words "$next" > /dev/null || break
    name="$next"; first=$((first + 1))
  done
  if [[ "$current" == -* ]]; then words=$(_vehicle_words "$name")
  elif ! words=$(_vehicle_words "${name:+$name }${COMP_WORDS[COMP_CWORD-1]}"); then
    words=$(_vehicle_words "$name"); words="${words%%%% --*}"
  fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}"""
"""Functions of the script. `_vehicle_words` prints the words that may follow a command or an option; file names follow
where it prints none."""


def completion_script(shell: str) -> str:
    """Return the completion script of a shell, "bash" or "zsh"."""
    if shell not in SHELLS:
        raise ConfigurationError(f"--print-completion {shell}: must be {' or '.join(SHELLS)}")
    rows = [("", f"{' '.join(COMMANDS)} --help --version --print-completion"), ("--print-completion", " ".join(SHELLS))]
    for name in COMMANDS:
        rows += _rows(name, import_module(module_of(name)).parser())
    return SCRIPT % "\n".join(f'    "{key}") echo "{choices}" ;;' for key, choices in rows) + SHELLS[shell]


def _rows(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, str]]:
    """Yield the words allowed after a command, and its options with a value.

    Values that contain a blank are left out.
    """
    tasks: dict[str, argparse.ArgumentParser] = {}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            tasks = action.choices
    options = [option for action in parser._actions for option in action.option_strings if option.startswith("--")]
    yield name, " ".join([*tasks, "", *options])
    shipped = {"--vehicle": CARS, "--input": shipped_inputs()}
    for action in parser._actions:
        values = [value for value in map(str, action.choices or ()) if " " not in value]
        for option in action.option_strings if action.nargs != 0 else ():
            yield f"{name} {option}", " ".join(values or shipped.get(option, ()))
    for task, task_parser in tasks.items():
        yield from _rows(f"{name} {task}", task_parser)
