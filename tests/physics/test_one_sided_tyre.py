"""A tyre that never pulls: max(0, load - k r - c r'), against quadrature with events, and on the car."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.engines.simulation.row_model import Stepper, add_bushing, add_mass, element_law, empty_spec
from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

MASS, STIFFNESS, DAMPING, GRAVITY, HEIGHT = 40.0, 2.0e5, 800.0, 9.81, 0.03
DURATION, EVERY = 0.4, 4e-3


def dropped(step: float, height: float = HEIGHT) -> tuple[np.ndarray, np.ndarray]:
    """Return the height of a bouncing wheel every 4 ms, and the force of its tyre at every step."""
    spec = empty_spec(step)
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    body = add_mass(spec.worldbody, "wheel", MASS)
    body.add_joint(name="z", type=2, axis=[0.0, 0.0, 1.0])
    law = element_law([0.0, 0.0, STIFFNESS], [0.0, 0.0, DAMPING])
    add_bushing(spec, "tyre", body, spec.worldbody.add_body(name="ground"), law)
    spec.add_numeric(name="one_sided/bushing/tyre", data=[1.0])
    run = Stepper(spec)
    run.data.qpos[0] = height
    run.data.qvel[0] = 0.5 * step * GRAVITY  # half a step before it is let go
    row = int(run.rows.layout.bushings.rows[0, 2])

    def read() -> list[float]:
        # The force of the step before.
        return [run.data.qpos[0], run.rows.state.explicit[row] + (run.data.efc_force[row] if run.data.nefc else 0.0)]

    samples = run.step(round(DURATION / step) + 1, read)
    return samples[:: round(EVERY / step), 0], samples[1:, 1]


def bounced(height: float = HEIGHT) -> tuple[np.ndarray, list[float]]:
    """The same by quadrature from one change of contact to the next, and when these are [s]."""

    def pushes(_: float, y: np.ndarray) -> float:
        return float(-STIFFNESS * y[0] - DAMPING * y[1])

    pushes.terminal = True  # type: ignore[attr-defined]
    times, changes, heights = np.arange(0.0, DURATION + 1e-9, EVERY), [0.0], []
    y, contact = np.array([height, 0.0]), 0.0
    while changes[-1] < DURATION:

        def law(_: float, y: np.ndarray, contact: float = contact) -> list[float]:
            return [y[1], contact * pushes(0.0, y) / MASS - GRAVITY]

        pushes.direction = -1.0 if contact else 1.0  # type: ignore[attr-defined]
        part = solve_ivp(law, (changes[-1], DURATION + EVERY), y, events=pushes, dense_output=True, rtol=1e-11,
                         atol=1e-14, max_step=1e-3)  # fmt: skip
        heights += [float(part.sol(t)[0]) for t in times if changes[-1] <= t < part.t[-1]]
        y, contact = part.y[:, -1], 1.0 - contact
        changes.append(float(part.t[-1]))
    return np.array(heights), changes[1:-1]


def test_a_wheel_falls_and_bounces():
    reference, changes = bounced()
    assert len(changes) >= 4 and len(reference) == round(DURATION / EVERY) + 1
    steps, errors = np.array([2e-3, 1e-3, 5e-4, 2.5e-4]), []
    for step in steps:
        height, force = dropped(step)
        errors.append(np.max(np.abs(height - reference)))
        # Where it touches the force is wrong for one step, by what the damper changes in it.
        assert np.min(force) > -1e-6 and 0.3 < np.mean(force < 1e-6) < 0.9
    order, rk45 = np.polyfit(np.log(steps), np.log(errors), 1)[0], foreign("scipy", "RK45 with events of contact")
    validated("Tyres", "order of convergence of a wheel that bounces", order, 2.0, within=(1.5, 2.5), source=rk45)
    validated(
        "Tyres", "height of a bouncing wheel, step 0.25 ms", errors[-1], 0.0, abs=5e-5 * HEIGHT, unit="m", source=rk45,
    )  # fmt: skip


@pytest.fixture(scope="module")
def one_sided() -> Car:
    return Car.load(None, ["tyre.one_sided=true"])


def hump(height: float) -> Signal:
    """Both plates go up and down once in 0.12 s."""
    time = np.arange(0.0, 0.6, 1e-3)
    inside = (time > 0.05) & (time < 0.17)
    z = np.where(inside, 0.5 * height * (1.0 - np.cos(2.0 * np.pi * (time - 0.05) / 0.12)), 0.0)
    return Signal(time=time, displacement={"fr": z, "fl": z})


def test_a_car_leaves_its_plates(one_sided, car):
    signal = hump(0.08)
    glued, run = car.run(signal), one_sided.run(signal, engine="auto")
    assert glued["tyre_fr_force_z"].min() < -500.0 and "would lift off" in glued.recording.statistics.warnings[0]
    # Up to the first lift-off they are one.
    first = int(np.argmax(glued["tyre_fr_force_z"] < 0.0))
    np.testing.assert_array_equal(run["tyre_fr_force_z"][: first - 1], glued["tyre_fr_force_z"][: first - 1])
    load, statistics = run["tyre_fr_force_z"], run.recording.statistics
    assert load.min() > -1e-3 and 0.01 < np.mean(load <= 0.0) < 0.5
    assert statistics.engine == "mujoco" and "rotates by 16.2 deg" in run.engine_reason
    assert statistics.warnings == () and "tyre fr left its plate at t = 0." in statistics.notices[-2]
    assert statistics.energies is not None and statistics.energies.residual < 2e-3
    fast = one_sided.run(signal, engine="reduced").recording.statistics
    assert ["tyre fr left its" in fast.notices[0], "tyre fl left its" in fast.notices[1]] == [True, True]


def test_on_the_ground_nothing_changes(one_sided, car):
    for engine in ("mujoco", "auto"):
        both = [tested.run(hump(2e-3), engine=engine) for tested in (one_sided, car)]
        assert both[0].recording.statistics.engine == both[1].recording.statistics.engine
        for name in ("tyre_fr_force_z", "seat_rail_acc_z"):
            size = np.max(np.abs(both[1][name]))
            # The compiler orders the sums of the reduced engine by their number.
            np.testing.assert_allclose(both[0][name], both[1][name], rtol=0.0, atol=(engine == "auto") * 1e-9 * size)


def test_only_what_stands_on_the_ground_is_one_sided():
    with pytest.raises(ConfigurationError, match=r"front\.bushings\.arm_rear\.one_sided: must be false"):
        load_vehicle(None, ["arm_rear.one_sided=true"])
    table = "tyre.table_z={displacement=[-1, 1], force=[-2e5, 2e5]}"
    with pytest.raises(ConfigurationError, match=r"front\.bushings\.tyre\.one_sided: found true together with table_z"):
        load_vehicle(None, ["tyre.one_sided=true", table])
