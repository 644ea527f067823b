"""Laws with more numbers than those of today: along three axes, and of a damper."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from tests.engines.simulation.python_form import difference
from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec
from tests.patience import HANG
from vehicle.engines.simulation.callbacks import compiled_rows

ROOT = Path(__file__).resolve().parents[3]

FURTHER = np.arange(26.0) + 0.5


def stepper(further: np.ndarray) -> Stepper:
    """Return two masses on bushings, the second of which has further numbers in its law."""
    spec = empty_spec(1e-3)
    spec.nuserdata = 2
    for name, more in (("a", np.zeros(0)), ("b", further)):
        body = add_free_body(spec, f"mass_{name}", 1.0, [1.0] * 3)
        law = element_law([1e4] * 3, [10.0] * 3, [2e3] * 3, [0.01] * 3)
        add_bushing(spec, name, body, spec.worldbody, np.concatenate([law, more]))
    run = Stepper(spec)
    run.data.qpos[[0, 7]] = 1e-3
    return run


def test_a_law_along_three_axes_with_40_numbers_gives_the_same_forces() -> None:
    short, long = stepper(np.zeros(0)), stepper(FURTHER)
    assert short.rows.layout.bushings.further.shape == (2, 0)
    np.testing.assert_array_equal(long.rows.layout.bushings.further, [np.zeros(26), FURTHER])
    expected = short.step(50, short.position)
    np.testing.assert_array_equal(long.step(50, long.position), expected)
    assert not np.array_equal(expected[0], expected[-1])
    long.rows.reset()
    assert difference(long.rows, compiled_rows(long.rows)) == ""


NUMBERS = [f"n{index}" for index in range(40)]

LAW = f"""
from dataclasses import dataclass
from typing import Any
from vehicle.compiler import jitable
from vehicle.model.laws.friction import Friction
from vehicle.model.laws.law import Numbers


@dataclass(frozen=True, kw_only=True, slots=True)
class Wave(Friction):
    {"; ".join(f"{name}: Numbers" for name in NUMBERS)}

    @staticmethod
    @jitable
    def limit_at(velocity: Any, numbers: Any) -> Any:
        return numbers["friction_limit"] + {" + ".join(f'numbers["{name}"]' for name in NUMBERS)}

    @staticmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        return 0.0
"""

CHECK = """
import mujoco, numpy as np
from vehicle.runs.car import Car
from vehicle.compiler import numba_module
from vehicle.engines.simulation.element_records import Dampers
from vehicle.engines.simulation.record_pointers import at, packed
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.callbacks import installed
from vehicle.model.laws.damper import friction_limit
car = Car.load(overrides=['damper.friction_law="wave"', "damper.coulomb_friction=100.0"])
rows = Rows(car.model.model, car.model.static.preload)
dampers, data = rows.layout.dampers, mujoco.MjData(rows.model)
assert [dampers.laws[f"n{index}"][0] for index in range(40)] == list(range(40))
with installed(rows):
    mujoco.mj_forward(rows.model, data)
assert set(data.efc_frictionloss[dampers.frictions]) == {880.0}
memory, dampers_at = packed(dampers), at(Dampers)
compiled = numba_module().njit(lambda address: friction_limit(dampers_at(address).laws[0], 0.1))
assert compiled(memory.ctypes.data) == 880.0
"""


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1, path
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_a_friction_law_with_40_numbers_of_its_own(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "vehicle", tmp_path / "vehicle", ignore=shutil.ignore_patterns("__pycache__"))
    laws = tmp_path / "vehicle" / "model" / "laws"
    (laws / "wave.py").write_text(LAW, encoding="utf-8")
    edit(
        tmp_path / "vehicle/model/parameters/force_elements.py",
        '("coulomb", "stribeck", "presliding")',
        '("coulomb", "stribeck", "presliding", "wave")',
    )
    names = ", ".join(f'"{name}"' for name in NUMBERS)
    last = '            "side_force",  # growth of the limit with the side force [-]\n'
    edit(laws / "damper.py", last, f"{last}            {names},\n")
    last = "            damper.side_force_coefficient,\n"
    edit(laws / "damper.py", last, f"{last}            *range(40),\n")
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run(
        [sys.executable, "-c", CHECK], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=HANG
    )
    assert done.returncode == 0, done.stderr
