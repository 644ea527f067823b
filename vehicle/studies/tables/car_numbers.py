"""Numbers of a table as numbers of a new car: units, sizes, axles, and what follows from several of them.

    sprung and unsprung      m = m_s + m_uf + m_ur,   h = (m_s h_s + m_u r) / m,   x = (m_s x_s + m_ur L) / m
    moments about the CoG    I = I_s + m_s d_s^2 + sum m_u d_u^2   (wheels are points at their centres)
    spring at the wheel      K_w = i^2 K_s,   C_w = i_d^2 C_d      (i: spring travel per wheel travel)
    ride rate                K_w = K_r K_t / (K_t - K_r)
    bar                      K_phi = K_w t^2 / 2 + K_bar

Sources: Gillespie, Fundamentals of Vehicle Dynamics, chapter 5 and 6 (rates, roll stiffness); parallel axes.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from vehicle.errors import DataError
from vehicle.studies.tables.table_numbers import AGREE, AXLES, CarNumbers, Values, key_words

NAMED = {"spring_rate", "ride_frequency", "wheel_hop", "free_radius", "tyre_radius", "bar_rate"}
"""Numbers whose omission is explained where they are replaced by others."""


@dataclass(slots=True)
class _Numbers:
    """Numbers of a table, and the numbers of a car made of them."""

    values: Values
    result: CarNumbers
    used: set[tuple[str, str]] = field(default_factory=set)

    def get(self, key: str, axle: str = "") -> float | None:
        """Return a number of an axle, or of both axles."""
        for of_axle in (axle, ""):
            if (entry := self.values.get((key, of_axle))) is not None:
                self.used.add((key, of_axle))
                return entry.value
        return None

    @property
    def of_body(self) -> bool:
        """Return True for a lumped model, whose sprung mass is stated without the mass of the car."""
        stated = ("kerb_mass", ""), ("axle_load", "front"), ("axle_load", "rear")
        return ("sprung_mass", "") in self.values and not any(key in self.values for key in stated)

    def put(self, name: str, value: float, *rows: tuple[str, str], why: str = "") -> None:
        """Store a number of the car with its rows."""
        self.result.stated[name] = value
        texts = [self.values[row].text for row in dict.fromkeys(rows) if row in self.values]
        self.result.origins[name] = ", ".join([*texts, why] if why else texts)

    def guess(self, key: str, axle: str, text: str) -> None:
        row = self.values.get((key, axle)) or self.values.get((key, ""))
        self.result.guessed.append((row.where if row else "", text))


def car_numbers(
    values: Values, result: CarNumbers, points: Mapping[str, Any], spring_points: Mapping[str, bool]
) -> None:
    """Compute the numbers of a new car.

    Args:
        values: numbers of the table.
        result: receives the numbers, guesses and what is left out.
        points: what the points give: "wheelbase", "track_front", "track_rear", "tyre_radius", "cog".
        spring_points: by axle, whether the table places the spring and the arms, so that a rate is one of the spring.

    Raises:
        DataError: numbers contradict each other, or one lacks another that it needs.
    """
    table = _Numbers(values=values, result=result)
    _lengths(table, points)
    _masses(table)
    _cog_and_inertia(table, points)
    for axle in AXLES:
        _rates(table, axle, at_spring=spring_points.get(axle, False))
    said = " ".join([*result.origins.values(), *(text for _, text in result.parameters.values()),
                     *(text for _, text in result.left_out)])  # fmt: skip
    for row, entry in values.items():
        if row in table.used and row[0] not in NAMED and entry.text not in said:
            result.left_out.append((entry.where, f"{entry.text}: not used beside the other numbers"))
        if row not in table.used:
            result.left_out.append((entry.where, f"{entry.text}: what it needs is not stated"))


def _lengths(table: _Numbers, points: Mapping[str, Any]) -> None:
    for name, key, axle in (("wheelbase", "wheelbase", ""), ("track_front", "track", "front"),
                            ("track_rear", "track", "rear"), ("tyre_radius", "tyre_radius", "front")):  # fmt: skip
        stated, placed = table.get(key, axle), points.get(name)
        if stated is not None and placed is not None and abs(stated / placed - 1.0) > AGREE:
            raise DataError(
                f"{key_words(key, axle)}: stated {stated:g} m, but the points give {placed:.4f} m; correct one"
            )
        if placed is not None:
            table.put(name, round(placed, 9), (key, axle), (key, ""), why="points")
        elif stated is not None:
            table.put(name, stated, (key, axle), (key, ""))
    rear = table.get("tyre_radius", "rear")
    if rear is not None and abs(rear - table.result.stated.get("tyre_radius", rear)) > 1e-3:
        table.result.left_out.append(
            ("", f"rear tyre radius {rear:g} m: the car has one radius, taken from the front axle")
        )
    free = table.get("free_radius", "front") or table.get("free_radius", "rear")
    if free is not None and "tyre_radius" not in table.result.stated:
        row = next(key for key in (("free_radius", "front"), ("free_radius", ""), ("free_radius", "rear"))
                   if key in table.values)  # fmt: skip
        table.put("tyre_free_radius", free, row)
    elif free is not None:
        table.result.left_out.append(("", f"free radius {free:g} m: the loaded radius is known too"))


def _cog_distances(table: _Numbers) -> tuple[float | None, float | None, float | None]:
    """Return a, b and L: distances of the CoG from front and rear axle, and the wheelbase [m]."""
    a = table.get("cog_x", "front") if ("cog_x", "front") in table.values else table.get("cog_x")
    b = table.values.get(("cog_x", "rear"))
    if b is not None:
        table.used.add(("cog_x", "rear"))
    return a, None if b is None else b.value, table.result.stated.get("wheelbase")


def _masses(table: _Numbers) -> None:
    stated, values = table.result.stated, table.values
    unsprung = {axle: table.get("unsprung_mass", axle) for axle in AXLES}
    for axle, mass in unsprung.items():
        if mass is not None:
            table.put(f"unsprung_mass_{axle}", mass, ("unsprung_mass", axle), ("unsprung_mass", ""))
    sprung = {axle: table.get("sprung_mass", axle) for axle in AXLES if ("sprung_mass", axle) in values}
    loads = {axle: table.get("axle_load", axle) for axle in AXLES}
    for axle, mass in sprung.items():
        if mass is None or unsprung[axle] is None:
            raise DataError(f"sprung mass {axle}: the axle load needs the unsprung mass of this axle too; add it")
        if loads[axle] is None:
            loads[axle] = mass + (unsprung[axle] or 0.0)
    kerb, whole = table.get("kerb_mass"), table.get("sprung_mass") if ("sprung_mass", "") in values else None
    if whole is not None and unsprung["front"] is not None and unsprung["rear"] is not None:
        total = whole + unsprung["front"] + unsprung["rear"]
        if kerb is not None and abs(total / kerb - 1.0) > AGREE:
            raise DataError(f"sprung mass {whole:g} kg and unsprung masses {unsprung['front']:g} and "
                            f"{unsprung['rear']:g} kg: together {total:g} kg instead of the mass of {kerb:g} kg; "
                            "correct one (unsprung masses: of an axle or of a wheel?)")  # fmt: skip
        kerb = total if kerb is None else kerb
        table.put("kerb_mass", kerb, ("kerb_mass", ""), ("sprung_mass", ""), why="with the unsprung masses")
    elif kerb is not None:
        table.put("kerb_mass", kerb, ("kerb_mass", ""))
    elif whole is not None:
        raise DataError(f"sprung mass {whole:g} kg: the mass of the car needs the unsprung masses too; add them")
    for axle, load in loads.items():
        if load is not None:
            table.put(f"{axle}_axle_load", load, ("axle_load", axle), ("sprung_mass", axle))
    share = next((table.get("front_share", axle) if axle != "rear" else 1.0 - (table.get("front_share", "rear") or 0.0)
                  for axle in ("front", "", "rear") if ("front_share", axle) in values), None)  # fmt: skip
    table.used |= {("front_share", axle) for axle in ("front", "", "rear")}
    shares = [values[key].value for axle in AXLES if (key := ("front_share", axle)) in values]
    if len(shares) == 2 and abs(sum(shares) - 1.0) > AGREE:
        raise DataError(f"mass distribution: {shares[0]:g} and {shares[1]:g} sum up to {sum(shares):g}; correct one")
    both = loads["front"] is not None and loads["rear"] is not None
    if both and kerb is not None:
        total = (loads["front"] or 0.0) + (loads["rear"] or 0.0)
        if abs(total / kerb - 1.0) > AGREE:
            raise DataError(f"axle loads: together {total:g} kg instead of the mass of {kerb:g} kg; correct one")
        del stated["kerb_mass"]
    if share is not None and not any(loads.values()):
        if kerb is None:
            raise DataError("mass distribution: needs the mass of the car; add it")
        table.put(
            "front_axle_load", share * kerb, ("front_share", "front"), ("front_share", ""), ("front_share", "rear")
        )


def _cog_and_inertia(table: _Numbers, points: Mapping[str, Any]) -> None:
    stated = table.result.stated
    mass = stated.get("kerb_mass") or stated.get("front_axle_load", 0.0) + stated.get("rear_axle_load", 0.0)
    front, rear = (stated.get(f"unsprung_mass_{axle}") for axle in AXLES)
    wheelbase, radius = stated.get("wheelbase"), stated.get("tyre_radius")
    a, b, _ = _cog_distances(table)
    if a is not None and b is not None:
        if wheelbase is None:
            stated["wheelbase"] = wheelbase = a + b
            table.result.origins["wheelbase"] = "distances of the centre of gravity from both axles"
        elif abs((a + b) / wheelbase - 1.0) > AGREE:
            raise DataError(f"centre of gravity: {a:g} and {b:g} m from the axles make {a + b:g} m instead of the "
                            f"wheelbase of {wheelbase:g} m; correct one")  # fmt: skip
    elif b is not None:
        if wheelbase is None:
            raise DataError("centre of gravity from the rear axle: needs the wheelbase; add it")
        a = wheelbase - b
    height, sprung_height = table.get("cog_height"), table.get("sprung_cog_height")
    sprung_a = table.get("sprung_cog_x", "front")
    if table.of_body and sprung_a is None and sprung_height is None and (a is not None or height is not None):
        table.guess("sprung_mass", "", "centre of gravity: of the sprung mass, whose mass is stated alone")
        a, height, sprung_a, sprung_height = None, None, a, height
    cog = points.get("cog")
    if cog is not None:
        x, above, of_sprung = cog
        if radius is None:
            raise DataError("centre of gravity as a point: its height needs the tyre radius or the tyre patch; add it")
        if of_sprung:
            sprung_a, sprung_height = x, above + radius
        else:
            a, height = x, above + radius
    placed = any(name in stated for name in ("front_axle_load", "rear_axle_load"))
    complete = front is not None and rear is not None and mass and radius is not None
    sprung = mass - (front or 0.0) - (rear or 0.0)
    if height is None and sprung_height is not None and complete:
        height = (sprung * sprung_height + ((front or 0.0) + (rear or 0.0)) * (radius or 0.0)) / mass
    elif height is None and sprung_height is not None:
        height = sprung_height
        table.guess(
            "sprung_cog_height", "", "height of the sprung mass taken for the car: unsprung masses or radius missing"
        )
    if a is None and sprung_a is not None and not placed:
        if not (front is not None and rear is not None and wheelbase):
            raise DataError("centre of gravity of the sprung mass: needs unsprung masses and wheelbase; add them")
        a = (sprung * sprung_a + rear * wheelbase) / mass
    if height is not None:
        table.put("cog_height", round(height, 6), ("cog_height", ""), ("sprung_cog_height", ""))
    if a is not None and not placed:
        keys = ("cog_x", "sprung_cog_x")
        table.put("cog_x", round(a, 6), *((key, axle) for key in keys for axle in ("", *AXLES)))
    elif a is not None:
        load = stated.get("front_axle_load") or mass - stated.get("rear_axle_load", 0.0)
        if wheelbase and mass and abs(1.0 - a / wheelbase - load / mass) > AGREE:
            raise DataError(f"centre of gravity {a:g} m behind the front axle: the axle loads give "
                            f"{wheelbase * (1.0 - load / mass):.3f} m; correct one")  # fmt: skip
    _inertia(table, mass, sprung, a, height, sprung_a, sprung_height)


def _inertia(table: _Numbers, mass: float, sprung: float, a: float | None, height: float | None,
             sprung_a: float | None, sprung_height: float | None) -> None:  # fmt: skip
    """Enter the moments of the car: stated, or of the sprung mass with the unsprung masses as points."""
    stated = table.result.stated
    unsprung, lengths = ("unsprung_mass_front", "unsprung_mass_rear"), ("wheelbase", "track_front", "track_rear")
    for name in ("roll_inertia", "pitch_inertia", "yaw_inertia"):
        value, key = table.get(name), f"sprung_{name}"
        moment = table.get(key)
        if value is not None and moment is None and table.of_body:
            table.guess(name, "", f"{name.replace('_', ' ')}: of the sprung mass, whose mass is stated alone")
            value, moment, key = None, value, name
        if value is not None:
            table.put(name, value, (name, ""))
        if value is not None or moment is None:
            continue
        needed = (*unsprung, *(lengths[:1] if name == "pitch_inertia" else lengths[1:] if name == "roll_inertia"
                               else lengths))  # fmt: skip
        missing = [word.replace("_", " ") for word in needed if word not in stated]
        if missing or a is None:
            missing += ["centre of gravity"] if a is None else []
            table.guess(key, "", f"{name.replace('_', ' ')} of the sprung mass left out: the moment of the car needs "
                        f"{', '.join(missing)} too")  # fmt: skip
            continue
        front, rear = (stated[word] for word in unsprung)
        wheelbase, track_f, track_r = (stated.get(word, 0.0) for word in lengths)
        # The CoG of the sprung mass: stated, or what is left of the car.
        along = sprung_a if sprung_a is not None else (mass * a - rear * wheelbase) / sprung
        x = (front * a**2 + rear * (wheelbase - a) ** 2) + sprung * (along - a) ** 2
        y, z = front * track_f**2 / 4.0 + rear * track_r**2 / 4.0, 0.0
        if height is not None and (radius := stated.get("tyre_radius")) is not None:
            above = sprung_height if sprung_height is not None else (mass * height - (front + rear) * radius) / sprung
            z = (front + rear) * (radius - height) ** 2 + sprung * (above - height) ** 2
        elif name != "yaw_inertia":
            table.guess(key, "", f"{name.replace('_', ' ')}: the heights of sprung and unsprung masses are taken as "
                        "equal, because height of the CoG or radius is not stated")  # fmt: skip
        extra = {"roll_inertia": y + z, "pitch_inertia": x + z, "yaw_inertia": x + y}[name]
        table.put(name, round(moment + extra, 3), (key, ""), why="with the unsprung masses at the wheels")


def _rates(table: _Numbers, axle: str, *, at_spring: bool) -> None:
    """Enter rates, damping and frequencies of an axle."""
    tyre, ratio = table.get("tyre_rate", axle), table.get("motion_ratio", axle)
    damper_ratio = table.get("damper_ratio", axle) or ratio
    if ratio is not None and ratio > 1.0:
        table.guess("motion_ratio", axle, f"motion ratio {axle} {ratio:g}: spring travel per wheel travel; write its "
                    "inverse if it is wheel travel per spring travel")  # fmt: skip
    if tyre is not None:
        table.put(f"tyre_stiffness_{axle}", tyre, ("tyre_rate", axle), ("tyre_rate", ""))
    wheel, why = table.get("wheel_rate", axle), ("wheel_rate", axle)
    if wheel is None and (ride := table.get("ride_rate", axle)) is not None:
        if tyre is None or tyre <= ride:
            raise DataError(f"ride rate {axle} {ride:g} N/m: the wheel rate needs the tyre stiffness, above it; add it")
        wheel, why = ride * tyre / (tyre - ride), ("ride_rate", axle)
    lumped = table.get("suspension_rate", axle)
    if wheel is None and lumped is not None:
        why = ("suspension_rate", axle)
        wheel = lumped if ratio is None else ratio**2 * lumped
        table.guess(*why, f"{key_words(*why)}: at the {'wheel' if ratio is None else 'spring, by its motion ratio'}")
    spring = table.get("spring_rate", axle)
    if spring is not None and wheel is None:
        why = ("spring_rate", axle)
        if ratio is not None:
            wheel = ratio**2 * spring
        elif at_spring:
            table.put(f"spring_stiffness_{axle}", spring, why, ("spring_rate", ""))
        else:
            wheel = spring
            table.guess(*why, f"{key_words(*why)}: at the wheel (motion ratio 1); neither a motion ratio nor "
                        "the points of spring and arm are stated")  # fmt: skip
    elif spring is not None:
        by_ratio = "" if ratio is None else f", {ratio**2 * spring:.0f} N/m at the wheel by its motion ratio"
        text = f"{key_words('spring_rate', axle)} {spring:g} N/m{by_ratio}"
        table.result.left_out.append(("", f"{text}: the wheel rate of {wheel or 0.0:.0f} N/m counts"))
    if wheel is not None:
        table.put(
            f"wheel_rate_{axle}",
            wheel,
            why,
            (why[0], ""),
            *((("motion_ratio", axle), ("motion_ratio", "")) if ratio else ()),
        )
    if (frequency := table.get("ride_frequency", axle)) is not None:
        if f"wheel_rate_{axle}" in table.result.stated or f"spring_stiffness_{axle}" in table.result.stated:
            table.result.left_out.append(("", f"ride frequency {axle} {frequency:g} Hz: follows from the stated rate"))
        else:
            table.put(f"ride_frequency_{axle}", frequency, ("ride_frequency", axle))
    if axle == "front" and (pitch := table.get("pitch_frequency")) is not None:
        table.put("pitch_frequency", pitch, ("pitch_frequency", ""))
    if (hop := table.get("wheel_hop", axle)) is not None:
        if tyre is None:
            table.put(f"wheel_hop_{axle}", hop, ("wheel_hop", axle))
        else:
            table.result.left_out.append(("", f"wheel hop {axle} {hop:g} Hz: follows from the tyre stiffness"))
    _damping(table, axle, damper_ratio, at_spring=at_spring)
    _roll(table, axle, wheel)


def _damping(table: _Numbers, axle: str, ratio: float | None, *, at_spring: bool) -> None:
    share, wheel = table.get("damping_ratio", axle), table.get("wheel_damping", axle)
    damper = table.get("damper_constant", axle)
    if (rubber := table.get("tyre_damping", axle)) is not None:
        row = table.values.get(("tyre_damping", axle)) or table.values["tyre_damping", ""]
        table.result.parameters[axle, "tyre.damping.z"] = (rubber, row.text)
    if wheel is not None:
        table.put(f"wheel_damping_{axle}", wheel, ("wheel_damping", axle), ("wheel_damping", ""))
    elif damper is not None and ratio is not None:
        key = "damper_ratio" if table.get("damper_ratio", axle) else "motion_ratio"
        table.put(f"wheel_damping_{axle}", ratio**2 * damper, ("damper_constant", axle), ("damper_constant", ""),
                  (key, axle), (key, ""))  # fmt: skip
    elif damper is not None and at_spring:
        table.put(f"damper_constant_{axle}", damper, ("damper_constant", axle), ("damper_constant", ""))
    elif damper is not None:
        table.put(f"wheel_damping_{axle}", damper, ("damper_constant", axle), ("damper_constant", ""))
        table.guess("damper_constant", axle, f"damper constant {axle}: at the wheel (motion ratio 1)")
    elif share is not None:
        table.put(f"damping_ratio_{axle}", share, ("damping_ratio", axle), ("damping_ratio", ""))


def _roll(table: _Numbers, axle: str, wheel: float | None) -> None:
    whole, bar = table.get("roll_rate", axle), table.get("bar_rate", axle)
    total, share = table.get("whole_roll_rate"), table.get("roll_share", axle)
    track = table.result.stated.get(f"track_{axle}")
    per_degree = math.pi / 180.0
    other = table.get("roll_share", "rear" if axle == "front" else "front")
    share = 1.0 - other if share is None and other is not None else share
    if whole is None and total is not None and share is not None:
        table.put(f"roll_stiffness_{axle}", total * share * per_degree, ("whole_roll_rate", ""), ("roll_share", axle))
        return
    at_wheel = table.get("bar_wheel_rate", axle)
    if bar is None and at_wheel is not None and track is not None:
        bar = 0.5 * at_wheel * track**2
        table.guess("bar_wheel_rate", axle, f"bar rate {axle} at the wheel: force over travel of a wheel, the other "
                    "one opposite, so K_phi = k t^2 / 2")  # fmt: skip
    if whole is not None:
        table.put(f"roll_stiffness_{axle}", whole * per_degree, ("roll_rate", axle))
    elif bar is not None and wheel is not None and track is not None:
        table.put(f"roll_stiffness_{axle}", (bar + 0.5 * wheel * track**2) * per_degree, ("bar_rate", axle),
                  ("bar_wheel_rate", axle),
                  why="with the springs, K_w t^2 / 2")  # fmt: skip
    elif bar is not None:
        table.result.left_out.append(("", f"bar rate {axle}: the roll stiffness needs wheel rate and track too"))
