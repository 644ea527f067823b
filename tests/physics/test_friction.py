"""Friction of the dampers against closed forms: locked strut, sliding, Coulomb decay, Den Hartog, Stribeck."""

import numpy as np
import pytest

from tests.engines.simulation.row_model import Stepper, add_damper, add_mass, empty_spec
from tests.validation import validated
from vehicle.model.laws.stribeck import Stribeck

LIMIT, SMOOTHING, VISCOUS = 125.0, 1e5, 2250.0  # the damper of Bommer 2006
CREEP = 2.0 / np.pi * LIMIT * SMOOTHING  # N s/m, slope of the smooth law at rest


def strut(step=1e-3, mass=40.0, *, viscous=VISCOUS, limit=LIMIT, static=None, stiffness=0.0, exponent=3.5):
    """A mass on a slide joint with a damper, and a spring to the ground where `stiffness` is given."""
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "mass", mass)
    law = [viscous, SMOOTHING, limit, limit if static is None else static, 0.03, exponent]
    add_damper(spec, body, law, stiffness=stiffness)
    return Stepper(spec)


def push(run, force):
    def before(time):
        run.data.xfrc_applied[1, 0] = force(time)

    return before


def speed(run):
    """Velocity at the present time: MuJoCo's is that of half a step before."""
    return lambda: run.data.qvel[0] + 0.5 * run.h * run.data.qacc[0]


@pytest.mark.parametrize("step", [1e-4, 1e-3, 4e-3])
@pytest.mark.parametrize("force", [1.0, -60.0, 124.0])
def test_below_the_limit_it_sticks_at_any_step(step, force):
    run = strut(step)
    velocity = run.step(200, lambda: run.data.qvel[0], push(run, lambda _: force))
    # It creeps with the slope of the published atan, some 1e-5 m/s; an explicit law would need steps of 5 us.
    validated(
        "Dampers and friction", f"creep of a stuck damper under {force:g} N, step {1e3 * step:g} ms", velocity[-1],
        force / (CREEP + VISCOUS), rel=1e-6, unit="m/s",
        source="closed form: slope 2 Fd eps / pi of the atan law of Bommer 2006 at rest",
    )  # fmt: skip
    assert np.max(np.abs(velocity)) < 2e-5


@pytest.mark.parametrize("force", [126.0, 350.0, -350.0])
def test_above_the_limit_it_slides(force):
    run = strut()
    # 40 kg / 2250 N s/m = 18 ms, so 0.6 s are 34 time constants.
    velocity = run.step(600, lambda: run.data.qvel[0], push(run, lambda _: force))
    validated(
        "Dampers and friction", f"sliding speed of a damper under {force:g} N", velocity[-1],
        (force - np.sign(force) * LIMIT) / VISCOUS, rel=1e-6, unit="m/s", source="closed form: (F - Fd sign v) / D",
    )  # fmt: skip


def test_it_breaks_away_and_stops_at_the_exact_times():
    # A force that rises by 250 N/s passes 125 N at 0.5 s; without a spring and with v' = (F - Fd - D v)/m.
    run = strut(step=1e-3, viscous=0.0)
    x = run.step(1000, run.position, push(run, lambda t: 250.0 * t))[:, 0]
    after = 1e-3 * np.arange(1000) - 0.5
    exact = np.where(after > 0.0, 250.0 / 40.0 * np.maximum(after, 0.0) ** 3 / 6.0, 0.0)
    # First-order error of the instant of breaking away: up to a step, of a speed that is then still zero.
    validated(
        "Dampers and friction", "motion after breaking away under a force that rises by 250 N/s", x, exact, peak=2e-3,
        unit="m", source="closed form: F' t^3 / (6 m) from the instant F = Fd",
    )  # fmt: skip
    # Pushed off with 0.5 m/s it stops after m v / Fd = 0.16 s, m v2 / (2 Fd) = 0.04 m further on.
    run = strut(step=1e-3, viscous=0.0)
    run.data.qvel[0] = 0.5
    x = run.step(300, run.position)[:, 0]
    stop = 40.0 * 0.5 / LIMIT
    before = int(0.9 * stop / 1e-3)
    # half a step of 0.5 m/s is 0.6 %
    validated(
        "Dampers and friction", "way of a mass that friction stops from 0.5 m/s", np.max(x), 0.5 * stop / 2.0, rel=0.02,
        unit="m", source="closed form: m v^2 / (2 Fd)",
    )  # fmt: skip
    assert x[before] < x[before + 5] and np.ptp(x[int(stop / 1e-3) + 3 :]) < 1e-9


def test_free_decay_with_coulomb_friction_is_linear():
    # k = 4 pi2 m (2 Hz half periods of 0.25 s): every half cycle loses 2 Fd / k.
    mass, limit = 40.0, 20.0
    stiffness = mass * (2.0 * np.pi * 2.0) ** 2
    run = strut(mass=mass, viscous=0.0, limit=limit, stiffness=stiffness)
    loss = 2.0 * limit / stiffness
    start = 10.3 * loss
    run.data.qpos[0] = start
    x = run.step(4000, run.position)[:, 0]
    turns = x[[0, *(np.flatnonzero(np.diff(np.sign(np.diff(x)))) + 1)]]
    tops = np.abs(turns[:10])
    # Half a step of turning round: x'' h2 / 8 is 2e-5 of the amplitude.
    validated(
        "Dampers and friction", "loss of amplitude by half cycle in free decay with Coulomb friction", -np.diff(tops),
        loss, rel=2e-3, unit="m", source="closed form: 2 Fd / k",
    )  # fmt: skip
    # It stays where spring and friction first balance: the tenth turn leaves 0.3 of the loss, inside Fd / k = 0.5.
    validated(
        "Dampers and friction", "place where Coulomb friction holds the oscillator for good", abs(x[-1]), 0.3 * loss,
        rel=0.01, unit="m", source="closed form: start less ten times 2 Fd / k",
    )  # fmt: skip
    # ... but for the creep of the smooth law, k x / c.
    creep = stiffness * abs(x[-1]) / (2.0 / np.pi * limit * SMOOTHING)
    validated(
        "Dampers and friction", "creep of the stuck oscillator in 1 s", np.ptp(x[-1001:]), creep * 1.0, rel=0.01,
        unit="m", source="closed form: k x over the slope of the smooth law at rest",
    )  # fmt: skip


@pytest.mark.parametrize(("ratio", "share"), [(0.6, 0.4), (1.5, 0.4), (0.8, 0.5)])
def test_den_hartogs_forced_oscillator(ratio, share):
    """Amplitude of m x'' + k x + Ff sign(x') = F0 cos(w t) without stops, equation 30 of the source.

    x0 k / F0 = sqrt(V2 - (Ff/F0)2 U2), V = 1 / (1 - r2), U = tan(pi / (2 r)) / r.

    Source: J. P. Den Hartog, Forced vibrations with combined Coulomb and viscous friction, Trans. ASME 53, 1931.
    """
    mass, natural, amplitude = 10.0, 2.0 * np.pi * 5.0, 100.0
    stiffness = mass * natural**2
    omega = ratio * natural
    period = 800  # steps
    step = 2.0 * np.pi / omega / period
    run = strut(step, mass, viscous=0.0, limit=share * amplitude, stiffness=stiffness)
    x = run.step(20 * period, run.position, push(run, lambda t: amplitude * np.cos(omega * t)))[:, 0]
    tail = x[-2 * period :]
    direct = 1.0 / (1.0 - ratio**2)
    lost = np.tan(np.pi / (2.0 * ratio)) / ratio
    exact = amplitude / stiffness * np.sqrt(direct**2 - (share * lost) ** 2)
    # No stops: only the two turns of each period are slow.
    slow = np.abs(np.diff(tail)) / step < 0.02 * omega * exact
    assert np.mean(slow) < 0.03
    # Friction turns round half a step early (it depends on the speed at the end of the step): of the order of
    # pi / period = 4e-3; without friction the amplitude would be 3 to 22 % larger.
    assert abs(direct) * amplitude / stiffness / exact > 1.03
    validated(
        "Dampers and friction",
        f"amplitude of a forced oscillator with Coulomb friction, w / w0 = {ratio}, Ff / F0 = {share}",
        0.5 * np.ptp(tail), exact, rel=4e-3, unit="m",
        source="closed form: Den Hartog, Trans. ASME 53, 1931, equation 30",
    )  # fmt: skip


@pytest.mark.parametrize("velocity", [1e-3, 0.01, 0.03, 0.06, 0.3])
def test_stribeck_limit_follows_the_velocity(velocity):
    # On a mass that nothing stops the friction row must hold the limit at its velocity.
    run = strut(mass=1e6, viscous=0.0, limit=65.0, static=125.0)
    run.data.qvel[0] = velocity
    run.step(1, run.position)
    force = run.data.efc_force[run.rows.layout.dampers.frictions][0]
    exact = 65.0 + 60.0 * np.exp(-((velocity / 0.03) ** 3.5))
    validated(
        "Dampers and friction", f"Stribeck friction of the simulated damper at {velocity:g} m/s", -force, exact,
        rel=1e-5, unit="N", source="closed form: Fc + (Fs - Fc) exp(-(v / vs)^n)",
    )  # fmt: skip
    law = Stribeck(
        friction_limit=65.0, static_limit=125.0, stribeck_velocity=0.03, stribeck_exponent=3.5, smoothing=SMOOTHING
    )
    assert exact == pytest.approx(float(law.limit(velocity)), rel=1e-12)


def test_stribeck_holds_up_to_its_static_limit():
    held, gone = (strut(limit=65.0, static=125.0, viscous=0.0) for _ in range(2))
    assert held.step(300, lambda: held.data.qvel[0], push(held, lambda _: 120.0))[-1] < 2e-5
    assert gone.step(300, lambda: gone.data.qvel[0], push(gone, lambda _: 130.0))[-1] > 0.1
