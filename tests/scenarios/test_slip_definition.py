"""The section on the one definition of slip."""

from scenarios.slip_definition import definition_lines


def content(bump_slip=5.055):
    shares = {"low": ([0.0, 0.0], [0.001, 0.0]), "mid": ([0.04, 0.0], [0.15, 0.01]), "high": ([0.2, 0.0], [0.35, 0.04])}
    point = {"value": 125.0, "slip": 0.3, "saturated": 0.45}
    return {
        "levels": {
            "slip_velocity": 0.012,
            "levels": {level: {"slip": slip, "saturated": loose} for level, (slip, loose) in shares.items()},
        },
        "comfort_sensitivity": {
            "source": {
                "coulomb_friction": {"smooth": [{"value": 62.5}, point], "rough": [{**point, "slip": 0.8}]},
            }
        },
        "bump": {
            "first_slip_s": {"125 N": bump_slip},
            "first_saturated_s": {"125 N": 5.038},
            "low_bump": {"largest_velocity": 0.008, "time_above_1_mm_s": 0.025},
        },
    }


def test_both_velocities_stand_beside_the_print_with_what_agrees():
    lines = definition_lines(content())
    assert lines[0] == "## One definition of slip"
    assert "| slip share, right damper, mid | 3.9 % | 4.0 % | yes | 15.0 % | NO |" in lines
    assert "| slip share, left damper, high | 0 % | 0.0 % | yes | 4.0 % | NO |" in lines
    assert "| slip share, smooth road | 31.3 % | 30.0 % | yes | 45.0 % | NO |" in lines
    assert "| first slip, 7.5 mm bump | 5.035 s | 5.055 s | NO | 5.038 s | yes |" in lines
    assert "| 1.5 mm bump | no slip | largest 8.0 mm/s | yes | for 25 ms | NO |" in lines
    assert len([line for line in lines if line.startswith("| ")]) == 1 + 6 + 2 + 2
    assert "| first slip, 7.5 mm bump | 5.035 s | never | NO | 5.038 s | yes |" in definition_lines(content(None))


def test_without_one_of_its_scenarios_there_is_no_section():
    part = content()
    del part["bump"]
    assert definition_lines(part) == []
