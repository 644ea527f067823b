"""`python -m vehicle body compare`: a body against itself with other frequencies and another order of modes."""

import csv
import dataclasses

import numpy as np
import pytest

from vehicle.commands.body import main
from vehicle.commands.body.compare_bodies import FILES
from vehicle.model.flexbody.superelement_file import write_superelement
from vehicle.runs.comparison import pictures


@pytest.fixture(scope="module")
def files(car, tmp_path_factory):
    """The body, and one whose second and third mode changed places, 4 and 2 % below the third."""
    folder = tmp_path_factory.mktemp("bodies")
    body = car.trimmed_body
    order = np.arange(len(body.frequencies))
    order[[1, 2]] = 2, 1
    frequencies = body.frequencies.copy()
    frequencies[[1, 2]] = body.frequencies[2] * 0.96, body.frequencies[2] * 0.98
    other = dataclasses.replace(
        body,
        frequencies=frequencies,
        shapes=-body.shapes[order],  # the sign of a shape means nothing
        damping_ratio=body.damping_ratio[order],
        mode_names=tuple(body.mode_names[i] for i in order),
    )
    for name, model in (("one.toml", body), ("other.toml", other)):
        write_superelement(folder / name, model)
    return folder / "one.toml", folder / "other.toml", body, other


def test_crossed_modes_are_found_by_their_shape(files, tmp_path, capsys, monkeypatch):
    one, other, body, changed = files
    drawn = []
    draw = pictures.plot_mac

    def keep(path, tables, caption):
        drawn.append((tables, caption))
        draw(path, tables, caption)

    monkeypatch.setattr(pictures, "plot_mac", keep)
    folder = tmp_path / "out"
    assert main(["compare", str(one), str(other), "--output", str(folder)]) == 0
    rows = [line.replace("%", "").split() for line in capsys.readouterr().out.splitlines()[1:]]
    assert [(int(row[0]), int(row[2])) for row in rows[:4]] == [(1, 1), (2, 3), (3, 2), (4, 4)]
    assert {row[5] for row in rows} == {"1.000"}
    change = 100.0 * (changed.frequencies[2] / body.frequencies[1] - 1.0)
    assert float(rows[1][4]) == pytest.approx(change, abs=0.005)
    lines = (folder / FILES[0]).read_text(encoding="utf-8").splitlines()
    assert lines[0].endswith("rows: one.toml, columns: other.toml")
    table = np.array([[float(value) for value in row] for row in list(csv.reader(lines[1:]))[1:]])
    np.testing.assert_allclose(table[:, 1], body.frequencies, rtol=1e-8)
    assert table[[1, 2], [4, 3]] == pytest.approx([1.0, 1.0])
    ((_, likeness, down, across),), caption = drawn[0]
    np.testing.assert_allclose(likeness, table[:, 2:], atol=1e-6)
    assert (down, across) == (
        body.frequencies.tolist(),
        changed.frequencies.tolist(),
    ) and "points of the car" in caption
    assert (folder / FILES[1]).read_bytes()[:4] == b"\x89PNG"
