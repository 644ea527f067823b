"""A condition that changes during a test: lag and delay, and a semi-active damper whose current is switched."""

import numpy as np
import pytest
import scipy

from tests.benchmarks.known_dampers import FINE, random_motion
from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.signals.records.choice import Choice
from vehicle.studies.dampers.conditions import fitted_beyond_lag, with_setting
from vehicle.studies.dampers.damper_fit import DamperFit, fit_law
from vehicle.studies.dampers.damper_force import Motion, force_and_slopes
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_setting import Setting
from vehicle.studies.dampers.damper_starts import first_start
from vehicle.studies.dampers.damper_test import read_test
from vehicle.studies.dampers.fitted_damper import fit_damper
from vehicle.studies.dampers.over_condition import control_lines, setting_values

SUBJECT = "Sweeps, tuning and optimisation"
LAG, RATE = 0.008, 1000
HEAD = "time [s],displacement [mm],velocity [mm/s],force [N],current [A],temperature [A]"


def switched(duration, seed=1):
    """Fine times, and a current that is switched between 0 and 1 A every 10 to 70 ms."""
    rng, time = np.random.default_rng(seed), np.arange(round(duration / FINE)) * FINE
    instants = np.cumsum(rng.uniform(0.01, 0.07, round(duration / 0.01)))
    return time, np.searchsorted(instants, time) % 2.0


def record(path, duration=4.0):
    """A magnetorheological damper under random motion: smooth curves, no law of the family; 2 % noise."""
    time, current = switched(duration)
    _, x, v = random_motion(duration, 0.008, 1)
    # The current is constant within a fine step: exact decay of the lag.
    fade = np.exp(-FINE / LAG)
    y, _ = scipy.signal.lfilter([0.0, 1.0 - fade], [1.0, -fade], current, zi=[0.0])
    force = (900.0 + 900.0 * y) * v + (60.0 + 700.0 * y) * np.tanh(v / 0.02) + 1500.0 * x - 80.0
    each = slice(None, None, round(1.0 / RATE / FINE))
    exact = force[each]
    force = exact + 0.02 * np.std(exact) * np.random.default_rng(2).standard_normal(exact.size)
    table = [time[each], 1e3 * x[each], 1e3 * v[each], force, current[each], 20.0 + time[each]]
    np.savetxt(path, np.column_stack(table), delimiter=",", header=HEAD, comments="", fmt="%.7g")
    return exact


def test_the_setting_follows_its_condition_with_lag_and_delay():
    """Against an integration of the equation of the lag, with a condition that is straight between its samples."""
    rng, time = np.random.default_rng(3), np.linspace(0.0, 0.059, 60)
    values = rng.uniform(0.0, 2.0, time.size)
    setting = Setting(name="current", time=time, values=values, lowest=0.0, highest=2.0)

    def rate(t, y):
        return (np.interp(t - 2.3e-3, time, values) / 2.0 - y) / LAG

    exact = {"max_step": 1e-4, "rtol": 1e-8, "atol": 1e-10}
    y = scipy.integrate.solve_ivp(rate, (0.0, time[-1]), [values[0] / 2.0], t_eval=time, **exact).y[0]
    assert setting.shares(LAG, 2.3e-3, 1.0)[0] == pytest.approx(y, abs=1e-6)
    assert setting.shares(LAG, 2.3e-3, 2.0)[0] == pytest.approx(2.0 * y / (1.0 + y), abs=1e-6)
    first = np.arange(0, 60, 7)
    means = [np.mean(each) for each in np.split(y, first[1:])]
    assert setting.averaged(first, 60).shares(LAG, 2.3e-3, 1.0)[0] == pytest.approx(means, abs=1e-6)


def test_the_slopes_are_those_of_differences():
    law = DamperLaw(setting="saturating", delayed=True, bends=1, friction="coulomb", gas_stiffness=True, series=True)
    values = {"gas_force": 20.0, "gas_stiffness": 1500.0, "lag": LAG, "saturation": 1.7, "delay": 1.3e-3}
    values |= {"damping_1": 3000.0, "damping_2": 1000.0, "velocity_1": 0.05, "friction": 50.0, "series_stiffness": 2e6}
    values |= {"firm_damping_1": 9e3, "firm_damping_2": 1500.0, "firm_velocity_1": 0.04, "firm_friction": 80.0}
    values |= {"firm_series_stiffness": 3e6}
    parameters = np.array([values[name] for name in law.parameters])
    time, current = (each[:5000:10] for each in switched(0.5))
    _, x, v = (each[::10] for each in random_motion(0.5, 0.008, 1))
    motion = Motion(time, x, v, 0.0, setting=Setting(name="i", time=time, values=current, lowest=0.0, highest=1.0))
    slopes = force_and_slopes(law, parameters, motion)[1]
    for at, (name, value) in enumerate(zip(law.parameters, parameters, strict=True)):
        step = np.zeros(parameters.size)
        step[at] = 1e-6 * value
        ends = [force_and_slopes(law, parameters + sign * step, motion)[0] for sign in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / (2.0 * step[at])
        assert np.linalg.norm(difference - slopes[:, at]) < 1e-4 * np.linalg.norm(difference), name


def test_a_switched_damper_gives_its_law_and_its_switching_time(tmp_path):
    exact = record(tmp_path / "switched.csv")
    soft, firm = fit_damper([tmp_path / "switched.csv"], conditions={"current": "channel:current"})
    assert [dict(each.conditions) for each in (soft, firm)] == [{"current": 0.0}, {"current": 1.0}]
    (test,) = soft.tests
    error = np.std(soft.force(test) - exact) / np.std(exact)
    lag = setting_values(soft)["lag"] + setting_values(soft).get("delay", 0.0)
    source = "second derivation: smooth law without segments, exact decay of the lag in steps of 0.1 ms"
    validated(SUBJECT, "damper, current switched every 10 to 70 ms: error of the force over its deviation", error, 0.0,
              abs=0.05, source=source)  # fmt: skip
    validated(SUBJECT, "damper, current switched every 10 to 70 ms: lag", lag, LAG, abs=1e-3, unit="s", source=source)
    lines = control_lines([soft, firm])
    low, high, rate = (
        float(lines.split(f"\n{name} = ")[1].split()[0]) for name in ("minimum_damping", "maximum_damping", "rate")
    )
    assert rate == pytest.approx((high - low) / (2.0 * setting_values(soft)["lag"]), rel=1e-2)
    # Damping of the work of both curves in this motion.
    v = test.velocity
    for damping, share in ((low, 0.0), (high, 1.0)):
        force = (900.0 + 900.0 * share) * v + (60.0 + 700.0 * share) * np.tanh(v / 0.02)
        assert damping == pytest.approx(np.sum(force * v) / np.sum(v**2), rel=0.03)


def after_a_switch(path, duration, lag):
    """A record of 900 to 1800 N s/m that begins 2 ms after a switch, while the damper follows the current before."""
    time, current = switched(duration)
    _, x, v = random_motion(duration, 0.008, 1)
    each = slice(None, None, round(1.0 / RATE / FINE))
    current = np.interp(time, time[each], current[each])
    # Exact decay of the lag in a fine step, under the mean current of the step.
    fade = np.exp(-FINE / lag)
    means = 0.5 * (current[1:] + current[:-1])
    y = np.concatenate([[0.0], scipy.signal.lfilter([1.0 - fade], [1.0, -fade], means)])
    table = np.column_stack([time, 1e3 * x, 1e3 * v, 900.0 * (1.0 + y) * v - 80.0, current, 20.0 + time])[each]
    begin = 200 + np.flatnonzero(np.diff(table[200:, 4]))[0] + 3
    np.savetxt(path, table[begin:], delimiter=",", header=HEAD, comments="", fmt="%.9g")
    return with_setting([read_test(path, Choice(), conditions={"current": "channel:current"})])


def linear_fit(tests):
    """Fit of a linear soft and firm law, as a choice of laws with this law alone."""
    law = DamperLaw(setting="lag")
    return DamperFit(law=law, parameters=fit_law(tests, law, first_start(law, tests), tolerance=1e-10)), []


def lag_of(fit):
    """Fitted lag [s]."""
    return float(fit.parameters[list(fit.law.parameters).index("lag")])


def test_what_was_before_the_record_does_not_count(tmp_path):
    lag = 0.06
    tests = after_a_switch(tmp_path / "cut.csv", 1.2, lag)
    whole = lag_of(linear_fit(tests)[0])
    (test,), (fit, _) = fitted_beyond_lag(tests, linear_fit)
    found = lag_of(fit)
    validated(SUBJECT, "damper, lag of 60 ms, record that begins just after a switch: lag", found, lag, rel=5e-3,
              unit="s", source="second derivation: exact decay of the lag in steps of 0.1 ms")  # fmt: skip
    assert abs(whole / lag - 1.0) > 0.05
    assert test.time[test.settled][0] - test.time[0] == pytest.approx(5.0 * lag, rel=0.1)
    assert test.notices[-1] == "the first 0.3 s are not fitted: the damper follows current with a lag of 0.06 s"
    tests = after_a_switch(tmp_path / "short.csv", 0.7, lag)
    (test,), _ = fitted_beyond_lag(tests, linear_fit)
    assert test.notices[-1].endswith("what current was before the record may still count: record longer")


def test_two_changing_conditions_are_refused_and_noise_is_a_constant(tmp_path):
    record(tmp_path / "switched.csv", 1.0)
    conditions = {name: f"channel:{name}" for name in ("current", "temperature")}
    table = np.loadtxt(tmp_path / "switched.csv", delimiter=",", skiprows=1)
    table[:, 5] *= 1.0 + 0.3 * table[:, 0]
    np.savetxt(tmp_path / "both.csv", table, delimiter=",", header=HEAD, comments="", fmt="%.7g")
    with pytest.raises(ConfigurationError, match="current and temperature change during the tests"):
        fit_damper([tmp_path / "both.csv"], conditions=conditions)
    table[:, 4] = 0.5 + 0.02 * np.random.default_rng(4).standard_normal(len(table))
    np.savetxt(tmp_path / "noise.csv", table, delimiter=",", header=HEAD, comments="", fmt="%.7g")
    (fitted,) = fit_damper([tmp_path / "noise.csv"], Choice(), conditions={"current": "channel:current"})
    assert fitted.conditions["current"] == pytest.approx(0.5, abs=0.01) and fitted.changing is None
