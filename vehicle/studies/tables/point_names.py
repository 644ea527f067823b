"""Points of an axle by the words of their names: what a point is in any program, and its name in the templates."""

import re

from vehicle.studies.tables.name_words import NameWords

TEMPLATE_NAMES: dict[str, tuple[str, ...]] = {
    "wheel_center": ("wheel_center",),
    "tyre_patch": ("tyre_patch",),
    "lower_ball": ("lower_ball",),
    "upper_ball": ("upper_ball", "upper_outer"),
    "lower_arm_front": ("arm_front", "lower_front"),
    "lower_arm_rear": ("arm_rear", "lower_rear"),
    "upper_arm_front": ("upper_front",),
    "upper_arm_rear": ("upper_rear",),
    "tie_outer": ("tie_outer", "tie_hub", "lower_front_outer"),
    "tie_inner": ("tie_inner", "tie_body", "lower_front_inner"),
    "strut_top": ("strut_top", "damper_upper"),
    "strut_bottom": ("damper_bottom", "damper_lower"),
    "spring_upper": ("spring_upper",),
    "spring_lower": ("spring_lower",),
    "bar_mount": ("stab_body",),
    "bar_end": ("stab_end",),
    "droplink_top": ("stab_rod_top",),
    "trailing_pivot": ("pivot",),
    "beam": ("beam",),
    # Rods of an axle of five links.
    **{f"{rod}_{end}": (f"{rod}_{end}",)
       for rod in ("trailing_upper", "trailing_lower", "upper", "lower_front", "lower_rear")
       for end in ("outer", "inner") if (rod, end) != ("upper", "outer")},
}  # fmt: skip
"""Point -> its names in the templates of axles."""

OF_OTHER_AXLES = {
    "upper_ball": "upper arm",
    "upper_arm_front": "upper arm",
    "upper_arm_rear": "upper arm",
    "lower_ball": "lower arm",
    "lower_arm_front": "lower arm",
    "lower_arm_rear": "lower arm",
    "trailing_pivot": "trailing arm",
}
"""Points of arms, by the arm: an axle without a name for them is of another type."""


ON_WHEEL = {"outer", "ball", "knuckle", "wheel"}
"""Words of the outer end of a link."""

OF_BODY = {"body", "chassis", "frame", "subframe"}
"""Words of the inner end of a link."""


def is_template_name(text: str) -> bool:
    """Return True for the name of a point in a template: "lower_front_outer" names no axle."""
    plain = re.sub(r"[\s-]+", "_", text.strip().lower())
    return any(plain in names for names in TEMPLATE_NAMES.values())


def _rod_of(name: NameWords, *, lower: bool, upper: bool, along: str) -> str | None:
    """Return the end of a rod of an axle of five links: "upper trailing link outer", "lower rear link body"."""
    terms = set(name.terms)
    if "link" not in terms or "damper" in terms:
        return None
    # The spring link is a lower one.
    lower = lower or ("spring" in terms and not upper)
    end = "inner" if terms & (OF_BODY | {"inner"}) else "outer" if terms & ON_WHEEL else ""
    if not end or lower == upper:
        return None
    if "trailing" in terms:
        return f"trailing_{'lower' if lower else 'upper'}_{end}"
    if upper:
        return "upper_ball" if end == "outer" else "upper_inner"
    return f"lower_{along or 'rear'}_{end}"


def point_of(name: NameWords) -> str | None:
    """Return the point that a name means, a key of `TEMPLATE_NAMES`, "cog", or None."""
    plain = re.sub(r"[\s-]+", "_", name.text.strip().lower())
    for key, names in TEMPLATE_NAMES.items():
        if plain in (key, *names):
            return key
    terms, has = set(name.terms) - OF_BODY, name.has
    lower, upper = bool(terms & {"lower", "bottom"}), bool(terms & {"upper", "top"})
    outer = bool(terms & {"outer", "ball", "knuckle"})
    along = next((word for word in name.terms if word in ("front", "rear")), "")
    if has("cog"):
        return "cog"
    if rod := _rod_of(name, lower=lower, upper=upper, along=along):
        return rod
    if "contact" in terms:
        return "tyre_patch"
    if has("wheel", "center") or has("knuckle", "center") or terms in ({"wheel"}, {"spindle", "center"}):
        return "wheel_center"
    if "tie" in terms:
        inner = bool(terms & {"inner", "rack"} or set(name.terms) & OF_BODY)
        return "tie_inner" if inner else "tie_outer" if outer or "end" in terms else None
    if terms <= {"rack", "end", "inner"} and "rack" in terms:
        return "tie_inner"
    if terms == {"top"}:
        return "strut_top"
    if terms == {"ball"}:
        return "lower_ball"
    if "droplink" in terms:
        at_bar = bool(terms & {"bar", "end", "lower", "bottom"}) and not terms & {"strut", "upper", "top", "outer"}
        return "bar_end" if at_bar else "droplink_top" if terms & {"strut", "upper", "top", "outer", "damper"} else None
    if "bar" in terms:
        return "bar_end" if terms & {"end", "outer", "droplink", "arm"} else "bar_mount"
    if "trailing" in terms or "twistbeam" in terms:
        return "trailing_pivot" if not outer and "beam" not in terms else None
    if "beam" in terms:
        return "beam"
    if "spring" in terms and not (lower or upper) and (set(name.terms) & OF_BODY or terms & {"arm", "link"}):
        return "spring_upper" if set(name.terms) & OF_BODY else "spring_lower"
    if "spring" in terms:
        # The seat of a spring is that on the suspension.
        return (
            "spring_upper" if upper and not lower else "spring_lower" if lower or terms == {"spring", "seat"} else None
        )
    if terms & {"strut", "damper"}:
        if not (lower or upper) and (set(name.terms) & OF_BODY or terms & {"arm", "link"}):
            return "strut_top" if set(name.terms) & OF_BODY else "strut_bottom"
        if terms & {"lower", "bottom", "knuckle"} and not terms & {"upper", "top"}:
            return "strut_bottom"
        return "strut_top" if upper or terms in ({"strut"}, {"strut", "inner"}) else None
    if lower == upper:
        # The only arm of an axle needs no "lower".
        if "arm" not in terms or upper:
            return None
        lower = True
    level = "lower" if lower else "upper"
    if "ball" in terms or ("arm" in terms and outer):
        return f"{level}_ball"
    if "arm" in terms and along:
        return f"{level}_arm_{along}"
    return None
