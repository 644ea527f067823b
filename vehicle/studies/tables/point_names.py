"""Points of an axle by the words of their names: what a point is in any program, and its name in the templates."""

from vehicle.studies.tables.name_words import NameWords

TEMPLATE_NAMES: dict[str, tuple[str, ...]] = {
    "wheel_center": ("wheel_center",),
    "tyre_patch": ("tyre_patch",),
    "lower_ball": ("lower_ball",),
    "upper_ball": ("upper_ball",),
    "lower_arm_front": ("arm_front", "lower_front"),
    "lower_arm_rear": ("arm_rear", "lower_rear"),
    "upper_arm_front": ("upper_front",),
    "upper_arm_rear": ("upper_rear",),
    "tie_outer": ("tie_outer", "tie_hub"),
    "tie_inner": ("tie_inner", "tie_body"),
    "strut_top": ("strut_top", "damper_upper"),
    "strut_bottom": ("damper_bottom", "damper_lower"),
    "spring_upper": ("spring_upper",),
    "spring_lower": ("spring_lower",),
    "bar_mount": ("stab_body",),
    "bar_end": ("stab_end",),
    "droplink_top": ("stab_rod_top",),
    "trailing_pivot": ("pivot",),
    "beam": ("beam",),
}
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
"""Points that only some axles have, and what they belong to: without a place for them the axle is of another type."""


OF_BODY = {"body", "chassis", "frame", "subframe"}
"""Words of the inner end of a link."""


def point_of(name: NameWords) -> str | None:
    """Return the point that a name means, a key of `TEMPLATE_NAMES`, "cog", or None."""
    own = name.text.strip().lower()
    for key, names in TEMPLATE_NAMES.items():
        if own in (key, *names):
            return key
    words, has = set(name.words) - OF_BODY, name.has
    lower, upper = bool(words & {"lower", "bottom"}), bool(words & {"upper", "top"})
    outer = bool(words & {"outer", "ball", "knuckle"})
    along = next((word for word in name.words if word in ("front", "rear")), "")
    if has("cog"):
        return "cog"
    if "contact" in words:
        return "tyre_patch"
    if has("wheel", "center") or has("knuckle", "center") or words in ({"wheel"}, {"spindle", "center"}):
        return "wheel_center"
    if "tie" in words:
        inner = bool(words & {"inner", "rack"} or set(name.words) & OF_BODY)
        return "tie_inner" if inner else "tie_outer" if outer or "end" in words else None
    if words <= {"rack", "end", "inner"} and "rack" in words:
        return "tie_inner"
    if words == {"top"}:
        return "strut_top"
    if words == {"ball"}:
        return "lower_ball"
    if "droplink" in words:
        at_bar = bool(words & {"bar", "end", "lower", "bottom"}) and not words & {"strut", "upper", "top", "outer"}
        return "bar_end" if at_bar else "droplink_top" if words & {"strut", "upper", "top", "outer", "damper"} else None
    if "bar" in words:
        return "bar_end" if words & {"end", "outer", "droplink", "arm"} else "bar_mount"
    if "trailing" in words or "twistbeam" in words:
        return "trailing_pivot" if not outer and "beam" not in words else None
    if "beam" in words:
        return "beam"
    if "spring" in words:
        # The seat of a spring is that on the suspension.
        return (
            "spring_upper" if upper and not lower else "spring_lower" if lower or words == {"spring", "seat"} else None
        )
    if words & {"strut", "damper"}:
        if words & {"lower", "bottom", "knuckle"} and not words & {"upper", "top"}:
            return "strut_bottom"
        return "strut_top" if upper or words in ({"strut"}, {"strut", "inner"}) else None
    if lower == upper:
        # An arm without "lower" is the only one of its axle.
        if "arm" not in words or upper:
            return None
        lower = True
    level = "lower" if lower else "upper"
    if "ball" in words or ("arm" in words and outer):
        return f"{level}_ball"
    if "arm" in words and along:
        return f"{level}_arm_{along}"
    return None
