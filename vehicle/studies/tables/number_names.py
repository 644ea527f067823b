"""Numbers of a car by the words of their names: key, dimension and possible sizes."""

from dataclasses import dataclass, replace

from vehicle.studies.tables.name_words import NameWords, name_words
from vehicle.studies.tables.unit_factor import (
    ANGLE,
    LENGTH,
    MASS,
    NONE,
    Dimension,
)

RATE, DAMPING, INERTIA = (1, 0, -2, 0), (1, 0, -1, 0), (1, 2, 0, 0)
ROLL_RATE, FREQUENCY = (1, 2, -2, -1), (0, 0, -1, 0)

SI = {MASS: "kg", LENGTH: "m", RATE: "N/m", DAMPING: "N s/m", INERTIA: "kg m2", ROLL_RATE: "N m/rad",
      FREQUENCY: "Hz", NONE: "-", ANGLE: "rad"}  # fmt: skip
"""SI unit of a dimension."""

GUESSED = {LENGTH: ("m", "mm"), MASS: ("kg",), RATE: ("N/m", "N/mm"), DAMPING: ("N s/m", "N s/mm"),
           INERTIA: ("kg m2",), ROLL_RATE: ("N m/rad", "N m/deg"), FREQUENCY: ("Hz",), NONE: ("-",)}  # fmt: skip
"""Units that a number without a unit may have; exactly one must give a possible size."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Quantity:
    """Number of a car.

    Attributes:
        terms: sets of words; the name contains a set.
        optional: further words of its name.
        dimension: powers of kg, m, s, rad.
        sizes: least and largest size of cars [SI units].
        of_axle: False for the whole car, True for an axle, None for both.
    """

    terms: tuple[str, ...]
    optional: str
    dimension: Dimension
    sizes: tuple[float, float]
    of_axle: bool | None = False


def _quantity(
    terms: str, dimension: Dimension, sizes: tuple[float, float], *, of_axle: bool | None = False, optional: str = ""
) -> Quantity:
    return Quantity(terms=tuple(terms.split("|")), optional=optional, dimension=dimension, sizes=sizes, of_axle=of_axle)


QUALIFIERS = frozenset({"max", "maximum", "min", "minimum", "permissible", "permitted", "zul", "zulässig", "zulässige",
                        "laden", "gross", "limit", "tyre", "only", "without", "excluding", "excl", "ohne"})  # fmt: skip
"""Words that make another number of it, also in parentheses: an axle load (max), a wheel rate (incl. tyre)."""

STROKES = ("compression", "rebound")
"""Words of the damping of one stroke."""

PER_WHEEL = ("wheel", "corner", "side", "each", "one", "quarter", "single")
"""Words of a number of one wheel instead of an axle."""

QUANTITIES: dict[str, Quantity] = {
    "sprung_cog_height": _quantity("sprung cog height|sprung mass cog height|sprung cog z", LENGTH, (0.2, 1.5),
                                   optional="above"),
    "sprung_cog_x": _quantity("sprung cog|sprung mass cog|sprung cog x|spring mass cog", LENGTH, (0.2, 5.0),
                              of_axle=None,
                              optional="mass distance behind longitudinal vehicle"),
    "sprung_roll_inertia": _quantity("sprung roll inertia|sprung inertia x|sprung inertia ixx|sprung ixx|sprung "
                                     "inertia xx", INERTIA, (50, 2e4), optional="mass moment"),
    "sprung_pitch_inertia": _quantity("sprung pitch inertia|sprung inertia y|sprung inertia iyy|sprung iyy|sprung "
                                      "inertia yy", INERTIA, (100, 5e4), optional="mass moment"),
    "sprung_yaw_inertia": _quantity("sprung yaw inertia|sprung inertia z|sprung inertia izz|sprung izz|sprung "
                                    "inertia zz", INERTIA, (100, 5e4), optional="mass moment"),
    "sprung_mass": _quantity("sprung mass|body mass", MASS, (100, 2e4), of_axle=None,
                             optional="vehicle total quarter corner wheel each"),
    "unsprung_mass": _quantity("unsprung mass", MASS, (10, 2e3), of_axle=None,
                               optional="wheel corner side each total one assembly suspension quarter"),
    "kerb_mass": _quantity("mass|kerb mass", MASS, (100, 2e4),
                           optional="vehicle total kerb empty unladen ready occupied"),
    "axle_load": _quantity("mass|load|axle load", MASS, (100, 2e4), of_axle=True,
                           optional="vehicle kerb wheel corner total empty"),
    "front_share": _quantity("mass distribution|distribution|mass share|load distribution|share|mass fraction",
                             NONE, (0.2, 0.8), of_axle=None, optional="kerb total vehicle"),
    "wheelbase": _quantity("wheelbase", LENGTH, (1.0, 4.2), optional="vehicle length"),
    "track": _quantity("track", LENGTH, (0.8, 3.0), of_axle=None, optional="wheel"),
    "half_track": _quantity("halftrack", LENGTH, (0.4, 1.5), of_axle=None),
    "cog_height": _quantity("cog height|cog z|height mass cog|cog above", LENGTH, (0.2, 1.2),
                            optional="vehicle above mass total"),
    "cog_x": _quantity("cog|cog distance|cog x|cog longitudinal", LENGTH, (0.2, 5.0), of_axle=None,
                       optional="distance behind longitudinal x wheel mass between vehicle"),
    "roll_inertia": _quantity("roll inertia|inertia x|inertia xx|ixx|inertia ixx|jxx", INERTIA, (50, 2e4),
                              optional="mass moment vehicle total"),
    "pitch_inertia": _quantity("pitch inertia|inertia y|inertia yy|iyy|inertia iyy|jyy", INERTIA, (100, 5e4),
                               optional="mass moment vehicle total"),
    "yaw_inertia": _quantity("yaw inertia|inertia z|inertia zz|izz|inertia izz|jzz", INERTIA, (100, 5e4),
                             optional="mass moment vehicle total"),
    "free_radius": _quantity("tyre radius free|tyre radius unloaded|wheel radius unloaded|unloaded radius|free radius",
                             LENGTH, (0.2, 0.8), of_axle=None, optional="tyre wheel"),
    "rolling_radius": _quantity("roll radius|effective radius|dynamic radius", LENGTH, (0.2, 0.8), of_axle=None,
                                optional="tyre wheel"),
    "tyre_radius": _quantity("tyre radius|wheel radius|loaded radius", LENGTH,
                             (0.2, 0.8), of_axle=None, optional="tyre wheel loaded"),
    "tyre_rate": _quantity("tyre rate|tyre spring rate", RATE, (5e4, 2e6), of_axle=None, optional="wheel"),
    "tyre_damping": _quantity("tyre damping|tyre damper", DAMPING, (0.0, 5e3), of_axle=None, optional="rate"),
    "ride_rate": _quantity("ride rate", RATE, (3e3, 3e5), of_axle=None, optional="wheel"),
    "wheel_rate": _quantity("wheel rate|wheel spring rate|wheel suspension rate", RATE, (3e3, 3e5), of_axle=None,
                            optional="spring suspension center body"),
    "suspension_rate": _quantity("suspension rate|suspension spring rate|suspension spring|heave rate", RATE,
                                 (3e3, 3e5), of_axle=None),
    "spring_rate": _quantity("spring rate|spring", RATE, (3e3, 1e6), of_axle=None, optional="main body"),
    "damper_ratio": _quantity("damper motion ratio", NONE, (0.2, 1.2), of_axle=None),
    "motion_ratio": _quantity("motion ratio|spring motion ratio|spring ratio", NONE, (0.2, 1.2), of_axle=None,
                              optional="spring damper wheel"),
    "damping_ratio": _quantity("damping ratio|critical damping", NONE, (0.02, 1.5), of_axle=None,
                               optional="suspension body ratio ride"),
    "wheel_damping": _quantity("wheel damping|wheel damper rate|suspension damping|suspension damper rate|"
                               "heave damping", DAMPING,
                               (100, 1e5), of_axle=None, optional="rate damper"),
    "damper_constant": _quantity("damper rate|damping|damper|damper damping|damping rate", DAMPING, (100, 1e5),
                                 of_axle=None, optional="linear"),
    "bar_wheel_rate": _quantity("bar wheel rate", RATE, (300, 2e5), of_axle=True),
    "bar_rate": _quantity("bar roll rate|bar rate", ROLL_RATE, (500, 5e5), of_axle=True, optional="roll torsional"),
    "roll_rate": _quantity("roll rate", ROLL_RATE, (2e3, 1e6), of_axle=True,
                           optional="suspension axle total vehicle"),
    "whole_roll_rate": _quantity("roll rate", ROLL_RATE, (5e3, 2e6), optional="total vehicle suspension"),
    "roll_share": _quantity("roll rate distribution|roll distribution", NONE, (0.05, 0.95), of_axle=True),
    "ride_frequency": _quantity("ride frequency|frequency|body frequency", FREQUENCY, (0.3, 8.0), of_axle=True,
                                optional="ride bounce heave suspension"),
    "pitch_frequency": _quantity("pitch frequency", FREQUENCY, (0.3, 8.0)),
    "wheel_hop": _quantity("wheel hop|wheel hop frequency|wheel frequency", FREQUENCY, (4.0, 30.0), of_axle=True),
}  # fmt: skip
"""Numbers by key; the first that fits is taken."""

SYMBOLS: dict[str, tuple[str, str]] = {
    "m": ("kerb_mass", ""), "mv": ("kerb_mass", ""), "mtot": ("kerb_mass", ""),
    "ms": ("sprung_mass", ""), "msu": ("sprung_mass", ""), "mb": ("sprung_mass", ""),
    "mus": ("unsprung_mass", ""), "muf": ("unsprung_mass", "front"), "mur": ("unsprung_mass", "rear"),
    "musf": ("unsprung_mass", "front"),
    "musr": ("unsprung_mass", "rear"), "a": ("cog_x", "front"), "lf": ("cog_x", "front"), "l1": ("cog_x", "front"),
    "b": ("cog_x", "rear"), "lr": ("cog_x", "rear"), "l2": ("cog_x", "rear"), "l": ("wheelbase", ""),
    "wb": ("wheelbase", ""), "lxaxle": ("wheelbase", ""), "h": ("cog_height", ""), "hcg": ("cog_height", ""),
    "hs": ("sprung_cog_height", ""), "hcgsu": ("sprung_cog_height", ""), "lxcgsu": ("sprung_cog_x", "front"),
    "tf": ("track", "front"), "tr": ("track", "rear"), "twf": ("track", "front"), "twr": ("track", "rear"),
    "ltrack": ("track", ""), "ix": ("roll_inertia", ""), "iy": ("pitch_inertia", ""), "iz": ("yaw_inertia", ""),
    "ixx": ("roll_inertia", ""), "iyy": ("pitch_inertia", ""), "izz": ("yaw_inertia", ""),
    "iphis": ("sprung_roll_inertia", ""), "ixs": ("sprung_roll_inertia", ""), "iys": ("sprung_pitch_inertia", ""),
    "ixxsu": ("sprung_roll_inertia", ""), "iyysu": ("sprung_pitch_inertia", ""), "izzsu": ("sprung_yaw_inertia", ""),
    "ksf": ("suspension_rate", "front"), "ksr": ("suspension_rate", "rear"), "ks": ("suspension_rate", ""),
    "kf": ("suspension_rate", "front"), "kr": ("suspension_rate", "rear"), "ksdf": ("wheel_damping", "front"),
    "ksdr": ("wheel_damping", "rear"), "csf": ("wheel_damping", "front"), "csr": ("wheel_damping", "rear"),
    "cs": ("wheel_damping", ""), "kt": ("tyre_rate", ""), "kzt": ("tyre_rate", ""), "ktf": ("tyre_rate", "front"),
    "ktr": ("tyre_rate", "rear"), "rw": ("tyre_radius", ""), "rre": ("tyre_radius", ""), "r0": ("free_radius", ""),
    "mr": ("motion_ratio", ""), "mrf": ("motion_ratio", "front"), "mrr": ("motion_ratio", "rear"),
    "kspring": ("spring_rate", ""), "kspringl": ("spring_rate", ""), "wheelbase": ("wheelbase", ""),
    "hwc": ("tyre_radius", ""), "krollaux": ("bar_rate", ""), "kaux": ("bar_rate", ""),
}  # fmt: skip
"""Symbol without signs, in small letters -> number and axle: lumped models, CommonRoad, CarSim."""


def number_of(name: NameWords) -> tuple[str, str, bool] | None:
    """Return key and axle of a number, and whether its name is a symbol; None if unknown."""
    symbol = "".join(letter for letter in name.text.lower() if letter.isalnum())
    # A small l is the length of the car in CommonRoad.
    if symbol in SYMBOLS and name.text != "l":
        key, axle = SYMBOLS[symbol]
        return key, "" if QUANTITIES[key].of_axle is False else axle or name.axle, True
    terms = set(name.terms)
    if {"tyre", "rate"} <= terms and "roll" not in terms and terms & {"incl", "including", "inkl", "einschließlich"}:
        return "ride_rate", name.axle, False
    if "suspension" in name.text.lower() and "suspension" not in terms:
        # "Front suspension stiffness" is the suspension stiffness of the front axle.
        whole = replace(name, text="", terms=(*name.terms, "suspension"))
        if (listed := number_of(whole)) is not None:
            return listed
    first, _, last = name.text.rpartition(" ")
    if len(name.terms) > 1 and (symbol := "".join(letter for letter in last.lower() if letter.isalnum())) in SYMBOLS:
        # "Sprung mass m_s": words and symbol of one number.
        words_before = name_words(first, right_letter="")
        listed = number_of(replace(words_before, axle=words_before.axle or name.axle)) if words_before.terms else None
        if listed is not None and listed[0] == SYMBOLS[symbol][0]:
            return listed
    for key, quantity in QUANTITIES.items():
        if (quantity.of_axle is True and not name.axle) or (quantity.of_axle is False and name.axle):
            continue
        for option in quantity.terms:
            required = set(option.split())
            if required <= terms <= required | set(quantity.optional.split()):
                return key, name.axle, False
    if "body" in terms:
        # The body of a lumped model is its sprung mass.
        return number_of(replace(name, text="", terms=tuple({"body": "sprung"}.get(term, term) for term in name.terms)))
    return None
