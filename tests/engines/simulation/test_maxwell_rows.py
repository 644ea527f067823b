"""The Maxwell branch of a row: complex stiffness, limits, and stability when it is fast."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec
from tests.validation import validated
from vehicle.engines.simulation.step_weights import implicit_share
from vehicle.model.laws.elastomer import Maxwell

K1, K2, D2 = 4.0e5, 1.0e5, 2000.0  # the hydromount of appendix F, tau = 20 ms
STEP = 1e-3


def elastomer(step=STEP, mass=220.0, *, static=K1, branch=K2, time=D2 / K2):
    spec = empty_spec(step)
    body = add_free_body(spec, "engine", mass, [10.0] * 3)
    ones = np.array([0.0, 0.0, 1.0])
    # The other axes are held by plain springs, so that nothing floats away.
    law = element_law([K1, K1, static], branch=branch * ones, time=time * ones)
    add_bushing(spec, "hydromount", body, spec.worldbody, law)
    return Stepper(spec)


def complex_stiffness(run, frequency, mass, periods=4):
    """K(jw) = F / X + m w2 in the steady state under F = cos(w t)."""
    omega = 2.0 * np.pi * frequency
    # The rows average their stiffness over three steps (1, 10, 1)/12; a load must be averaged alike (Numerov).
    average = (10.0 + 2.0 * np.cos(omega * run.h)) / 12.0
    steps = round(1.0 / (frequency * run.h))

    def push(time):
        run.data.xfrc_applied[1, 2] = average * np.cos(omega * time)

    settle = 40 * steps if frequency > 4.0 else 15 * steps
    x = run.step(settle + periods * steps, run.position, push)[settle:, 2]
    times = run.h * (settle + np.arange(len(x)))
    amplitude = 2.0 * np.mean(x * np.exp(-1j * omega * times))
    return 1.0 / amplitude + mass * omega**2


@pytest.mark.parametrize("frequency", [2.0, 5.0, 10.0, 20.0])
def test_complex_stiffness_against_the_transfer_function(frequency):
    # A light mass, so that F / X is the element and little else; a dashpot beside it would be seen in the angle.
    mass = 5.0
    found = complex_stiffness(elastomer(mass=mass), frequency, mass)
    omega = 2.0 * np.pi * frequency
    exact = K1 + K2 * D2 * 1j * omega / (D2 * 1j * omega + K2)
    law = Maxwell(stiffness=K1, branch_stiffness=K2, branch_damping=D2)
    assert exact == pytest.approx(complex(law.complex_stiffness(omega)), rel=1e-12)
    # The branch is averaged with 1/4 instead of 1/12: (w h)^2 / 6 of it is missing, 5.4e-4 of K at 20 Hz.
    validated(
        "Bushings, springs and stops", f"complex stiffness of the hydromount in a run at {frequency:g} Hz", found,
        exact, rel=6e-4 * (frequency / 20.0) ** 2, unit="N/m",
        source="closed form: K1 + K2 D i w / (D i w + K2), Bommer 2006, appendix F",
    )  # fmt: skip


@pytest.mark.parametrize("time", [1e-5, 1e-4, 1e-3])
def test_a_fast_branch_is_the_damper_it_stands_for(time):
    # A bushing behind sheet metal: K2 = 1e7 N/m and tau of a tenth to a whole step. Its damper D2 = K2 tau.
    stiff, mass, frequency = 1e7, 5.0, 5.0  # light, so that its own vibration dies out
    run = elastomer(mass=mass, branch=stiff, time=time)
    found = complex_stiffness(run, frequency, mass)
    turn = 2j * np.pi * frequency * time
    exact = K1 + stiff * turn / (1.0 + turn)
    # (w h)^2 = 1e-3 of the force of the branch; a first-order step would be off by w h = 3e-2 of it.
    validated(
        "Bushings, springs and stops", f"complex stiffness of a fast Maxwell branch, {1e3 * time:g} ms", found, exact,
        abs=1e-3 * abs(exact - K1) + 1e-5 * K1, unit="N/m", source="closed form: K1 + K2 i w T / (1 + i w T)",
    )  # fmt: skip


@pytest.mark.parametrize("time", [1e-9, 1e-6, 1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("branch", [1e7, 1e9, 1e11])
def test_a_stiff_and_fast_branch_is_stable(branch, time):
    # Up to w h = 450 on 0.5 kg: a branch as stiff as sheet metal may not ask for a shorter step.
    run = elastomer(mass=0.5, static=1e3, branch=branch, time=time)
    run.data.qpos[2] = 1e-4
    run.data.qvel[2] = 0.1
    x = run.step(3000, run.position)[:, 2]
    first, last = np.max(np.abs(x[:300])), np.max(np.abs(x[-300:]))
    assert np.isfinite(x).all() and last <= first
    assert first < 0.1 * np.sqrt(0.5 / 1e3) + 1e-3  # it can never swing farther than on K1 alone


def test_a_light_part_behind_a_strong_branch_does_not_ring():
    # m v' = -B v: (m + theta B h) a = -B v must leave exp(-z) of the velocity after a step, z = B h/m.
    for z in (1e-6, 5e-5, 2e-4, 1e-2, 1.0, 5.0):
        share = float(implicit_share(np.array([z]))[0])
        validated(
            "Bushings, springs and stops", f"velocity that a strong branch leaves in a step, B h / m = {z:g}",
            1.0 - z / (1.0 + share * z), np.exp(-z), rel=1e-9, source="closed form: exp(-B h / m)",
        )  # fmt: skip
    # Second order: the half of the centred damping, and a small part of a step more.
    assert implicit_share(np.array([1e-3, 0.1])) == pytest.approx([0.5 + 1e-3 / 12.0, 0.5 + 0.1 / 12.0], rel=1e-5)


def test_the_share_acts_on_branches_that_are_not_very_stiff():
    # 6 kg behind 1.25e7 N/m and 5.5e3 N s/m: z = 0.8. At 1 ms the branch answers 1.13 times half a step.
    light, heavy, stiff = (elastomer(mass=mass, branch=1.25e7, time=4.4e-4).rows.weights for mass in (6.0, 6e6, 3.0))
    slope, centred = light.slope[0, 2], heavy.slope[0, 2]
    z = light.gain[0, 2] * STEP / 6.0
    assert light.average[0, 2] == pytest.approx(1.0 / 12.0)
    assert slope / centred == pytest.approx(2.0 * float(implicit_share(np.array([z]))[0]), rel=1e-6)
    assert slope / centred > 1.1
    assert stiff.slope[0, 2] == pytest.approx(centred, rel=1e-6)  # w h = 2.07
