"""Each law against its printed equation, its derivative against differences, its bad parameters refused."""

import ctypes
import dataclasses
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.lumped.degressive import Degressive
from scenarios.lumped.switch import Switch
from tests.core.laws import friction_limit
from tests.validation import validated
from vehicle.core.library import core
from vehicle.errors import ConfigurationError
from vehicle.model.laws import damper as damper_module
from vehicle.model.laws.coulomb import Coulomb
from vehicle.model.laws.damper import RECORD, _friction_laws, damper_law, pack
from vehicle.model.laws.elastomer import Kelvin, Maxwell
from vehicle.model.laws.friction import Clamped
from vehicle.model.laws.law import Parallel
from vehicle.model.laws.stribeck import Stribeck
from vehicle.model.parameters.force_elements import FRICTION_LAWS, NUMBERS
from vehicle.model.parameters.vehicle import load_vehicle

STRIBECK = {
    "friction_limit": 65.0, "static_limit": 125.0, "stribeck_velocity": 0.03, "stribeck_exponent": 3.5,
    "smoothing": 1e3,
}  # fmt: skip
LAWS = [
    Degressive(low_damping=15000.0, high_damping=1500.0, knee_velocity=0.02),
    Coulomb(friction_limit=75.0, smoothing=1e3),
    Clamped(law=Coulomb(friction_limit=75.0, smoothing=1e3)),
    Clamped(law=Stribeck(**STRIBECK)),
    Stribeck(**STRIBECK),
    Stribeck(**{**STRIBECK, "stribeck_exponent": 0.5}),
    Parallel(
        laws=(
            Degressive(low_damping=9.0, high_damping=9.0, knee_velocity=1.0),
            Coulomb(friction_limit=125.0, smoothing=1e3),
        )
    ),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_the_slope_is_the_derivative_of_the_force(law):
    # Knees (0.02 and pi/2/1e3 m/s) are not on the grid; a centred difference of 1e-8 m/s errs by its square times
    # F''' (below 75e9 N s3/m3) and by 1e-16 F / 1e-8: 1e-5 of the largest slope covers both.
    v = np.linspace(-0.1, 0.1, 402)
    step = 1e-8
    difference = (law.force(v + step) - law.force(v - step)) / (2.0 * step)
    validated(
        "Dampers and friction", f"slope of the law {LAWS.index(law) + 1}, {type(law).__name__}, -0.1 to 0.1 m/s",
        law.slope(v), difference, peak=1e-5, unit="N s/m", source="second derivation: central difference of the force",
    )  # fmt: skip


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_a_law_is_odd_and_opposes_the_motion(law):
    v = np.linspace(0.0, 0.5, 101)
    assert law.force(-v) == pytest.approx(-law.force(v), abs=0.0)
    assert (law.force(v[1:]) > 0.0).all()
    assert law.slope(-v) == pytest.approx(law.slope(v), abs=0.0)
    assert np.isfinite(law.slope(np.array([0.0, 1e3, -1e3]))).all()


def test_a_law_accepts_scalars_and_broadcasts_arrays_of_parameters():
    many = Coulomb(friction_limit=np.array([50.0, 75.0]), smoothing=1e5)
    both = many.force(np.array([[0.01], [-0.02], [0.0]]))
    assert both.shape == (3, 2)
    assert both[1, 1] == Coulomb(friction_limit=75.0, smoothing=1e5).force(-0.02)


def test_degressive_damper_follows_c1():
    law = Degressive(low_damping=15000.0, high_damping=1500.0, knee_velocity=0.02)
    # 15000 * 0.01; 15000 * 0.02; 1500 * 0.1 + (15000 - 1500) * 0.02, by hand.
    validated(
        "Dampers and friction", "degressive law at 0.01, 0.02, 0.1 and -0.1 m/s",
        law.force(np.array([0.01, 0.02, 0.1, -0.1])), np.array([150.0, 300.0, 420.0, -420.0]), rel=1e-14, unit="N",
        source="closed form: Bommer 2006, equation C.1, by hand",
    )  # fmt: skip
    assert law.force(0.02 * (1 - 1e-12)) == pytest.approx(law.force(0.02 * (1 + 1e-12)), rel=1e-11)


def test_smooth_coulomb_follows_2_4_and_the_regularised_law_has_its_slope_at_rest():
    smooth = Coulomb(friction_limit=75.0, smoothing=1e5)
    hard = Clamped(law=Coulomb(friction_limit=75.0, smoothing=1e5))
    coefficient = 2.0 / np.pi * 75.0 * 1e5
    assert smooth.force(1e-5) == pytest.approx(75.0 * 0.5, rel=1e-14)  # atan(1) = pi/4
    validated(
        "Dampers and friction", "smooth Coulomb law at 1 mm/s, of its limit", smooth.force(1e-3) / 75.0, 0.99363,
        abs=5e-6, source="closed form: Bommer 2006, equation 2.4: 2 / pi atan(eps v)",
    )  # fmt: skip
    assert hard.slope(0.0) == pytest.approx(coefficient, rel=1e-15) == smooth.slope(0.0)
    assert hard.force(np.array([1e-6, 1.0, -1.0])) == pytest.approx([coefficient * 1e-6, 75.0, -75.0], rel=1e-14)


def test_stribeck_follows_3_2():
    law = Stribeck(**{**STRIBECK, "smoothing": 1e5})
    assert law.limit(0.0) == 125.0
    validated(
        "Dampers and friction", "Stribeck limit at the Stribeck velocity", law.limit(0.03), 65.0 + 60.0 * np.exp(-1.0),
        rel=1e-14, unit="N", source="closed form: Bommer 2006, equation 3.2",
    )  # fmt: skip
    assert law.limit(np.array([-0.5, 1e6])) == pytest.approx([65.0, 65.0], rel=1e-14)
    assert law.force(0.03) == pytest.approx((65.0 + 60.0 / np.e) * 2.0 / np.pi * np.arctan(3e3), rel=1e-14)
    assert law.slope(0.0) == pytest.approx(125.0 * 2.0 / np.pi * 1e5, rel=1e-14)


@pytest.mark.parametrize("word", ["coulomb", "stribeck"])
def test_the_record_of_a_damper_is_its_law(word):
    numbers: dict[str, Any] = {
        "coulomb_friction": 65.0, "stribeck_friction": 125.0, "stribeck_velocity": 0.03, "stribeck_exponent": 2.0,
    }  # fmt: skip
    valve: dict[str, Any] = {"viscous_law": "degressive", "degressive_viscous": 15000.0, "degressive_velocity": 0.02}
    damper = dataclasses.replace(load_vehicle().damper, friction_law=word, **numbers, **valve)
    record = pack(damper)
    v = np.array([0.001, -0.03, 0.2])
    falling = 60.0 * np.exp(-((v / 0.03) ** 2)) if word == "stribeck" else 0.0
    limit = 65.0 + falling
    assert [friction_limit(record, one) for one in v] == pytest.approx(limit + np.zeros(3), rel=1e-14)
    smooth = limit * 2.0 / np.pi * np.arctan(damper.smoothing * v)
    assert damper.viscous == 2250.0
    knee = 2250.0 * v + np.clip(12750.0 * v, -0.02 * 12750.0, 0.02 * 12750.0)
    validated(
        "Dampers and friction", f"degressive damper with {word} friction", damper_law(damper).force(v), knee + smooth,
        rel=1e-13, unit="N", source="second derivation: sum of both laws, written out",
    )  # fmt: skip


def test_switch_mixes_the_fields_as_appendix_a():
    law = Switch(limit=50.0, band=1e-6, return_time=1e-4)
    h = np.array([2e-6, -2e-6, 5e-7, 5e-7, 5e-7, 5e-7])
    plus = np.array([-10.0, -10.0, 5.0, -20.0, -60.0, 5.0])
    minus = np.array([90.0, 90.0, 105.0, -5.0, 40.0, -5.0])
    alpha = law.mixing(h, plus, minus)
    # slip +, slip -, transition to +, transition to -, stick, repulsive
    assert alpha[[0, 1, 2, 3, 5]].tolist() == [1.0, 0.0, 1.0, 0.0, 1.0]
    assert law.sticks(h, plus, minus).tolist() == [False, False, False, False, True, False]
    # In stick the mixed field returns the velocity to zero with the time constant: h' = -h/tau.
    assert alpha[4] * plus[4] + (1.0 - alpha[4]) * minus[4] == pytest.approx(-5e-7 / 1e-4, rel=1e-12)
    assert law.force(2e-6, -10.0, 90.0) == 50.0
    assert law.force(-2e-6, -10.0, 90.0) == -50.0


BAD = [
    (
        Coulomb,
        {"friction_limit": np.array([1.0, np.nan]), "smoothing": 1e5},
        "friction_limit: found nan N, must be a finite number",
    ),
    (Coulomb, {"friction_limit": "much", "smoothing": 1e5}, "friction_limit: must be a number [N], not 'much'"),
    (Coulomb, {"friction_limit": True, "smoothing": 1e5}, "friction_limit: must be a number [N], not True"),
    (
        Degressive,
        {"low_damping": 1.0, "high_damping": 1.0, "knee_velocity": -0.1},
        "knee_velocity: found -0.1 m/s, must be at least 0.0",
    ),
    (Coulomb, {"friction_limit": 75.0, "smoothing": 0.0}, "smoothing: found 0.0 s/m, must be greater than 0.0"),
    (Coulomb, {"friction_limit": -75.0, "smoothing": 1e5}, "friction_limit: found -75.0 N, must be at least 0.0"),
    (
        Coulomb,
        {"friction_limit": 75.0, "smoothing": np.array([1e5, -1.0])},
        "smoothing: found -1.0 s/m, must be greater than 0.0",
    ),
    (Switch, {"limit": 50.0, "band": 0.0, "return_time": 1e-3}, "band: found 0.0 m/s, must be greater than 0.0"),
    (Switch, {"limit": 50.0, "band": 1e-6, "return_time": -1.0}, "return_time: found -1.0 s, must be greater than 0.0"),
    (
        Stribeck,
        {**STRIBECK, "static_limit": 60.0},
        "static_limit: found 60.0 N, must be at least the friction limit 65.0 N",
    ),
    (Stribeck, {**STRIBECK, "stribeck_velocity": 0.0}, "stribeck_velocity: found 0.0 m/s, must be greater than 0.0"),
    (Kelvin, {"stiffness": -1.0, "damping": 0.0}, "stiffness: found -1.0 N/m, must be at least 0.0"),
    (
        Maxwell,
        {"stiffness": 1.0, "branch_stiffness": -1.0, "branch_damping": 1.0},
        "branch_stiffness: found -1.0 N/m, must be at least 0.0",
    ),
]


@pytest.mark.parametrize(("law", "values", "message"), BAD)
def test_bad_parameters_are_refused_by_name(law, values, message):
    with pytest.raises(ConfigurationError) as caught:
        law(**values)
    assert str(caught.value).startswith(f"{law.__name__}.{message}")


def test_a_law_whose_numbers_no_damper_must_have_is_refused_at_import(monkeypatch):
    for name in ("stribeck_friction", "stribeck_exponent"):
        monkeypatch.setitem(
            NUMBERS, "stribeck", {key: unit for key, unit in NUMBERS["stribeck"].items() if key != name}
        )
        with pytest.raises(ConfigurationError, match=f"friction law stribeck: a damper need not have {name}, and"):
            _friction_laws()
        monkeypatch.undo()
    monkeypatch.delitem(NUMBERS, "stribeck")
    with pytest.raises(ConfigurationError, match="need not have stribeck_friction, stribeck_velocity, stribeck_exp"):
        _friction_laws()


def test_a_law_of_the_core_without_a_class_or_a_place_for_a_number_is_refused_at_import(monkeypatch):
    monkeypatch.setattr(damper_module, "FRICTION_LAWS", (*FRICTION_LAWS, "dry_ice"))
    with pytest.raises(
        ConfigurationError, match=r"dry_ice: .* add vehicle/model/laws/dry_ice.py with the class DryIce"
    ):
        _friction_laws()
    monkeypatch.undo()
    monkeypatch.setattr(
        damper_module, "RECORD", np.dtype([(name, float) for name in RECORD.names or () if name != "stribeck_exponent"])
    )
    with pytest.raises(ConfigurationError, match=r"no stribeck_exponent, but only .* add them to DAMPER_LAW_FIELDS"):
        _friction_laws()


def test_every_friction_law_with_a_class_is_in_the_core():
    folder = Path(damper_module.__file__).parent
    classes = {
        path.stem
        for path in folder.glob("*.py")
        if re.search(r"^class \w+\((Friction|Coulomb)\)", path.read_text(), re.M)
    }
    assert classes - {"friction_by_address"} == set(FRICTION_LAWS), "list it in EACH_FRICTION_LAW of laws.h"
    function = core().core_friction_laws
    function.restype = ctypes.c_char_p
    assert tuple(function().decode().split()) == FRICTION_LAWS
