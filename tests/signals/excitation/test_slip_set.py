from itertools import pairwise

from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.excitation.slip_set import CHOSEN, OTHERS, sets_text


def test_the_car_and_the_declared_set_agree():
    assert load_vehicle().damper.slip_velocity == CHOSEN.slip_velocity


def test_a_faster_slip_velocity_needs_higher_edges_and_the_text_names_every_set():
    sets = sorted((CHOSEN, *OTHERS), key=lambda one: one.slip_velocity)
    for slow, fast in pairwise(sets):
        assert fast.shaker_edge_hz >= slow.shaker_edge_hz
        assert fast.road_edge_hz >= slow.road_edge_hz
    assert sets[-1].road_edge_hz > sets[0].road_edge_hz and sets[-1].shaker_edge_hz > sets[0].shaker_edge_hz
    assert max(one.log_likelihood for one in sets) - CHOSEN.log_likelihood < 1.0, "no worse than a bare mention"
    assert all(one.text() in sets_text() for one in sets)
