"""Laws of mounts: against hysteresis loops and a linear solution, and fitted to noisy synthetic points."""

import tomllib

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import DataError
from vehicle.model.parameters.force_elements import Hydromount
from vehicle.model.parameters.toml_file import build
from vehicle.studies.mounts.measured_stiffness import MeasuredStiffness, read_stiffness
from vehicle.studies.mounts.mount_fit import fit_mount
from vehicle.studies.mounts.mount_laws import friction_stiffness
from vehicle.studies.mounts.mount_text import caption_of, vehicle_lines

FREQUENCY = np.array([1.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 11.0, 12.0, 14.0, 17.0, 20.0, 25.0, 30.0, 40.0, 50.0])
AMPLITUDE = np.array([0.05e-3, 0.2e-3, 1e-3])
RUBBER = {"stiffness": 2.0e5, "maxwell_stiffness": 8e4, "maxwell_damping": 900.0} | {
    "friction_force": 40.0,
    "friction_stroke": 2.5e-4,
}
HYDRAULIC = {"stiffness": 1.8e5, "damping": 180.0, "chamber_stiffness": 3.5e5, "track_mass": 60.0} | {
    "track_damping": 1100.0
}


def friction_loop(amplitude, force, stroke, points=20_000):
    """First harmonic of the friction of rubber, from its force along a closed loop after Masing's rule."""
    phase = 2.0 * np.pi * (np.arange(points) + 0.5) / points
    x, down = amplitude * np.cos(phase), phase < np.pi

    def first_loading(u):
        return force * u / (stroke + u)

    top = first_loading(amplitude)
    loop = np.where(
        down, top - 2.0 * first_loading((amplitude - x) / 2.0), -top + 2.0 * first_loading((amplitude + x) / 2.0)
    )
    return 2.0 * np.mean(loop * np.exp(-1j * phase)) / amplitude


def rubber_point(frequency, amplitude):
    """Dynamic stiffness of rubber: spring, Maxwell branch by its impedances in series, friction loop."""
    s, p = 2j * np.pi * frequency, RUBBER
    branch = 1.0 / (1.0 / p["maxwell_stiffness"] + 1.0 / (s * p["maxwell_damping"]))
    return p["stiffness"] + branch + friction_loop(amplitude, p["friction_force"], p["friction_stroke"])


def hydraulic_point(frequency, _):
    """Dynamic stiffness of a hydraulic mount: chamber and track as two unknown forces and displacements."""
    w, p = 2.0 * np.pi * frequency, HYDRAULIC
    # Unknown: displacement x of the fluid and force f of the chamber, for a unit displacement of the mount.
    matrix = np.array([[p["chamber_stiffness"], 1.0], [1j * w * p["track_damping"] - w**2 * p["track_mass"], -1.0]])
    _, force = np.linalg.solve(matrix, [p["chamber_stiffness"], 0.0])
    return force + p["stiffness"] + 1j * w * p["damping"]


def measured(point, seed):
    """Points of a law with 3 % of noise on stiffness, and 0.03 rad on the loss angle."""
    frequency, amplitude = (grid.ravel() for grid in np.meshgrid(FREQUENCY, AMPLITUDE))
    exact = np.array([point(f, a) for f, a in zip(frequency, amplitude, strict=True)])
    relative, angle = 0.03 * np.random.default_rng(seed).standard_normal((2, len(exact)))
    return MeasuredStiffness(
        frequency=frequency, amplitude=amplitude, stiffness=exact * np.exp(relative + 1j * angle)
    ), exact


@pytest.mark.parametrize("amplitude", [1e-8, 1e-5, 2.5e-4, 1e-3, 1e-2])
def test_the_friction_of_rubber_is_that_of_its_loop(amplitude):
    validated(
        "Sweeps, tuning and optimisation", f"first harmonic of the friction of rubber at {1e3 * amplitude:g} mm",
        friction_stiffness(np.array([amplitude]), 40.0, 2.5e-4)[0], friction_loop(amplitude, 40.0, 2.5e-4), rel=1e-5,
        unit="N/m", source="second derivation: force along a loop after Masing, 20 000 points",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("law", "point", "values"), [("rubber", rubber_point, RUBBER), ("hydromount", hydraulic_point, HYDRAULIC)]
)
def test_a_fit_finds_the_law_and_its_parameters_in_noise(law, point, values):
    worst, stiffness, angle = 0.0, 0.0, 0.0
    for seed in range(3):
        data, exact = measured(point, seed)
        best, other = fit_mount(data, ["rubber", "hydromount"])
        assert best.law.name == law and best.criterion < other.criterion - 10.0 and best.determined.all()
        error = np.log(best.stiffness(data.frequency, data.amplitude) / exact)
        stiffness = max(stiffness, float(np.max(np.abs(np.expm1(error.real)))))
        angle = max(angle, float(np.degrees(np.max(np.abs(error.imag)))))
        deviations = (best.values - np.array([values[name] for name in best.law.parameters])) / best.errors
        worst = max(worst, float(np.max(np.abs(deviations))))
    source = "closed form: parameters of the synthetic points, three seeds"
    subject, noisy = "Sweeps, tuning and optimisation", f"{law} fitted to 48 points with 3 % noise"
    validated(subject, f"{noisy}: largest error of the stiffness", stiffness, 0.0, abs=0.05, source=source)
    validated(subject, f"{noisy}: largest error of the loss angle", angle, 0.0, abs=3.0, unit="deg", source=source)
    validated(subject, f"{noisy}: deviation in standard errors", worst, 0.0, abs=3.0, source=source)


def test_a_parameter_that_the_points_do_not_determine_is_named():
    # One amplitude cannot separate the friction from the elastic stiffness.
    data, _ = measured(rubber_point, 0)
    chosen = data.amplitude == AMPLITUDE[2]
    (fit,) = fit_mount(MeasuredStiffness(frequency=data.frequency[chosen], amplitude=data.amplitude[chosen],
                                         stiffness=data.stiffness[chosen]), ["rubber"])  # fmt: skip
    assert not fit.determined.all()


@pytest.mark.parametrize("amplitudes", [(1e-4, 1e-3), (2e-4,)])
@pytest.mark.parametrize("maxwell_stiffness", [5e4, 0.0])
def test_parts_that_the_points_do_not_show_stay_within_the_limits_of_a_vehicle_file(amplitudes, maxwell_stiffness):
    # Without friction, and without a branch, their parameters left every range: a stroke of 1e-10 m, a spring of
    # 6e10 N/m, 5 N/m in place of 2e5 N/m at rest.
    frequency, amplitude = (grid.ravel() for grid in np.meshgrid(FREQUENCY, amplitudes))
    s = 2j * np.pi * frequency
    branch = maxwell_stiffness * 800.0 * s / (maxwell_stiffness + 800.0 * s)
    relative, angle = 0.03 * np.random.default_rng(0).standard_normal((2, len(s)))
    stiffness = (2e5 + 20.0 * s + branch) * np.exp(relative + 1j * angle)
    data = MeasuredStiffness(frequency=frequency, amplitude=amplitude, stiffness=stiffness)
    (fit,) = fit_mount(data, ["rubber"])
    law = build(Hydromount, tomllib.loads(vehicle_lines(fit, caption_of(data, "points.csv"), data)), "mount")
    assert law.tested is not None
    assert law.tested.frequency == pytest.approx((min(data.frequency), max(data.frequency)), rel=1e-3)
    assert law.tested.amplitude == pytest.approx((min(data.amplitude), max(data.amplitude)), rel=1e-3)
    assert law.stiffness[2] > 4e4 and law.friction_force[2] / law.friction_stroke[2] < 0.2 * law.stiffness[2]


HEAD = "frequency [Hz],amplitude [mm],stiffness [N/mm],loss_angle [deg]\n"
ROWS = "".join(f"{f},{a},{300 + f},{5 + f / 10}\n" for a in (0.1, 1.0) for f in (1, 5, 10, 20, 50))


def test_units_and_order_of_the_columns_are_free(tmp_path):
    plain, other = tmp_path / "a.csv", tmp_path / "b.csv"
    plain.write_text(HEAD + ROWS)
    rows = [[float(cell) for cell in row.split(",")] for row in ROWS.splitlines()]
    head = "Loss angle [rad];amplitude [um];stiffness [N/m];temperature [degC];Frequency [Hz]\n"
    other.write_text(head + "".join(f"{np.radians(d)};{1e3 * a};{1e3 * k};23;{f}\n" for f, a, k, d in rows))
    first, second = read_stiffness(plain), read_stiffness(other)
    for name in ("frequency", "amplitude", "stiffness"):
        np.testing.assert_allclose(getattr(first, name), getattr(second, name), rtol=1e-12)
    assert [round(1e3 * amplitude, 6) for amplitude, _ in first.levels()] == [0.1, 1.0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD.replace("[N/mm]", "[lbf/in]") + ROWS, r"stiffness \[N/mm\] or stiffness \[N/m\]"),
        (HEAD.replace(" [mm]", "") + ROWS, r"'amplitude': .*amplitude \[mm\]"),
        (HEAD.replace("loss_angle [deg]", "loss factor [-]") + ROWS, "no column 'loss_angle'"),
        (HEAD + ROWS.replace("5,0.1,305", "5,0.1,-305"), r"a\.csv:3: stiffness: found -305 N/mm, .*3 to 1e"),
        (HEAD.replace("N/mm", "N/m") + ROWS, r"a\.csv:2: stiffness: found 301 N/m, .*3000 to 1e"),
        (HEAD.replace("[mm]", "[m]") + ROWS, r"amplitude: found 0\.1 m, .*1e-07 to 0\.02 m"),
        (HEAD + "".join(ROWS.splitlines(keepends=True)[:6]), r"8 rows and 4 frequencies"),
        (HEAD + "".join(f"{f},{a},300,{f}\n" for a in (0.1, 1.0) for f in range(1, 6)), "'frequency' and 'loss_angle'"),
    ],
)
def test_a_bad_table_is_refused_with_the_remedy(tmp_path, text, said):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(DataError, match=said):
        read_stiffness(path)
