"""Modified cars equal the cars that are built, for every number of the shipped vehicle files."""

import gc
import weakref
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from vehicle.errors import VehicleError
from vehicle.model.parameters.paths import paths, value_at
from vehicle.runs.car import Car

TABLES = (
    "front.main_spring.table.displacement=[-0.4, -0.1, 0.1]",
    "front.main_spring.table.force=[-9000.0, -3000.0, 2000.0]",
    "damper.stop.displacement=[-0.1, -0.03, 0.04, 0.1]",
    "damper.stop.force=[-9000.0, 0.0, 0.0, 9000.0]",
    "*.tyre.one_sided=true",
)
"""A bent spring, stops and tyres that lift off."""

RATE = 2.5e4
"""Slope of a table [N/m]."""


def numbers(table):
    """Return all single numbers of a table by path."""
    values = {path: value_at(table, path) for path in paths(table)}
    return {
        path: value for path, value in values.items() if isinstance(value, int | float) and not isinstance(value, bool)
    }


def same(varied, built, path):
    """Compare arrays within 1e-9 of their largest number, and other fields exactly."""
    if is_dataclass(built):
        for field in fields(built):
            # The residual of the trim is round-off.
            if field.name != "residual":
                same(getattr(varied, field.name), getattr(built, field.name), f"{path}.{field.name}")
    elif isinstance(built, dict):
        assert list(varied) == list(built), path
        for key, value in built.items():
            same(varied[key], value, f"{path}.{key}")
    elif isinstance(built, np.ndarray | float):
        finite = np.isfinite(built)
        assert np.array_equal(finite, np.isfinite(varied)) and np.shape(varied) == np.shape(built), path
        varied, built = np.asarray(varied)[finite], np.asarray(built)[finite]
        assert np.max(np.abs(varied - built), initial=0.0) <= 1e-9 * np.max(np.abs(built), initial=0.0), path
    elif isinstance(built, tuple):
        assert len(varied) == len(built), path
        for index, value in enumerate(built):
            same(varied[index], value, f"{path}.{index}")
    else:
        assert varied == built, path


def require_same(reference, file, fixed, changes):
    varied, built = reference.with_(changes), Car.load(file, (*fixed, *changes))
    assert varied.vehicle == built.vehicle and varied.vehicle.composition == built.vehicle.composition
    assert varied.vehicle.body == built.vehicle.body and varied.vehicle.solver == built.vehicle.solver
    assert (varied.overrides, varied.origin) == (built.overrides, built.origin)
    same(varied.matrices, built.matrices, f"{changes}: matrices")
    same(varied.static, built.static, f"{changes}: static")
    assert "model" not in vars(varied)


def outcome(make):
    """Return the data of the reduced engine, or the reason why there is none."""
    try:
        car = make()
        car.check("reduced")
        return car
    except VehicleError as error:
        return f"{type(error).__name__}: {error}"


@pytest.mark.parametrize(("file", "beside"), [("focus", None), ("focus_road", "focus")])
def test_every_number_of_a_vehicle_file_moves_what_it_moves_in_a_built_car(file, beside):
    reference = Car.load(file)
    known_values = {} if beside is None else numbers(Car.load(beside).vehicle.table)
    groups: dict[str, list[str]] = {}
    for index, (path, value) in enumerate(numbers(reference.vehicle.table).items()):
        is_geometry = "hardpoints" in path or "offset" in path
        if path in known_values or (is_geometry and path.endswith((".x", ".y"))):
            continue
        # Moments of inertia keep their proportions: the largest is at most the sum of the others.
        factor = 1.04 if "inertia" in path else 1.01 + 0.001 * (index % 37)
        change = f"{path}={value * factor if value else 1e-3!r}"
        try:
            short = reference.with_([change])._from_terms is not None
        except VehicleError:
            # A moment alone may be refused; those of a part together are moved below.
            short = "parts" in path and "inertia" in path
        # Other changes are built by the same code as any car.
        if short:
            groups.setdefault(path.partition(".inertia")[0].rpartition(".")[0], []).append(change)
        else:
            assert not any(word in path for word in (".stiffness", ".damping", "viscous", "friction")), path
    assert len(groups) > 20
    # Tables of four elements at once: the matrices show which number is wrong.
    every = list(groups.values())
    for first in range(0, len(every), 4):
        require_same(reference, file, (), [change for changes in every[first : first + 4] for change in changes])


@pytest.mark.parametrize(("file", "fixed"), [("focus", TABLES), ("sedan", ()), ("focus_road_seated", ())])
def test_many_numbers_at_once(file, fixed):
    reference = Car.load(file, fixed)
    values = numbers(reference.vehicle.table)
    moved = [
        path for path in values if path.endswith((".mass", ".viscous", ".torsional_stiffness")) or ".bushings." in path
    ]
    rng = np.random.default_rng(3)
    changes = [
        f"{path}={values[path] * float(rng.uniform(0.8, 1.25))!r}"
        for path in moved
        if values[path] and not path.startswith(("front.parts.main_spring_upper", "body.model"))
    ]
    assert len(changes) > 30
    require_same(reference, file, fixed, changes)


def test_a_maxwell_branch_that_moves_to_the_other_side_moves_the_forces_on_treads():
    # As many branches as before, in another order; a change of the rolling radius acts on those of the treads.
    fixed = ("driving.speed=22.0", "front.nonuniformity.rolling_runout=[[1, 3e-4, 30]]")
    mount = "bushings.suspension_mount.damping"
    changes = [f"front.right.{mount}=[0.0, 8000.0, 0.0]", f"front.left.{mount}=[4000.0, 8000.0, 4000.0]"]
    reference = Car.load("focus_road", fixed)
    built = Car.load("focus_road", (*fixed, *changes))
    assert not np.array_equal(built.matrices.force_slips, reference.matrices.force_slips)
    same(reference.with_(changes).matrices, built.matrices, "matrices")


def test_a_spring_on_a_corner_of_its_table_has_its_car_built():
    def table(corner, above):
        points = [(-0.4, -0.4 * RATE), (corner, corner * RATE), (0.2, corner * RATE + (0.2 - corner) * above)]
        kinds = zip(("displacement", "force"), zip(*points, strict=True), strict=True)
        return [f"front.main_spring.table.{column}={list(values)!r}" for column, values in kinds]

    reference = Car.load(None, table(0.1, RATE))
    spring = reference._terms.rows.layout.springs.rows[0]
    at = -float(reference.static.preload[spring]) / RATE
    # The two sides differ so little that the spring carries the same force, and is at rest on the breakpoint.
    assert reference.with_(table(at + 0.01, RATE + 1e-3))._from_terms is not None
    assert reference.with_(table(at, RATE + 1e-3))._from_terms is None


@pytest.mark.parametrize(
    "changes",
    [
        TABLES[:2],
        TABLES[4:],
        ["front.bushings.tyre.rotational_stiffness=0.0"],
        [
            "front.damper.viscous_law=degressive",
            "front.damper.degressive_viscous=4e3",
            "front.damper.degressive_velocity=0.1",
        ],
        ["front.hardpoints.stab_end.x=0.88"],
        ["gravity=9.0"],
        ["body.flexible=false"],
    ],
)
def test_another_kind_of_element_or_another_place_is_built(car, changes):
    assert car.with_(changes)._from_terms is None


@pytest.mark.parametrize("changes", [
    ["damper.viscos=1.0"],
    ["damper.viscous=much"],
    ["damper.viscous=-1.0"],
    ["bushings.tyre.stiffness=1.0"],
    ["main_spring.stiffness=1e3"],
    ["body.frequency_scale=0.1"],
    ["engine.parts.engine.mass=999.0", "bushings.hydromount.stiffness.z=0.0"],
    ["bushings.suspension_mount.stiffness.z=0.0"],
])  # fmt: skip
def test_what_is_wrong_is_said_as_of_a_built_car(car, changes):
    varied, built = (
        outcome(lambda make=make: make(changes)) for make in (car.with_, lambda more: Car.load(None, more))
    )
    if isinstance(built, str):
        assert varied == built
    else:
        same(varied.matrices, built.matrices, "matrices")


def test_a_star_means_what_it_means_to_a_built_car():
    fixed, stars = ["front.damper.gas_force=50.0"], ["*.damper.gas_force=100.0", "*.damper.viscous=2000.0"]
    varied = Car.load("focus_road", fixed).with_(stars).vehicle
    assert varied == Car.load("focus_road", [*fixed, *stars]).vehicle
    # The rear one has it too now, which had none.
    assert [damper.law.gas_force for damper in varied.composition.dampers] == [100.0] * 4


def test_a_varied_car_can_be_varied_and_has_a_model_where_one_is_asked_for(car):
    once = car.with_(["damper.viscous=2000.0"])
    twice = once.with_(["main_spring.stiffness=2.2e4"])
    assert twice.overrides == ("damper.viscous=2000.0", "main_spring.stiffness=2.2e4")
    same(twice.static.tyre_load, Car.load(None, twice.overrides).model.static.tyre_load, "tyre load")
    assert twice.model.static.tyre_load == pytest.approx(twice.static.tyre_load, rel=1e-9)
    assert twice.model.vehicle is twice.vehicle


def test_a_variant_is_freed_without_the_garbage_collector():
    reference = Car.load("focus_road")
    reference.with_({"front.damper.viscous": 1400.0}).check("reduced")
    gc.disable()
    try:
        varied = reference.with_({"front.damper.viscous": 1500.0})
        varied.check("reduced")
        freed = weakref.ref(varied)
        del varied
        assert freed() is None
    finally:
        gc.enable()


def bits(value):
    """Return the bytes of all arrays of an object, and the texts of its other values."""
    if isinstance(value, np.ndarray):
        return value.tobytes() if value.dtype != object else [bits(each) for each in value.tolist()]
    if isinstance(value, dict):
        return [(key, bits(each)) for key, each in value.items()]
    if isinstance(value, (list, tuple)):
        return [bits(each) for each in value]
    if is_dataclass(value) and not isinstance(value, type):
        return [(entry.name, bits(getattr(value, entry.name))) for entry in fields(value)]
    return repr(value)


DAMPER = "front.damper."

PRESLIDING = {"friction_law": "presliding", "presliding_stiffness": 2e6}


@pytest.mark.parametrize(
    ("shared", "one", "other", "equal"),
    [
        ({}, {"coulomb_friction": 60.0}, {"coulomb_friction": 90.0}, True),
        ({"friction_law": "stribeck", "stribeck_friction": 200.0}, {"stribeck_velocity": 0.02},
         {"stribeck_velocity": 0.05, "stribeck_friction": 260.0, "stribeck_exponent": 2.0}, True),
        ({"viscous_law": "degressive"}, {"degressive_viscous": 9e3}, {"degressive_viscous": 12e3}, True),
        ({"side_force_coefficient": 0.05}, {"coulomb_friction": 60.0}, {"coulomb_friction": 90.0}, True),
        ({}, {"viscous": 1500.0}, {"viscous": 1500.1}, False),
        ({}, {"gas_force": 100.0}, {"gas_force": 110.0}, False),
        ({}, {"side_force_coefficient": 0.04}, {"side_force_coefficient": 0.05}, False),
        (PRESLIDING, {"coulomb_friction": 60.0}, {"coulomb_friction": 90.0}, True),
        (PRESLIDING, {"presliding_stiffness": 1e6}, {"presliding_stiffness": 1.1e6}, False),
    ],
)  # fmt: skip
def test_cars_of_equal_matrices_share_them(shared, one, other, equal):
    """The matrices of the second car equal, bit by bit, those from the terms of a base car that has stored none."""
    base, fresh = (Car.load("focus_road", {f"{DAMPER}{key}": value for key, value in shared.items()}) for _ in "ab")
    first, second = (base.with_({f"{DAMPER}{key}": value for key, value in each.items()}) for each in (one, other))
    alone = fresh.with_(dict(zip([f"{DAMPER}{key}" for key in other], other.values(), strict=True)))
    assert first._from_terms is not None
    assert (first.matrices is second.matrices) == (first.poles is second.poles) == equal
    assert bits(second.matrices) == bits(alone.matrices) and bits(second.static) == bits(alone.static)
    assert second.vehicle.composition.dampers != first.vehicle.composition.dampers
