"""Simulation of a car on a signal with the engine that is asked for, or that the motion needs."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.stated_errors import error_sentence
from vehicle.engines.simulation.applied_forces import force_histories, force_notices, require_resolved
from vehicle.engines.simulation.judgement import require_finite, require_samples
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.stepping import Progress, simulate
from vehicle.errors import ConfigurationError
from vehicle.names import ENGINES
from vehicle.runs.car.air_notice import air_notice, air_springs
from vehicle.runs.car.grip_notice import grip_notice
from vehicle.runs.car.record_rate_notice import record_rate_notice
from vehicle.runs.car.run_up_notice import run_up_notice
from vehicle.signals.excitation.signal import Signal

NOT_COMPUTED = "errors from the linear geometry of the reduced engine: not computed"
"""Notice on a run without stated errors."""


def simulated_run(
    car: Any,
    signal: Signal,
    progress: Progress | None,
    engine: str,
    channels: Sequence[str] | None,
    *,
    stated: bool = True,
) -> tuple[Any, Recording, str]:
    """Simulate a car on a signal.

    Args:
        progress, engine, channels: as in `Car.run`.
        stated: state the errors of the reduced engine, see `Car.run`.

    Returns:
        The simulated car, with its time step if MuJoCo ran; the recording; the reason for the choice of the engine.

    Raises:
        VehicleError: see `Car.run`.
    """
    if engine not in ENGINES:
        raise ConfigurationError(f"engine: must be one of {', '.join(ENGINES)}, not {engine!r}")
    defaults = car.vehicle.channels
    if isinstance(channels, str):
        raise ConfigurationError(
            f"channels: must be a list of names, not the text {channels!r}; for loads use "
            "[*car.vehicle.channels, *car.vehicle.load_channels]"
        )
    car.vehicle.require_channels(channels or (), (*defaults, *car.vehicle.requested_channels))
    car.vehicle.require_wheels(signal.wheels)
    forces = car.vehicle.composition.forces
    require_resolved(forces, car.vehicle.solver.record_rate)
    names = defaults if channels is None else channels
    # Histories of forces are known: no engine records them.
    units = {} if channels is None else car.vehicle.force_channels
    shown = {name: units[name] for name in names if name in units}
    computed = None if channels is None else [name for name in names if name not in shown]
    more = [name for name in names if name not in defaults and name not in shown]
    air = [name for name in air_springs(car) if stated and name not in names]
    if air:
        # Their forces, for a notice on their travel.
        computed, more = [*(defaults if computed is None else computed), *air], [*more, *air]
    loads = [name for name in more if name in car.vehicle.load_channels]
    require_samples(signal.duration * car.vehicle.solver.record_rate, len(names))
    reason = "asked for"
    if engine != "mujoco":
        car.check("reduced")
        recording = simulate_reduced(
            car.poles,
            signal,
            dampers=[damper.law for damper in car.vehicle.composition.dampers],
            record_rate=car.vehicle.solver.record_rate,
            tyre_load=car.static.tyre_load,
            channels=computed,
            loads=car.load_rows if loads else None,
            forms=car.quadratic_forms if stated else None,
            seated=car.vehicle.seated,
        )
        require_finite(recording)
        recording = _noted(recording, car, names, shown, channels)
        if engine == "reduced" or recording.statistics.within_validity:
            recording = recording if stated else with_notices(recording, [NOT_COMPUTED])
            if engine == "auto":
                reason = "the motion stayed in the range where the reduced engine is valid"
            return car, recording, reason
        reason = "; ".join(recording.statistics.warnings) or error_sentence(recording.statistics.errors)
    stepped = car.stepped()
    wanted_step, used_step = car.vehicle.solver.timestep, stepped.vehicle.solver.step
    recording = simulate(stepped.model, signal, progress=progress, requested=more)
    require_finite(recording)
    recording = _noted(recording, car, names, shown, channels)
    if wanted_step is not None and used_step < wanted_step:
        said = (
            f"the time step is {used_step:g} s, because the {wanted_step:g} s of the vehicle file are too long "
            "for this car"
        )
        recording = with_notices(recording, [said])
    if channels is not None:
        recording = recording.only(channels)
    return stepped, recording, reason


def _noted(
    recording: Recording, car: Any, names: Sequence[str], shown: Mapping[str, str], chosen: Sequence[str] | None
) -> Recording:
    """Return a recording with notices on forces and chosen channels, and the histories of forces, as in `names`."""
    composition = car.vehicle.composition
    notices = [*force_notices(composition.forces), *run_up_notice(car), *grip_notice(car, recording.channels)]
    notices += air_notice(car, recording.channels)
    recording = with_notices(recording, [*notices, *record_rate_notice(recording, chosen or ())])
    if unasked := {*air_springs(car)} - {*names}:
        recording = recording.only([name for name in recording.channels if name not in unasked])
    if not shown:
        return recording
    channels = {**recording.channels, **force_histories(composition, shown, recording.time)}
    units = {**recording.units, **shown}
    order = [*names, *(name for name in channels if name not in names)]
    return replace(
        recording, channels={name: channels[name] for name in order}, units={name: units[name] for name in order}
    )


def with_notices(recording: Recording, notices: Sequence[str]) -> Recording:
    """Return a recording with further notices."""
    statistics = recording.statistics
    return replace(recording, statistics=replace(statistics, notices=(*statistics.notices, *notices)))
