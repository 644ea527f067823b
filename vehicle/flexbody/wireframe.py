"""The wireframe of the trimmed body: 43 nodes and the members between them, an estate car standing on the rig.

The thesis publishes the number of nodes only. Interface and output points are the assumed hardpoints of the car; the
other nodes follow the joints of a body in white (sills, pillars, roof rails, rear rails) of a compact estate 4.4 m
long. Both sides are the same but for the engine mounts and the driver's seat. Member groups are the beams that real
bodies have, plus crossed struts for what sheet metal and bonded glass add in shear; doors hang on hinges and seals and
are mass at the belt of the B pillar. `require_nodes` compares the interface points with the hardpoints of the car that
is assembled.
"""

from __future__ import annotations

import numpy as np

from vehicle.flexbody.beam import FloatArray

Point = tuple[float, float, float]

_PAIRS: dict[str, Point] = {  # right side (y > 0); the left is mirrored
    # interface points: assumed hardpoints of the suspension and the rear rubber blocks
    "arm_front": (0.842, 0.365, 0.605),
    "arm_rear": (1.135, 0.385, 0.600),
    "strut_top": (0.877, 0.548, 1.230),
    "tie_inner": (0.985, 0.335, 0.660),
    "stab_body": (1.100, 0.330, 0.655),
    "rear_support": (3.465, 0.500, 0.720),
    # body shell: assumed
    "rail_front": (0.150, 0.520, 0.820),
    "cowl": (1.330, 0.580, 1.270),
    "sill_front": (1.430, 0.700, 0.640),
    "sill_middle": (2.300, 0.720, 0.620),
    "sill_rear": (3.020, 0.700, 0.660),
    "a_pillar_top": (1.980, 0.580, 1.780),
    "b_pillar_top": (2.450, 0.540, 1.860),
    "b_pillar_belt": (2.450, 0.660, 1.200),  # carries the doors
    "c_pillar_belt": (3.400, 0.580, 1.270),
    "d_pillar_belt": (4.230, 0.600, 1.270),
    "rear_end": (4.380, 0.520, 0.830),
}
_CENTRE: dict[str, Point] = {
    # interface and output points: assumed hardpoints
    "hydromount": (0.800, 0.440, 1.100),
    "linear_mount": (0.800, -0.420, 1.020),
    "bottom_body": (1.130, 0.000, 0.620),
    "seat_rail": (2.050, -0.370, 0.700),
    "seat": (2.150, -0.370, 0.850),
    "roof_left_rear": (3.900, -0.500, 1.850),
    "body_front": (0.450, 0.000, 0.950),
    # body shell: assumed
    "roof_right_rear": (3.900, 0.500, 1.850),
    "seat_rail_right": (2.050, 0.370, 0.700),
}
_WHEEL_SIDES = ("arm_front", "arm_rear", "strut_top", "tie_inner", "stab_body")  # named by wheel, the rest by side


def side_names(pair: str) -> tuple[str, str]:
    """Names of the right and the left node of a pair: `_fr`, `_fl` at the wheels, `_right`, `_left` elsewhere."""
    right, left = ("fr", "fl") if pair in _WHEEL_SIDES else ("right", "left")
    return f"{pair}_{right}", f"{pair}_{left}"


def node_positions() -> dict[str, FloatArray]:
    """Position of every node [m], vehicle frame, in the order of the data file."""
    nodes: dict[str, FloatArray] = {}
    for pair, point in _PAIRS.items():
        right, left = side_names(pair)
        nodes[right] = np.array(point)
        nodes[left] = np.array(point) * (1.0, -1.0, 1.0)
    return nodes | {name: np.array(point) for name, point in _CENTRE.items()}


# Members: "a-b" joins two pairs on each side, "a=b" crosses from each side of a to the other side of b, "a" alone joins
# its own two sides; a name of _CENTRE is one node. A name with its side given stands for that node only.
MEMBERS: dict[str, tuple[str, ...]] = {
    "front rails": ("rail_front-arm_front", "rail_front-strut_top", "arm_rear-sill_front", "rail_front-body_front"),
    "rail bumper": ("rail_front",),
    "strut towers": ("strut_top-arm_front", "strut_top-cowl", "strut_top-arm_rear", "cowl-arm_rear"),
    "subframe": (
        "arm_front-tie_inner",
        "tie_inner-stab_body",
        "stab_body-arm_rear",
        "stab_body-bottom_body",
        "arm_rear-bottom_body",
        "tie_inner-bottom_body",
        "arm_front-bottom_body",
        "arm_front",
    ),
    "engine mounts": (
        "hydromount-strut_top_fr",
        "hydromount-arm_front_fr",
        "hydromount-rail_front_right",
        "linear_mount-strut_top_fl",
        "linear_mount-arm_front_fl",
        "linear_mount-rail_front_left",
    ),
    "sills": ("sill_front-sill_middle", "sill_middle-sill_rear", "sill_rear-rear_support"),
    "hinge pillars": ("cowl-sill_front",),
    "a pillars": ("cowl-a_pillar_top",),
    "centre pillars": ("sill_middle-b_pillar_belt", "b_pillar_belt-b_pillar_top"),
    "rear pillars": (
        "sill_rear-c_pillar_belt",
        "c_pillar_belt_right-roof_right_rear",
        "c_pillar_belt_left-roof_left_rear",
    ),
    "roof rails": (
        "a_pillar_top-b_pillar_top",
        "b_pillar_top_right-roof_right_rear",
        "b_pillar_top_left-roof_left_rear",
    ),
    "roof bows": ("a_pillar_top", "b_pillar_top", "roof_left_rear-roof_right_rear"),
    "cowl": ("cowl",),
    "floor": (
        "seat_rail-sill_front_left",
        "seat_rail_right-sill_front_right",
        "seat_rail-rear_support_left",
        "seat_rail_right-rear_support_right",
        "rear_support",
    ),
    "tunnel": (
        "bottom_body-seat_rail",
        "bottom_body-seat_rail_right",
        "seat_rail-sill_rear_left",
        "seat_rail_right-sill_rear_right",
    ),
    "seat cross members": (
        "seat_rail-seat_rail_right",
        "seat_rail-sill_middle_left",
        "seat_rail_right-sill_middle_right",
    ),
    "floor cross members": ("sill_rear",),
    "rear rails": ("rear_support-rear_end", "rear_end"),
    "wheelhouses": ("rear_support-c_pillar_belt",),
    "rear seat back": ("c_pillar_belt", "c_pillar_belt=rear_support"),
    "rear frame": (
        "c_pillar_belt-d_pillar_belt",
        "d_pillar_belt-rear_end",
        "d_pillar_belt_right-roof_right_rear",
        "d_pillar_belt_left-roof_left_rear",
    ),
    "tailgate": ("d_pillar_belt",),
    "seat frame": ("seat-seat_rail",),
    "roof skin": (
        "a_pillar_top=b_pillar_top",
        "b_pillar_top_right-roof_left_rear",
        "b_pillar_top_left-roof_right_rear",
    ),
    "windscreen": ("cowl=a_pillar_top",),
    "firewall": ("cowl=sill_front", "cowl-bottom_body"),
    "floor skin": ("sill_rear=rear_support", "rear_support=rear_end"),
    "front floor skin": (
        "seat_rail-sill_rear_right",
        "seat_rail_right-sill_rear_left",
        "seat_rail-sill_front_right",
        "seat_rail_right-sill_front_left",
    ),
    "wings": ("rail_front-cowl",),
    "quarter panels": (
        "b_pillar_top-c_pillar_belt",
        "c_pillar_belt-rear_end",
        "rear_support-d_pillar_belt",
        "roof_right_rear-rear_end_right",
        "roof_left_rear-rear_end_left",
    ),
    "tailgate skin": (
        "d_pillar_belt_right-roof_left_rear",
        "d_pillar_belt_left-roof_right_rear",
        "d_pillar_belt=rear_end",
    ),
}


def member_ends(group: str) -> list[tuple[str, str]]:
    """End nodes of every member of a group."""
    ends: list[tuple[str, str]] = []
    for member in MEMBERS[group]:
        crossed = "=" in member
        names = member.replace("=", "-").split("-")
        if len(names) == 1:
            ends.append(side_names(names[0]))
            continue
        first, second = (side_names(name) if name in _PAIRS else (name, name) for name in names)
        if crossed:
            second = (second[1], second[0])
        for pair in zip(first, second, strict=True):
            if pair not in ends:
                ends.append(pair)
    return ends
