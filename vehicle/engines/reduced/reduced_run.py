"""Run of a single car with the reduced engine, which gives the same recording as MuJoCo in much shorter time."""

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from vehicle.engines.linear.load_rows import LoadRows, stop_rows
from vehicle.engines.reduced.group_run import GroupRun, parts_of, time_steps
from vehicle.engines.reduced.load_outputs import direct_applied, direct_forces, direct_laws, slope_loads
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.quadratic_forms import QuadraticForms
from vehicle.engines.reduced.second_order import rms_errors_of
from vehicle.engines.reduced.stated_errors import messages, misses_main
from vehicle.engines.reduced.step_factors import car_factors
from vehicle.engines.reduced.table_layout import DOUBLE
from vehicle.engines.reduced.validity import LARGEST_STATED_ANGLE
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.tyre_contact import lift_off_notices, pulling_tyres
from vehicle.engines.simulation.tyre_variation import with_run_out
from vehicle.mapped_table import release, table_of
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import channel_units, wheel_channels
from vehicle.signals.excitation.signal import Signal, uniform_time

LONGEST_STEP = 2e-4
"""Maximum time step [s]. Linear parts are exact at any step, and a stuck damper has third order, so the step only
limits the accuracy of the instants of sticking and slipping. Against 1/64 ms the worst channel of the shipped cars on
both shipped levels has an RMS error of 0.07 to 0.24 %, and the median channel of at most 0.02 %."""


def simulate_reduced(
    model: PoleModel,
    signal: Signal,
    *,
    dampers: Sequence[Damper],
    record_rate: float,
    tyre_load: Mapping[str, float],
    channels: Sequence[str] | None = None,
    loads: LoadRows | None = None,
    present_load: bool = True,
    step: float | None = None,
    forms: QuadraticForms | None = None,
    seated: bool = False,
) -> Recording:
    """Simulate a car on its plates in double precision; the recording has neither poses nor an energy balance.

    Args:
        model: pole model of the car.
        signal: displacement of the plates.
        dampers: laws of the dampers; the model already contains their viscous parts.
        record_rate: rate of the samples [Hz].
        tyre_load: static tyre loads [N] by wheel.
        channels: names of the recorded channels; all except the loads by default.
        loads: rows of the load channels; needed if `channels` contains load channels.
        present_load: slope forces of rolling tyres by their current load; if False, by their static load and z'.
        step: maximum time step [s]; `LONGEST_STEP` by default.
        forms: second order of the equations of the car, for the errors of its channels; without it they stay unknown.
        seated: True for a car with a seat, on whose cushion comfort is read too.
    """
    inputs, road = model.matrices.system.inputs, signal
    signal = with_run_out(road, model.matrices.run_out)
    wheeled = wheel_channels(inputs, model.matrices.damper_names)
    asked = (*model.matrices.system.outputs, *wheeled) if channels is None else tuple(channels)
    # The force of a damper is that of its law and that of its stop.
    stops = stop_rows(model.matrices, dampers)
    stops = stops.only([name.replace("_force", "_stop_force") for name in asked])
    names = (*asked, *(name for name in stops.names if name not in asked))
    samples, every = time_steps(signal, record_rate, step or LONGEST_STEP)
    interval, rolling = 1.0 / record_rate, present_load and model.slope.shape[1] > 0
    loads = loads and loads.only(asked)
    if len(names) > len(asked):
        added = stops.only(names[len(asked) :])
        loads = loads + added if loads else added
    # The force of a load at an instant contains the mean forces of the dampers in both adjacent steps.
    forces = [f"friction_{index}" for index in range(len(dampers))] if loads else []
    forces += [f"law_{index}" for index in range(len(model.laws))] if loads else []
    tyres = {f"tyre_{wheel}_force_z": wheel for wheel in signal.wheels} if loads and rolling else {}
    present = {*names, *forces, *tyres}
    wanted = (*wheeled, *(f"law_{index}" for index in range(len(model.laws)))) if forms else ()
    more = [name for name in wanted if name not in present and not name.startswith("plate_")]
    table = table_of((len(names) + len(forces) + len(tyres) + len(more), 1, samples))
    columns = [inputs.index(wheel) for wheel in signal.wheels]
    factors = car_factors([model], interval / every, columns, exact=True, present_load=rolling)
    started = clock.perf_counter()
    group = GroupRun(
        [model], factors, [dampers], [tyre_load], signal, interval, every, DOUBLE, present_load=rolling, loads=loads
    )
    (validity,) = group.fill(table, [0], [*names, *forces, *tyres, *more])
    time, rows = uniform_time(samples=samples, timestep=interval), [*names, *forces, *tyres, *more]
    record = dict(zip(rows, table[:, 0], strict=True))
    errors, read = dict[str, float](), frozenset[str]()
    # A law that returned no number has spoilt all samples from then on; the run is rejected where it is recorded.
    if forms and np.isfinite(table[:, 0, -1]).all():
        errors, read = rms_errors_of(model, forms, dampers, signal, time, record, asked, tyre_load, seated)
    direct = np.hstack([direct_forces(model, loads), direct_laws(model, loads)]) if loads else np.zeros((0, 0))
    for part in parts_of(samples):
        block = table[:, 0, part]
        of_forces, of_tyres = block[len(names) :][: len(forces)], block[len(names) + len(forces) :][: len(tyres)]
        for load, row in zip(loads.names, direct, strict=True) if loads else ():
            # The direct effect of the forces on u'' at the same instant, in addition to the part of the poles.
            for force, history in zip(row, of_forces, strict=True):
                block[names.index(load)] += force * history
        if loads and len(model.matrices.lines):
            applied = direct_applied(model, loads) @ model.matrices.lines.values(time[part]).T
            for load, history in zip(loads.names, applied, strict=True):
                block[names.index(load)] += history
        if loads and tyres:
            tyre_forces = dict(zip(tyres.values(), of_tyres, strict=True))
            on_slopes = slope_loads(model, loads, signal, time[part], tyre_forces, tyre_load)
            for load, history in zip(loads.names, on_slopes, strict=True):
                block[names.index(load)] += history
        for stop in stops.names:
            block[names.index(stop.replace("_stop_force", "_force"))] += block[names.index(stop)]
        release(table)
    histories = dict(zip(asked, table[: len(asked), 0], strict=True))
    one_sided = [wheel for wheel in inputs if wheel in model.matrices.one_sided]
    tyre_forces = {
        wheel: record.get(f"tyre_{wheel}_force_z", np.zeros(0)) for wheel in inputs if wheel not in one_sided
    }
    pulled, pulls = tuple[str, ...](), tuple[str, ...]()
    if all(history.size for history in tyre_forces.values()):
        # With the tyre forces at every sample, pulling is judged by them and not by the checks every 16 samples.
        validity = replace(validity, loads={})
        pulled, pulls = pulling_tyres(tyre_forces, record_rate)
    if errors:
        validity = replace(validity, limit=LARGEST_STATED_ANGLE)
    statistics = group.statistics(validity, samples, clock.perf_counter() - started)
    warnings, notices = messages(errors, read)
    notices = (*pulls, *lift_off_notices(histories, one_sided, tyre_load, record_rate), *notices)
    statistics = replace(
        statistics,
        warnings=(*statistics.warnings, *pulled, *warnings),
        within_validity=statistics.within_validity and not misses_main(errors),
    )
    return Recording(
        time=time,
        channels=histories,
        units=channel_units(asked),
        excited=tuple(wheel for wheel in road.wheels if np.ptp(road.displacement[wheel]) > 0.0),
        pose_time=np.zeros(0),
        poses=np.zeros((0, 0)),
        statistics=replace(statistics, notices=notices, errors=errors),
    )
