"""`python -m scenarios.half_car_rider` as a user runs it."""

import json
from dataclasses import fields

import numpy as np
import pytest

from scenarios.claims import PREDICTED, Claim
from scenarios.half_car_rider.__main__ import main
from scenarios.half_car_rider.claims import relative_changes
from scenarios.half_car_rider.runs import SPEEDS, TIME_STEP, VARIED, outcome, parameter_study, passive, varied
from scenarios.half_car_rider.seats import MEASURES, STIFFNESS, seats, with_experiment
from scenarios.lumped.bump_response import bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import half_car_rider, output_points
from scenarios.lumped.half_car_rider_parameters import PUBLISHED, half_car_rider_parameters
from tests.scenarios.kept_table import contradictions
from vehicle.runs.output.written_files import MARKER
from vehicle.signals.analysis.exposure import vibration_dose_value

CAR = half_car_rider_parameters()


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "half_car_rider"
    assert main(["--output", str(folder), "--quick"]) == 0
    return folder


def test_every_file_is_there_and_no_temporary_one(results):
    names = {path.name for path in results.iterdir()}
    assert {"results.md", "results.json", "speed.png", "lift_off.png", "figure_23_24_25_travel.png"} <= names
    assert {f"figure_{n:02d}.png" for n in range(5, 11)} <= names
    assert {f"figure_{n}_{n + 1}_{p}.png" for n, p in zip(range(11, 23, 2), VARIED, strict=True)} <= names
    assert not [name for name in names if name.startswith(".") and name != MARKER]


def test_rows_carry_the_agreed_keys_and_every_published_direction(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    rows = content["rows"]
    assert all(set(row) == {field.name for field in fields(Claim)} for row in rows)
    open_rows = [row["name"] for row in rows if row["within"] is None]
    assert open_rows == ["semi-active suspension: control forces uf and ur"] and all(row["why"] for row in rows)
    names = [row["name"] for row in rows]
    for label in VARIED.values():
        assert f"VDV of the upper body with {label}" in names
        assert f"VDV of the lower body with {label}" in names
    assert len(names) == len(set(names))
    text = (results / "results.md").read_text(encoding="utf-8")
    assert all(name in text for name in names)
    assert "Tyre lift-off" in text


def test_a_disagreement_says_whether_a_seat_or_a_measure_turns_it():
    def made(name, within):
        return PREDICTED.statement(name, "larger", "smaller", within, "why")

    def rows_of(car, measure=None):
        stiff = car.seat.stiffness > 1e5
        return [made("VDV a", measure is MEASURES["RMS"]), made("seat b", stiff), made("VDV c", False), made("d", True)]

    rows = with_experiment(
        [made("VDV a", False), made("seat b", False), made("VDV c", False), made("d", True)], CAR, rows_of
    )
    count = len(seats(CAR))
    assert "it holds for 0 of" in rows[0].why and "with the RMS" in rows[0].why
    assert f"it holds for {count // len(STIFFNESS)} of {count} seats of 5000 to 150000 N/m" in rows[1].why
    assert f"a contradiction of the source: with its equations and parameters it holds for none of {count} seats" in (
        rows[2].why
    )
    assert rows[2].why.endswith("and with RMS and peak in place of the dose value") and rows[3].why == "why"


def test_agreements_and_findings_of_the_shipped_car(results):
    rows = {row["name"]: row["within"] for row in json.loads((results / "results.json").read_text())["rows"]}
    for name in ("sprung mass", "suspension stiffness"):
        assert rows[f"VDV of the upper body with {name}"] is True
    assert rows["suspension travel with suspension damping"] is True
    # the correct equations contradict the source here; see the reasons in the rows
    assert rows["VDV with speed, 20 to 60 km/h"] is False
    assert rows["suspension travel with tyre stiffness"] is False
    assert rows["matrices [C] and [K] below equation 16"] is False


def test_text_and_conclusions_on_suspension_damping_both_stand(results):
    rows = {row["name"]: row for row in json.loads((results / "results.json").read_text())["rows"]}
    for limb in ("upper", "lower"):
        name = f"VDV of the {limb} body with suspension damping"
        text, conclusion = rows[name], rows[f"conclusions: {name}"]
        assert (text["published"], text["within"]) == ("little", False)
        assert (conclusion["published"], conclusion["within"]) == ("rises", True)
        assert text["ours"] == conclusion["ours"]
        changes = [float(value) for value in text["ours"].split(" %")[0].split(", ")]
        assert all(9.0 < value < 18.0 for value in changes)


def test_settling_times_are_chosen_and_say_the_band_that_the_print_needs(results):
    rows = [row for row in json.loads((results / "results.json").read_text())["rows"] if "settling time" in row["name"]]
    assert len(rows) == 11
    assert {row["status"] for row in rows} == {"chosen"}
    assert all("The printed time needs a band of" in row["why"] for row in rows)


def test_every_row_has_its_place_and_a_picture_that_is_there(results):
    rows = json.loads((results / "results.json").read_text(encoding="utf-8"))["rows"]
    assert all(row["place"] for row in rows)
    assert {row["picture"] for row in rows} - {""} <= {path.name for path in results.iterdir()}
    assert [row["name"] for row in rows if not row["picture"]] == [
        "matrices [C] and [K] below equation 16",
        "semi-active suspension: control forces uf and ur",
    ]


def test_base_case_is_tabled_for_every_point(results):
    table = json.loads((results / "results.json").read_text(encoding="utf-8"))["base_case"]
    history = passive(CAR, SPEEDS[0])
    assert set(table) == set(output_points(CAR))
    assert table["rear_body"]["acceleration"]["peak"] == pytest.approx(
        np.abs(history.acceleration("heave") + 1.45 * history.acceleration("pitch")).max(), rel=1e-12
    )
    times = table["upper_limb"]["displacement"]["settling_s"]
    assert list(times.values()) == sorted(times.values(), reverse=True)  # a wider band is reached sooner


def test_existing_results_are_not_overwritten_without_force(results, capsys):
    assert main(["--output", str(results), "--quick"]) == 2
    assert capsys.readouterr().err == (
        f"error: --output {results}: holds files; give another folder, or --force to overwrite\n"
    )


def test_bad_parameter_file_stops_before_anything_is_written(tmp_path, capsys):
    path = tmp_path / "car.toml"
    path.write_text(PUBLISHED.read_text(encoding="utf-8").replace("mass = 575.0", "mass = -575.0"), encoding="utf-8")
    assert main(["--parameters", str(path), "--output", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == "error: body.mass: found -575.0 kg, must be greater than 0.0\n"
    assert not (tmp_path / "out").exists()


def test_dose_value_does_not_depend_on_the_sampling():
    passage = bump_passage(CAR.bump, 60.0 / 3.6, 2.8)
    values = []
    for step in (TIME_STEP, 0.5 * TIME_STEP):
        history = bump_response(half_car_rider(CAR), passage, time_step=step, duration=3.0)
        values.append(vibration_dose_value(step, history.acceleration("lower_limb")))
    assert values[0] == pytest.approx(values[1], rel=1e-4)  # as the constant says


def test_study_varies_one_parameter_at_a_time():
    assert varied(CAR, "sprung_mass", 1.2).body.mass == pytest.approx(690.0)
    assert varied(CAR, "sprung_mass", 1.2).body.pitch_inertia == CAR.body.pitch_inertia
    softer = varied(CAR, "tyre_stiffness", 0.8)
    assert (softer.front.tyre_stiffness, softer.rear.tyre_stiffness) == pytest.approx((152000.0, 152000.0))
    assert softer.front.suspension_stiffness == CAR.front.suspension_stiffness


def test_study_holds_the_base_case_in_its_middle():
    study = parameter_study(CAR, [1.0])
    assert set(study) == set(VARIED)
    base = outcome(CAR, passive(CAR, SPEEDS[2]))
    for table in study.values():
        assert table[2][0] == base


def test_relative_change():
    np.testing.assert_allclose(relative_changes([[0.8, 1.0, 1.2], [2.0, 2.0, 2.0]]), [0.4, 0.0])


def test_quick_contradicts_no_verdict_of_the_full_study(results):
    assert contradictions("half_car_rider", results) == []
