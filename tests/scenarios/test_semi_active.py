"""The study of semi-active dampers: settings, sentences on values, and the measure on a run."""

import json
from pathlib import Path

import numpy as np
import pytest

from scenarios import semi_active
from scenarios.semi_active import LEAD_S, RideMeasure, Setting, main, settings
from vehicle.model.parameters.semi_active_damper import LAWS
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.analysis.weighting import weighted_record
from vehicle.studies.sweeps.run_batch import Runs


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
        points[setting] = {"weighted": comfort, "unfiltered": 2.0 * comfort, "tyre": 0.2 * tyre, "hop": 0.1 * tyre}
        points[setting]["lowest"] = 0.3
    return points


def test_it_says_what_its_numbers_show(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(semi_active, "computed", made_up)
    assert main(["--quick", "--output", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "2 own check (2 agree); tyres rolling at 80 km/h" in said
    text = (tmp_path / "out" / "results.md").read_text(encoding="utf-8")
    assert "-20.0 %, with a delay of 40 ms +12.0 %" in text and "-10.0 %, with a delay of 40 ms +26.0 %" in text
    assert (
        "Weighted rail, road B at 80 km/h: lowest with skyhook (-20.0 % against the passive damper); the best " in text
    )
    points = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))["points"]
    assert {point["law"] for point in points} == {"passive", *LAWS}
    assert {path.name for path in (tmp_path / "out").glob("*.png")} == {"trade_off.png", "delay.png"}


def test_measure_of_sines():
    time = 1e-3 * np.arange(13001, dtype=np.float64)
    wave, sizes = np.sin(2 * np.pi * 8.0 * time), {"x": 3.0, "y": 4.0, "z": 12.0}
    channels = {f"seat_rail_acc_{axis}": (size * wave)[None] for axis, size in sizes.items()}
    hop, body = np.sin(2 * np.pi * 11.0 * time), np.cos(2 * np.pi * 1.4 * time)
    channels |= {"tyre_fr_force_z": (4000.0 * (1.0 + 0.25 * hop + 0.1 * body))[None]}
    runs = Runs(time=time, channels=channels, vehicles=(), tyre_load={"fr": np.array([4000.0])})
    numbers = {name: values[0] for name, values in RideMeasure(wheels=("fr",)).of(runs).items()}
    assert numbers["unfiltered"] == pytest.approx(13.0 / np.sqrt(2.0), rel=5e-3)
    assert numbers["tyre"] == pytest.approx(np.sqrt(0.25**2 + 0.1**2) / np.sqrt(2.0), rel=1e-3)
    assert numbers["hop"] == pytest.approx(0.25 / np.sqrt(2.0), rel=1e-3)
    assert numbers["lowest"] == pytest.approx(np.min((1.0 + 0.25 * hop + 0.1 * body)[3000:]), rel=1e-12)
    weighted = weighted_record(1e-3, runs["seat_rail_acc_z"][0], "Wk")[round(LEAD_S / 1e-3) :]
    assert numbers["weighted"] == pytest.approx(np.sqrt(np.mean(weighted**2)), rel=1e-12)
