"""The course: answers of its exercises by a second way, hints for wrong answers, notebooks made of its pages."""

import json
import math
import re

import numpy as np
import pytest
from scipy import linalg, optimize, signal

from scenarios.course.check import main
from scenarios.course.lessons import BODY, EXERCISES, FORCES, FRICTION, SPEEDS, SPRING, TYRE, WHEEL
from tools.course_notebooks import COURSE, lessons, notebook

TURN = 2.0 * math.pi


def slips_from():
    """Smallest amplitude [mm] of a plate at 2 Hz that makes a body on a friction element slip.

    The body takes the speed of the plate at the end of each time step, unless that needs more than the friction force.
    """
    amplitude, step = np.linspace(0.5e-3, 2.5e-3, 2001), 1e-4
    speed, slipped = np.zeros(amplitude.size), np.zeros(amplitude.size, bool)
    for time in np.arange(0.0, 1.0, step):
        plate = amplitude * TURN * 2.0 * math.sin(TURN * 2.0 * time)  # at rest at the start, without a jump
        force = np.clip(BODY * (plate - speed) / step, -FRICTION, FRICTION)
        speed = speed + step * force / BODY
        slipped |= np.abs(plate - speed) > 1e-12
    return 1e3 * amplitude[slipped].min()


def same_loss():
    """Viscous constant [N s/m] whose work in a cycle is that of friction: both integrated over time."""
    time = np.linspace(0.0, 1.0 / 1.25, 20001)
    speed = 5e-3 * TURN * 1.25 * np.cos(TURN * 1.25 * time)
    return np.trapezoid(FRICTION * np.sign(speed) * speed, time) / np.trapezoid(speed**2, time)


def scatter_of_the_gain():
    """Standard deviation of |H| [%] over 20 000 records of 20 windows, noise a quarter of the power of the output."""
    draws = np.random.default_rng(1).normal(size=(2, 20_000, 20))
    response = 1.0 + math.sqrt(0.25 / 2.0) * (draws[0] + 1j * draws[1])
    return 100.0 * np.abs(response.mean(axis=1)).std()


def rms_of_the_response():
    """RMS [m/s2] of 1500 times a sum of sines with 1e-8 m2/Hz from 4 to 8 Hz."""
    lines = np.arange(4.05, 8.0, 0.1)
    phases = np.random.default_rng(2).uniform(0.0, TURN, lines.size)
    time = np.arange(0.0, 20.0, 0.01)
    plate = math.sqrt(2.0 * 1e-8 * 0.1) * np.cos(TURN * np.outer(time, lines) + phases).sum(axis=1)
    return 1500.0 * plate.std()


def frequency(mass, stiffness, number):
    return math.sqrt(linalg.eigh(stiffness, np.diag(mass), eigvals_only=True)[number]) / TURN


def hop_of_two_masses():
    """Upper natural frequency [Hz] of body and wheel, the body so heavy that it stays."""
    return frequency([1e9, WHEEL], np.array([[SPRING, -SPRING], [-SPRING, SPRING + TYRE]]), 1)


def heave_of_a_rigid_strut():
    """Lower natural frequency [Hz] of body and wheel, the strut a spring of 1e10 N/m."""
    return frequency([BODY, WHEEL], np.array([[1e10, -1e10], [-1e10, 1e10 + TYRE]]), 0)


def filtered_sine():
    """RMS [m/s2] of the output of Wk, stepped in time, with a sine of 0.8 m/s2 and 16 Hz as its input."""
    w = TURN * np.array([0.4, 100.0, 12.5, 2.37, 3.35])
    upper = np.polymul([w[1] ** 2 * (w[3] / w[4]) ** 2, 0.0, 0.0], [1.0 / w[2], 1.0])
    upper = np.polymul(upper, [1.0 / w[3] ** 2, 1.0 / (0.91 * w[3]), 1.0])
    lower = np.polymul([1.0, math.sqrt(2.0) * w[0], w[0] ** 2], [1.0, math.sqrt(2.0) * w[1], w[1] ** 2])
    lower = np.polymul(lower, [1.0 / w[2] ** 2, 1.0 / (0.63 * w[2]), 1.0])
    lower = np.polymul(lower, [1.0 / w[4] ** 2, 1.0 / (0.91 * w[4]), 1.0])
    time = np.arange(0.0, 12.0, 1.0 / 2000.0)
    _, output, _ = signal.lsim((upper, lower), 0.8 * np.sin(TURN * 16.0 * time), time)
    return output[-8000:].std()


def record_of_two_roads():
    """RMS [m/s2] of a record of 15 and 5 parts with the levels 0.3 and 0.9 m/s2."""
    noise = np.random.default_rng(3).normal(size=(20, 20_000))
    noise /= noise.std(axis=1)[:, None]
    return np.sqrt(np.mean((noise * np.repeat([0.3, 0.9], [15, 5])[:, None]) ** 2))


def height_of_a_road():
    """RMS height [mm] of a profile of class B between 1 and 2 Hz at 20 m/s: a sum of waves over the distance."""
    waves = np.arange(0.05, 0.1, 1e-4) + 0.5e-4
    sizes = np.sqrt(2.0 * 64e-6 * (waves / 0.1) ** -2 * 1e-4)
    phases = np.random.default_rng(4).uniform(0.0, TURN, waves.size)
    distance = np.arange(0.0, 10_000.0, 2.0)
    return 1e3 * (sizes * np.cos(TURN * np.outer(distance, waves) + phases)).sum(axis=1).std()


def slowest_common_heave():
    """Highest speed [km/h] with the least mean of both axles on a wave of 1.3 Hz."""
    speed = np.linspace(20.0, 60.0, 40_001)
    mean = np.abs(1.0 + np.exp(-1j * TURN * 1.3 * 2.6 / (speed / 3.6)))
    return speed[np.argmin(mean)]


def ratio_of_a_decay():
    """Damping ratio [%] whose free vibration falls to a fifth in three cycles: peaks of a solution, root by search."""

    def fall(ratio):
        time = np.linspace(0.0, 4.0 * TURN, 40_001)
        swing = math.sqrt(1.0 - ratio**2)
        motion = np.exp(-ratio * time) * (np.cos(swing * time) + ratio / swing * np.sin(swing * time))
        peaks = signal.argrelmax(motion)[0]
        return motion[peaks[2]] - 0.2  # the third maximum after the release at 1

    return 100.0 * optimize.brentq(fall, 0.01, 0.3)


def calmest_body():
    """Damping [N s/m] with the least acceleration of the body, road velocity white: covariance by Lyapunov."""

    def mean_square(damping):
        body = np.array([-SPRING / BODY, -damping / BODY, 0.0, damping / BODY])
        wheel = np.array([SPRING, damping, -TYRE, -damping]) / WHEEL
        matrix = np.array([[0.0, 1.0, 0.0, -1.0], body, [0.0, 0.0, 0.0, 1.0], wheel])
        covariance = linalg.solve_continuous_lyapunov(matrix, -np.diag([0.0, 0.0, 1.0, 0.0]))
        return body @ covariance @ body

    return optimize.minimize_scalar(mean_square, bounds=(100.0, 5000.0), method="bounded").x


def damper_of_equal_work():
    """Damper constant [N s/m] that takes the work of 1500 N s/m at the wheel, by the work of a cycle."""
    speed = np.cos(np.linspace(0.0, TURN, 1001))
    return np.mean(1500.0 * speed**2) / np.mean((0.6 * speed) ** 2)


def shortest_way():
    """Factor on the damping in the smallest change, by a search with a constraint."""
    aim = {"type": "eq", "fun": lambda change: change[0] - 0.5 * change[1] - math.log(1.2)}
    return math.exp(optimize.minimize(lambda change: change @ change, [0.1, 0.0], constraints=[aim]).x[0])


def quantile_of_runs():
    """Value [m/s2] of which 95 % of 400 000 repetitions with 4 % of error stay below 0.80 m/s2."""
    return 0.80 / np.quantile(1.0 + 0.04 * np.random.default_rng(5).normal(size=400_000), 0.95)


SECOND_WAY = {
    "1.1": slips_from,
    "1.2": same_loss,
    "2.1": scatter_of_the_gain,
    "2.2": rms_of_the_response,
    "3.1": hop_of_two_masses,
    "3.2": heave_of_a_rigid_strut,
    "4.1": filtered_sine,
    "4.2": record_of_two_roads,
    "5.1": height_of_a_road,
    "5.2": slowest_common_heave,
    "6.1": ratio_of_a_decay,
    "6.2": lambda: np.polyfit(SPEEDS, FORCES, 1)[0],
    "7.1": calmest_body,
    "7.2": damper_of_equal_work,
    "8.1": shortest_way,
    "8.2": quantile_of_runs,
}


def said(capsys, number, answer):
    """Output of the command for an answer, without the number of the exercise."""
    assert main([number, answer]) == 0
    line = capsys.readouterr().out
    assert line.startswith(f"{number} ") and line.count("\n") == 1
    return line.removeprefix(f"{number} ").strip()


@pytest.mark.parametrize("number", EXERCISES)
def test_the_answer_by_a_second_way_is_right(number, capsys):
    exercise = EXERCISES[number]
    value = SECOND_WAY[number]()
    assert value == pytest.approx(exercise.value, rel=0.5 * exercise.tolerance)
    assert said(capsys, number, f"{value:.6g} {exercise.unit}").startswith("right: ")
    assert said(capsys, number, f"{float(f'{exercise.value:.3g}'):g} {exercise.unit}").startswith("right: ")


@pytest.mark.parametrize("number", EXERCISES)
def test_each_slip_is_refused_with_its_hint(number, capsys):
    exercise = EXERCISES[number]
    assert len(exercise.slips) >= 3
    for slip in exercise.slips:
        assert said(capsys, number, f"{slip.value:.6g} {exercise.unit}") == f"not yet: {slip.hint}"
    assert said(capsys, number, f"{7.7 * exercise.value:g} {exercise.unit}") == f"not yet: {exercise.remedy}"


@pytest.mark.parametrize("number", EXERCISES)
def test_no_slip_is_taken_for_the_answer_or_another_slip(number):
    exercise = EXERCISES[number]
    known = [(exercise.value, "")] + [(slip.value, slip.hint) for slip in exercise.slips]
    for index, (value, hint) in enumerate(known):
        for other, text in known[index + 1 :]:
            assert hint == text or abs(value - other) > exercise.tolerance * (abs(value) + abs(other))


def test_units_and_sizes(capsys):
    assert said(capsys, "1.1", "0.001187 m").startswith("right: 1.19 mm")
    assert said(capsys, "2.1", "0.0791 -").startswith("not yet: - is no unit of this answer")
    assert said(capsys, "8.1", "115.7 %") == said(capsys, "8.1", "1.157") == "right: 1.16"
    assert said(capsys, "5.2", "6.76 m/s").startswith("right: 24.3 km/h")
    assert said(capsys, "1.1", "1.187") == "not yet: the unit is missing; the answer is in mm"
    assert said(capsys, "1.1", "1.187 N") == "not yet: N is no unit of this answer; the answer is in mm"
    assert "1000 times too large" in said(capsys, "1.1", "1.187 m")
    assert said(capsys, "6.2", "-1481 N s/m") == "not yet: look at the sign"
    assert said(capsys, "6.2", "1.481 N s/mm").startswith("right: 1480")


def test_what_is_no_answer_is_an_error(capsys):
    assert main(["1.1", "many mm"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: 'many mm': no number") and "'12 mm'" in said
    assert main(["9.1", "1 mm"]) == 2
    assert capsys.readouterr().err.startswith("error: exercise '9.1': must be 1.1, 1.2, ")


def code_of(page):
    """Lines of commands and scripts of a page that a notebook must have."""
    text = re.sub(r"\\\n> *", "", page.read_text(encoding="utf-8"))
    return [line[2:] for line in text.splitlines() if line.startswith("$ ") and not line.endswith(".py")]


@pytest.mark.parametrize("page", lessons(), ids=lambda page: page.stem)
def test_a_notebook_is_its_page(page, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    made = notebook(page, tmp_path)
    nbformat.validate(nbformat.reads(json.dumps(made), as_version=4))
    code = "\n".join(cell["source"] for cell in made["cells"] if cell["cell_type"] == "code")
    prose = "\n".join(cell["source"] for cell in made["cells"] if cell["cell_type"] == "markdown")
    assert [line[1:] for line in code.splitlines() if line.startswith("!")] == code_of(page)
    compile(re.sub(r"^(!|%%).*$", "", code, flags=re.MULTILINE), page.stem, "exec")
    assert not any(text in prose for text in ("$ python", "<!--", "```{"))
    for link in re.findall(r"\]\(([^)\s#]+)", prose):
        assert link.startswith("http") or (tmp_path / link).exists(), link


@pytest.mark.parametrize("page", lessons(), ids=lambda page: page.stem)
def test_a_lesson_has_two_exercises_with_answers_that_are_checked(page):
    lesson = page.stem[0]
    text = page.read_text(encoding="utf-8")
    assert re.findall(r"^\*\*Exercise (\d\.\d)", text, re.MULTILINE) == [f"{lesson}.1", f"{lesson}.2"]
    checks = re.findall(rf"^\$ python -m scenarios\.course\.check {lesson}\.[12] .*\n(.*)$", text, re.MULTILINE)
    assert len(checks) >= 2 and all(": " in line for line in checks)
    assert not any(" right: " in line for line in checks), "the page gives the answer away"


def test_a_word_is_explained_where_it_stands_first():
    """Each word that a page explains is bold at its first place in the course.

    Headings, aims of a page, its links to others, and code are left out.
    """
    texts = []
    for page in lessons():
        text = re.sub(
            r"^```.*?^```$|^## Next.*|^#[^\n]*|^45 minutes\..*?\n\n",
            "",
            page.read_text(encoding="utf-8"),
            flags=re.M | re.S,
        )
        texts.append(re.sub(r"\]\([^)]*\)|`[^`]*`", "", text))
    whole = " ".join("\n".join(texts).split())
    words = [word for word in re.findall(r"\*\*([^*]+)\*\*", whole) if not re.match(r"Exercise \d|\d+ min", word)]
    assert len(words) > 50 and len(words) == len(set(words))
    for word in words:
        first = re.search(rf"(?<![\w-]){re.escape(word)}(?:e?s)?(?![\w-])", whole, re.IGNORECASE)
        assert first is not None and whole[first.start() - 2 : first.start()] == "**", f"{word} before it is explained"


def test_the_teacher_finds_every_lesson():
    text = (COURSE / "teacher.md").read_text(encoding="utf-8")
    for page in lessons():
        assert f"]({page.name})" in text
    for number, exercise in EXERCISES.items():
        answer = re.search(rf"^\| {re.escape(number)} \| ([\d.]+)", text, re.MULTILINE)
        assert answer is not None and float(answer[1]) == pytest.approx(exercise.value, rel=0.5 * exercise.tolerance)
