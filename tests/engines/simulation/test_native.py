"""Compiled form of the element laws and of the loop: the results of the Python form, or a clear error."""

from __future__ import annotations

import ctypes
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.engines.simulation.python_form import difference, python_run
from tests.validation import validated
from vehicle.engines.simulation import structures
from vehicle.engines.simulation.callbacks import compiled_rows, installed
from vehicle.engines.simulation.compiled import CompiledRows
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.engines.simulation.stepping import simulate
from vehicle.errors import MissingPartError, SimulationError
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

GROWTH = 2e-8
"""Both forms round differently in the last digit. The ideal ball joints answer a residual of 1e-16 m with accelerations
of 1e-16 m / (4 h)2 = 3e-11 m/s2 a step, some 1e-9 of the RMS; ten times that is allowed for 2000 steps and peaks."""

STRIBECK = ['damper.friction_law="stribeck"', "damper.stribeck_friction=200.0"]


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


@pytest.fixture(scope="module")
def python(car: Car, second: Signal) -> Recording:
    return python_run(car.model, second)


def prepared(car: Car) -> Rows:
    model = car.model.spec.compile()
    prepare_model(model)
    return Rows(model, car.model.static.preload)


def callbacks_in_place() -> list[object]:
    return [mujoco.get_mjcb_control(), mujoco.get_mjcb_act_gain(), mujoco.get_mjcb_act_bias()]


def test_all_channels_agree(compiled: Recording, python: Recording) -> None:
    assert compiled.statistics.notices == python.statistics.notices == ()
    for name, expected in python.channels.items():
        size = np.sqrt(np.mean(expected**2))
        np.testing.assert_allclose(compiled[name], expected, rtol=0.0, atol=GROWTH * size, err_msg=name)


def test_energies_and_poses_agree(compiled: Recording, python: Recording) -> None:
    for name in ("work_in", "dissipated", "stored"):
        found, expected = (getattr(run.statistics.energies, name) for run in (compiled, python))
        # The stored energy is a difference of 1e4 J of weight and preload: 1e-12 of it.
        validated(
            "Integration in MuJoCo", f"compiled element laws, energy {name}", found, expected, rel=1e-9, abs=1e-8,
            unit="J", source="second derivation: Python form of the laws",
        )  # fmt: skip
    np.testing.assert_array_equal(compiled.pose_time, python.pose_time)
    # Metres and radians; round-off of one step is 1e-16.
    np.testing.assert_allclose(compiled.poses, python.poses, rtol=0.0, atol=1e-12)


def test_two_compiled_runs_are_the_same_bit_for_bit(car: Car, second: Signal, compiled: Recording) -> None:
    again = simulate(car.model, second)
    assert again.statistics.callback == "native"
    for name, expected in compiled.channels.items():
        np.testing.assert_array_equal(again[name], expected)
    np.testing.assert_array_equal(again.poses, compiled.poses)


@pytest.mark.parametrize("rate", [2000.0, 500.0])
def test_other_recording_rates(second: Signal, rate: float) -> None:
    car = Car.load(overrides=["solver.timestep=0.0005", f"solver.record_rate={rate}"])
    piece = beginning(second, 301)
    found, expected = (form(car.model, piece) for form in (simulate, python_run))
    for name, values in expected.channels.items():
        size = np.sqrt(np.mean(values**2))
        # Positions of some metres are rounded at 4e-16 m, and differenced twice over an interval.
        rounding = 1e-14 * rate**2 if "_acc_" in name else 0.0
        np.testing.assert_allclose(found[name], values, rtol=0.0, atol=GROWTH * size + rounding, err_msg=name)
    np.testing.assert_array_equal(found.pose_time, expected.pose_time)


def test_without_numba_a_run_names_it(car: Car, second: Signal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "vehicle.engines.simulation.compiled", None)
    with pytest.raises(MissingPartError, match=r"^a run needs numba, which cannot be imported \(.+\); install it: pip"):
        simulate(car.model, second)


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
    assert str(caught.value) == (
        f"MuJoCo {mujoco.__version__} is not as its declarations (mujoco.introspect) say at {named}, so compiled code "
        "would read wrong numbers; install the tested version: pip install -c constraints.txt mujoco"
    )


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
    compiled_rows(prepared(car))
    monkeypatch.setattr(structures, "scalar_offsets", lambda data: pytest.fail("checked again"))
    compiled_rows(prepared(car))


@pytest.mark.parametrize("constant", ["preload", "decay", "gain", "average", "impedance"])
def test_the_oracle_detects_other_constants(car: Car, monkeypatch: pytest.MonkeyPatch, constant: str) -> None:
    rows, right = prepared(car), CompiledRows.attach

    def wrong(self: CompiledRows, data: mujoco.MjData) -> None:
        own = rows.weights
        rows.weights = own._replace(**{constant: getattr(own, constant) * (1.0 + 1e-9)})
        right(self, data)
        rows.weights = own

    assert difference(rows, compiled_rows(rows)) == ""
    monkeypatch.setattr(CompiledRows, "attach", wrong)
    assert difference(rows, compiled_rows(rows)) != ""


def test_stribeck_friction_agrees() -> None:
    rows = prepared(Car.load(overrides=STRIBECK))
    assert set(rows.layout.dampers.laws["friction_law"]) == {1.0}
    assert difference(rows, compiled_rows(rows)) == ""


def test_the_callbacks_leave_other_models_alone(car: Car, python: Recording) -> None:
    rows = prepared(car)
    callback = compiled_rows(rows)
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


def test_an_interrupt_between_chunks_removes_the_callbacks(car: Car, second: Signal) -> None:
    def interrupt(fraction: float) -> None:
        assert None not in callbacks_in_place()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(car.model, second, progress=interrupt)
    assert callbacks_in_place() == [None, None, None]


def test_a_lost_state_stops_both_forms(car: Car, second: Signal) -> None:
    piece = beginning(second, 301)
    displacement = piece.displacement["fr"].copy()
    displacement[200:] += 1e7
    jump = Signal(time=piece.time, displacement={"fr": displacement})
    times = []
    for form in (simulate, python_run):
        with pytest.raises(SimulationError) as caught:
            form(car.model, jump)
        found = re.search(r"^the state is no longer finite at t = (\S+) s \(joint \w+\); the step", str(caught.value))
        assert found, str(caught.value)
        times.append(float(found.group(1)))
        assert callbacks_in_place() == [None, None, None]
    # A state that runs away magnifies round-off at once, so the first sample that overflows may be a neighbour.
    assert times[0] == pytest.approx(times[1], abs=0.003)


def test_other_rows_than_those_compiled_for_lose_the_state(car: Car) -> None:
    # The Python form raises there; compiled code cannot, so it makes the state one that the guard of a run refuses.
    rows = prepared(car)
    callback = compiled_rows(rows)
    data = mujoco.MjData(rows.model)
    callback.attach(data)
    data.eq_active[0] = 0
    with installed(rows, callback):
        mujoco.mj_forward(rows.model, data)
    assert np.all(np.isnan(data.qfrc_applied))
