"""Settings of a road beside the speed of the car, each declared once: for Python, its documentation and the options."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.settings import Settings, setting


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadSettings(Settings):
    """Settings of a road; None is the default of each."""

    duration: float | None = setting("length [s]; 60, or the whole profile, by default", type=float, metavar="S")
    rate: float | None = setting("samples a second; 1000 by default", type=float, metavar="HZ")
    seed: int | None = setting("one seed is one road; 1 by default", type=int, metavar="N")
    coherence: float | None = setting(
        "of the tracks: 1 equal, 0 unrelated; isotropic plane by default", type=float, metavar="G"
    )
    patch: float | None = setting(
        "length of the contact patch that averages the road [m], 0 for none; 0.1 by default", type=float, metavar="M"
    )
    contact: str | None = setting(
        "patch: the road is averaged over the contact patch; cams: two elliptical cams envelop the road; patch by "
        "default, cams on an obstacle",
        choices=("patch", "cams"),
    )
    tyre: str | None = setting(
        "rolling: tyres roll at the speed, the default on a road; standing: tyres on moving plates, as on a rig, the "
        "default for a car that is on blocks too",
        choices=("rolling", "standing"),
    )


SETTINGS = RoadSettings.declared()
"""Name to the declaration of each setting."""
