"""Parsed options end at the parser: where they are seen, and which command knows of another."""

import ast
import re
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "vehicle"
PATHS = sorted(PACKAGE.rglob("*.py"))


def imports_of(path: Path) -> set[str]:
    """Return the modules that a file imports, wherever the import is."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    found = {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
    return found | {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}


def test_only_commands_see_parsed_options():
    aware = {path.relative_to(PACKAGE).parts[0] for path in PATHS if "argparse" in imports_of(path)}
    assert aware == {"commands"}


def test_no_command_imports_a_command():
    made = re.compile(r"^main = command\(", re.MULTILINE)
    commands = {path.stem: path for path in PATHS if made.search(path.read_text(encoding="utf-8"))}
    assert len(commands) > 20
    for path in commands.values():
        others = imports_of(path) & {f"vehicle.commands.{name}" for name in commands}
        assert not others, f"{path.name} imports {others}"
