"""A tyre on a moving plate: MuJoCo's mocap bodies have no velocity, the rows must bring it."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec
from tests.validation import validated

MASS, K, B = 35.0, 2.5e5, 400.0


def wheel_on_plate(step):
    spec = empty_spec(step)
    tyre = add_free_body(spec, "tyre_fr", MASS, [1.0] * 3)
    plate = spec.worldbody.add_body(name="plate_fr")
    plate.mocap = True
    add_bushing(spec, "tyre_fr", tyre, plate, element_law([K] * 3, [B] * 3))
    return Stepper(spec)


def transmissibility(frequency, step):
    """Complex ratio of wheel to plate displacement, measured and exact."""
    omega = 2.0 * np.pi * frequency
    exact = (K + 1j * omega * B) / (K + 1j * omega * B - MASS * omega**2)
    run = wheel_on_plate(step)
    # From the exact steady state, so that there is no transient to wait for; MuJoCo's velocity is half a step old.
    run.data.qpos[2] = 1e-3 * exact.real
    run.data.qvel[2] = 1e-3 * np.real(1j * omega * exact * np.exp(-0.5j * omega * step))

    def drive(time):
        run.data.mocap_pos[0, 2] = 1e-3 * np.cos(omega * time)
        run.rows.state.plate_velocity[0, 2] = -1e-3 * omega * np.sin(omega * time)
        run.rows.state.plate_acceleration[0, 2] = -1e-3 * omega**2 * np.cos(omega * time)

    period = round(1.0 / (frequency * step))
    x = run.step(25 * period, run.position, drive)[-5 * period :, 2]
    times = step * (20 * period + np.arange(5 * period))
    return 2.0 * np.mean(x * np.exp(-1j * omega * times)) / 1e-3, exact


@pytest.mark.parametrize("frequency", [5.0, 12.5, 25.0, 40.0])
def test_wheel_on_a_moving_plate(frequency):
    measured, exact = transmissibility(frequency, 1e-3)
    # Fourth order but for the damping: largest near the resonance of 13.5 Hz.
    validated(
        "Tyres", f"transmissibility of a wheel on a moving plate at {frequency:g} Hz", measured, exact, rel=2e-3,
        unit="m/m", source="closed form: (k + i w c) / (k + i w c - m w^2)",
    )  # fmt: skip
