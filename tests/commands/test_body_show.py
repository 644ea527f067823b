"""`python -m vehicle body show`: tables, files, and a model that is not the body of the vehicle file."""

import csv
import json
import tomllib

import numpy as np
import pytest

from vehicle.commands.body import main
from vehicle.drawing.rendering.body_plot import plot_body
from vehicle.model.flexbody.mass_difference import mass_difference, vehicle_lines
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.runs.output.run_files import summarise
from vehicle.signals.excitation.signal import Signal

STORED, IMPROVED = "body.superelement=trimmed_body.toml", "body.inertia.ixx=1200"


def rows_of(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_tables_and_files(car, tmp_path, capsys):
    folder = tmp_path / "out"
    assert main(["show", "--output", str(folder)]) == 0
    printed = capsys.readouterr().out
    body = car.trimmed_body
    assert "\ncompared with the car focus; --vehicle chooses another\n" in printed
    assert "mass [kg]              813.00     813.00       +0.00" in printed
    # Ixz is the integral of xz dm, the opposite of the element of the tensor.
    (products,) = (line.split()[3] for line in printed.splitlines() if line.startswith("Ixz [kg m2]"))
    assert products != "0.0" and float(products) == pytest.approx(-body.inertia[0, 2], abs=0.06)
    assert "   2   25.500   3.00 %  torsion" in printed and "-0.0" not in printed
    assert "two different bodies" not in printed  # the frame has the mass properties of its vehicle
    modes, attachments, residuals = (rows_of(folder / f"{name}.csv") for name in ("modes", "attachments", "residuals"))
    assert [float(row["frequency [Hz]"]) for row in modes] == pytest.approx(body.frequencies.tolist(), rel=1e-8)
    level = np.array([[float(row[f"mode_{n + 1} [-]"]) for n in range(9)] for row in attachments]).reshape(-1, 3, 9)
    names = [row["attachment"] for row in attachments[::3]]
    # Against its mean in the body: of all nodes, weighed with their masses, the mean square is 1.
    weighed = np.einsum("mni,mni,n->m", body.shapes, body.shapes, body.node_mass)
    assert weighed == pytest.approx(np.ones(9), abs=1e-6)
    rail = names.index("seat_rail")
    assert level[rail] == pytest.approx(np.sqrt(813.0) * body.shape_at("seat_rail"), rel=1e-5, abs=1e-6)
    assert f"  {'seat_rail':<28}" + "".join(f"{one:>6.2f}" for one in np.linalg.norm(level[rail], axis=0)) in printed
    assert {row["attachment"]: float(row["zz [m/N]"]) for row in residuals} == pytest.approx(
        {name: own[2, 2] for name, own in body.residual.items()}, rel=1e-5
    )
    assert (folder / "shapes.png").read_bytes()[:4] == b"\x89PNG"


def test_a_quiet_task_writes_its_file_only(tmp_path, capsys):
    assert main(["build", "--quiet", "--output", str(tmp_path / "frame.npz")]) == 0
    assert capsys.readouterr().out == "" and (tmp_path / "frame.npz").is_file()


def test_json_is_the_model_in_numbers(capsys):
    assert main(["show", "--json", "--set", STORED, "--set", IMPROVED, "--set", "body.mass=823"]) == 0
    # The stored file: a frame that is computed has the round-off of the library at hand.
    found, body = json.loads(capsys.readouterr().out), Car.load(overrides=[STORED]).trimmed_body
    assert (found["mass_kg"], found["vehicle"]["mass_kg"]) == (pytest.approx(body.mass), 823.0)
    assert found["inertia_kgm2"] == pytest.approx(body.inertia) and len(found["notices"]) == 1
    assert [one["frequency_hz"] for one in found["modes"]] == body.frequencies.tolist()
    level = np.sqrt(body.mass) * np.linalg.norm(body.shape_at("seat_rail"), axis=0)
    assert found["participation"]["seat_rail"] == pytest.approx(level)
    assert found["residual_m_per_n"].keys() == body.residual.keys() and found["on_this_car"]
    assert not set(found["without_residual"]) & set(body.residual)


def test_a_model_of_another_mass_is_named_in_every_run(capsys):
    car = Car.load(overrides=[STORED, IMPROVED, "body.mass=823"])
    said = mass_difference(car.trimmed_body, car.vehicle.body)
    assert len(said) == 1 and said[0].startswith("body model trimmed_body: 813.0 kg with the CoG at [2.157, 0.000, 1.0")
    signal = Signal(time=np.arange(0.0, 0.2, 1e-3), displacement={"fr": 1e-5 * np.sin(np.arange(200.0))})
    run = car.run(signal, engine="reduced")
    assert said[0] in summarise(run, (), {})["notices"]
    assert main(["show", "--set", STORED, "--set", IMPROVED, "--set", "body.cog.z=1.035"]) == 0
    printed = capsys.readouterr().out
    assert "and a CoG 24 mm away" in printed
    # What it says to write is what the model has.
    lines = printed.partition("lines for the section [body] of a vehicle file:\n")[2].splitlines()[:3]
    table = tomllib.loads("\n".join(lines))
    table |= {f"inertia.{key}": value for key, value in table.pop("inertia").items()} | {"inertia.about": "cog"}
    mended = Car.load(overrides=[STORED, *(f"body.{key}={value}" for key, value in table.items())])
    own, model = rigid_body(mended.vehicle.body), mended.trimmed_body
    assert own.inertia == pytest.approx(model.inertia, abs=0.05)
    assert not mass_difference(model, mended.vehicle.body) and vehicle_lines(model)[0] == "mass = 813"


@pytest.mark.parametrize(("change", "said"), [("body.mass=820", 0), ("body.mass=822", 1), ("body.cog.z=1.03", 0)])
def test_what_scales_cannot_tell_is_not_said(change, said):
    vehicle = load_vehicle(None, [STORED, change])
    assert len(mass_difference(Car.load(overrides=[STORED]).trimmed_body, vehicle.body)) == said


def test_a_rigid_body_says_nothing():
    vehicle = load_vehicle(None, [STORED, "body.mass=900", "body.flexible=false"])
    assert mass_difference(Car.load(overrides=[STORED]).trimmed_body, vehicle.body) == []


def test_a_body_without_lines_is_a_picture_of_dots(car, tmp_path):
    body = car.trimmed_body
    none = np.zeros((0, 2), dtype=int)
    plot_body(tmp_path / "dots.png", body.positions, none, body.shapes[:1], ["mode"], np.arange(3), "dots", "")
    assert (tmp_path / "dots.png").stat().st_size > 5000
