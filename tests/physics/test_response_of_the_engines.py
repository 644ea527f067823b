"""Responses of both engines with default settings to a periodic plate motion, compared with the matrices."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.signals.analysis.periodic_record import whole_record_responses
from vehicle.signals.excitation.signal import Signal

PERIOD, PERIODS, RATE = 4.0, 4, 4000.0


def periodic_motion():
    """Lines from 1 to 100 Hz, faded in over a second; small enough to be linear."""
    count = round(PERIOD * RATE)
    lines = np.arange(4, 401)
    spectrum = np.zeros(count // 2 + 1, dtype=complex)
    spectrum[lines] = np.exp(2j * np.pi * np.random.default_rng(1).random(lines.size)) / np.maximum(
        lines / PERIOD, 10.0
    )
    wave = np.fft.irfft(spectrum)
    time = np.arange(PERIODS * count + 1) / RATE
    fade = np.clip(time, 0.0, 1.0)
    motion = np.resize(1e-5 * wave / np.std(wave), time.size) * fade**3 * (10.0 - 15.0 * fade + 6.0 * fade**2)
    return Signal(time=time, displacement={"fr": motion})


# In MuJoCo the centred damping of tyres and dampers is left, second order: 0.1 to 0.2 %. With the central difference as
# velocity of the plate in the tyre rows the knuckle would be 0.8 % (stuck) and 1.0 % (sliding) off. The reduced engine
# is exact while it slides (0.004 %; the filter of its accelerations is 0.014 % low at 100 Hz); the force of a stuck
# damper is constant over a step of 0.125 ms: 0.09 to 0.18 %.
FRICTION = {"stuck": 1e4, "sliding": 0.0}
LIMITS = {
    ("mujoco", "stuck"): 1.5e-3,
    ("mujoco", "sliding"): 2.5e-3,
    ("reduced", "stuck"): 2e-3,
    ("reduced", "sliding"): 1e-4,
}


@pytest.mark.parametrize(("engine", "damper"), LIMITS)
def test_response_up_to_100_hz(engine, damper):
    limit = LIMITS[engine, damper]
    car = Car.load(None, [f"damper.coulomb_friction={FRICTION[damper]}"])
    channels = ["knuckle_fr_acc_z", "seat_rail_acc_z", "engine_acc_z", "suspension_mount_fr_acc_z", "body_front_acc_z"]
    run = car.run(periodic_motion(), engine=engine, channels=[*channels, "plate_fr_displacement"])
    responses = np.array([run[name][:-1] for name in channels])
    plate = run["plate_fr_displacement"][None, :-1]
    (frf,) = whole_record_responses(1e-3, plate, responses, band=(1.0, 100.0))
    frequency, measured = frf.frequency, frf.response
    exact = car.matrix_frf(channels, frequency, damper=damper, wheel="fr")
    error = np.sqrt(np.sum(np.abs(measured - exact) ** 2, axis=1) / np.sum(np.abs(exact) ** 2, axis=1))
    assert frequency[-1] > 99.0
    for channel, value in zip(channels, error, strict=True):
        validated(
            "Integration in MuJoCo" if engine == "mujoco" else "Reduced engine",
            f"FRF of {channel} from a run, 1 to 100 Hz, damper {damper}, error", value, 0.0, abs=limit,
            source="second derivation: FRF from M, C, K of the linear system",
        )  # fmt: skip
