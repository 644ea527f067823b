"""`from vehicle import ...`: every public name exists, is imported at its first use alone, and says what it is."""

import ast
import inspect
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import vehicle
from tests.patience import HANG
from vehicle.commands import OLDER

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "vehicle" / "__init__.py"


def names_for_type_checkers() -> dict[str, str]:
    """Name to module of the block that type checkers alone read."""
    tree = ast.parse(SOURCE.read_text(encoding="utf-8"))
    (block,) = [node for node in tree.body if isinstance(node, ast.If)]
    assert ast.unparse(block.test) == "TYPE_CHECKING"
    found = {}
    for node in block.body:
        assert isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names:
            assert alias.asname == alias.name, "only `import x as x` is exported to a strict type checker"
            found[alias.name] = node.module
    return found


def test_the_table_and_the_block_for_type_checkers_are_equal() -> None:
    assert names_for_type_checkers() == vehicle._MODULES
    assert list(vehicle._MODULES) == sorted(vehicle._MODULES) and 30 <= len(vehicle._MODULES) <= 58


@pytest.mark.parametrize("name", vehicle.__all__)
def test_a_name_is_where_the_table_says_and_explains_itself(name: str) -> None:
    value = getattr(vehicle, name)
    module = import_module(vehicle._MODULES[name])
    assert value is getattr(module, name) and value.__module__ == module.__name__
    first = (inspect.getdoc(value) or "").splitlines()[0]
    assert 15 < len(first) <= 110 and first.endswith("."), first
    if inspect.isfunction(value):
        text = inspect.getdoc(value) or ""
        assert len(inspect.signature(value).parameters) < 2 or "Args:" in text
        assert "Returns:" in text or "Yields:" in text or first.startswith(("Return", "Write"))


def test_no_function_is_named_as_a_module() -> None:
    """Importing a module `vehicle.X` replaces the attribute X of the package."""
    modules = {path.stem for path in (ROOT / "vehicle").iterdir() if path.suffix == ".py" or path.is_dir()}
    assert {*OLDER, "errors", "studies"} <= modules
    assert not modules & set(vehicle.__all__)


def test_the_package_is_imported_without_any_of_its_modules() -> None:
    code = (
        "import sys; before = set(sys.modules); import vehicle\n"
        "print(sorted(name for name in set(sys.modules) - before if name.startswith('vehicle.')), len(dir(vehicle)))\n"
        "vehicle.DataError; print(sorted(name for name in sys.modules if name.startswith('vehicle.')))\n"
        "import vehicle.shaker, vehicle.modes, vehicle.comfort; print(callable(vehicle.sweep))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        f"['vehicle.handed_down'] {len(vehicle.__all__)}",
        "['vehicle.errors', 'vehicle.handed_down', 'vehicle.wording']",
        "True",
    ]


def test_a_wrong_name_lists_the_right_ones() -> None:
    with pytest.raises(AttributeError, match="'Kar'; did you mean Car"):
        vehicle.Kar  # noqa: B018
    with pytest.raises(AttributeError, match="'xyz'; choose from Car, "):
        vehicle.xyz  # noqa: B018
