"""Options of findings are joined to a command line."""

import pickle

import pytest

from vehicle.signals.records.finding import Finding, FindingError, added, findings_of


@pytest.mark.parametrize(
    ("words", "options", "joined"),
    [
        ("F", "--detrend", "F --detrend"),
        ("F --detrend", "--detrend", "F --detrend"),
        ("--map a=1 F --map b=2", "--map a=2 --map b=1", "F --map a=2 --map b=1"),
        ("--map=a=1 F", "--map a=2", "F --map a=2"),
        ("F --unit z=g", "--unit z=m/s2 --unit x=g", "F --unit z=m/s2 --unit x=g"),
        ("F --to 10", "--to 12", "F --to 10"),
        ("F --from 1", "--from 2.5", "F --from 2.5"),
        ("F --turn a", "--turn b", "F --turn a --turn b"),
        ("F --turn a", "--turn a", "F"),
        ("F --delay 2", "--delay accelerations=3ms", "F --delay 2 --delay accelerations=3ms"),
        ("F --delay 2", "--delay 0.5", "F --delay 0.5"),
    ],
)
def test_options_replace_those_of_the_same_role(words, options, joined):
    assert added(words.split(), options.split()) == joined.split()


def test_a_finding_is_text_with_options():
    finding = Finding("z: inverted", "sign", ("--turn", "z"))
    again = pickle.loads(pickle.dumps(finding))
    assert (again, again.kind, again.options) == ("z: inverted", "sign", ("--turn", "z"))
    assert findings_of(["a notice", finding, finding]) == [finding]
    assert findings_of([finding], kinds=("unit",)) == []
    assert finding.within("file: ").options == ("--turn", "z")


def test_an_error_of_findings_can_be_pickled():
    """A worker of several processes hands its error over."""
    again = pickle.loads(pickle.dumps(FindingError("a.csv", [Finding("z: inverted", "sign", ("--turn", "z"))])))
    assert str(again) == "a.csv: z: inverted" and again.findings[0].options == ("--turn", "z")
