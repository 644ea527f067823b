"""A small car on four rolling wheels: hubs on springs at the wheel centres, and its motion derived on paper."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]

TEMPLATE = """
mirrored = true
use = [{ template = "wheel", with = { hub = "knuckle" } }]
joint = [{ kind = "free", child = "knuckle" }]
connection = [{ name = "mount", moving = "knuckle", carrier = "body", at = "wheel_center" }]
output = [{ name = "knuckle", on = "knuckle", at = "wheel_center" }]
parts = { knuckle = { shape = "knuckle", points = ["wheel_center"] } }
"""

BODY, COG, INERTIA = 900.0, (2.1, 0.0, 0.9), (400.0, 1300.0, 1500.0)
"""Mass [kg], centre of gravity [m] and moments about it [kg m2] of the body."""

RADIUS, TRACK, AXLES = 0.3, 1.5, {"front": 0.8, "rear": 3.4}
"""Of the wheels [m]; x of the axles [m]."""

MASSES = {"knuckle": 8.0, "tyre": 16.0, "brake_disc": 5.0, "caliper": 3.0}
SPINS = {"knuckle": 0.05, "tyre": 1.0, "brake_disc": 0.05, "caliper": 0.01}
"""Mass [kg] and Iyy [kg m2] of the parts of a wheel, all of them at its centre."""

TYRE = {"slip_stiffness": 7e4, "carcass_longitudinal": 3.5e5, "carcass_lateral": 1e5, "trail": 0.0}
CORNERING = {"front": 3.2e4, "rear": 4.2e4}


def rolling_car(
    folder: Path,
    speed: float,
    *,
    gravity: float = 0.0,
    mount: Any = (2e5, 8e5, 4e4),
    turning: float = 3e4,
    damping: float = 300.0,
    inertia: float = 1.0,
    tyre: Any = None,
    cornering: Any = None,
    vertical: float = 2e5,
    overrides: Iterable[str] = (),
) -> Car:
    """The car.

    Args:
        folder: for its template.
        speed: V [m/s].
        gravity: [m/s2]; without it nothing has a preload.
        mount: stiffness of the springs between hubs and body [N/m].
        turning: their stiffness against rotation [N m/rad].
        damping: of the mounts, along each axis [N s/m].
        inertia: factor on the moments of inertia of the wheels.
        tyre: numbers of the rolling tyres in place of some of `TYRE`.
        cornering: C_alpha of each axle.
        vertical: stiffness of the tyres [N/m].
        overrides: texts "path=value".
    """
    from vehicle.model.parameters.paths import override

    (folder / "corner.toml").write_text(TEMPLATE)
    table: dict[str, Any] = {
        "name": "small_car",
        "gravity": gravity,
        "solver": {"record_rate": 1000.0, "timestep": 0.001},
        "driving": {"speed": speed},
        "body": {
            "mass": BODY,
            "cog": list(COG),
            "inertia": dict(zip(("ixx", "iyy", "izz"), INERTIA, strict=True)),
            "flexible": False,
            "attachment_flexibility": False,
        },
        "hardpoints": {"seat_rail": [2.0, -0.4, 1.0]},
        "outputs": {"seat_rail": {"on": "body", "at": "seat_rail"}},
    }
    for axle, position in AXLES.items():
        stiffness = {"knuckle": 0.6, "tyre": 0.55, "brake_disc": 0.6, "caliper": 0.6}
        parts = {
            name: {
                "mass": mass,
                "inertia": [inertia * stiffness[name] * SPINS[name], inertia * SPINS[name],
                            inertia * stiffness[name] * SPINS[name]],
                "offset": [0.0, 0.0, 0.0],
            }
            for name, mass in MASSES.items()
        }  # fmt: skip
        numbers = {**TYRE, "cornering_stiffness": (cornering or CORNERING)[axle], **(tyre or {})}
        table[axle] = {
            "template": "corner",
            "hardpoints": {"wheel_center": [position, TRACK / 2, RADIUS], "tyre_patch": [position, TRACK / 2, 0.0]},
            "parts": parts,
            "bushings": {
                "tyre": {"stiffness": [1e5, 1e5, vertical], "damping": [0.0, 0.0, 200.0], "rotational_stiffness": 0.0,
                         **numbers},
                "mount": {"stiffness": list(mount), "damping": 3 * [damping], "rotational_stiffness": turning},
            },
        }  # fmt: skip
    return Car(vehicle_of(override(table, list(overrides), lambda: ["driving.hold_frequency"]), folder), folder=folder)


def pitch_plane(speed: float, hold: Vector, mount: Any = (2e5, 8e5, 4e4), turning: float = 3e4) -> Vector:
    """State matrix of the motions that are alike on both sides, derived on paper, without preloads.

    x, z, theta of the body; of each axle x, z of the wheel centres, phi of the hubs, alpha of the wheels (absolute),
    and the slip force f with f' = k (x' - R alpha') - f V k / C; the wheel feels -f along x and +R f about y.

    Args:
        speed: V [m/s].
        hold: stiffness and damping of the hold along x.
        mount, turning: see `rolling_car`.
    """
    kx, _, kz = mount
    damping = 300.0
    size = 3 + 4 * len(AXLES)
    mass, stiffness, drag = np.zeros(size), np.zeros((size, size)), np.zeros((size, size))
    mass[:3] = BODY, BODY, INERTIA[1]
    stiffness[0, 0], drag[0, 0] = hold
    slips = []
    for number, position in enumerate(AXLES.values()):
        x, z, phi, alpha = range(3 + 4 * number, 7 + 4 * number)
        whole = sum(MASSES.values())
        mass[[x, z]] = 2.0 * whole
        mass[phi] = 2.0 * (SPINS["knuckle"] + SPINS["caliper"])
        mass[alpha] = 2.0 * (SPINS["tyre"] + SPINS["brake_disc"])
        along, up, turn = np.zeros(size), np.zeros(size), np.zeros(size)
        # A point r of the body moves by theta x r: z along x, -x along z.
        along[[x, 0, 2]] = 1.0, -1.0, -(RADIUS - COG[2])
        up[[z, 1, 2]] = 1.0, -1.0, position - COG[0]
        turn[[phi, 2]] = 1.0, -1.0
        stiffness += 2.0 * (kx * np.outer(along, along) + kz * np.outer(up, up) + turning * np.outer(turn, turn))
        drag += 2.0 * damping * (np.outer(along, along) + np.outer(up, up))
        stiffness[z, z] += 2.0 * 2e5
        drag[z, z] += 2.0 * 200.0
        slip = np.zeros(size)
        slip[[x, alpha]] = 1.0, -RADIUS
        slips.append(slip)
    rows = np.array(slips)
    state = np.zeros((2 * size + len(rows), 2 * size + len(rows)))
    state[:size, size : 2 * size] = np.eye(size)
    state[size : 2 * size] = np.hstack([-stiffness, -drag, -2.0 * rows.T]) / mass[:, None]
    state[2 * size :, size : 2 * size] = TYRE["carcass_longitudinal"] * rows
    state[2 * size :, 2 * size :] = -np.eye(len(rows)) * speed * TYRE["carcass_longitudinal"] / TYRE["slip_stiffness"]
    return state


def single_track(
    speed: float, mass: float, turned: float, cog: float, hold: Vector, axles: Any, trail: float
) -> Vector:
    """State matrix of the single-track car in y, psi, v, r: F = -C (v + V psi + x r)/V of each axle, at x + trail.

    Args:
        speed: V [m/s].
        mass, turned: of the car [kg], about z through its centre of gravity [kg m2].
        cog: x of the centre of gravity [m].
        hold: k and c along y at the front axle, k and c in yaw.
        axles: x [m] and C of both wheels [N/rad] of each.
        trail: [m].
    """
    stiffness, damping = np.zeros((2, 2)), np.zeros((2, 2))
    for position, cornering in axles:
        arm = position - cog
        felt = np.array([1.0, arm + trail])
        stiffness += np.outer(felt, [0.0, cornering])
        damping += np.outer(felt, [1.0, arm]) * cornering / speed
    ahead = np.array([1.0, axles[0][0] - cog])
    stiffness += hold[0] * np.outer(ahead, ahead) + np.diag([0.0, hold[2]])
    damping += hold[1] * np.outer(ahead, ahead) + np.diag([0.0, hold[3]])
    inverse = np.diag([1.0 / mass, 1.0 / turned])
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]])
