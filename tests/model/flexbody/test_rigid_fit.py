"""Mass properties of a hung body from its accelerances: made tests of a body that is elastic, softly hung and noisy."""

import json
import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.model.flexbody.hung_body import UNIT, HungBody, channels, write_test
from tests.validation import validated
from vehicle.commands import body as command
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.inertia_tensor import components
from vehicle.model.flexbody.sources.accelerances import read_accelerances
from vehicle.model.flexbody.sources.rigid_fit import fit_rigid_body
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.formats.geometry import Geometry
from vehicle.signals.formats.uff_writer import write

LINES = np.arange(2.0, 170.0, 1.0)
FRAME = ("x,y,z", (0.0, 0.0, 0.0))


def true_values(body):
    own = body.properties
    return np.array([own.mass, *own.cog, *components(own.inertia).values()])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("hung")


@pytest.fixture(scope="module")
def engine(folder):
    """Return the accelerances of an engine with noise of 5 %, read from a file."""
    return read_accelerances(write_test(folder / "engine.uff", HungBody(), LINES), None, None, *FRAME)


def test_thirty_tests_with_noise_of_five_percent(folder):
    errors = []
    for seed in range(30):
        body = HungBody(seed=seed)
        fit = fit_rigid_body(read_accelerances(write_test(folder / "t.uff", body, LINES), None, None, *FRAME))
        errors.append([fit.values() - true_values(body), fit.errors, true_values(body)])
    off, stated, true = np.array(errors).transpose(1, 0, 2)
    apart = {
        "mass (relative)": (np.abs(off[:, 0] / true[:, 0]), 0.01),
        "centre of gravity [m]": (np.linalg.norm(off[:, 1:4], axis=1), 3e-3),
        "moments of inertia (relative)": (np.abs(off[:, 4:7] / true[:, 4:7]).max(axis=1), 0.05),
    }
    for name, (values, limit) in apart.items():
        validated(
            "Body models",
            f"27th largest error of 30 hung engines, FRFs with 5 % noise: {name}",
            float(np.sort(values)[26]),
            0.0,
            abs=limit,
            source="second derivation: point masses and springs of the made test, limits of the issue",
        )
    inside = np.abs(off) < 2.0 * stated
    assert inside.sum(axis=0).min() >= 25  # a count of 30 with probability 0.954 is 25 and more in 99 %
    validated(
        "Body models",
        "mass properties of 30 hung engines, FRFs with 5 % noise: share of 300 values within two stated errors",
        float(inside.mean()),
        0.954,
        abs=0.03,
        source="closed form: probability of two standard deviations; two standard deviations of 300 such values",
    )


def test_the_errors_contain_the_scatter_of_sensitivities(folder, engine):
    """Noise of 5 %, and sensitivities of the accelerometers that scatter by 2 %, common to all FRFs of an output."""
    outputs = np.unique([name.split("/")[0] for name in engine.names], return_inverse=True)[1]
    ratios = []
    for seed in range(20):
        gains = 1.0 + 0.02 * np.random.default_rng(seed).standard_normal(outputs.max() + 1)
        body = HungBody(seed=seed)
        data = read_accelerances(write_test(folder / "gains.uff", body, LINES), None, None, *FRAME)
        fit = fit_rigid_body(replace(data, response=data.response * gains[outputs][:, None]))
        ratios.append((fit.values() - true_values(body)) / fit.errors)
    # The RMS of 20 values with a standard deviation of 1 is below 1.4 in 99.9 %.
    rms = np.sqrt(np.mean(np.square(ratios), axis=0))
    assert rms.max() < 1.4, rms


def test_a_rigid_body_without_noise_is_exact(folder):
    body = HungBody(first_elastic=1e4, support=1.0, rubber=0.0)
    path = write_test(folder / "exact.uff", body, np.linspace(10.0, 100.0, 91), noise=0.0)
    fit = fit_rigid_body(read_accelerances(path, None, None, *FRAME))
    # Six digits of the points in the file.
    np.testing.assert_allclose(fit.values(), true_values(body), rtol=1e-4, atol=1e-4)
    assert fit.chosen.low == 10.0 and fit.chosen.above is None and fit.elastic < 1e-3


def test_support_modes_are_those_of_the_body_on_its_springs(folder):
    body = HungBody(rubber=0.05)
    fit = fit_rigid_body(read_accelerances(write_test(folder / "s.uff", body, LINES, noise=0.0), None, None, *FRAME))
    mass, stiffness = body.matrices()
    modes = np.sqrt(np.linalg.eigvalsh(stiffness.real / np.sqrt(np.outer(mass, mass)))[:6]) / (2.0 * np.pi)
    np.testing.assert_allclose(fit.support, modes, rtol=0.02)  # elastic terms of w^6 that are left


def test_axes_and_origin_of_the_test(folder, engine):
    path = folder / "engine.uff"
    turned = fit_rigid_body(read_accelerances(path, None, None, "-x,-y,z", (1.0, 0.5, 0.25)))
    plain, values = fit_rigid_body(engine).values(), turned.values()
    np.testing.assert_allclose(values[:1], plain[:1], rtol=1e-6)
    np.testing.assert_allclose(values[1:4], np.array([1.0, 0.5, 0.25]) + plain[1:4] * [-1, -1, 1], rtol=1e-5)
    np.testing.assert_allclose(values[4:], plain[4:] * [1, 1, 1, 1, -1, -1], rtol=1e-4)


def table_of(path, body, frequency, *, unit="g/N", factor=9.80665):
    """Write the FRFs of a body as a table of columns, and its points."""
    heads, columns = ["frequency [Hz]"], [frequency]
    for each in channels(body, frequency, body.accelerances(frequency, 0.05)):
        name = f"{each.place}{each.direction}/{each.reference}"
        heads += [f"{name} real [{unit}]", f"{name} imag [{unit}]"]
        columns += [each.values.real / factor, each.values.imag / factor]
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=",".join(heads), comments="", fmt="%.9g")
    points = path.with_name("points.csv")
    rows = [",".join([f"p{n + 1}", *(f"{1e3 * each:.6g}" for each in body.at[n])]) for n in range(body.points)]
    points.write_text("point,x [mm],y [mm],z [mm]\n" + "\n".join(rows) + "\n")
    return path, points


def test_a_table_in_g_per_newton_is_the_universal_file(folder, engine):
    path, points = table_of(folder / "engine.csv", HungBody(), LINES)
    fit = fit_rigid_body(read_accelerances(path, points, None, *FRAME))
    np.testing.assert_allclose(fit.values(), fit_rigid_body(engine).values(), rtol=1e-4, atol=1e-4)


def test_a_mobility_is_an_accelerance(folder, engine):
    velocity = replace(engine, response=engine.response / (2j * np.pi * engine.frequency))
    body, path = HungBody(), folder / "velocity.uff"
    rows = velocity.response.reshape(3 * body.points, len(body.inputs), -1)
    geometry = Geometry(points={f"p{n + 1}": body.at[n].tolist() for n in range(body.points)})
    write(path, channels(body, engine.frequency, rows, "(m/s)/(N)"), "velocity", geometry)
    again = read_accelerances(path, None, None, *FRAME)
    np.testing.assert_allclose(again.response, engine.response, rtol=1e-9)


def chosen(data, keep):
    """Return the accelerances whose names a function keeps."""
    rows = [index for index, name in enumerate(data.names) if keep(name)]
    names = tuple(data.names[index] for index in rows)
    return replace(
        data, response=data.response[rows], names=names, place=data.place[:, rows], along=data.along[:, rows]
    )


def flipped(data):
    """Return the accelerances with the wrong sign of a sensor."""
    sign = np.array([-1.0 if name.startswith("4+Z") else 1.0 for name in data.names])
    return replace(data, response=data.response * sign[:, None])


REFUSED = {
    "one direction of force": (lambda d: chosen(d, lambda n: n.endswith("+Z")), None, "do not determine .*izz"),
    "a single force": (lambda d: chosen(d, lambda n: n.endswith("/1+X")), None, "add forces in other directions"),
    "points on a line": (lambda d: replace(d, place=d.place * [1.0, 0.0, 0.0]), None, "do not determine"),
    "sensor with the wrong sign": (flipped, None, "the worst is 4[+]Z/"),
    "all signs wrong": (lambda d: replace(d, response=-d.response), None, "have a mass of -.* kg"),
    "elastic mode in the range": (lambda d: d, (10.0, 160.0), "contains a resonance at 153 Hz"),
    "elastic mode near the range": (lambda d: d, (10.0, 130.0), "the elastic motion is"),
    "support modes in the range": (lambda d: d, (2.0, 70.0), "contains a resonance at [234] Hz"),
    "support modes near the range": (lambda d: d, (5.5, 70.0), "begins too close to the modes of the support"),
    "undamped support": (lambda d: replace(d, response=d.response.real + 0j), (2.0, 70.0), "does not converge"),
    "few lines": (lambda d: d, (20.0, 35.0), "16 lines from 20 to 35 Hz, must be at least 20"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_frfs_of_no_determined_rigid_body_are_refused(case, engine):
    change, band, message = REFUSED[case]
    with pytest.raises(DataError, match=message):
        fit_rigid_body(change(engine), band)


def test_files_without_unit_place_or_direction_are_refused(folder):
    body, lines = HungBody(points=6), LINES[:30]
    path = write_test(folder / "bare.uff", body, lines, unit="")
    with pytest.raises(DataError, match=r"1\+X/1\+X has no unit.*--unit"):
        read_accelerances(path, None, None, *FRAME)
    assert np.isclose(
        read_accelerances(path, None, "g/N", *FRAME).response,
        9.80665 * read_accelerances(path, None, UNIT, *FRAME).response,
    ).all()
    with pytest.raises(DataError, match="must be a motion per force"):
        read_accelerances(path, None, "m/m", *FRAME)
    table, points = table_of(folder / "bare.csv", body, lines)
    with pytest.raises(DataError, match="6 points have no position: p1, p2"):
        read_accelerances(table, None, None, *FRAME)
    points.write_text("point,x,y,z\np1,1,2,3\n")
    with pytest.raises(DataError, match=r"must be point,x \[m\]"):
        read_accelerances(table, points, None, *FRAME)
    table.write_text("frequency [Hz],a real [g/N],a imag [g/N]\n" + "".join(f"{f},1,0\n" for f in range(1, 40)))
    with pytest.raises(DataError, match="no FRF between two points"):
        read_accelerances(table, None, None, *FRAME)
    with pytest.raises(ConfigurationError, match="--axes"):
        read_accelerances(path, None, UNIT, "x,y,-z", (0.0, 0.0, 0.0))


@pytest.mark.parametrize(("part", "mass"), [("engine", "engine.parts.engine.mass"), ("body", "body.mass")])
def test_the_command_writes_lines_of_a_vehicle_file(part, mass, folder, engine, tmp_path, capsys):
    piece = tmp_path / "piece.toml"
    words = ["rigid", str(folder / "engine.uff"), "--part", part, "--output", str(piece), "--json"]
    assert command.main(words) == 0
    values = {each["name"]: each["value"] for each in json.loads(capsys.readouterr().out)["properties"]}
    car = tmp_path / "car.toml"
    car.write_text(f'name = "car"\nbase = "sedan"\n{piece.read_text(encoding="utf-8")}', encoding="utf-8")
    loaded = load_vehicle(car)
    value: Any = tomllib.loads(piece.read_text(encoding="utf-8"))
    for key in mass.split("."):
        value = value[key]
    assert value == float(f"{values['mass']:.5g}")
    if part == "engine":
        engine_part = next(each for each in loaded.composition.parts if each.name == "engine")
        np.testing.assert_allclose(engine_part.cog, [values[axis] for axis in "xyz"], rtol=1e-4)
    else:
        np.testing.assert_allclose(
            [loaded.body.inertia.izx, loaded.body.mass], [values["izx"], values["mass"]], rtol=1e-4
        )
