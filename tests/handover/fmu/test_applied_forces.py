"""Applied forces of a car as inputs of its FMU, against the reduced engine with the same histories."""

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")

from tests.handover.fmu.master import STEP, Instance, drive, plates_of, written
from tests.handover.fmu.test_against_the_engine import engine, loads_without_accelerations, on_road
from tests.validation import validated
from vehicle.commands.fmu import main as fmu_command
from vehicle.engines.linear.load_rows import load_rows
from vehicle.engines.reduced.load_outputs import direct_applied
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration
from vehicle.runs.car.given_forces import with_histories

FORCES = (
    "force.push.on=knuckle_fr",
    "force.push.force=[1,0.5,1]",
    "force.push.mean=60",
    "force.idle.on=engine",
    "force.idle.moment=[0,1,0]",
    "force.idle.against=body",
    "force.idle.harmonics=[[2,40,0]]",
    "force.idle.frequency=12",
    "front.imbalance.mass=0.02",
    "front.imbalance.radius=0.2",
)
JOINT = "tie_inner_fr_force_y"
"""Load of an ideal joint, which takes part of a force on the knuckle at once."""


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """A rolling car with its road, its FMU, and the outputs that both codes have at an instant."""
    car, signal = on_road("sedan", "C", FORCES)
    calm = car.with_({"front.imbalance.mass": 0.0})
    channels = (*calm.vehicle.channels, *loads_without_accelerations(calm), JOINT)
    return calm, signal, channels, written(car, tmp_path_factory.mktemp("fmu"), fmi="3", channels=channels)


def deviation(exported, pushed, seconds: float, length: float = STEP) -> dict[str, float]:
    """Largest deviation of positions, tyre forces and loads of the FMU from the engine, over their peaks."""
    car, signal, channels, fmu = exported
    given = with_histories(car, {name.partition("_")[2]: np.vectorize(force) for name, force in pushed.items()},
                           signal.time)  # fmt: skip
    run, outputs = engine(given, signal, channels), fmu.names("output")
    instance = Instance(fmu, started=False)
    plates = plates_of(signal, seconds + 1e-3 * AHEAD, length)
    found = drive(instance, signal, plates, outputs, round(1e-3 / length), length, pushed)
    instance.close()
    count, worst = found.shape[1] - AHEAD, {"acceleration": 0.0, "load": 0.0}
    for name, values in zip(outputs, found, strict=True):
        point, _, axis = name.rpartition("_displacement_")
        if point:
            kind, wanted = "acceleration", run[f"{point}_acc_{axis}"][:count]
            peak = max(float(np.max(np.abs(run[f"{point}_acc_{letter}"][:count]))) for letter in "xyz")
            values = acceleration(values.copy(), 1e-3)
        elif name in run.channels and name != JOINT and (name in car.vehicle.load_channels or name.startswith("tyre_")):
            kind, wanted, values = "load", run[name][:count], values[:count]
            peak = float(np.max(np.abs(wanted - wanted[0]))) or 1.0
        else:
            continue
        worst[kind] = max(worst[kind], float(np.max(np.abs(values - wanted))) / peak)
    return worst


def test_forces_of_an_fmu_are_those_of_a_run(exported):
    """Forces that are linear in time, as those of the FMU within a step: equal to round-off."""
    pushed = {"force_push": lambda t: 900.0 * t, "torque_idle": lambda t: -300.0 * t}
    assert {"force_push", "torque_idle"} <= set(exported[3].names("input"))
    found = deviation(exported, pushed, 0.4)
    validated(
        "Exported FMUs",
        f"sedan on C, a force and a moment that grow with time: deviation of {', '.join(found)} over the peak",
        [*found.values()],
        0.0,
        source="second derivation: reduced engine at the same step",
        abs=1e-9,  # the integral of the force of the engine goes through the whole block, with its round-off
    )


def test_a_force_is_linear_within_a_step(exported):
    """The mean of a sine over a step h is (w h)^2/12 low: 5 times the step, 25 times the deviation."""
    pushed = {"force_push": lambda t: 400.0 * np.sin(2.0 * np.pi * 25.0 * t), "torque_idle": lambda t: 0.0}
    fine, coarse = (deviation(exported, pushed, 0.3, length)["load"] for length in (STEP, 1e-3))
    validated(
        "Exported FMUs", "force of 25 Hz: deviation of the loads at communication steps of 1 ms over those at 0.2 ms",
        coarse / fine, 25.0, source="closed form: the mean of a sine over a step is (w h)^2/12 low", rel=0.2,
    )  # fmt: skip
    assert coarse < 2.0 * (2.0 * np.pi * 25.0 * 1e-3) ** 2 / 12.0


def test_accelerations_and_ideal_joints_have_their_part_of_a_force_at_once(exported, tmp_path):
    """At a jump: M^-1 l F of the linear car at high frequencies, and the rows of loads over the forces."""
    no_friction = {f"{axle}.damper.coulomb_friction": 0.0 for axle in ("front", "rear")}  # which takes a part too
    car, step, names = exported[0].with_(no_friction), 2e-5, ["knuckle_fr_acc_z", JOINT]
    instance = Instance(written(car, tmp_path, channels=names, step=step))
    histories = []
    for force in (0.0, 500.0, 500.0, 0.0):
        instance.set({"force_push": force})
        instance.step(step)
        histories.append(instance.get(names))
    instance.close()
    (_, before, after) = np.array(histories)[1:]
    forces = list(car.vehicle.composition.forces)
    index = next(k for k, force in enumerate(forces) if force.name == "push")
    matrices = car.matrices.with_unit_forces([index])
    (joint,) = direct_applied(pole_model(matrices), load_rows(car.model, matrices).only([JOINT]))
    at_once = [car.force_frf(names[:1], [1e6], force="push", damper="sliding")[0, 0].real, joint[0]]
    # The rest of the change is that of springs and dampers in 20 us.
    assert before - after == pytest.approx(500.0 * np.array(at_once), rel=0.02)


def test_a_force_beyond_all_forces_is_refused_and_the_command_names_the_inputs(exported, tmp_path, capsys):
    instance = Instance(exported[3])
    with pytest.raises(Exception, match="fmi3SetFloat64 failed"):
        instance.set({"force_push": 1e7})
    assert any("force_push: found 1e+07, must be -1e+06 to 1e+06 N or N m" in text for text in instance.messages)
    instance.close()
    words = [word for text in FORCES for word in ("--set", text)]
    assert fmu_command(["sedan", *words, "--speed", "80", "--output", str(tmp_path / "car.fmu")]) == 0
    printed = capsys.readouterr().out
    assert "note: torque_idle: is an input; the FMU keeps its mean value only, without harmonics and files" in printed
    assert "note: imbalance_fr_x, imbalance_fr_z, imbalance_fl_x, imbalance_fl_z: left out of the FMU" in printed
