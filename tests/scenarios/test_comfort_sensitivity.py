"""`python -m scenarios.comfort_sensitivity` as a user runs it, its statistics, and its physics."""

import dataclasses
import json
from types import SimpleNamespace

import numpy as np
import pytest

from scenarios.car_runs import CarRuns
from scenarios.comfort_runs import ComfortRuns, Records, chosen_engine, point, standard_error
from scenarios.comfort_sensitivity import __main__ as beyond
from scenarios.comfort_sensitivity.__main__ import SURE, SensitivitySettings, main, records_of
from scenarios.comfort_sensitivity.claims import (
    FRICTION,
    MOUNT_DAMPING,
    PUBLISHED,
    SOURCE,
    is_monotone,
    order_claims,
    size_claims,
    slip_claims,
)
from scenarios.comfort_sensitivity.figures import curve_table
from scenarios.comfort_sensitivity.histories import (
    RoadLevels,
    amplification_claim,
    history_claims,
    level_claims,
    road_levels,
    stiffness_claim,
    wheel_claims,
    wheel_modes,
    wheel_peak,
)
from scenarios.evidence import LEVELS, evidence_of, status_of
from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import ROAD_EDGE_HZ, ROAD_RMS
from tests.scenarios.kept_table import contradictions
from vehicle.commands.options import read
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.car import Car
from vehicle.runs.output.written_files import MARKER
from vehicle.studies.sweeps.case import Case


def test_quick_contradicts_no_verdict_of_the_full_study(results):
    assert contradictions("comfort_sensitivity", results) == []


def test_a_short_study_shows_that_friction_makes_a_smooth_road_worse(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    assert {path.name for path in results.iterdir()} == {
        MARKER,
        "results.md",
        "results.json",
        "sweep",
        "wheel.png",
        *(f"{variation.name}.png" for variation in SOURCE),
    }
    assert [(row["name"], row["within"]) for row in content["rows"]] == [(SURE, True)]
    assert "slip share of the right damper, rough road [%]" in content["not_judged"]
    assert content["engine"] == "reduced"
    slip = [point["slip"] for point in content["source"]["coulomb_friction"]["smooth"]]
    assert slip == sorted(slip, reverse=True)
    assert not (results / "sweep" / "rows.jsonl").exists()


def question(car=(), rms=0.0075, lead=3.0):
    source = RoadInput(name="road", rms=rms, seed=0, duration=8.0, lead=lead, lower_band_edge=ROAD_EDGE_HZ, wheel="fl")
    return Case(overrides=car, source=source, engine="reduced")


def observe(cases, folder):
    comfort = ComfortRuns(CarRuns(), Records(count=1, duration=8.0, lead=3.0), folder)
    return [SimpleNamespace(**numbers) for numbers in comfort(cases)]


def test_doubling_road_and_friction_doubles_comfort_and_keeps_the_slip_in_scale(tmp_path):
    # All but friction is linear and gravity's part is a constant: x(2 Fd, 2 z) = 2 x(Fd, z), with the smooth law
    # reaching its limit at twice the velocity. So the curve over Fd and the one over the level of the road are one.
    double = (
        "damper.coulomb_friction=250",
        "damper.smoothing=5e4",
        f"damper.slip_velocity={2.0 * Car.load().vehicle.damper.slip_velocity!r}",
    )
    single, two = observe([question(), question(double, rms=0.015)], tmp_path)
    # Rounding, and the 1e-9 N at which the friction forces of a step are called solved.
    assert two.unweighted == pytest.approx(2.0 * single.unweighted, rel=1e-6)
    assert two.slip == pytest.approx(single.slip, abs=1e-3)
    static = Car.load().model.static.tyre_load["fl"]
    assert two.lowest_load - static == pytest.approx(2.0 * (single.lowest_load - static), rel=1e-6)


def test_the_lead_is_left_out():
    measure = RoadMeasure(lead=3.0, wheel="fl")
    run = Car.load().run(question().source.signal(), engine="reduced", channels=measure.channels)
    late = measure(run)
    damper = np.abs(run["damper_fl_velocity"][3000:-1])
    assert late["slip"] == pytest.approx(np.mean(damper > run.car.vehicle.damper.slip_velocity))
    assert late["lowest_load"] == np.min(run["tyre_fl_force_z"][3000:-1])
    assert late["pulling"] == 0.0
    # Parseval with an independent sum: lines of 1/8 Hz from 2 to 50 Hz, half of the two at the edges, all three axes.
    lines = [np.fft.rfft(run[f"seat_rail_acc_{axis}"][3000:-1])[16:401] for axis in "xyz"]
    power = np.sum(np.abs(lines) ** 2, axis=0)
    power[[0, -1]] *= 0.5
    assert late["unweighted"] == pytest.approx(np.sqrt(2.0 * np.sum(power)) / 8000, rel=1e-9)
    assert RoadMeasure(lead=0.0, wheel="fl")(run)["slip"] != late["slip"]


def test_histories_of_several_cars_are_those_of_their_runs(tmp_path):
    comfort = ComfortRuns(CarRuns(engine="reduced"), Records(count=1, duration=8.0, lead=3.0), tmp_path)
    soft = ("damper.coulomb_friction=62.5",)
    both = comfort.histories([(), soft], "smooth")
    run = Car.load(None, soft).run(question().source.signal(), engine="reduced", channels=["seat_rail_acc_z"])
    # Steps of 0.5 ms against 0.125 ms, single against double precision.
    np.testing.assert_allclose(both[1], run["seat_rail_acc_z"], atol=2e-3 * np.max(np.abs(both[1])))
    assert np.max(np.abs(both[1] - both[0])) > 0.1 * np.max(np.abs(both[0]))
    assert comfort.histories([soft], "smooth")[0] is both[1]


def test_a_run_that_fails_stops_the_study_with_its_reason(tmp_path):
    with pytest.raises(SimulationError, match=r"road, damper\.coulomb_friction=-5.*must be"):
        observe([question(("damper.coulomb_friction=-5",))], tmp_path)


def observation(comfort, slip=0.3):
    others = {"slip": slip, "slip_left": 0.0, "saturated": 0.5, "pulling": 0.0}
    return {
        "unweighted": comfort,
        "weighted": 0.7 * comfort,
        "gaussian_error": 0.02 * comfort,
        "lowest_load": 1000.0 * comfort,
        **others,
    }


def test_common_roads_make_the_error_of_a_ratio_small():
    level = np.array([1.0, 1.2, 0.8, 1.1])
    base = [observation(value) for value in level]
    scatter = np.array([0.01, -0.01, 0.005, -0.005])
    averaged = point(62.5, [observation(value) for value in level * (0.8 + scatter)], base)
    assert averaged.relative == pytest.approx(0.8, abs=1e-12)
    assert averaged.relative_error == pytest.approx(np.sqrt(np.sum(scatter**2) / 3 / 4))
    assert averaged.comfort_error > 10.0 * averaged.relative_error
    # Four independent records: half the error of one.
    assert averaged.gaussian_error == pytest.approx(0.02 * np.sqrt(np.sum((level * (0.8 + scatter)) ** 2)) / 4)
    assert averaged.lowest_load == pytest.approx(1000 * 0.8 * (0.8 + scatter[2]))
    assert np.isnan(standard_error([1.0]))


def made(value, relative, error=0.001):
    return dataclasses.replace(
        point(value, [observation(relative)] * 2, [observation(1.0)] * 2), relative_error=error, slip=0.3
    )


def test_rows_disagree_where_the_numbers_do():
    ends = {
        ("coulomb_friction", "smooth"): (75, 85, 100, 115, 130),
        ("coulomb_friction", "rough"): (99.0, 99.6, 100, 104, 107.5),
        ("mount_damping", "smooth"): (100, 98.5, 97.3, 95.5),
        ("mount_damping", "rough"): (100, 99.8, 99.5, 99.25),
        ("mount_stiffness", "smooth"): (108.1, 103, 100, 95, 91.9),
        ("mount_stiffness", "rough"): (109, 103, 100, 98, 96.5),
    }

    def curves(turn):
        return {
            variation.name: {
                road: [
                    made(value, turn(percent / 100.0), 1e-4)
                    for value, percent in zip(variation.values, ends[(variation.name, road)], strict=True)
                ]
                for road in ROAD_RMS
            }
            for variation in SOURCE
        }

    good, bad = curves(lambda x: x), curves(lambda x: 2.0 - x)
    assert all(claim.within for claim in (*order_claims(good), *size_claims(good)))
    assert not any(claim.within for claim in size_claims(bad))
    assert not any(claim.within for claim in order_claims(bad)[:6])
    assert len(size_claims(good)) == sum(len(values) for values in PUBLISHED.values()) == 10
    slip = {"smooth": 0.313, "rough": 0.794}
    assert all(claim.within for claim in slip_claims(shares(slip), 0.012))
    assert not any(claim.within for claim in slip_claims(shares({"smooth": 0.35, "rough": 0.75}), 0.012))


def test_an_end_that_disagrees_tells_what_experiments_changed():
    curves = {
        variation.name: {road: [made(value, 1.5, 1e-4) for value in variation.values] for road in ROAD_RMS}
        for variation in SOURCE
    }
    trials = {
        label: {(name, road, value): percent for (name, road), ends in PUBLISHED.items() for value in ends}
        for label, percent in (("edge", 75.0), ("body", 125.0))
    }
    why = {claim.name: claim.why for claim in size_claims(curves, trials)}
    first = why["relative comfort value at Fd 62.5, smooth road [%]"]
    assert "experiments: reached with edge 75; not with body 125" in first
    assert "(edge 75, body 125)" in why["relative comfort value at Fd 62.5, rough road [%]"]


def test_levels_are_windows_of_all_cars_of_a_figure(tmp_path):
    comfort = ComfortRuns(CarRuns(engine="auto"), Records(count=2, duration=30.0, lead=2.0), tmp_path)
    levels = road_levels(comfort)
    assert {road: sorted(level.largest) for road, level in levels.items()} == {
        "smooth": ["4.1", "4.5", "4.9"],
        "rough": ["4.10", "4.2"],
    }
    assert all(values.size == 120 for level in levels.values() for values in level.largest.values())
    # One road at two levels; the car is not linear, so its answer is not in that ratio.
    ratio = ROAD_RMS["rough"] / ROAD_RMS["smooth"]
    np.testing.assert_allclose(levels["rough"].swing, ratio * levels["smooth"].swing, rtol=1e-9)
    # More friction is in figure 4.1 only, so its largest values are above those of the nominal car in every window.
    smooth, friction = levels["smooth"], ("coulomb_friction", 250.0)
    assert np.all(smooth.largest["4.1"] >= 0.0) and np.mean(smooth.largest["4.1"]) > np.mean(smooth.largest["4.5"])
    assert not smooth.apart["coulomb_friction", 125.0].any() and smooth.apart[friction].all()
    # Parseval: the PSD of the wheel has the mean square of its history, here within the ends of the windows.
    assert np.sqrt(np.sum(smooth.wheel)) == pytest.approx(3.3, rel=0.3)


def history(scale, peak):
    """A road whose rows all agree with scale 1, and whose wheel has its peak at a frequency [Hz]."""
    lines = np.arange(0.0, 51.0)
    sizes = {
        ("coulomb_friction", 62.5): 0.8, ("coulomb_friction", 125.0): 1.0, ("coulomb_friction", 250.0): 1.3,
        ("mount_damping", 0.0): 1.0, ("mount_damping", 2000.0): 0.97,
        ("mount_stiffness", 3.5e5): 1.2, ("mount_stiffness", 7e5): 1.0, ("mount_stiffness", 14e5): 0.9,
    }  # fmt: skip
    return RoadLevels(
        largest={
            figure: np.linspace(*evidence_of(f"level_{figure.replace('.', '_')}").interval, 50) for figure, *_ in LEVELS
        },
        seat_rail={key: np.full(2, size) for key, size in sizes.items()},
        apart={key: np.full(2, scale * abs(size - 1.0)) for key, size in sizes.items()},
        swing=np.linspace(2.4, 3.9, 50) * ROAD_RMS["rough"],
        frequency=lines,
        wheel=1.0 / (1.0 + ((lines - peak) / (0.1 * peak + 20.0 * (1.0 - scale))) ** 2),
    )


def test_rows_of_histories_follow_the_numbers():
    good = {"smooth": history(1.0, 24.0), "rough": history(0.5, 16.0)}
    claims = [*level_claims(good, {}), *history_claims(good), *wheel_claims(good)]
    assert {claim.within for claim in claims} == {True, None}
    assert [claim.status for claim in level_claims(good, {})][:5] == [
        status_of(f"level_{figure.replace('.', '_')}") for figure, *_ in LEVELS
    ]
    untested = [claim for claim in claims if claim.status == "not testable"]
    assert len(untested) == 3 and all(claim.within is None for claim in untested)
    turned = {"smooth": good["rough"], "rough": good["smooth"]}
    failed = [claim.name for claim in (*history_claims(turned), *wheel_claims(turned)) if claim.within is False]
    assert len(failed) == 3 and failed[-1].startswith("peak of the wheel")
    louder = {
        road: dataclasses.replace(
            road_level, largest={figure: 5.0 + values for figure, values in road_level.largest.items()}
        )
        for road, road_level in good.items()
    }
    rows = level_claims(louder, {"edge": {figure: 0.7 for figure, *_ in LEVELS}})
    assert not any(claim.within for claim in rows[:5])
    assert "reached with edge 0.7" in rows[0].why and "no modification reaches" in rows[3].why


def test_the_peak_of_a_wheel_is_that_of_a_known_resonance():
    frequency, width = wheel_peak(history(1.0, 24.0))
    # 1 / (1 + x2) falls to a half at x = 1: 2.4 Hz to either side, seen on lines 1 Hz apart.
    assert frequency == 24.0 and width == 4.0


def test_a_stiffer_mount_raises_the_wheel_mode(tmp_path):
    modes = wheel_modes(ComfortRuns(CarRuns(), Records(count=1), tmp_path))
    assert stiffness_claim(modes).within is True
    # Tyre and mount hold the wheel: with twice the stiffness of one of them it rises by less than sqrt 2.
    assert 1.0 < modes[14e5] / modes[7e5] < np.sqrt(2.0)
    assert stiffness_claim({7e5: 28.0, 14e5: 27.0}).within is False
    made_up = {"smooth": made(0.0, 1.0), "rough": made(0.0, 1.0)}
    assert amplification_claim(made_up).within is True
    louder = {"smooth": made(0.0, 1.0), "rough": dataclasses.replace(made(0.0, 1.0), comfort=6.0)}
    assert amplification_claim(louder).within is False


def shares(slip):
    """Four records of each road with a slip share, a tenth more and less at 10 % lower and higher velocities."""
    factors = {"slip": 1.0, "saturated": 1.2, "slip_less": 1.02, "slip_more": 0.98}
    return {
        road: [
            {name: factor * (value + scatter) for name, factor in factors.items()} for scatter in (-2e-3, 0, 0, 2e-3)
        ]
        for road, value in slip.items()
    }


def test_a_step_within_its_error_is_no_rise():
    assert is_monotone([made(1, 0.9), made(2, 1.0), made(3, 1.1)], rising=True)
    assert not is_monotone([made(1, 0.9), made(2, 1.0), made(3, 1.0005)], rising=True)
    assert not is_monotone([made(1, 0.9), made(2, 1.0), made(3, 1.1)], rising=False)


def test_a_single_record_tells_no_error():
    single = point(1.0, [observation(0.9)], [observation(1.0)])
    text = curve_table("Fd [N]", {"smooth": [single]})
    assert "| 1 | 90.00 ± ? |" in text


def test_one_component_of_a_bushing_varies(tmp_path):
    comfort = ComfortRuns(CarRuns(), Records(count=1), tmp_path)
    cars = comfort.cars(MOUNT_DAMPING)
    assert cars[0.0] == ()
    changed = comfort.runs.car(cars[500.0]).vehicle.table["front"]["bushings"]["suspension_mount"]["damping"]
    assert changed == [4000.0, 8000.0, 500.0]
    assert comfort.cars(FRICTION, ("body.flexible=false",))[125.0] == ("body.flexible=false",)


def test_the_options_choose_records_and_engine():
    def settings(*words: str) -> SensitivitySettings:
        return read(main.parser.parse_args(words), SensitivitySettings)

    assert settings().engine == "auto"
    assert records_of(settings("--records", "7")).count == 7
    assert records_of(settings("--quick")).duration < 60.0
    with pytest.raises(ConfigurationError, match="--records 0"):
        settings("--records", "0")
    assert chosen_engine("mujoco") == "mujoco"
    assert chosen_engine("auto") == "reduced"


class Answers(ComfortRuns):
    """Answers without runs: friction and the degressive damper make comfort worse, MuJoCo is 1 % above the other."""

    def __call__(self, cases):
        self.asked = [*getattr(self, "asked", []), *cases]
        results = []
        for case in cases:
            comfort = 4.0 if case.source.rms > 0.01 else 1.0
            comfort *= 1.2 if "damper.viscous_law=degressive" in case.overrides else 1.0
            comfort *= 1.3 if "damper.coulomb_friction=250.0" in case.overrides else 1.0
            results.append(observation(comfort * (1.01 if case.engine == "mujoco" else 1.0)))
        return results


def test_what_goes_beyond_the_source_is_asked_at_once_and_reported(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(beyond, "draw_variation", lambda path, *_, **__: drawn.append(path.name))
    comfort = Answers(CarRuns(engine="auto"), Records(count=2), tmp_path)
    asked = set(beyond.beyond_cases(comfort))
    linear = {variation.name: comfort.curves(variation) for variation in SOURCE}
    comfort.asked = []
    notes, data = beyond.beyond_findings(comfort, tmp_path, linear)
    source = {case for variation in SOURCE for case in comfort.all_cases(variation)}
    # A run that was not asked for in advance would start worker processes of its own.
    assert set(comfort.asked) <= asked | source
    assert drawn == [
        *(f"{variation.name}_degressive.png" for variation in SOURCE),
        "body_stiffness.png",
    ]
    text = "\n".join(notes)
    assert "comfort value 120.0 ± 0.00 % on the smooth road, 120.0 ± 0.00 % on the rough road" in text
    assert "| nominal | rough | 4.0400 | -0.99 | 100.00, 100.00 |" in text
    assert "| Coulomb friction Fd [N]: 250 | smooth | 1.3130 | -0.99 | 130.00, 130.00 |" in text
    degressive = data["degressive"]["coulomb_friction"]["rough"]
    assert degressive[-1]["relative"] == pytest.approx(1.3)
    assert degressive[-1]["comfort"] == pytest.approx(4.0 * 1.2 * 1.3)
