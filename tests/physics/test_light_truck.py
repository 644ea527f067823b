"""The shipped light truck: static loads by hand, ride frequencies and modes of its cab, both engines, energy."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

CHANNELS = ("seat_rail_acc_z", "seat_acc_z", "cab_floor_acc_x", "knuckle_rr_acc_z", "tyre_fr_force_z")


@pytest.fixture(scope="module")
def truck():
    return Car.load("light_truck")


def masses_by_hand(table):
    """Yield mass [kg] and centre of gravity [m] of each part of the file: mean of its points, plus its offset."""
    cab, engine = table["cab"], table["engine"]
    yield table["body"]["mass"], table["body"]["cog"]
    yield engine["parts"]["engine"]["mass"], engine["hardpoints"]["engine_cog"]
    yield cab["parts"]["cab"]["mass"], cab["hardpoints"]["cab_cog"]
    for part in table["seat"]["driver"]["parts"].values():
        yield part["mass"], table["hardpoints"]["seat_rail"]
    ends = {
        "damper_bottom": ("damper_lower", "damper_upper"), "damper_top": ("damper_lower", "damper_upper"),
        "stabilizer_half": ("stab_body", "stab_end"), "stabilizer_rod": ("stab_end", "stab_rod_top"),
    }  # fmt: skip
    for axle in (table["front"], table["rear"]):
        for name, part in axle["parts"].items():
            points = [axle["hardpoints"][point] for point in ends.get(name, ("wheel_center",))]
            centre = np.mean(points, axis=0) + part.get("offset", (0.0, 0.0, 0.0))
            for side in (1.0, -1.0):
                yield part["mass"], centre * [1.0, side, 1.0]


def test_static_loads_by_hand(truck):
    """N_r l = sum of m g (x - x_f), sum of N y = sum of m g y, sum of N = sum of m g."""
    table, loads, g = truck.vehicle.table, truck.static.tyre_load, truck.vehicle.gravity
    masses, centres = (np.array(column) for column in zip(*masses_by_hand(table), strict=True))
    weight = g * masses @ np.column_stack([np.ones(len(masses)), centres])
    x, y = ([table[axle]["hardpoints"]["tyre_patch"][k] for axle in ("front", "rear")] for k in (0, 1))
    rear = (weight[1] - weight[0] * x[0]) / (x[1] - x[0])
    validated(
        "Static equilibrium", "light_truck: loads of both axles",
        [loads["fr"] + loads["fl"], loads["rr"] + loads["rl"]],
        [weight[0] - rear, rear], rel=1e-6, unit="N", source="closed form: moments about the front axle",
    )  # fmt: skip
    moment = y[0] * (loads["fr"] - loads["fl"]) + y[1] * (loads["rr"] - loads["rl"])
    validated(
        "Static equilibrium", "light_truck: moment of the wheel loads about the middle, driver on the left", moment,
        weight[2], rel=1e-6, unit="N m", source="closed form: moments about the line x",
    )  # fmt: skip


def test_frequencies_are_those_of_a_light_truck(truck):
    data = truck.show()
    for axle, wheel in zip(data.axles, (truck.vehicle.table[name] for name in ("front", "rear")), strict=True):
        leaf, tyre = (wheel["bushings"][name]["stiffness"][2] for name in ("leaf_spring", "tyre"))
        rate = leaf * tyre / (leaf + tyre)
        # Damper mounts that twist give 3e-4 of the wheel rate.
        by_hand = np.sqrt(2.0 * rate / axle.sprung_kg) / (2.0 * np.pi)
        assert 1.5 < by_hand < 2.5
        assert axle.ride_frequency_hz == pytest.approx(by_hand, rel=1e-3)
    hop = [figure.frequency_hz for figure in data.figures if "hop" in figure.motion and figure.dampers == "sliding"]
    assert len(hop) == 2 and all(10.0 < frequency < 13.0 for frequency in hop)
    for motion in ("cab heave (z)", "cab pitch (Ry)"):
        mode = max(truck.modes("sliding"), key=lambda mode: mode.motions.get(motion, 0.0))
        assert mode.description.startswith(motion) and 2.0 < mode.frequency < 4.0


ROADS = {"class B": Road("B", 60, duration=5, period="record"), "cleat": Road("cleat:20x50", 40, duration=3.5)}


@pytest.mark.parametrize("road", ROADS)
def test_both_engines_and_energy(truck, road):
    stepped, run = (truck.run(ROADS[road], engine=engine, channels=CHANNELS) for engine in ("mujoco", "reduced"))
    errors = run.recording.statistics.errors
    ratios = np.array([np.std(run[each]) / np.std(stepped[each]) - errors.get(each, 0.0) for each in CHANNELS])
    validated(
        "Reduced engine", f"light_truck, {road}: RMS of cab, seat, knuckle and tyre over MuJoCo, less the stated error",
        ratios, 1.0, abs=2e-3, source="second derivation: time integration in MuJoCo",
    )  # fmt: skip
    energies = stepped.recording.statistics.energies
    assert energies is not None
    # Tyres that leave the plate on the cleat take 4e-4, all else 1e-4.
    validated(
        "Bushings, springs and stops", f"light_truck, {road}: work, less stored and dissipated energy",
        energies.residual, 0.0, abs=1e-3, source="conservation: energy balance",
    )  # fmt: skip
