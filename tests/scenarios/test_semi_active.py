"""The study of semi-active dampers: settings, sentences on values, and the measure on a run."""

import json
from pathlib import Path

import numpy as np
import pytest

from scenarios import semi_active
from scenarios.semi_active import LEAD_S, HopMeasure, Setting, main, settings
from vehicle.model.parameters.semi_active_damper import LAWS
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.figures.chosen_figure import ChosenFigure
from vehicle.runs.figures.run_batch import Runs
from vehicle.studies.sweeps.measure import FigureMeasure


def test_settings_cover_laws_roads_delays_and_the_passive_range():
    full, quick = settings(False), settings(True)
    assert set(quick) <= set(full) and len(full) == len(set(full)) == 9 * 7 + 6 + 3 * 4
    changed = Setting(law="skyhook", delay=20.0, factor=0.5).changes(load_vehicle(Path("focus_road")))
    assert changed == [
        "front.damper.control.law=skyhook", "front.damper.control.delay=0.02", "front.damper.viscous=1125.0",
        "rear.damper.control.law=skyhook", "rear.damper.control.delay=0.02", "rear.damper.viscous=750.0",
    ]  # fmt: skip


def made_up(runs, chosen, duration, engine):
    """Return made-up values: skyhook improves comfort, groundhook reduces tyre loads, and delay worsens both."""
    points = {}
    for setting in chosen:
        comfort = (
            {"skyhook": 0.8, "groundhook": 1.2}.get(setting.law, 1.0)
            * (1.0 + 0.01 * setting.delay)
            * setting.factor**0.2
        )
        tyre = {"skyhook": 1.1, "groundhook": 0.9}.get(setting.law, 1.0) * (1.0 + 0.01 * setting.delay)
        points[setting] = {"weighted_z": comfort, "unweighted": 2.0 * comfort, "tyre_load": 0.2 * tyre}
        points[setting] |= {"hop": 0.1 * tyre, "lowest_load": 0.3}
    return points


def test_it_says_what_its_numbers_show(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(semi_active, "computed", made_up)
    assert main(["--quick", "--output", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "2 own check (2 agree); tyres rolling at 80 km/h" in said
    text = (tmp_path / "out" / "results.md").read_text(encoding="utf-8")
    assert "-20.0 %, with a delay of 40 ms +12.0 %" in text and "-10.0 %, with a delay of 40 ms +26.0 %" in text
    assert "Groundhook changes the tyre load of the wheel hop (7 to 30 Hz) by -10.0 %, the rest by -10.0 %" in text
    points = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["points"]
    assert {point["law"] for point in points} == {"passive", *LAWS}
    assert {path.name for path in (tmp_path / "out").glob("*.png")} == {"trade_off.png"}


def test_the_hop_is_the_part_of_the_load_in_its_band():
    time = 1e-3 * np.arange(13001, dtype=np.float64)
    hop, body = np.sin(2 * np.pi * 11.0 * time), np.cos(2 * np.pi * 1.4 * time)
    channels = {"tyre_fr_force_z": (4000.0 * (1.0 + 0.25 * hop + 0.1 * body))[None]}
    runs = Runs(time=time, channels=channels, vehicles=(), tyre_load={"fr": np.array([4000.0])})
    figures = tuple((name, ChosenFigure(quantity=name)) for name in ("tyre_load", "lowest_load"))
    ride = FigureMeasure(figures=figures, channels=("tyre_fr_force_z",), skip=LEAD_S, errors=False)
    numbers = {name: values[0] for name, values in HopMeasure(ride=ride).of(runs).items()}
    assert numbers["tyre_load"] == pytest.approx(np.sqrt(0.25**2 + 0.1**2) / np.sqrt(2.0), rel=1e-3)
    assert numbers["hop"] == pytest.approx(0.25 / np.sqrt(2.0), rel=1e-3)
    assert numbers["lowest_load"] == pytest.approx(np.min((1.0 + 0.25 * hop + 0.1 * body)[3000:]), rel=1e-12)
