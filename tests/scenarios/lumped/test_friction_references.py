"""The friction models against exact solutions of stick-slip problems."""

import math

import numpy as np
import pytest

from scenarios.lumped.input_signals import Sine
from scenarios.lumped.quarter_car_network import quarter_car, single_mass
from scenarios.lumped.quarter_car_parameters import load_quarter_car
from scenarios.lumped.stiff_solution import Tolerances, stiff_solution, switch_solution
from scenarios.lumped.switch import Switch
from tests.scenarios.lumped.stick_slip import ExactStickSlip
from tests.validation import validated
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.laws.coulomb import Coulomb
from vehicle.model.laws.stribeck import Stribeck

CAR = load_quarter_car()


class Ramp:
    """A belt of constant velocity."""

    def __init__(self, rate):
        self.rate = rate

    def at(self, time):
        return self.rate * time, self.rate


FINE = Tolerances(relative=1e-8, displacement=1e-12, velocity=1e-10)


def oscillator(friction, *, mass=1.0, stiffness=100.0, smoothing=1e5, **more):
    law = Coulomb(friction_limit=friction, smoothing=smoothing)
    return single_mass(mass=mass, stiffness=stiffness, friction=law, **more).first_order()


def den_hartog(ratio, share):
    """Return the amplitude per static deflection P/k of continuous motion; ratio w/wn, share Fd/P (Den Hartog 1931)."""
    v = 1.0 / (1.0 - ratio**2)
    u = math.sin(math.pi / ratio) / (ratio * (1.0 + math.cos(math.pi / ratio)))
    return math.sqrt(v**2 - share**2 * u**2)


def steady_amplitude(time, motion, period):
    last = motion[time > time[-1] - 2.0 * period]
    return 0.5 * (last.max() - last.min())


@pytest.mark.parametrize(("ratio", "share"), [(0.75, 0.3), (1.25, 0.5)])
def test_den_hartog_without_stops(ratio, share):
    omega = ratio * 10.0
    period = 2 * math.pi / omega
    time = np.arange(0.0, 40.0 * period, period / 200)
    history = stiff_solution(
        oscillator(30.0 * share), time, force=Sine(amplitude=30.0, frequency=omega / 2 / math.pi), tolerances=FINE
    )
    # The atan law is below Fd by 2/(pi eps v) = 1e-5 at the speeds met (1 m/s); 40 periods leave a transient below
    # 1e-3, and 200 samples a period miss the peak by (2 pi/200)^2/8 = 1.2e-4.
    validated(
        "Dampers and friction",
        f"lumped oscillator with Coulomb friction, amplitude, w / w0 = {ratio}, Ff / F0 = {share}",
        steady_amplitude(time, history.displacement("mass"), period), 0.3 * den_hartog(ratio, share), rel=2e-3,
        unit="m", source="closed form: Den Hartog, Trans. ASME 53, 1931",
    )  # fmt: skip


@pytest.mark.parametrize(("ratio", "share"), [(0.5, 0.8), (0.25, 0.5)])
@pytest.mark.parametrize("kind", ["smooth", "switch"])
def test_den_hartog_with_stops(ratio, share, kind):
    """Slow or strongly braked motion stops in every cycle: compared with the closed forms between stops."""
    omega = ratio * 10.0
    period = 2 * math.pi / omega
    time = np.arange(0.0, 6.0 * period, period / 400)
    drive = Sine(amplitude=30.0, frequency=omega / 2 / math.pi)
    exact = ExactStickSlip(1.0, 100.0, 30.0 * share, 30.0, omega)
    pieces = exact.motion(time[-1], 0.0, 0.0)
    stops = [p for p in pieces if p[2] == 0 and p[0] > 3 * period and p[1] - p[0] > 0.01 * period]
    assert len(stops) >= 4  # at least two in each of the last cycles, or the case shows nothing
    expected = exact.sample(pieces, time)
    model = oscillator(30.0 * share, smoothing=1e6)
    if kind == "smooth":
        displacement = stiff_solution(model, time, force=drive).displacement("mass")
    else:
        law = Switch(limit=30.0 * share, band=1e-6, return_time=1e-4)
        displacement = switch_solution(model, law, time, force=drive).displacement("mass")
    # While stuck the atan law creeps at 1e-6 m/s times tan(pi/2 load/Fd): below 1e-4 m in all, of 0.3 m. The switch
    # model drifts by at most its band times the time.
    validated(
        "Dampers and friction",
        f"lumped oscillator that stops in every cycle, {kind} law, w / w0 = {ratio}, Ff / F0 = {share}", displacement,
        expected, abs=1e-4 if kind == "smooth" else 2e-5, unit="m",
        source="closed form: harmonic motion between the stops, instants by root finding",
    )  # fmt: skip
    assert steady_amplitude(time, displacement, period) == pytest.approx(
        steady_amplitude(time, expected, period), rel=1e-3
    )


def test_free_decay_with_coulomb_friction():
    # The amplitude falls by 4 Fd/K in each cycle until the spring can no longer overcome the friction: 0.1, then
    # -0.09, 0.08, ... with Fd/K = 0.005 per quarter; it rests at 0.0 +- Fd/K.
    time = np.arange(0.0, 8.0, 1e-3)
    history = stiff_solution(oscillator(0.5), time, initial=[0.1013, 0.0], tolerances=FINE)
    x = history.displacement("mass")
    half = math.pi / 10.0
    for count in range(1, 10):
        peak = np.interp(count * half, time, x)
        # Creep and the missing tail of the atan law: 2/(pi eps) per second of sliding, below 1e-5 m.
        validated(
            "Dampers and friction", f"lumped oscillator, Coulomb decay, extreme after {count} half cycles", peak,
            (-1) ** count * (0.1013 - count * 0.01), abs=1e-5, unit="m", source="closed form: loss of 2 Fd / k each",
        )  # fmt: skip
    # 0.1013 - 10 * 0.01 = 0.0013 < Fd/K: it stops there for good, creeping at 1e-5 tan(pi/2 0.13/0.5) m/s for 5 s.
    assert x[-1] == pytest.approx(0.0013, abs=5e-5)


def test_mass_on_a_belt_with_kinetic_friction_alone():
    """Never as fast as the belt: an undamped oscillation about x = Fd/K, which the friction only shifts."""
    belt, friction, natural = 0.1, 2.0, 10.0
    time = np.arange(0.0, 4.0, 1e-3)
    model = oscillator(friction, belt=True, smoothing=1e6)
    history = stiff_solution(model, time, road=Ramp(rate=belt), initial=[0.02, 0.5 * belt], tolerances=FINE)
    expected = 0.02 + 0.5 * belt / natural * np.sin(natural * time)
    # At a slip of 0.05 to 0.15 m/s the atan law is 2/(pi eps v) = 1.3e-5 below Fd: 3e-7 m on K, and its slope feeds
    # the oscillation: (2/pi) Fd/(eps v^2) = 5e-4 N s/m, over 4 s at most a part in 1e3 of 5 mm.
    validated(
        "Dampers and friction", "mass on a belt with kinetic friction alone", history.displacement("mass"), expected,
        abs=6e-6, unit="m", source="closed form: Fd / k + v / (2 w) sin w t",
    )  # fmt: skip


def test_mass_on_a_belt_with_static_and_kinetic_friction():
    """Relaxation oscillation: stick until K x = Fs, then a half sine about Fd/K; period and peak in closed form."""
    belt, static, kinetic, natural = 0.1, 4.0, 2.0, 10.0
    law = Stribeck(
        friction_limit=kinetic, static_limit=static, stribeck_velocity=5e-4, stribeck_exponent=2.0, smoothing=1e7
    )
    model = single_mass(mass=1.0, stiffness=100.0, friction=law, belt=True).first_order()
    time = np.arange(0.0, 6.0, 2e-4)
    history = stiff_solution(model, time, road=Ramp(rate=belt), tolerances=FINE)
    x = history.displacement("mass")
    a, b = (static - kinetic) / 100.0, belt / natural
    slip = (math.pi + 2.0 * math.atan2(b, a)) / natural
    period = slip + 2.0 * a / belt
    rising = time[1:][(x[:-1] < kinetic / 100.0) & (x[1:] >= kinetic / 100.0)]
    # The limit falls within 5e-4 m/s, 0.5 % of the belt speed, and the product with the atan peaks at 0.99 Fs: 1 %.
    belted = "closed form: stick until k x = Fs, then half a sine about Fk / k"
    validated(
        "Dampers and friction", "period of stick-slip on a belt", np.diff(rising)[2:], period, rel=1e-2, unit="s",
        source=belted,
    )  # fmt: skip
    validated(
        "Dampers and friction", "peak of stick-slip on a belt", x[time > 3.0].max(), kinetic / 100.0 + math.hypot(a, b),
        rel=1e-2, unit="m", source=belted,
    )  # fmt: skip


@pytest.mark.parametrize("frequency", [1.0, 8.0, 40.0])
def test_the_locked_strut_unlocks_where_its_force_reaches_the_limit(frequency):
    """'Boulevard ride': below A(w) the strut never slides; A = Fd / |friction force of the stuck car per road metre|.

    The stuck car by two separate equations: damper mass on the wheel, mount spring above it.
    """
    s = 2j * math.pi * frequency
    k = 3e4 + 7e5
    matrix = np.array([[180 * s**2 + k, -k], [-k, 46 * s**2 + k + 2.5e5]])
    body, wheel = np.linalg.solve(matrix, [0.0, 2.5e5])
    held = 7e5 * (body - wheel) - 1.0 * s**2 * wheel  # what the friction carries
    amplitude = CAR.friction.limit / abs(held)
    # A steep law, so that the stuck strut creeps at 1e-6 m/s times tan(0.95 pi/2) = 13 only.
    model = quarter_car(CAR, damper="friction", vary={"friction.steepness": 1e6}).first_order()
    periods = 3
    time = np.linspace(0.0, periods / frequency, 1200)
    peak = {}
    for share in (0.95, 1.05):
        # Start on the steady motion of the stuck car; it is real because nothing in it is damped.
        w = 2 * math.pi * frequency
        start = share * amplitude * w * np.array([0, 0, 0, body.real, wheel.real, (wheel - body).real])
        start[:3] = 0.0
        history = stiff_solution(
            model, time, road=Sine(amplitude=share * amplitude, frequency=frequency), initial=start, longest_step=1e-3
        )
        peak[share] = np.abs(history.sliding_velocity()).max()
    assert peak[0.95] < 5e-5  # creep: 1.3e-5, with room for the ripple of the start
    # Sliding: 5 % of 75 N, on 1 kg and 1500 N s/m: 2.5 mm/s where it lasts, less at 40 Hz where it lasts 2 ms.
    assert peak[1.05] > 2e-4


def test_switch_and_smooth_law_agree_above_the_published_velocity():
    p = CAR.mass_on_damper
    model = oscillator(p.friction_limit, mass=p.mass, stiffness=0.0, damping=p.damping, smoothing=p.steepness)
    drive = Sine(amplitude=p.force_amplitude, frequency=p.force_frequency)
    time = np.linspace(0.0, 0.5, 5001)
    smooth = stiff_solution(model, time, force=drive)
    law = Switch(limit=p.friction_limit, band=p.stick_band, return_time=p.return_time)
    switched = switch_solution(model, law, time, force=drive)
    v, vs = smooth.sliding_velocity(), switched.sliding_velocity()
    fast = np.abs(v) > 5e-5
    # At 5e-5 m/s the atan law lacks 2/(pi eps v) = 1.27 % of 50 N, that is 4.3e-5 m/s on the damper.
    assert np.abs(v - vs)[fast].max() < 4.5e-5
    assert np.abs(smooth.sliding_force - switched.sliding_force)[fast].max() < 0.0128 * p.friction_limit
    # (110 - 50)/15000 = 4e-3 m/s, less what the inertia costs (w m/D)^2 = 1e-6.
    validated(
        "Published cars", "mass on the damper: peak velocity with the switch model", np.abs(vs).max(), 4e-3, rel=1e-4,
        unit="m/s", source="publication: Bommer 2006, figures 2.9 and 2.10",
    )  # fmt: skip
    # It sticks while |F| < 50 N: (2/pi) asin(50/110) of the time, to two samples at each of four ends.
    validated(
        "Dampers and friction", "share of time in which a mass on a damper sticks", np.mean(np.abs(vs) <= p.stick_band),
        2 / math.pi * math.asin(50 / 110), abs=8 / 5001, source="closed form: 2 / pi asin(Fd / F)",
    )  # fmt: skip


def test_the_switch_model_gives_up_after_its_evaluations():
    p = CAR.mass_on_damper
    model = oscillator(p.friction_limit, mass=p.mass, stiffness=0.0, damping=p.damping)
    law = Switch(limit=p.friction_limit, band=p.stick_band, return_time=p.return_time)
    drive = Sine(amplitude=p.force_amplitude, frequency=p.force_frequency)
    with pytest.raises(SimulationError) as caught:
        switch_solution(model, law, np.linspace(0.0, 0.5, 101), force=drive, max_evaluations=300)
    message = str(caught.value)
    assert message.startswith("switch model: stopped at t = 0.")  # 1200 for the whole half second
    assert message.endswith(
        "s of 0.5 s after max_evaluations = 300; widen the stick band, lengthen the return time, or allow more"
    )
    with pytest.raises(ConfigurationError, match=r"^max_evaluations: found 0, must be at least 1$"):
        switch_solution(model, law, [0.0, 0.5], max_evaluations=0)


def test_the_switch_model_refuses_a_belt():
    with pytest.raises(ConfigurationError, match="a single model with one sliding pair"):
        switch_solution(oscillator(1.0, belt=True), Switch(limit=1.0, band=1e-6, return_time=1e-4), [0.0, 1.0])
