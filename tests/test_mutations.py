"""The seeded faults of `tools/mutations.py` can be tried: each text stands once, and its tests exist."""

from tools.mutations import FAULTS, ROOT


def test_every_fault_has_its_place_and_its_tests():
    assert len(FAULTS) >= 40
    moved = [fault.file for fault in FAULTS if (ROOT / fault.file).read_text(encoding="utf-8").count(fault.old) != 1]
    missing = {name for fault in FAULTS for name in fault.tests.split() if not (ROOT / "tests" / name).exists()}
    assert moved == [] and missing == set()
