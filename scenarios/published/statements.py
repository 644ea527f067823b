"""Statements of the publications with their rows; the page lists statements without a row."""

from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any

COMPLETE_CAR = {
    "slip share, low / mid / high": ("levels: slip share of the *",),
    "vertical wheel mode": ("levels: vertical wheel mode*",),
    "damper top and knuckle FRF": ("levels: damper top against knuckle*",),
    "coherence up to 50 Hz at all levels": ("levels: *coherence*",),
    "roll mode of the body": ("inertia: roll peak*",),
    "six rigid body modes": ("inertia: six rigid body modes",),
    "engine modes": ("inertia: engine modes",),
    "Ixx 1200, no change of the other modes": ("inertia: other rigid body modes, Ixx 1200*",),
    "roll tuned otherwise, three others badly tuned": ("inertia: other rigid body modes with the roll mode tuned*",),
    "stabilizer tuned from 3 to 5 kN m/rad": ("inertia: stabilizer*",),
    "seat above 22 Hz": ("levels: seat above*",),
    "body of another stiffness": ("comfort_sensitivity: body of another global stiffness*",),
    "flexible body modes": ("inertia: flexible modes*",),
    "torsion mode and vertical wheel mode": ("inertia: torsion mode*",),
    "left damper top and left knuckle": ("levels: damper top against knuckle on the left*",),
    "one nonlinear against two linear models": ("bump: one nonlinear against two linear*",),
    "degressive damper in the complete car": ("comfort_sensitivity: degressive damper in the complete car*",),
    "loss angle of the hydromount, 6.5 degrees at 7 Hz": ("inertia: *hydromount*",),
    "FRFs, axes": ("levels: * line of the FRFs*",),
    "bump 7.5 mm, first slip": ("bump: bump 7.5 mm, first slip*", "bump: *end of stick*"),
    "bump 7.5 mm, extremes": ("bump: bump 7.5 mm, lowest*", "bump: bump 7.5 mm, highest*"),
    "bump 1.5 mm, extremes": ("bump: bump 1.5 mm, lowest*", "bump: bump 1.5 mm, highest*"),
    "bump, seat rail in x and y": ("bump: *longitudinal*", "bump: *lateral*"),
    "bump 1.5 mm, no slip, rings down slowly": ("bump: bump 1.5 mm*", "bump: *ring*down*"),
    "Stribeck law, extra peak": ("stribeck: extra peak*",),
    "force over velocity, axes of figure 3.39": ("stribeck: highest velocity*", "stribeck: lowest force*"),
    "road slip share": ("comfort_sensitivity: *slip share*",),
    "level of the seat rail": ("comfort_sensitivity: largest *",),
    "level of the knuckle on the measured road": ("comfort_sensitivity: *knuckle*road*",),
    "swing of a road": ("comfort_sensitivity: swing *", "quarter_car: *swing*"),
    "comfort against Fd": ("comfort_sensitivity: comfort*Fd*",),
    "comfort against mount damping": ("comfort_sensitivity: comfort*mount damping*",),
    "comfort against mount stiffness": ("comfort_sensitivity: comfort*mount stiffness*",),
    "accelerations against Fd": ("comfort_sensitivity: accelerations*Fd*",),
    "accelerations against mount stiffness": ("comfort_sensitivity: accelerations*mount stiffness*",),
}
"""Statements about the complete car (chapters 3 and 4 of the thesis)."""

QUARTER_CAR = {
    "wheel peaks of the measured PSDs, asphalt and cobbles": ("@figure 2.1",),
    "modes with the damper slipping and sticking": ("quarter_car: slip mode*", "quarter_car: stick mode*"),
    "phases of both linear models": ("quarter_car: *, slip: *", "quarter_car: *, stick: *"),
    "switch and smooth friction model": ("quarter_car: switch and smooth*", "quarter_car: mass on damper*"),
    "sine of 1 mm": ("quarter_car: sine 1 mm*",),
    "sine of 50 mm": ("quarter_car: sine 50 mm*",),
    "sines, axes of figures 2.12, 2.13, 2.17 and 2.18": (
        "quarter_car: sine *: highest *",
        "quarter_car: sine *: lowest *",
    ),
    "resonances against the level of the road": ("quarter_car: *resonance*",),
    "engine alone at the slip wheel mode": ("quarter_car: engine alone against the wheel*",),
    "engine mass, accelerations at 1 and 50 mm": ("@figure 2.17",),
    "engine mass, effect of the transitions": ("@figure 2.18",),
    "engine mass on the road": ("quarter_car: *engine*first resonance*",),
    "elastomer, loss angle": ("quarter_car: elastomer*",),
    "elastomer against linear mount": ("quarter_car: *elastomer against linear mount*",),
    "degressive damper, resonances": ("quarter_car: degressive*resonance*",),
    "degressive damper, share of sticking": ("quarter_car: degressive*sticking*",),
    "degressive damper, influence": ("quarter_car: degressive*influence*",),
    "angle of the strut": ("quarter_car: angle of the strut*", "@figure D.4"),
    "damping Dh": ("@figure D.5",),
    "smoothing parameter eps": ("quarter_car: table B.1*",),
}
"""Statements about the quarter-car models (chapter 2 and appendices of the thesis)."""

HALF_CAR_RIDER = {
    "upper against lower body": ("half_car_rider: *upper body above*",),
    "settling times": ("half_car_rider: *settling time*",),
    "VDV with sprung mass": ("half_car_rider: VDV*sprung mass*",),
    "VDV with unsprung mass": ("half_car_rider: VDV*unsprung mass*",),
    "VDV with suspension stiffness": ("half_car_rider: VDV*suspension stiffness*",),
    "VDV with suspension damping": ("half_car_rider: VDV*suspension damping*",),
    "VDV with tyre stiffness": ("half_car_rider: VDV*tyre stiffness*",),
    "VDV with tyre damping": ("half_car_rider: VDV*tyre damping*",),
    "VDV with speed": ("half_car_rider: VDV with speed*",),
    "suspension travel": ("half_car_rider: suspension travel*",),
    "semi-active law": ("half_car_rider: semi-active suspension: control*",),
    "semi-active at the first natural frequency": ("half_car_rider: semi-active suspension at the first*",),
    "conclusions": ("half_car_rider: conclusion*", "half_car_rider@*conclusion*", "half_car_rider@section 5*"),
}
"""Statements of the half car with rider."""

DAMPER_CHOICE = {
    "damping ratios": ("damper_choice: *damping ratio*",),
    "quarter car, wheel FRF": ("damper_choice: quarter car wheel*",),
    "quarter car, body FRF": ("damper_choice: *sprung peak*",),
    "quarter car, optimum": ("damper_choice: *quarter car optimum*",),
    "half car, wheel FRFs": ("damper_choice: *half car front wheel*", "damper_choice: *half car rear wheel*"),
    "half car, heave and pitch": ("damper_choice: *pitch peak*",),
    "half car, equal dampers": ("damper_choice: *equal dampers*",),
    "half car, iteration": ("damper_choice: *iteration*",),
    "bump and rebound curves": ("damper_choice: *rebound*",),
    "determinant": ("damper_choice: determinant*",),
    "city road": ("damper_choice: *city road*",),
}
"""Statements of the choice of dampers."""

STATEMENTS = {
    f"{part}: {statement}": patterns
    for part, statements in (
        ("complete car", COMPLETE_CAR),
        ("quarter car", QUARTER_CAR),
        ("half car with rider", HALF_CAR_RIDER),
        ("damper choice", DAMPER_CHOICE),
    )
    for statement, patterns in statements.items()
}
"""Statement, and the patterns of its rows: `study: name of the row` or `study@place`, with wild cards; `@place` is for
any study."""


def unanswered(rows: Sequence[Mapping[str, Any]], left_open: Iterable[str] = ()) -> list[str]:
    """Return the statements without a row.

    Args:
        rows: rows of all studies, see `scenarios.published.table`.
        left_open: "study: name" of rows that short signals cannot judge; they also count as rows of a statement.
    """
    texts = {*left_open}
    for row in rows:
        study = row["name"].partition(": ")[0]
        texts |= {row["name"], f"{study}@{row['place']}", f"@{row['place']}"}
    return [
        statement
        for statement, patterns in STATEMENTS.items()
        if not any(fnmatchcase(text, pattern) for text in texts for pattern in patterns)
    ]
