"""Sobol indices of the comfort of a car: command and Python against the indices of the written table."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.studies.sweeps.sweep_samples import rows_of
from vehicle import Car, DataError, sobol
from vehicle.commands.sweep import main
from vehicle.model.parameters.ranges import Range
from vehicle.signals.excitation.signal_file import write_signal
from vehicle.studies.sweeps.indices import sobol_indices
from vehicle.studies.sweeps.sobol_sweep import SobolSample, comfort_indices, index_lines
from vehicle.studies.sweeps.sweep_settings import SweepSettings

BOUNDS = {"damper.viscous": (1500.0, 3000.0), "damper.coulomb_friction": (50.0, 250.0)}
RANGES = [Range(path=path, low=low, high=high) for path, (low, high) in BOUNDS.items()]


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    place = tmp_path_factory.mktemp("roads")
    paths = [place / "one.csv", place / "two.csv"]
    for seed, path in enumerate(paths):
        write_signal(path, random_road(rms=(2 + 4 * seed) * 1e-4, seed=seed, wheel="fl", duration=1.5), plain=True)
    return [str(path) for path in paths]


def test_command_and_python_give_the_indices_of_the_table(inputs, tmp_path, capsys):
    arguments = ["--engine", "reduced", "--skip", "0.5", "--sobol", "64", "--output", str(tmp_path / "out")]
    for file in inputs:
        arguments += ["--input", file]
    for path, (low, high) in BOUNDS.items():
        arguments += ["--vary", f"{path}={low:g}:{high:g}"]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    # The mean over both inputs, each over its own mean; the inputs vary slowest in the table.
    comfort = [float(row["weighted [m/s2]"]) for row in rows_of(tmp_path / "out" / "table.csv")]
    values = np.reshape(comfort, (2, 256))
    expected = sobol_indices(RANGES, (values / values.mean(axis=1, keepdims=True)).mean(axis=0))
    written = {row["parameter"]: row for row in rows_of(tmp_path / "out" / "sobol.csv") if row["value"] == "weighted"}
    for i, path in enumerate(BOUNDS):
        row = [float(written[path][f"{name} [-]"]) for name in ("S1", "S1_95", "ST", "ST_95")]
        each = (expected.first[i], expected.first_error[i], expected.total[i], expected.total_error[i])
        assert row == pytest.approx(each, rel=1e-5)  # six digits are written
        assert f"{path:<23}  {each[0]:6.3f} {each[1]:6.3f}  {each[2]:6.3f} {each[3]:6.3f}\n" in said
    found = sobol(Car.load(), BOUNDS, inputs, base=64, engine="reduced", skip=0.5)
    assert list(found) == ["weighted", "unweighted"] and found["weighted"].paths == tuple(BOUNDS)
    assert found["weighted"].total == pytest.approx(expected.total, rel=1e-9)


def test_failed_runs_are_left_out_and_counted(inputs):
    """A table of the same form, whose comfort is known."""
    cases = SobolSample(BOUNDS, 64).plan(Car.load(), inputs, SweepSettings(engine="reduced")).cases
    values = np.array([sum(float(text.partition("=")[2]) for text in case.overrides) for case in cases])
    values[[3, 256 + 20]] = np.nan
    table: Any = SimpleNamespace(cases=cases, units={"weighted": "m/s2"}, column=lambda name: values)
    (indices,) = comfort_indices(table, RANGES).values()
    # Uniform in widths of 1500 and 200: shares of the variance are those of the squares; the third is an interval.
    exact = np.array([1500.0**2, 200.0**2]) / (1500.0**2 + 200.0**2)
    assert np.all(np.abs(indices.total - exact) < 3.0 * indices.total_error)
    assert (indices.base, indices.left_out) == (64, 2)
    assert "2 of 64 base points" in "\n".join(index_lines({"weighted": indices}))
    assert indices.contradictions == ()
    table.column = lambda name: np.ones(len(cases))
    with pytest.raises(DataError, match=r"--sobol: .* equal"):
        comfort_indices(table, RANGES)


def test_a_figure_without_change_or_value_leaves_the_others_their_indices(inputs):
    plan = SobolSample(BOUNDS, 64).plan(Car.load(), inputs[0], SweepSettings(engine="reduced"))
    values = np.array([sum(float(text.partition("=")[2]) for text in case.overrides) for case in plan.cases])
    columns = {
        "weighted": values,
        "travel": 2.0 * values,
        "order_frequency": 20.0 + 1e-9 * values,  # rounding
        "slip_share": np.zeros(len(values)),
        "first_slip": np.full(len(values), np.nan),
    }
    units = dict.fromkeys([*columns, "weighted_error"], "m/s2")
    table: Any = SimpleNamespace(cases=plan.cases, units=units, column=columns.__getitem__)
    # Figures that were asked for: the first is no sign of comfort, whose table has relative errors.
    indices = comfort_indices(table, RANGES)
    assert list(indices) == ["weighted", "travel"]
    assert indices["weighted"].total == pytest.approx(indices["travel"].total)
    assert "order_frequency, slip_share, first_slip" in plan.evaluation_of(table, "").lines[-1]
    for name, message in (("slip_share", "equal"), ("first_slip", "64 of 64 base points")):
        table.units = {name: "-"}
        with pytest.raises(DataError, match=f"--sobol: .*{message}"):
            comfort_indices(table, RANGES)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--vary", "damper.viscous=1500,2000"], "damper.viscous=1500,2000: contains values"),
        (["--vary", "damper.viscous=1500:2000", "--report"], "--report"),
        (["--vary", "damper.viscous=1500:2000", "--vary", "damper.viscous=1:2"], "damper.viscous: given twice"),
        (["--vary", "damper.viscous=1500:2000", "--sobol", "12"], "found 12, must be a power of two"),
        (["--vary", "damper.viscous=1500:2000", "--sobol", "32"], "found 32, must be at least 64"),
    ],
)
def test_refused(words, message, inputs, capsys):
    assert main(["--input", inputs[0], "--sobol", "64", *words]) == 2
    assert message in capsys.readouterr().err
