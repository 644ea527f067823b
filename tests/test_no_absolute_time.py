"""No test waits for a number of seconds of its own: a slow machine may take ten times as long."""

import ast
from pathlib import Path

TESTS = Path(__file__).resolve().parent
CLOCKS = {"monotonic", "perf_counter", "process_time", "thread_time", "time"}
"""Functions of `time` that read a clock."""
WAITING = {"wait", "WebDriverWait", "set_script_timeout"}
"""Functions whose last argument is a time-out."""
ELSEWHERE = ("benchmarks", "faults", "windows")
"""Folders of programs that no test waits for, or that judge times on a machine of their own."""


def fixed_times(tree: ast.AST) -> list[int]:
    """Return the lines with a time-out of a number, or a clock that is compared with a number alone."""
    lines = []
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword) and node.arg == "timeout" and isinstance(node.value, ast.Constant):
            lines.append(node.value.lineno)
        if isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in WAITING:
            last = node.args[-1] if node.args else None
            number = last.value if isinstance(last, ast.Constant) else None
            lines += [node.lineno] if isinstance(number, int | float) and number >= 1 else []
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add) and _is_clock(node.left):
            lines += [node.lineno] if isinstance(node.right, ast.Constant) else []
        if isinstance(node, ast.Compare) and any(isinstance(side, ast.Constant) for side in node.comparators):
            keys = [_text_key(item) for item in ast.walk(node.left)]
            timed = any(_is_clock(item) for item in ast.walk(node.left))
            positive = all(isinstance(side, ast.Constant) and side.value == 0.0 for side in node.comparators)
            if not positive and (timed or any(key.endswith(("_ms", "_us")) for key in keys)):
                lines.append(node.lineno)
    return lines


def _is_clock(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr in CLOCKS
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == "time"
    )


def _text_key(node: ast.AST) -> str:
    """Return the key of an item as found["step_ms"]; empty for any other node."""
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
        return str(node.slice.value)
    return ""


def test_the_rule_finds_what_it_forbids():
    code = (
        "wait(timeout=60)\n"
        "until = time.monotonic() + 5.0\n"
        "assert time.monotonic() - began < 2.0\n"
        "assert found['first_car_ms'] < 1100.0\n"
        "assert found['first_car_ms'] > 0.0\n"
        "wait(timeout=HANG)\n"
        "assert entered.wait(10.0)\n"
        "WebDriverWait(driver, 60).until(loaded)\n"
        "wait(HANG), wait(0.01)\n"
    )
    assert sorted(fixed_times(ast.parse(code))) == [1, 2, 3, 4, 7, 8]


def test_no_test_judges_a_time():
    found = {}
    for path in sorted(TESTS.rglob("*.py")):
        if path.relative_to(TESTS).parts[0] in ELSEWHERE and not path.name.startswith("test_"):
            continue
        lines = fixed_times(ast.parse(path.read_text(encoding="utf-8")))
        if lines:
            found[str(path.relative_to(TESTS))] = lines
    assert found == {}
