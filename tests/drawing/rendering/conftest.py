from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np
import pytest

from vehicle.drawing.rendering.backend import film_available
from vehicle.drawing.rendering.stage import stage_model
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.recording import Energies, Recording, Statistics
from vehicle.names import channel_units
from vehicle.runs.car import Car

RATE = 1000.0
POSE_STEP = 0.01


@dataclass(frozen=True)
class FakeSignal:
    source: str = "folder/shake.csv"

    def rms(self, wheel: str) -> float:
        return 0.25e-3


@dataclass(frozen=True)
class FakeCar:
    model: CarModel


@dataclass(frozen=True)
class FakeRun:
    """What a plot or a film needs of a run, without a simulation."""

    car: FakeCar
    recording: Recording
    signal: FakeSignal = FakeSignal()
    wheel: str = "fr"


@pytest.fixture(scope="session")
def car() -> CarModel:
    return Car.load().model


@pytest.fixture(scope="session")
def stage(car) -> mujoco.MjModel:
    return stage_model(car, (320, 180))


def fabricated(car: CarModel, duration: float, level: float = 1e-3) -> Recording:
    """Every joint and channel swings at a frequency of its own; the right damper slips in the second half."""
    time = np.arange(round(duration * RATE) + 1) / RATE
    channels = {
        name: level * np.sin(2.0 * np.pi * (3.0 + 0.7 * number) * time)
        for number, name in enumerate(car.vehicle.channels)
    }
    channels["damper_fr_velocity"] = np.where(time >= 0.5 * duration, 0.02, 0.0)
    channels["tyre_fr_force_z"] = 3400.0 + 0.0 * time
    pose_time = POSE_STEP * np.arange(round(duration / POSE_STEP) + 1, dtype=float)
    model = car.model
    poses = np.zeros((len(pose_time), model.nq))
    for row, now in enumerate(pose_time):
        swing = np.cos(np.arange(model.nv)) * np.sin(2.0 * np.pi * 2.0 * now)
        poses[row] = model.qpos0
        mujoco.mj_integratePos(model, poses[row], level * swing, 1.0)
    return Recording(
        time=time,
        channels=channels,
        units=channel_units(car.vehicle.channels),
        excited=("fr",),
        pose_time=pose_time,
        poses=poses,
        statistics=Statistics(
            engine="none",
            callback="none",
            timestep=1.0 / RATE,
            steps=len(time) - 1,
            wall_time=1.0,
            warnings=(),
            energies=Energies(work_in=0.0, dissipated=0.0, stored=0.0),
        ),
    )


@pytest.fixture(scope="session")
def run(car) -> FakeRun:
    return FakeRun(car=FakeCar(model=car), recording=fabricated(car, 0.3))


@pytest.fixture
def film_machine() -> Iterator[None]:
    """Skip where no film can be made at all."""
    reason = film_available()
    if reason is not None:
        pytest.skip(reason)
    yield
