"""Item 52: a run whose energy balance does not close says so, and one that is wrong fails."""

import numpy as np
import pytest

from vehicle.engines.simulation.judgement import judge_energy
from vehicle.engines.simulation.recording import Energies
from vehicle.engines.simulation.stepping import simulate
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.vehicle import load_vehicle


def balance(residual, work=10.0):
    return Energies(work_in=work, dissipated=work * (0.9 - residual), stored=0.1 * work)


def test_limits_of_the_residual():
    assert judge_energy(balance(9e-3), 1000.0, 1e-3) == ()
    (warning,) = judge_energy(balance(2e-2), 1000.0, 1e-3)
    assert warning.startswith("energy balance: 0.2 J of 10 J put in") and "(residual 0.02)" in warning
    # Only a residual that falls with the step is an error of the step: work that is not counted stays.
    assert "--set solver.timestep=0.0005" in warning
    with pytest.raises(SimulationError, match=r"^energy balance: .*residual 0\.06\), must be at most 0\.05"):
        judge_energy(balance(6e-2), 1000.0, 1e-3)
    # A still plate, or one that does next to nothing, has no balance to judge.
    assert judge_energy(balance(1.0, work=1e-8), 1000.0, 1e-3) == ()
    # Plates that end lower than they began: the work of lifting comes back.
    assert judge_energy(Energies(work_in=0.02, dissipated=0.8, stored=-0.781), 1000.0, 1e-3) == ()
    (warning,) = judge_energy(Energies(work_in=0.02, dissipated=0.8, stored=-0.76), 1000.0, 1e-3)
    assert warning.startswith("energy balance: 0.02 J of 0.8 J dissipated") and "(residual 0.025)" in warning
    # Powers of a few samples a period cannot be summed.
    (coarse,) = judge_energy(balance(0.2), 50.0, 1e-3)
    assert "; 50 Hz " in coarse


def test_item_52_a_friction_line_too_steep_for_the_vehicle_file(car, high_piece):
    with pytest.raises(ConfigurationError, match=r"^front\.damper\.smoothing: found 10000"):
        load_vehicle(None, ["damper.smoothing=1e10"])
    # Past the range, as a library would come: the step solves for sticking and slipping, so the run approaches that of
    # set-valued friction. The line of 1e5 s/m creeps below 16 um/s, 0.2 % of the RMS velocity of the damper.
    within = simulate(car.model, high_piece)
    for wheel in ("fr", "fl"):
        parameters = car.model.spec.actuator(f"damper_{wheel}").biasprm
        kept, parameters[1] = parameters[1], 1e10
        assert kept == 1e5
    try:
        beyond = simulate(car.model, high_piece)
    finally:
        for wheel in ("fr", "fl"):
            car.model.spec.actuator(f"damper_{wheel}").biasprm[1] = 1e5
    assert beyond.statistics.energies is not None and beyond.statistics.energies.residual < 1e-3
    for channel in ("seat_rail_acc_z", "damper_fr_velocity", "damper_fr_force"):
        assert 0.0 < np.std(beyond[channel] - within[channel]) < 5e-3 * np.std(within[channel])
