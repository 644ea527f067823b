"""Names of displacements and accelerations: none is mapped wrongly; what is not clear is asked."""

import numpy as np
import pytest

from vehicle.signals.formats.channel import Channel
from vehicle.signals.records.channel_words import axis_of, by_point, is_plate, on_seat, suggested_channels

PLATES = {
    "Shaker FL": "fl", "shaker_fr_disp": "fr", "Poster FL disp": "fl", "Actuator RL pos": "rl", "Plate RR": "rr",
    "MTS Actuator LF Disp": "fl", "Wheel plate FL": "fl", "Shaker LVDT FL": "fl", "Road plate RR (mm)": "rr",
    "Four Poster HR": "rr", "Stempel VL": "fl", "Weg Stempel HR": "rr", "Prüfstand VL": "fl", "StempelWegVR": "fr",
    "Pruefstempel HL Ist": "rl", "Hydropulszylinder VR": "fr", "Aktuator vorne links": "fl", "Radplatte HL": "rl",
    "Fußpunktanregung VL": "fl", "plate_fl_displacement": "fl", "displacement_fr": "fr", "Exciter rear left": "rl",
}  # fmt: skip
"""Names of the motion of a plate, with its wheel."""

NO_PLATES = (
    "RideHeight FR", "Ride height FL", "Tyre deflection FL", "SuspPos FL", "Suspension travel RR", "Shock Pot FR",
    "LVDT FL", "String pot RL", "Laser FR", "Jounce FL", "Rebound FR", "Airgap FL", "Air gap RR", "Strut length FL",
    "Wheel-to-body FL", "Wheel to plate FL", "Damper stroke RL", "Damper actuator FL", "Spring plate FL", "Weg VL",
    "Skid plate FR", "Number plate RL", "Plate to body FL", "Brake actuator FL", "Steering actuator RL", "Bump FL",
    "Wheel travel FR", "Body height FL", "Axle travel RL", "Tie rod FL", "Disp FL", "Ground clearance FR", "Gap RL",
    "Einfederweg VL", "Federweg HR", "Federteller VL", "Dämpferweg HL", "Höhenstand VR", "Fahrwerkshöhe VL",
    "Reifeneinfederung VL", "Radhub HR", "Seilzug HL", "Aufbauhöhe VR", "Luftspalt VL", "Niveau HL", "Feder VL",
    "Road wheel actuator FL", "Actuator RoadWheel RR",
)  # fmt: skip
"""Names of other displacements at a wheel: motions of one part against another, or not known."""

AXES = {
    "Seat_X 0x1F": "x", "Seat_Z 0x18FF102A": "z", "Seat Z x1000": "z", "xDCU_SeatZ": "z", "Seat Z X2": "z",
    "Seat Z (y axis of sensor)": "z", "X1:3 Seat Z": "z", "4x4 Seat Z": "z", "10x Seat Z": "z", "Seat Z 16x": "z",
    "Seat Z x 10": "z", "Tx Seat Z": "z", "Seat_Z_mux": "z", "axle Z": "z", "Box vertical": "z", "auxZ": "z",
    "xSeatZ": "z", "SeatZ_x1": "z", "Seat Z (X)": "z", "maxSeatZ": "z", "Vx_seat_Z": "z", "HexaSeat Y": "y",
    "Extra Y": "y", "Seat Y Rx": "y", "Index 3 Seat Z": "z", "AccX": "x", "acc_x": "x", "accz": "z", "ACCZ1": "z",
    "a_x": "x", "X-Richtung": "x", "Achse X Sitz": "x", "+X": "x", "Seat +Z": "z", "zAccel": "z", "AccelX_g": "x",
    "acc_z_m_s2": "z", "accSeatZLeft": "z", "SEAT_Z1": "z", "Seat acc (vertical)": "z", "Querbeschleunigung": "y",
    "Seat Lat": "y", "Z Seat rail": "z", "Hub FL z": "z", "az": "z", "IMU_AccelY": "y", "Sitz Z": "z", "Sitz hoch": "z",
    "Model X seat vertical": "", "Model X Seat Z": "", "Model X seat": "", "BMW X5 seat": "", "Seat x1000": "",
    "Seat 0x1F": "", "acc x2": "", "Seat (y axis of sensor)": "", "Seat Z vs x": "", "Lane x Seat Z": "",
    "X_Seat_Z": "", "xDCU seat": "", "Seat HEX 1X": "", "Seat": "", "relax": "", "Seat_Zx": "",
}  # fmt: skip
"""Names of accelerations, with the direction they state."""

POINTS = {
    "Wheel arch FL z": "", "Wheel well FR z": "", "Radhaus VL z": "", "Steering wheel FL z": "", "Spare wheel RL z": "",
    "Seat belt anchor z": "", "Seat back x": "", "Seat bolt z": "", "Rücksitz z": "", "Seat rear left z": "",
    "Passenger seat z": "", "Engine mount z": "", "Wiper motor z": "", "Motorhaube z": "", "Roof z": "",
    "Hub FL z": "knuckle_fl_acc_z", "MP12 Hub RL z": "knuckle_rl_acc_z", "Carrier wheel RR z": "knuckle_rr_acc_z",
    "VL_Radtraeger_z_Beschl": "knuckle_fl_acc_z", "Wheel hub z FL": "knuckle_fl_acc_z", "Seat Z 0x1F": "seat_acc_z",
    "Driver seat Z": "seat_acc_z", "Fahrersitz y": "seat_acc_y", "Sitzschiene z": "seat_rail_acc_z",
    "Seat rail z": "seat_rail_acc_z", "Seat track left z": "seat_rail_acc_z", "Motor x": "engine_acc_x",
    "Engine block Z": "engine_acc_z",
}  # fmt: skip
"""Names of accelerations, with the channel of the model that they suggest."""


def channel(name: str, unit: str) -> Channel:
    return Channel(name=name, values=np.zeros(3), unit=unit)


@pytest.mark.parametrize("name", PLATES)
def test_names_of_plates(name):
    assert suggested_channels([channel(name, "mm")]) == {f"plate_{PLATES[name]}_displacement": name}


@pytest.mark.parametrize("name", NO_PLATES)
def test_other_displacements_are_no_plates(name):
    assert not is_plate(channel(name, "mm")) and not suggested_channels([channel(name, "mm")])


@pytest.mark.parametrize("name", AXES)
def test_a_letter_within_a_name_is_no_direction(name):
    assert axis_of(channel(name, "m/s2")) == AXES[name]


@pytest.mark.parametrize("name", POINTS)
def test_a_name_with_a_further_word_is_another_point(name):
    suggested = suggested_channels([channel(name, "g")])
    assert suggested == ({POINTS[name]: name} if POINTS[name] else {})
    words = name.lower()
    of_seat = ("seat" in words or "sitz" in words) and not any(part in words for part in ("belt", "back", "bolt"))
    assert on_seat(channel(name, "g")) == of_seat


def test_points_are_told_apart_by_numbers_only_where_an_axis_repeats():
    def grouped(*names: str) -> list[list[str]]:
        pairs = list(enumerate(channel(name, "g") for name in names))
        return [[each.name for _, each in point] for point in by_point(pairs)]

    assert grouped("AI1 Seat X", "AI2 Seat Z") == [["AI1 Seat X", "AI2 Seat Z"]]
    assert grouped("Seat_Z 0x1A", "Seat_Z 0x1B", "Seat_X 0x1B") == [["Seat_Z 0x1A"], ["Seat_Z 0x1B", "Seat_X 0x1B"]]
    assert grouped("Seat 1 Z", "Seat 2 Z", "Seat 2 Y") == [["Seat 1 Z"], ["Seat 2 Z", "Seat 2 Y"]]
