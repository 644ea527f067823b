"""Roll centre, swing arms, support angles and steering axis of a wheel, from its position and its velocity.

Axes: x to the rear, y to the right, z up. The wheel is locked to its carrier. Its velocity v and angular velocity w are
per unit of wheel travel, so a point at r from the wheel centre moves by v + w x r. Definitions of ISO 8855 and
SAE J670; formulas of Milliken and Milliken, Race Car Vehicle Dynamics, chapter 17.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector

FARTHEST = 1e3
"""Maximum length of a swing arm [m]; a longer one is a translation without a swing centre."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelMotion:
    """Position of a wheel and its velocity per unit of wheel travel.

    Attributes:
        side: +1 for a right wheel, -1 for a left wheel.
        centre: wheel centre [m], (3,).
        contact: point of the wheel that is on the ground [m], (3,).
        velocity: velocity of the wheel centre [m/m], (3,).
        rotation: angular velocity [rad/m], (3,).
        steering_axis: lower and upper point of the steering axis [m], (2, 3); None for a wheel that is not steered.
    """

    side: float
    centre: Vector
    contact: Vector
    velocity: Vector
    rotation: Vector
    steering_axis: Vector | None = None

    @property
    def contact_velocity(self) -> Vector:
        """Velocity of the contact point [m/m], (3,)."""
        return self.velocity + np.cross(self.rotation, self.contact - self.centre)


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelGeometry:
    """Geometry of an axle at a wheel travel; nan for a quantity that is not defined.

    Attributes:
        roll_centre_height_m: height of the roll centre above the ground [m].
        roll_centre_lateral_m: distance of the roll centre from the middle plane, to the right [m].
        front_swing_arm_m: distance from the wheel centre to the swing centre in the front view, inwards [m].
        side_swing_arm_m: the same in the side view, towards the middle of the car [m].
        side_swing_height_m: height of the swing centre of the side view above the ground [m].
        brake_support_deg: angle of the line from the contact point to that swing centre [deg]; positive if brake
            forces at the contact point oppose dive (front) or lift (rear).
        drive_support_deg: angle of the line from the wheel centre to that swing centre [deg]; positive if drive forces
            at the wheel centre oppose lift (front) or squat (rear).
        caster_deg: angle of the steering axis in the side view [deg], top to the rear positive.
        kingpin_inclination_deg: angle of the steering axis in the front view [deg], top inwards positive.
        caster_trail_m: distance from the point of the steering axis on the ground back to the contact point [m].
        scrub_radius_m: distance from that point outwards to the contact point [m].
    """

    roll_centre_height_m: float
    roll_centre_lateral_m: float
    front_swing_arm_m: float
    side_swing_arm_m: float
    side_swing_height_m: float
    brake_support_deg: float
    drive_support_deg: float
    caster_deg: float
    kingpin_inclination_deg: float
    caster_trail_m: float
    scrub_radius_m: float


def wheel_geometry(rolling: Sequence[WheelMotion], bouncing: Sequence[WheelMotion], towards: float) -> WheelGeometry:
    """Compute the geometry of the first wheel of an axle.

    Args:
        rolling: motions of both wheels, right and left, if the body rolls: opposite travel.
        bouncing: motions of both wheels for equal travel.
        towards: +1 for a front axle, -1 for a rear axle.
    """
    lateral, height = roll_centre(*rolling)
    wheel, rolled = bouncing[0], rolling[0]
    side_arm = towards * _radius(wheel.velocity[2], wheel.rotation[1])
    # v_x - w_y (z_centre - z) = 0 at the swing centre of the side view.
    rise = -wheel.velocity[0] * towards * side_arm / wheel.velocity[2]
    caster, inclination, trail, scrub = steering_geometry(wheel)
    return WheelGeometry(
        roll_centre_height_m=height,
        roll_centre_lateral_m=lateral,
        front_swing_arm_m=rolled.side * _radius(rolled.velocity[2], rolled.rotation[0]),
        side_swing_arm_m=side_arm,
        side_swing_height_m=float(wheel.centre[2] + rise - wheel.contact[2]),
        brake_support_deg=_support(wheel.contact_velocity, towards),
        drive_support_deg=_support(wheel.velocity, towards),
        caster_deg=caster,
        kingpin_inclination_deg=inclination,
        caster_trail_m=trail,
        scrub_radius_m=scrub,
    )


def roll_centre(right: WheelMotion, left: WheelMotion) -> tuple[float, float]:
    """Return position to the right and height above the ground of the roll centre [m]; nan for parallel lines.

    In the transverse plane a contact point moves at a right angle to the line to its swing centre, so that line rises
    inwards by v_out / v_z. The lines of both wheels meet in the roll centre.
    """
    rises = [wheel.side * wheel.contact_velocity[1] / wheel.contact_velocity[2] for wheel in (right, left)]
    (y1, z1), (y2, z2) = right.contact[1:], left.contact[1:]
    # Lines z = z1 + rise1 (y1 - y) and z = z2 + rise2 (y - y2): equal at y = offset/slope.
    offset, slope = z1 - z2 + rises[0] * y1 + rises[1] * y2, rises[0] + rises[1]
    # A symmetric axle has its roll centre in the middle plane, on the ground too, where both lines are the same.
    if abs(offset) < 1e-9:
        lateral = 0.0
    elif abs(offset) < FARTHEST * abs(slope):
        lateral = offset / slope
    else:
        return math.nan, math.nan
    # The ground is the line through both contact points.
    ground = z2 + (z1 - z2) * (lateral - y2) / (y1 - y2)
    return float(lateral), float(z1 + rises[0] * (y1 - lateral) - ground)


def steering_geometry(wheel: WheelMotion) -> tuple[float, float, float, float]:
    """Return caster and kingpin inclination [deg], caster trail and scrub radius [m]; nan without steering axis."""
    if wheel.steering_axis is None:
        return (math.nan,) * 4
    low, high = wheel.steering_axis
    axis = high - low
    # Point of the steering axis at the height of the contact.
    ground = low + axis * (wheel.contact[2] - low[2]) / axis[2]
    return (
        math.degrees(math.atan2(axis[0], axis[2])),
        math.degrees(math.atan2(-wheel.side * axis[1], axis[2])),
        float(wheel.contact[0] - ground[0]),
        float(wheel.side * (wheel.contact[1] - ground[1])),
    )


def _radius(velocity: float, rotation: float) -> float:
    """Return the distance to the instant centre [m]; nan beyond `FARTHEST`."""
    return float(velocity / rotation) if abs(velocity) < FARTHEST * abs(rotation) else math.nan


def _support(velocity: Vector, towards: float) -> float:
    """Return the angle of the line to the swing centre of the side view [deg]: at a right angle to the velocity."""
    return math.degrees(math.atan2(-towards * velocity[0], velocity[2]))
