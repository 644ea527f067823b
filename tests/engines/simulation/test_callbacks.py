"""MuJoCo's callbacks are global: never left behind, never shared, never called for another model."""

import mujoco
import pytest

from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec
from vehicle.engines.simulation.callbacks import installed
from vehicle.errors import SimulationError


def small():
    spec = empty_spec(1e-3)
    body = add_free_body(spec, "mass", 1.0, [1.0] * 3)
    add_bushing(spec, "x", body, spec.worldbody, element_law([1e4] * 3))
    return Stepper(spec)


def callbacks():
    return mujoco.get_mjcb_control(), mujoco.get_mjcb_act_gain(), mujoco.get_mjcb_act_bias()


def test_removed_after_the_block_and_after_an_exception():
    run = small()
    with installed(run.rows):
        assert all(callback is not None for callback in callbacks())
    assert callbacks() == (None, None, None)
    with pytest.raises(RuntimeError, match="from inside"), installed(run.rows):
        raise RuntimeError("from inside")
    assert callbacks() == (None, None, None)


def test_a_second_simulation_is_refused_and_the_first_goes_on():
    first, second = small(), small()
    with installed(first.rows):
        before = callbacks()
        with pytest.raises(SimulationError) as caught, installed(second.rows):
            pass
        assert callbacks() == before
    assert str(caught.value) == (
        "mjcb_control is taken by another simulation in this process; finish it first, or use "
        "a process for each simulation"
    )
    assert callbacks() == (None, None, None)


def test_an_exception_in_a_law_reaches_the_caller(monkeypatch):
    run = small()

    def broken(*_):
        raise ArithmeticError("a law broke")

    monkeypatch.setattr(type(run.rows), "__call__", broken)
    with pytest.raises(ArithmeticError, match="a law broke"):
        run.step(1, run.position)
    assert callbacks() == (None, None, None)


def test_item_37_no_log_in_the_users_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = small()
    before = mujoco.MjLogConfig.get()
    state = before.logto_console, before.logto_file
    run.data.qvel[0] = 1e12  # MuJoCo warns of a bad velocity
    run.step(3, run.position)
    assert sum(run.data.warning[k].number for k in range(int(mujoco.mjtWarning.mjNWARNING))) > 0
    assert list(tmp_path.iterdir()) == []
    after = mujoco.MjLogConfig.get()
    assert (after.logto_console, after.logto_file) == state
