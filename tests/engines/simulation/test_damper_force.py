"""Total force of the dampers in MuJoCo's data: the sensors hold what the channels of a run hold."""

import mujoco
import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.engines.simulation import callbacks, stepping
from vehicle.engines.simulation.damper_force import fill_sensors
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.run_model import run_model
from vehicle.runs.car import Car

LAWS = {
    "focus": [],  # Coulomb friction, linear
    "sedan": ["*.damper.gas_force=200"],  # a table in front: friction rows of its steeper segments
    "focus_road": ["*.damper.friction_law=presliding", "*.damper.presliding_stiffness=2e5"],  # Jenkins elements
}


@pytest.mark.parametrize(("name", "laws"), LAWS.items())
def test_the_sensors_are_the_channels_of_a_run(name, laws, monkeypatch):
    """A run with its sensors switched on: after each step they are the sample of their channel, bit for bit."""
    car = Car.load(name, ["solver.timestep=0.0005", "solver.record_rate=2000", *laws])
    signal = random_road(rms=4e-3, seed=2, wheel=car.vehicle.wheels[0], duration=0.3, taper_length=0.05)
    dampers = [damper.name for damper in car.vehicle.composition.dampers]
    model, sensed, viscous = car.stepped().model, [], []

    def model_with_sensors(model_of_car):
        model, space = run_model(model_of_car)
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
        return model, space

    def watched(rows, data, stage):
        fill_sensors(rows, data, stage)
        if stage == mujoco.mjtStage.mjSTAGE_ACC:
            sensed.append([data.sensor(f"{damper}_force").data[0] for damper in dampers])
            viscous.append(data.actuator_force.copy())

    monkeypatch.setattr(callbacks, "fill_sensors", watched)
    monkeypatch.setattr(stepping, "run_model", model_with_sensors)
    run = stepping.simulate(model, signal)
    channels = np.array([run[f"{damper}_force"] for damper in dampers]).T
    np.testing.assert_array_equal(np.array(sensed)[: len(channels)], channels)
    assert np.ptp(channels, axis=0).max() > 100.0
    # The actuator alone lacks the friction.
    friction = np.abs(channels + np.array(viscous)[: len(channels)]).max(axis=0)
    assert friction.max() > 0.9 * car.vehicle.damper.coulomb_friction


def test_a_model_without_its_rows_has_no_force(car):
    """A row that is switched off makes the forces undefined, not wrong; without the callbacks they are zero."""
    model = car.model.spec.compile()
    rows, data = Rows(model, car.model.static.preload), mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    sensors = [data.sensor(f"{name}_force").data for name in rows.laws.dampers]
    assert not np.any(sensors)
    rows_in_place = data.nefc
    data.eq_active[0] = 0
    mujoco.mj_fwdPosition(model, data)
    assert data.nefc < rows_in_place
    fill_sensors(rows, data, mujoco.mjtStage.mjSTAGE_ACC)
    assert np.isnan(sensors).all()
