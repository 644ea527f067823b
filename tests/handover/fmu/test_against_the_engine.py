"""An FMU against the reduced engine: the same car at the same step on the same plates."""

import dataclasses
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")

from tests.handover.fmu.master import STEP, Fmu, Instance, drive, plates_of, written
from tests.validation import validated
from vehicle.engines.reduced.load_outputs import direct_forces, direct_slopes
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration
from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.force_elements import FRICTION_LAWS, NUMBERS, Damper
from vehicle.model.parameters.semi_active_damper import LAWS
from vehicle.runs.car import Car, Road
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal

SECONDS = 1.3
EVERY = round(1e-3 / STEP)

STRIBECK: dict[str, Any] = {"friction_law": "stribeck", "coulomb_friction": 60, "stribeck_friction": 95}
STRIBECK |= {"stribeck_velocity": 0.05, "stribeck_exponent": 1.5}


def on_road(name: str, level: str, overrides: tuple[str, ...] = ()) -> tuple[Car, Signal]:
    """Return a car on a road or an obstacle with rolling tyres, and the road under its wheels."""
    car = Car.load(name, overrides)
    ride = Road(level, speed=80, duration=SECONDS + 0.1).under(car.vehicle, car.overrides)
    return car.with_(ride.overrides), ride.signal()


def on_plates(level: str, overrides: tuple[str, ...] = ()) -> tuple[Car, Signal]:
    """Return the car of Bommer 2006 and a piece of a shipped input."""
    whole = read_signal(find_input(f"{level}.csv"), wheel="fl")
    samples = round((SECONDS + 0.1) / (whole.time[1] - whole.time[0])) + 1
    piece = {wheel: z[:samples] for wheel, z in whole.displacement.items()}
    return Car.load("focus", overrides), replace(whole, time=whole.time[:samples], displacement=piece)


def engine(car: Car, signal: Signal, channels: tuple[str, ...]) -> Recording:
    """Return the run of the reduced engine at the step of the FMU."""
    return simulate_reduced(
        car.poles,
        signal,
        dampers=[damper.law for damper in car.vehicle.composition.dampers],
        record_rate=1000.0,
        tyre_load=car.static.tyre_load,
        channels=channels,
        loads=car.load_rows,
        step=STEP,
    )


def deviations(fmu: Fmu, car: Car, signal: Signal, channels: tuple[str, ...]) -> dict[str, float]:
    """Return the largest deviation of each quantity of the FMU from the engine, over its peak.

    Accelerations of the engine are filtered differences of displacements, so displacements of the FMU are compared,
    with the same filter. A direction of a point is compared with the peak of the point: its round-off is that of the
    motion of the whole car.
    """
    run, outputs = engine(car, signal, channels), fmu.names("output")
    instance = Instance(fmu, started=False)
    found = drive(instance, signal, plates_of(signal, SECONDS + 1e-3 * AHEAD), outputs, EVERY)
    instance.close()
    count = found.shape[1] - AHEAD
    worst: dict[str, float] = {}
    for name, values in zip(outputs, found, strict=True):
        point, _, axis = name.rpartition("_displacement_")
        if point:
            kind, wanted = "acceleration", run[f"{point}_acc_{axis}"][:count]
            peak = max(float(np.max(np.abs(run[f"{point}_acc_{letter}"][:count]))) for letter in "xyz")
            values = acceleration(values.copy(), 1e-3)
        elif name in car.vehicle.load_channels or name.endswith(("_force_z", "_velocity")):
            kind = "load" if name in car.vehicle.load_channels else {"t": "tyre", "d": "damper"}[name[0]]
            if name not in run.channels:
                continue
            wanted, values = run[name][:count], values[:count]
            peak = float(np.max(np.abs(wanted - wanted[0]))) or 1.0
        elif name.startswith("damper_") and name.endswith("_force"):
            kind, wanted, values = "instantaneous damper force", run[name][:count], values[:count]
            peak = float(np.max(np.abs(wanted)))
        else:
            continue
        worst[kind] = max(worst.get(kind, 0.0), float(np.max(np.abs(values - wanted))) / peak)
    return worst


def agree(case: str, found: dict[str, float]) -> None:
    """Check the largest deviation of each quantity over its peak."""
    validated(
        "Exported FMUs", f"{case}: deviation of {', '.join(sorted(found))} over the peak",
        np.array([found[quantity] for quantity in sorted(found)]), 0.0, abs=1e-10,
        source="second derivation: reduced engine at the same step",
    )  # fmt: skip


def loads_without_accelerations(car: Car) -> list[str]:
    """Return the loads that damper forces and slopes do not enter directly: those of an instant in both codes."""
    rows, model = car.load_rows, car.poles
    direct = np.hstack([direct_forces(model, rows), direct_slopes(model, rows)])
    return [name for name, row in zip(rows.names, direct, strict=True) if not np.any(row)]


@pytest.mark.parametrize(
    ("case", "fmi"),
    [
        ("focus low", "2"),
        ("focus high", "3"),
        ("focus_road A", "3"),
        ("sedan C", "2"),
        ("focus_road cleat:20x50@25", "2"),
    ],
)
def test_the_fmu_gives_the_motion_of_the_engine(case, fmi, tmp_path):
    name, level = case.split()
    car, signal = on_plates(level) if name == "focus" else on_road(name, level)
    channels = (*car.vehicle.channels, *loads_without_accelerations(car))
    fmu = written(car, tmp_path, fmi=fmi, channels=channels)
    found = deviations(fmu, car, signal, channels)
    force = found.pop("instantaneous damper force")
    assert set(found) == {"acceleration", "tyre", "damper", "load"}
    agree(f"{name} on {level}, FMI {fmi}.0", found)
    # The force at an instant is not the mean over both adjacent steps, which the engine records.
    assert 1e-9 < force < 0.1


def test_an_fmu_starts_at_rest_over_plates_at_a_level(tmp_path):
    """The engine and the FMU start on plates as the record begins, all 1 mm above the design position."""
    car, signal = on_road("focus_road", "A")
    lifted = {wheel: z + 0.001 for wheel, z in signal.displacement.items()}
    found = deviations(written(car, tmp_path), car, replace(signal, displacement=lifted), car.vehicle.channels)
    found.pop("instantaneous damper force")
    agree("focus_road on A, plates lifted by 1 mm", found)


def test_an_acceleration_is_the_second_derivative_of_its_displacement(tmp_path):
    """At the instant and not filtered; no friction, whose force jumps, on a plate that begins smoothly."""
    car = Car.load("focus", ("damper.coulomb_friction=0",))
    instance, rate = Instance(written(car, tmp_path)), 2.0 * np.pi * 8.0
    outputs = [name for name in instance.fmu.names("output") if "_displacement_" in name or "_acc_" in name]
    rows = []
    for k in range(1, 2500):
        time = k * STEP
        rise, slope = (1.0 - np.exp(-((time / 0.1) ** 3))), 3.0 * time**2 / 0.1**3 * np.exp(-((time / 0.1) ** 3))
        height, velocity = np.sin(rate * time), rate * np.cos(rate * time)
        instance.set({"plate_fl_displacement": 2e-3 * rise * height,
                      "plate_fl_velocity": 2e-3 * (rise * velocity + slope * height)})  # fmt: skip
        instance.step(STEP)
        rows.append(instance.get(outputs))
    instance.close()
    found = dict(zip(outputs, np.array(rows).T, strict=True))
    for name in (name for name in outputs if "_acc_" in name):
        point, _, axis = name.rpartition("_acc_")
        second = np.diff(found[f"{point}_displacement_{axis}"], 2) / STEP**2
        # The difference is wrong by (w h)^2 / 12: 1e-3 up to 90 Hz.
        largest = max(np.max(np.abs(found[f"{point}_acc_{letter}"])) for letter in "xyz")
        assert found[name][1:-1] == pytest.approx(second, abs=1e-3 * largest), name


CONTROL: dict[str, float] = {
    "minimum_damping": 500,
    "maximum_damping": 4000,
    "skyhook_damping": 2500,
    "groundhook_damping": 1500,
}
CONTROL |= {"skyhook_share": 0.6, "control_period": 1e-3, "delay": 2e-3, "rate": 1e6}
"""Numbers of a controlled damper, with delay and rate."""

NUMBERS_OF_FRICTION: dict[str, dict[str, Any]] = {"stribeck": STRIBECK, "presliding": {"presliding_stiffness": 1e6}}
"""Numbers of each friction law, beside the limit."""

FOCUS_LAWS: dict[str, dict[str, Any]] = {
    "linear": {},
    "degressive": {"viscous_law": "degressive", "degressive_viscous": 3000, "degressive_velocity": 0.1},
    "table": {"viscous_law": "table", "velocity": [-1, -0.1, 0, 0.2, 1], "force": [-900, -300, 0, 700, 2000]},
}
"""Numbers of each law of the damping."""


def overrides_of(numbers: dict[str, Any]) -> tuple[str, ...]:
    """Return the texts that set numbers of the dampers."""
    quoted = {name: f'"{value}"' if isinstance(value, str) else value for name, value in numbers.items()}
    return tuple(f"front.damper.{name}={value}" for name, value in quoted.items())


def damping_laws() -> tuple[str, ...]:
    """Return the names of all laws of the damping."""
    (entry,) = (entry for entry in dataclasses.fields(Damper) if entry.name == "viscous_law")
    return tuple(entry.metadata["choices"])


LIFTING = {f"{axle}.bushings.tyre.one_sided": True for axle in ("front", "rear")}
RUBBER: dict[str, Any] = {
    "front.bushings.arm_rear.friction_force": [300.0] * 3,
    "front.bushings.arm_rear.friction_stroke": [2e-4] * 3,
}
STOP = {"displacement": [-0.04, -0.02, -0.005, 0.005, 0.02], "force": [-9e3, -2e3, 0.0, 0.0, 3e3]}
MOUNT = {"displacement": [-8e-3, -1e-3, 0.0, 4e-3], "force": [-8e3, -800.0, 0.0, 3200.0]}
LAWS_OF_A_CAR: dict[str, tuple[str, dict[str, Any]]] = {
    "rubber friction": ("focus", RUBBER),
    "stops": ("focus", {"front.damper.stop": STOP}),
    "a table": ("focus", {"front.bushings.suspension_mount.table_z": MOUNT}),
    "tyres that lift off": ("focus", {"front.bushings.tyre.one_sided": True}),
    "side forces": ("focus", {"front.damper.side_force_coefficient": 0.1}),
    "rubber friction and rolling tyres that lift off": ("focus_road", RUBBER | LIFTING),
}
"""Cars and changes for each law over displacement, and friction by the side force."""


@pytest.mark.parametrize(("law", "fmi"), [*zip(LAWS_OF_A_CAR, ["2", "3"] * 3, strict=True)])
def test_each_law_of_a_car(law, fmi, tmp_path):
    name, changes = LAWS_OF_A_CAR[law]
    linear, signal = on_plates("high") if name == "focus" else on_road(name, "D")
    # A strong input: tyres lift off, and dampers reach their stops.
    level = 40.0 if name == "focus" else 1.0
    signal = replace(signal, displacement={wheel: level * z for wheel, z in signal.displacement.items()})
    car = linear.with_(changes)
    channels = (*car.vehicle.channels, *loads_without_accelerations(car))
    found = deviations(written(car, tmp_path, fmi=fmi, channels=channels), car, signal, channels)
    found.pop("instantaneous damper force")
    agree(f"{name} with {law}, FMI {fmi}.0", found)
    with_law, without = (engine(each, signal, ("knuckle_fl_acc_z",))["knuckle_fl_acc_z"] for each in (car, linear))
    assert np.max(np.abs(with_law - without)) > 1e-3 * np.max(np.abs(without))


def checked(law: str, overrides: tuple[str, ...], folder: Path) -> None:
    """Check the FMU of a car with other dampers against the engine."""
    car, signal = on_plates("high", overrides)
    found = deviations(written(car, folder), car, signal, car.vehicle.channels)
    found.pop("instantaneous damper force")
    agree(f"focus on high with {law}", found)


@pytest.mark.parametrize("law", FRICTION_LAWS)
def test_each_friction_law(law, tmp_path):
    of_law = dict.fromkeys(NUMBERS.get(law, ()), 0.5) | NUMBERS_OF_FRICTION.get(law, {})
    checked(f"{law} friction", overrides_of({"friction_law": law} | of_law), tmp_path)


@pytest.mark.parametrize("law", damping_laws())
def test_each_damping_law(law, tmp_path):
    checked(f"{law} damping", overrides_of({**FOCUS_LAWS[law], **STRIBECK}), tmp_path)


@pytest.mark.parametrize("law", LAWS)
def test_each_control_law(law, tmp_path):
    inline = ", ".join(f"{name}={value}" for name, value in CONTROL.items())
    checked(f"control law {law}", (f"front.damper.control={{law='{law}', {inline}}}",), tmp_path)
