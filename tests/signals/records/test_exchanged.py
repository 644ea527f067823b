"""Exchanged channels are found by what they move like, whatever their signs and delays."""

import numpy as np
import pytest

from tests.benchmarks.record_alignment import made_pair
from vehicle.signals.formats.table import Record
from vehicle.signals.records.exchanged import exchange_finding, exchanged_histories, put_right

STEP = 1e-3
NAMES = ("knuckle_fl_acc_z", "knuckle_fr_acc_z", "seat_acc_z")


def record(channels):
    count = next(iter(channels.values())).size
    return Record(time=STEP * np.arange(count), channels=channels, units=dict.fromkeys(channels, "m/s2"))


def curves(alike=0.0):
    common = made_pair(20.0, 0.0, 0.0, band=(1.0, 30.0), seed=50)[0]
    own = [made_pair(20.0, 0.0, 0.0, band=(1.0, 30.0), seed=seed)[0] for seed in range(len(NAMES))]
    return [alike * common + np.sqrt(1.0 - alike**2) * each for each in own]


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 0, 2), (2, 1, 0), (1, 2, 0)])
def test_every_permutation_is_put_right(order):
    noise, simulated = np.random.default_rng(3), record(dict(zip(NAMES, curves(), strict=True)))
    signs, lags = (1.0, -1.0, 1.0), (0, 12, 40)
    measured = record(
        {
            name: signs[at] * np.roll(curves()[at], lags[at]) + 0.1 * noise.standard_normal(20_000)
            for name, at in zip(NAMES, order, strict=True)
        }
    )
    exchanged = exchanged_histories(measured, simulated, measured.time)
    assert exchanged == {name: NAMES[at] for name, at in zip(NAMES, order, strict=True) if name != NAMES[at]}
    right = put_right(measured, exchanged)
    for name, at in zip(NAMES, range(3), strict=True):
        assert np.corrcoef(right.channels[name], signs[at] * np.roll(curves()[at], lags[at]))[0, 1] > 0.9


def test_channels_that_move_alike_are_not_exchanged():
    """In heave both sides are equal, and a wrong car makes neither of them fit better."""
    first, second, third = curves(alike=0.99)
    simulated = record(dict(zip(NAMES, (first, second, third), strict=True)))
    measured = record(dict(zip(NAMES, (second, first, third), strict=True)))
    assert exchanged_histories(measured, simulated, measured.time) == {}


def test_options_name_two_channels_or_all():
    mapped = {"a": "1", "b": "2", "c": "3"}
    (finding,) = exchange_finding({"a": "b", "b": "a"}, mapped, complete=False)
    assert finding.options == ("--map", "b=1", "--map", "a=2") and finding.startswith("swapped channels: ")
    (finding,) = exchange_finding({"a": "b", "b": "a"}, mapped, complete=True)
    assert finding.options == ("--map", "a=2", "--map", "b=1", "--map", "c=3")


def test_a_role_keeps_its_plate_and_a_run_has_no_channels_in_a_file():
    swap = {"seat_acc_x": "seat_acc_z", "seat_acc_z": "seat_acc_x"}
    mapped = {"seat_acc_x/plate_fl": "1", "seat_acc_z/plate_fl": "2"}
    (finding,) = exchange_finding(swap, mapped, complete=False)
    assert finding.options == ("--map", "seat_acc_z/plate_fl=1", "--map", "seat_acc_x/plate_fl=2")
    assert exchange_finding(swap, {}, complete=False) == []


def test_exchanged_plates_are_not_blamed_on_the_other_channels():
    """All knuckles move like those of the other side: it may be the plates, and no option is accepted."""
    mapped = {f"plate_{wheel}_displacement": f"P{wheel}" for wheel in ("fl", "fr", "rl", "rr")}
    mapped |= {f"knuckle_{wheel}_acc_z": f"K{wheel}" for wheel in ("fl", "fr", "rl", "rr")} | {"seat_acc_z": "S"}
    front = {"knuckle_fl_acc_z": "knuckle_fr_acc_z", "knuckle_fr_acc_z": "knuckle_fl_acc_z"}
    rear = {"knuckle_rl_acc_z": "knuckle_rr_acc_z", "knuckle_rr_acc_z": "knuckle_rl_acc_z"}
    (finding,) = exchange_finding(front | rear, mapped, complete=False)
    assert "plates or all other channels" in finding and finding.options == ()
    assert "--map plate_fl_displacement=Pfr" in finding and "--map knuckle_fl_acc_z=Kfr" in finding
    (finding,) = exchange_finding(front, mapped, complete=False)
    assert finding.options == ("--map", "knuckle_fr_acc_z=Kfl", "--map", "knuckle_fl_acc_z=Kfr")
    seat = {"knuckle_fl_acc_z": "seat_acc_z", "seat_acc_z": "knuckle_fl_acc_z"}
    (finding,) = exchange_finding(seat, {"knuckle_fl_acc_z": "1", "seat_acc_z": "2"}, complete=False)
    assert finding.options == ("--map", "seat_acc_z=1", "--map", "knuckle_fl_acc_z=2")
