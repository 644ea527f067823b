"""Controllers in FMUs: the call against the own law, its timing, and FMUs that are refused."""

import json
import sys
import zipfile
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[fmu]'")

from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.core import laws as core_laws
from tests.core.laws import called
from tests.model.laws.controller_files import NUMBERS, PARAMETERS, controller_fmu
from tools.controller_library import FOLDER, digests
from vehicle.core.trusted_code import trust
from vehicle.errors import ConfigurationError, DataError, SimulationError
from vehicle.model.laws.control_laws import PRESENT, act, at_rest, demanded, in_steps, pack
from vehicle.model.laws.controller_fmu import NOT_FINITE, TERMINATED, Controller, controllers, read_controller
from vehicle.signals.formats.file_digest import digest

if sys.platform != "linux":
    pytest.skip("the library of the tests is for Linux", allow_module_level=True)

SKYHOOK = replace(half_car_rider_parameters().semi_active, law="skyhook")
STEP = 1e-3
VERSIONS = pytest.mark.parametrize("version", ["2", "3"])


def started(path, control=SKYHOOK, messages=None):
    return Controller(
        read_controller(path, trust(path)), "damper_fr", control, STEP, [] if messages is None else messages
    )


def outside(control, path):
    """A control whose law is that of an FMU with its digest."""
    return replace(control, law="fmu", fmu=str(path), fmu_sha256=trust(path))


def speeds(count=200):
    return np.random.default_rng(7).normal(size=(count, 2)) * 0.3


def test_the_library_is_built_from_this_source():
    stamp = json.loads((FOLDER / "stamp.json").read_text())
    assert stamp == digests(), "build the library again: python tools/controller_library.py"


@VERSIONS
def test_the_call_equals_the_own_law(tmp_path, version):
    path = controller_fmu(tmp_path / "skyhook.fmu", version)
    record = in_steps(pack(SKYHOOK), STEP)
    wanted = [float(demanded(record, body, wheel)) for body, wheel in [*speeds(), (0.0, 0.0)]]
    controller = started(path)
    for n, (body, wheel) in enumerate([*speeds(), (0.0, 0.0)]):
        assert called(controller.address, body, wheel) == pytest.approx(wanted[n], rel=1e-14)
    assert controller.record.memory.readings == len(wanted)
    controller.close()


@VERSIONS
def test_a_damper_with_period_delay_and_rate_equals_the_own_law(tmp_path, version):
    path = controller_fmu(tmp_path / "skyhook.fmu", version)
    own = replace(SKYHOOK, control_period=3e-3, delay=2e-3, rate=2e5)
    record, other_record = (in_steps(pack(control), STEP) for control in (own, outside(own, path)))
    past, other = at_rest(record), at_rest(other_record)
    laws = np.array([other_record])
    with controllers(laws, [("damper_fr", outside(own, path))], STEP) as check:
        for step, (body, wheel) in enumerate(speeds()):
            act(record, step, body, wheel, past)
            core_laws.act(laws, step, body, wheel, other)
            assert other[PRESENT] == pytest.approx(past[PRESENT], rel=1e-13)
        check()
    assert laws["controller"][0] == 0.0


@pytest.mark.parametrize(("sensor", "wanted"), [
    ("damper_velocity", lambda body, wheel: body - wheel),
    ("body_acceleration", lambda body, wheel: np.diff(body, prepend=body[:1]) / STEP),
    ("wheel_acceleration", lambda body, wheel: np.diff(wheel, prepend=wheel[:1]) / STEP),
])  # fmt: skip
def test_values_and_times_of_the_sensors(tmp_path, sensor, wanted):
    # The output is the input itself.
    numbers = {**NUMBERS, "coefficient": NUMBERS[sensor]}
    path = controller_fmu(tmp_path / "sensor.fmu", inputs=("wheel_velocity", sensor), references=numbers)
    controller = started(path)
    found = [called(controller.address, body, wheel) for body, wheel in speeds()]
    np.testing.assert_allclose(found, wanted(*speeds().T), rtol=1e-14, atol=1e-12)
    controller.close()


MILLIMETRES = (
    '<Unit name="mm/s"><BaseUnit m="1" s="-1" factor="0.001"/></Unit>'
    '<Unit name="shifted"><BaseUnit m="1" s="-1" factor="0.001" offset="0.5"/></Unit>'
    '<Unit name="N.s/mm"><BaseUnit kg="1" s="-1" factor="1000"/></Unit>'
)


@VERSIONS
@pytest.mark.parametrize(("units", "wanted"), [
    ({"damper_velocity": 'unit="mm/s"'}, lambda v: 1e3 * v),
    ({"damper_velocity": 'unit="shifted"'}, lambda v: 1e3 * (v - 0.5)),
    ({"damper_velocity": 'unit="shifted" relativeQuantity="true"'}, lambda v: 1e3 * v),
    ({"damper_velocity": 'unit="km/h"'}, lambda v: 3.6 * v),
    ({"damper_velocity": 'unit="m/s"', "coefficient": 'unit="N.s/mm"'}, lambda v: 1e3 * v),
    ({"coefficient": 'unit="N s/m"', "wheel_velocity": 'unit="mm/s"'}, lambda v: v),
])  # fmt: skip
def test_variables_are_converted_by_their_declared_units(tmp_path, version, units, wanted):
    # The output is the input itself.
    path = controller_fmu(
        tmp_path / "units.fmu", version, inputs=("wheel_velocity", "damper_velocity"), units=units,
        references={**NUMBERS, "coefficient": NUMBERS["damper_velocity"]}, definitions=MILLIMETRES,
    )  # fmt: skip
    controller = started(path)
    found = [called(controller.address, body, wheel) for body, wheel in speeds()]
    np.testing.assert_allclose(found, wanted(-np.diff(speeds()).ravel()), rtol=1e-12, atol=1e-12)
    controller.close()


def test_parameters_are_converted_by_their_declared_units(tmp_path):
    units = dict.fromkeys(PARAMETERS, 'unit="N.s/mm"')
    scaled = started(controller_fmu(tmp_path / "scaled.fmu", units=units, definitions=MILLIMETRES))
    plain = started(controller_fmu(tmp_path / "si.fmu"))
    for body, wheel in speeds():
        # The coefficient has no unit, so it is as large as in N s/mm.
        assert called(scaled.address, body, wheel) == pytest.approx(
            1e-3 * called(plain.address, body, wheel), rel=1e-12
        )
    scaled.close()
    plain.close()


@pytest.mark.parametrize(("attribute", "text"), [
    ('unit="furlong/h"', "has the unit 'furlong/h' without a BaseUnit in its model description"),
    ('unit="mm"', "has the unit 'mm' without a BaseUnit"),
    ('unit="N.s/mm"', "has the unit 'N.s/mm', 1000 kg^1 s^-1, must be a unit of m/s"),
])  # fmt: skip
def test_a_unit_of_another_dimension_is_refused(tmp_path, attribute, text):
    path = controller_fmu(tmp_path / "bad.fmu", units={"body_velocity": attribute}, definitions=MILLIMETRES)
    with pytest.raises(DataError) as caught:
        read_controller(path, trust(path))
    assert text in str(caught.value)


def test_the_coefficient_stays_within_the_damper(tmp_path):
    # Without parameters the gain of the FMU is 1000, and its limits are wider than those of the damper.
    path = controller_fmu(tmp_path / "wide.fmu", parameters=())
    control = outside(replace(SKYHOOK, minimum_damping=400.0, maximum_damping=600.0), path)
    laws = np.array([in_steps(pack(control), STEP)])
    with controllers(laws, [("damper_fr", control)], STEP):
        found = [core_laws.demanded(laws, body, wheel) for body, wheel in speeds()]
    assert min(found) == 400.0 and max(found) == 600.0
    assert any(400.0 < value < 600.0 for value in found)


def test_instances_and_runs_are_independent(tmp_path):
    path = controller_fmu(tmp_path / "skyhook.fmu")
    firm, soft = started(path, replace(SKYHOOK, skyhook_damping=5000.0)), started(path)
    first = [called(each.address, 0.1, -0.1) for each in (firm, soft)]
    assert first == pytest.approx([2500.0, 1500.0], rel=1e-14)
    # A library of its own each: also global variables would be separate.
    assert firm.record.memory.set != soft.record.memory.set
    again = started(path)
    assert called(again.address, 0.1, -0.1) == first[1]
    for each in (firm, soft, again):
        each.close()


@pytest.mark.parametrize(("version", "fault", "status", "text"), [
    *((version, 0.25, NOT_FINITE, "returns a coefficient that is not a finite number") for version in "23"),
    ("3", 0.5, TERMINATED, "requests the end of the simulation"),
    *((version, 0.75, 3, "reports an error") for version in "23"),
])  # fmt: skip
def test_a_failure_in_a_run_is_said_with_its_time(tmp_path, version, fault, status, text):
    path = controller_fmu(tmp_path / "faulty.fmu", version, parameters=(*PARAMETERS, "skyhook_share"))
    controller = started(path, replace(SKYHOOK, skyhook_share=fault))
    answers = [called(controller.address, 0.3, 0.1) for _ in range(120)]
    assert len(set(answers)) == 1 and controller.record.memory.status == status
    with pytest.raises(SimulationError) as caught:
        controller.check()
    message = str(caught.value)
    assert f"damper_fr: controller faulty.fmu {text} at t = 0.1000 s" in message
    assert ("with the message 'the controller fails from 0.1 s on'" in message) == (fault == 0.75)
    assert "control_period = 0.001 s" in message
    controller.close()


REFUSED: dict[str, tuple[dict[str, Any], type[Exception], str]] = {
    "model exchange": ({"form": "ModelExchange"}, DataError, "is not for co-simulation; export it as FMI 2.0 or 3.0"),
    "platform": ({"platform": "win64"}, DataError, "has no library for linux64, but for win64; export it on this"),
    "inputs": (
        {"inputs": ("body_velocity", "v_wheel")},
        DataError,
        ("found inputs body_velocity, v_wheel and outputs coefficient"),
    ),
    "no input": ({"inputs": ()}, DataError, "found inputs none"),
    "output": ({"output": "c"}, DataError, "outputs c; must be inputs among body_velocity, wheel_velocity"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_an_unsuitable_fmu_is_refused_with_the_remedy(tmp_path, case):
    options, error, text = REFUSED[case]
    path = controller_fmu(tmp_path / "bad.fmu", **options)
    with pytest.raises(error) as caught:
        read_controller(path, trust(path))
    assert str(caught.value).startswith(f"controller {path}: ") and text in str(caught.value)


def test_a_file_that_is_missing_or_no_fmu_is_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="the file does not exist"):
        read_controller(tmp_path / "none.fmu", "")
    (tmp_path / "text.fmu").write_text("no archive")
    with pytest.raises(DataError, match=r"cannot be read as an FMU .*; export it as FMI 2\.0 or 3\.0 co-simulation"):
        read_controller(tmp_path / "text.fmu", trust(tmp_path / "text.fmu"))


def test_native_code_runs_only_by_the_word_of_the_user(tmp_path, monkeypatch):
    """The digest in a vehicle file allows nothing; it must fit."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    path = controller_fmu(tmp_path / "skyhook.fmu")
    for named in (None, digest(path)):
        with pytest.raises(ConfigurationError, match=f'native code.* you have not allowed .* trust "{path}"'):
            read_controller(path, named)
    assert trust(path) == digest(path) and read_controller(path, None).path == path
    with pytest.raises(ConfigurationError, match="the FMU has changed: its SHA-256 is"):
        read_controller(path, digest(path)[::-1])


@pytest.mark.parametrize(("size", "found"), [(300, "0.279 GiB but may need at most 0.186 GiB"),
                                             (150, "to 1, must be at most 200 to 1")])  # fmt: skip
def test_an_fmu_that_would_fill_the_disk_is_refused_before_it_is_unpacked(tmp_path, size, found):
    path = controller_fmu(tmp_path / "skyhook.fmu")
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("resources/zeros.bin", bytes(size * 10**6))
    with pytest.raises(DataError, match=f"cannot be read as an FMU .*{found}"):
        read_controller(path, trust(path))


@VERSIONS
def test_an_fmu_that_does_not_start_is_refused(tmp_path, version):
    path = controller_fmu(tmp_path / "other.fmu", version, token="{another}")
    with pytest.raises(SimulationError, match=r"damper_fr: controller other\.fmu cannot be started \("):
        started(path)


def test_without_fmpy_the_extra_is_named(tmp_path, monkeypatch):
    from vehicle.errors import MissingPartError

    path = controller_fmu(tmp_path / "skyhook.fmu")
    monkeypatch.setitem(sys.modules, "fmpy", None)
    with pytest.raises(MissingPartError, match=r"needs FMPy.*pip install 'vehicle-on-shaker\[fmu\]'"):
        read_controller(path, trust(path))
