"""Faults drawn at random over all packages: which of them does no test of `make test` see?

    python -m tools.drawn_faults [--seed 1] [--each 2] [--package vehicle/engines ...] [--list]

Each is one changed operator, sign, comparison or decimal number in a file that computes with numpy, drawn with a seed,
so that a draw can be repeated. Its tests are those of the product that import the changed module, then the folder of
its name.
A fault that survives is either one that changes nothing (a start value, a tolerance, a limit never met) or a gap.
"""

from __future__ import annotations

import argparse
import ast
import random
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.parts import is_rest
from tools.mutations import ROOT, Fault, try_all

PACKAGES = (
    *("vehicle/signals", "vehicle/model", "vehicle/engines", "vehicle/core", "vehicle/drawing"),
    *("vehicle/runs", "vehicle/handover", "vehicle/studies", "vehicle/commands"),
)
"""Folders from which faults are drawn, the same number from each."""

OPERATORS: dict[type[ast.AST], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Lt: ("<", ">="),
    ast.LtE: ("<=", ">"),
    ast.Gt: (">", "<="),
    ast.GtE: (">=", "<"),
}
"""Operator to its text and the text of the fault."""


def drawn(package: str, count: int, seed: int) -> list[Fault]:
    """Return faults of a package: first a file is drawn, then a place in it, so that long files do not prevail."""
    source = random.Random(f"{seed} {package}")
    files = sorted(path for path in (ROOT / package).rglob("*.py") if "import numpy" in path.read_text("utf-8"))
    faults: list[Fault] = []
    while len(faults) < count:
        path = source.choice(files)
        text = path.read_text(encoding="utf-8")
        if places := list(changes(text)):
            begin, end, new = source.choice(places)
            name = path.relative_to(ROOT).as_posix()
            faults.append(Fault(name, *alone(text, begin, end, new), tests_of(name)))
    return faults


def changes(text: str) -> Iterator[tuple[int, int, str]]:
    """Yield begin, end and new text of each fault that a source file can have."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    lines = text.splitlines(keepends=True)

    def at(line: int, column: int) -> int:
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    def begin(node: ast.expr) -> int:
        return at(node.lineno, node.col_offset)

    def end(node: ast.expr) -> int:
        return at(node.end_lineno or node.lineno, node.end_col_offset or 0)

    for node in _computed(ast.parse(text)):
        if isinstance(node, ast.BinOp | ast.Compare):
            left, operator, right = (
                (node.left, node.op, node.right)
                if isinstance(node, ast.BinOp)
                else (node.left, node.ops[0], node.comparators[0])
            )
            old, new = OPERATORS.get(type(operator), ("", ""))
            texts = any(isinstance(one, ast.Constant | ast.JoinedStr) and not _number(one) for one in ast.walk(node))
            between = text[end(left) : begin(right)]
            if old and not texts and between.count(old) == 1:
                place = end(left) + between.index(old)
                yield place, place + len(old), new
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and not _number(node.operand, int):
            yield begin(node), begin(node) + 1, "+"
        elif isinstance(node, ast.Constant) and isinstance(node.value, float) and node.value:
            yield begin(node), end(node), f"{1.1 * node.value!r}"


def _computed(node: ast.AST) -> Iterator[ast.AST]:
    """Yield a node and what is below it, without texts and annotations: their numbers change no result."""
    yield node
    for name, field in ast.iter_fields(node):
        if name not in ("annotation", "returns"):
            for one in field if isinstance(field, list) else [field]:
                if isinstance(one, ast.AST) and not isinstance(one, ast.JoinedStr):
                    yield from _computed(one)


def _number(node: ast.AST, *kinds: type) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (kinds or (int, float))


def alone(text: str, begin: int, end: int, new: str) -> tuple[str, str]:
    """Return the lines around a change, old and new: as many that they stand once in the file."""
    first, last = text.rfind("\n", 0, begin) + 1, text.index("\n", end)
    while text.count(text[first:last]) > 1:
        first = text.rfind("\n", 0, first - 1) + 1
    return text[first:last], text[first:begin] + new + text[end:last]


def tests_of(file: str) -> str:
    """Return the tests that may see a fault: tests that import its module, then the folder of its name."""
    package, _, module = file.removesuffix(".py").replace("/", ".").rpartition(".")
    direct = re.compile(rf"from {re.escape(package)} import .*\b{module}\b|from {re.escape(package)}\.{module} import")
    tests = ROOT / "tests"
    found = [
        path.relative_to(tests).as_posix()
        for path in sorted(tests.rglob("test_*.py"))
        if direct.search(path.read_text(encoding="utf-8"))
        and not is_rest(path.relative_to(tests).as_posix(), renders=False)
    ]
    folder = Path(file).parent.relative_to("vehicle")
    while not (tests / folder).is_dir():
        folder = folder.parent
    return " ".join([*found, folder.as_posix()])


def main() -> int:
    """Draw faults, try each, and print the table; return 1 if one survives."""
    parser = argparse.ArgumentParser(description="Faults drawn at random: does a test see each of them?")
    parser.add_argument("--seed", type=int, default=1, help="seed of the draw (default: 1)")
    parser.add_argument("--each", type=int, default=2, help="number of faults of each package (default: 2)")
    parser.add_argument("--package", nargs="+", default=PACKAGES, help="folders to draw from (default: all)")
    parser.add_argument("--list", action="store_true", help="print each fault and its tests, and try none")
    options = parser.parse_args()
    faults = (("", fault) for package in options.package for fault in drawn(package, options.each, options.seed))
    return try_all(faults, only_list=options.list)


if __name__ == "__main__":
    sys.exit(main())
