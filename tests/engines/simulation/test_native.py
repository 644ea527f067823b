"""Callbacks and stepping loop of the core: right places in MuJoCo, the same results twice, or a clear error."""

import ctypes
import shutil
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import pytest

from vehicle.engines.simulation import structures
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.compiled import CompiledRows
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.engines.simulation.stepping import simulate
from vehicle.errors import MissingPartError, SimulationError
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal


def beginning(signal: Signal, samples: int) -> Signal:
    return Signal(time=signal.time[:samples], displacement={"fr": signal.displacement["fr"][:samples]})


@pytest.fixture(autouse=True)
def checked_anew() -> Iterator[None]:
    """Drop the cached offsets after a test that made them wrong."""
    yield
    structures.offsets.cache_clear()


@pytest.fixture(scope="module")
def second(high_piece: Signal) -> Signal:
    """One second: two chunks and the rest of a third."""
    return beginning(high_piece, 1101)


@pytest.fixture(scope="module")
def compiled(car: Car, second: Signal) -> Recording:
    return simulate(car.model, second)


def prepared(car: Car) -> Rows:
    model = car.model.spec.compile()
    prepare_model(model)
    return Rows(model, car.model.static.preload)


def callbacks_in_place() -> list[object]:
    return [mujoco.get_mjcb_control(), mujoco.get_mjcb_act_gain(), mujoco.get_mjcb_act_bias()]


def test_two_runs_are_the_same_bit_for_bit(car: Car, second: Signal, compiled: Recording) -> None:
    again = simulate(car.model, second)
    assert again.statistics.callback == "native"
    for name, expected in compiled.channels.items():
        np.testing.assert_array_equal(again[name], expected)
    np.testing.assert_array_equal(again.poses, compiled.poses)


def shifted(name: str) -> type[ctypes.Structure]:
    """Return the layout of a structure with all fields shifted by one number."""
    fields = structures.layout(name, "nuserdata" if name == "mjModel" else "")._fields_
    return type(name, (ctypes.Structure,), {"_fields_": [("shift", structures.PLAIN_TYPES["mjtNum"]), *fields]})


@pytest.mark.parametrize(("structure", "named"), [("mjData", "mjData.time"), ("mjModel", "mjModel.nq")])
def test_an_offset_that_does_not_fit_is_an_error(
    car: Car, second: Signal, monkeypatch: pytest.MonkeyPatch, structure: str, named: str
) -> None:
    right, wrong = structures.layout, shifted(structure)
    monkeypatch.setattr(structures, "layout", lambda name, last="": wrong if name == structure else right(name, last))
    structures.offsets.cache_clear()
    with pytest.raises(MissingPartError) as caught:
        simulate(car.model, second)
    assert f"MuJoCo {mujoco.__version__} " in str(caught.value) and f" at {named}, " in str(caught.value)


@pytest.mark.parametrize("name", structures.POINTERS)
def test_a_pointer_that_does_not_fit_is_an_error(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    right = structures.layout("mjData")
    fields = [(f"other_{one}" if one == name else one, kind) for one, kind in right._fields_]  # type: ignore[misc]
    wrong = type("mjData", (ctypes.Structure,), {"_fields_": fields})
    monkeypatch.setattr(structures, "layout", lambda name, last="": wrong)
    data = mujoco.MjData(mujoco.MjModel.from_xml_string(structures.PROBE))
    mujoco.mj_forward(data.model, data)
    with pytest.raises(LookupError, match=f"mjData.{name}$"):
        structures.pointer_offsets(data, structures.POINTERS)


def test_another_copy_of_the_library_is_an_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder = Path(mujoco.__file__).parent
    for path in folder.glob("libmujoco*"):
        shutil.copy(path, tmp_path / path.name)
    monkeypatch.setattr(mujoco, "__file__", str(tmp_path / "__init__.py"))
    with pytest.raises(LookupError, match=r"mjcb_control \(the bindings use another library"):
        structures.step_address()
    assert callbacks_in_place() == [None, None, None]


def test_the_offsets_are_checked_once_in_a_process(car: Car, monkeypatch: pytest.MonkeyPatch) -> None:
    structures.offsets.cache_clear()
    CompiledRows(prepared(car))
    monkeypatch.setattr(structures, "step_address", lambda: pytest.fail("checked again"))
    CompiledRows(prepared(car))


def test_the_callbacks_leave_other_models_alone(car: Car) -> None:
    rows = prepared(car)
    callback = CompiledRows(rows)
    other = car.model.spec.compile()
    plain = mujoco.MjModel.from_xml_string(
        "<mujoco><worldbody><body><joint type='slide'/><geom size='.1'/></body></worldbody></mujoco>"
    )
    results = []
    for form in (None, callback):
        states = []
        data, small = mujoco.MjData(other), mujoco.MjData(plain)
        if form is not None:
            # Even the user data of a simulation do not make its callbacks act on another model.
            callback.attach(data)
            with installed(rows, callback):
                mujoco.mj_step(other, data)
                mujoco.mj_step(plain, small)
        else:
            mujoco.set_mjcb_act_gain(lambda model, data, index: 0.0)
            mujoco.set_mjcb_act_bias(lambda model, data, index: 0.0)
            mujoco.mj_step(other, data)
            mujoco.mj_step(plain, small)
            mujoco.set_mjcb_act_gain(None)
            mujoco.set_mjcb_act_bias(None)
        states += [data.qpos.copy(), data.efc_D.copy(), small.qvel.copy()]
        results.append(states)
        assert not np.any(data.userdata)
    for one, two in zip(*results, strict=True):
        np.testing.assert_array_equal(one, two)


def test_other_rows_than_those_compiled_for_lose_the_state(car: Car) -> None:
    # A callback of the core cannot raise: it makes the state one that the guard of a run refuses.
    rows = prepared(car)
    callback = CompiledRows(rows)
    data = mujoco.MjData(rows.model)
    callback.attach(data)
    data.eq_active[0] = 0
    with installed(rows, callback):
        mujoco.mj_forward(rows.model, data)
    assert np.all(np.isnan(data.qfrc_applied))


def test_a_single_state_with_other_rows_is_refused(car: Car) -> None:
    rows = prepared(car)
    data = mujoco.MjData(rows.model)
    mujoco.mj_forward(rows.model, data)
    rows(rows.model, data)
    data.eq_active[0] = 0
    mujoco.mj_fwdPosition(rows.model, data)
    with pytest.raises(SimulationError, match=r"^the state has 63 constraint rows .*, the car has 66 dense ones"):
        rows(rows.model, data)
