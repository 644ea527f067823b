"""Settings of a road beside the speed of the car, each declared once: for Python, its documentation and the options."""

from dataclasses import dataclass

from vehicle.settings import Settings, setting

LEVEL = "level"
"""Name of the road without any height, for a car that its own forces shake."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadSettings(Settings):
    """Settings of a road; None is the default of each."""

    duration: float | None = setting(
        "length of the drive [s]; default: 60, or the whole profile", within="(0, inf)", type=float, metavar="S"
    )
    precision: float | None = setting(
        "half of the 95-percent interval of the weighted comfort, in percent, for which pilot runs with the reduced "
        "engine choose the length of the drive, in place of its duration: 6 to 600 s are evaluated; of a measured "
        "profile (shaker) they choose pieces, whose run gives comfort and tyre loads of the whole",
        within="(0, 100)",
        type=float,
        metavar="P",
    )
    rate: float | None = setting(
        "sampling rate of the plate signals [Hz]; default: 1000", within="(0, inf)", type=float, metavar="HZ"
    )
    seed: int | None = setting(
        "number that selects the random road; the same seed gives the same road; default: 1",
        within="[0, inf)",
        type=int,
        metavar="N",
    )
    period: str | None = setting(
        "evaluated: the road repeats after the evaluated span, so that comfort of a few seconds scatters little from "
        "seed to seed; record: it repeats nowhere in the drive; default: evaluated",
        choices=("evaluated", "record"),
    )
    coherence: float | None = setting(
        "coherence of left and right track: 1 equal, 0 unrelated; default: of an isotropic road",
        within="[0, 1]",
        type=float,
        metavar="G",
    )
    patch: float | None = setting(
        "length of the contact patch over which the tyre averages the road [m]; 0: contact at a point; default: 0.1",
        within="[0, 1)",
        type=float,
        metavar="M",
    )
    contact: str | None = setting(
        "patch: the tyre averages the road over its contact patch; cams: the road is enveloped by two "
        "elliptical cams, as in MF-Swift; default: patch, on an obstacle cams",
        choices=("patch", "cams"),
    )
    tyre: str | None = setting(
        "rolling: the tyres roll at the speed of the car (default on a road); standing: the tyres stand on "
        "moving plates, as on a rig (default if the car also stands on blocks)",
        choices=("rolling", "standing"),
    )


SETTINGS = RoadSettings.declared()
"""Name to the declaration of each setting."""
