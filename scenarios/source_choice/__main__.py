"""Joint choice of what Bommer 2006 does not print, on half of its statements; the other half is held out.

python -m scenarios.source_choice [--output DIR] [--quick] [--jobs N]
"""

import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.evidence import EVIDENCE, HALF_SEED, USED
from scenarios.interval_probability import AGREES_ABOVE
from scenarios.source_choice.candidates import BRACKETS, DAMPING, IXX, PLATES, SLIP_VELOCITIES, TODAY, Rig, all_sides
from scenarios.source_choice.figures import side_figure
from scenarios.source_choice.likelihood import (
    BARE_MENTION,
    MISREADING,
    NUMBERS,
    Candidate,
    agreement,
    best,
    jackknife,
    probabilities,
    shipped_numbers,
    table,
    values_of,
)
from scenarios.source_choice.runs import Plan, Readings, readings
from scenarios.study import QUICK_NOTE, Study, StudySettings, study_parser
from vehicle.arrays import Vector
from vehicle.studies.sweeps.executors import process_pool

EVERY = frozenset(row.key for row in EVIDENCE)
HELD = EVERY - USED

FULL = Plan()

QUICK = Plan(seeds=2, shaker_edges=(2.5, 6.0), road_edges=(0.017, 0.029), shaker_s=8.0, road_s=8.0)

BEFORE = {"velocity": 0.012, "shaker": 6.0, "road": 0.029}
"""Slip velocity [m/s] and edges [Hz] that were fitted to the eight slip shares alone."""

SHOWN = 10
"""Rigs in the table of runners-up."""

POINTS = 0.10
"""Largest difference of the shares of rows that agree in both halves."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Judged:
    """Log-likelihoods of all candidates with one plan of inputs."""

    plan: Plan  # the inputs
    found: Mapping[Rig, Readings]  # rig with the roof point at -y to its readings, which contain both roof points
    # used, held: rig to log-likelihoods of the half used for the choice and of the held-out half, axes as `NUMBERS`
    used: Mapping[Rig, Vector]
    held: Mapping[Rig, Vector]

    def of(self, candidate: Candidate) -> Readings:
        """Return the readings of a candidate."""
        return self.found[replace(candidate.rig, roof="-y")]

    def numbers(self, candidate: Candidate) -> tuple[float, float, float, float]:
        """Return the log-likelihoods of both halves, and the shares of agreeing rows of both halves."""
        at = tuple(getattr(candidate, name) for name in NUMBERS)
        by_row = probabilities(self.of(candidate), candidate, self.plan)
        first, second = (float(half[candidate.rig][at]) for half in (self.used, self.held))
        return first, second, agreement(by_row, sorted(USED)), agreement(by_row, sorted(HELD))


def rigs(quick: bool) -> list[list[Rig]]:
    """Return the rigs of the designed body, grouped by the side of the plate; readings contain both roof points."""
    groups = [[rig for rig in all_sides(TODAY) if rig.plate == plate and rig.roof == "-y"] for plate in PLATES]
    return [group[:1] for group in groups] if quick else groups


def bodies(rig: Rig) -> list[Rig]:
    """Return the rig with one parameter of the body modified at a time."""
    same = replace(rig, roof="-y")
    candidates = [replace(same, ixx=value) for value in IXX]
    candidates += [replace(same, damping=value) for value in DAMPING] + [
        replace(same, brackets=name) for name in BRACKETS
    ]
    return [candidate for candidate in candidates if candidate != same]


def judged(plan: Plan, groups: Sequence[Sequence[Rig]], folder: Path, jobs: int) -> Judged:
    """Run rigs and compute the log-likelihoods of all candidates."""
    folder.mkdir(exist_ok=True)
    pool = process_pool(min(jobs, len(groups))) if jobs > 1 and len(groups) > 1 else ThreadPoolExecutor(1)
    with pool as workers:
        done = list(workers.map(readings, groups, [plan] * len(groups), [folder] * len(groups)))
    by_rig = {
        rig: rig_readings
        for group, group_readings in zip(groups, done, strict=True)
        for rig, rig_readings in zip(group, group_readings, strict=True)
    }
    both = {replace(rig, roof=roof): rig_readings for rig, rig_readings in by_rig.items() for roof in ("-y", "+y")}
    used, held = (
        {rig: table(rig_readings, rig, plan, keys) for rig, rig_readings in both.items()} for keys in (USED, HELD)
    )
    return Judged(plan=plan, found=by_rig, used=used, held=held)


def joined(first: Judged, second: Judged) -> Judged:
    """Join the candidates of two runs."""
    return Judged(
        plan=first.plan,
        found={**first.found, **second.found},
        used={**first.used, **second.used},
        held={**first.held, **second.held},
    )


def before(plan: Plan) -> Candidate:
    """Return the candidate that was shipped before the choice."""
    edges = {"shaker": plan.shaker_edges, "road": plan.road_edges}
    return Candidate(
        rig=TODAY,
        velocity=SLIP_VELOCITIES.index(BEFORE["velocity"]),
        noise=plan.shaker_edges.index(BEFORE["shaker"]),
        level=0,
        **{name: values.index(BEFORE[name]) for name, values in edges.items()},
    )


def study(_: None, folder: Path, settings: StudySettings) -> Findings:
    """Compute the likelihoods of all candidates, draw them by side, and compare the winner with the car before."""
    plan = QUICK if settings.quick else FULL
    judgement = judged(plan, rigs(settings.quick), folder / "cars", settings.jobs)
    if not settings.quick:
        more = bodies(best(judgement.used)[0][1].rig)
        # Two halves: a worker for each.
        judgement = joined(judgement, judged(plan, [more[::2], more[1::2]], folder / "cars", settings.jobs))
    ranking = best(judgement.used)
    winner = chosen(ranking)
    winner = shipped_numbers(judgement.of(winner), winner.rig, plan, judgement.used[winner.rig])
    other = {name: best(half)[0] for name, half in (("held-out", judgement.held), ("all", _sum(judgement)))}
    side_figure(folder / "sides.png", judgement.used, judgement.held, winner)
    claims = [*half_claims(judgement, winner), *side_claims(winner, other)]
    return Findings(
        title="Joint choice of what Bommer 2006 does not print",
        claims=claims,
        unjudged={claim.name: "short records of two seeds cannot choose" for claim in claims} if settings.quick else {},
        notes=[
            f"{'Most likely here' if settings.quick else 'Winner'}: {winner.rig.sides()}; {winner.rig.body()}; "
            f"{_words(winner, plan)}. {len(USED)} rows chose, "
            f"{len(HELD)} are held out, drawn with seed {HALF_SEED}. Log-likelihood: sum over rows of weight times "
            f"ln(m + (1 - m) P), m = {MISREADING:g} for a row that we misread, P the probability of the printed "
            f"interval over {plan.seeds} seeds of each input; a row agrees above {100 * AGREES_ABOVE:g} %. "
            f"Rigs within {BARE_MENTION:g} of the most likely are tied (odds of e to 1 are not worth more than a bare "
            "mention: Kass and Raftery 1995); of these the one with the fewest changes is the winner. Its numbers are, "
            f"of the sets within {BARE_MENTION:g} of its best ones, those with the median slip velocity, and of these "
            "the one whose eight slip shares deviate least from the printed ones.",
            side_table(judgement),
            rank_table(judgement, ranking[:SHOWN], f"The {SHOWN} most likely rigs, each with its best numbers:"),
            margin_table(judgement, ranking),
            own_noise(judgement, ranking),
            velocity_table(judgement, winner.rig),
            rank_table(judgement, [other["held-out"], other["all"]], "Chosen on the held-out half, and on all rows:"),
            row_table(judgement, before(plan), winner),
            *([QUICK_NOTE] if settings.quick else []),
        ],
        data={
            "winner": {"sides": winner.rig.sides(), "body": winner.rig.body(), "numbers": winner.text(plan)},
            "before": judgement.numbers(before(plan)),
            "ranking": [
                (candidate.rig.sides(), candidate.rig.body(), candidate.text(plan), *judgement.numbers(candidate))
                for _, candidate in ranking
            ],
        },
    )


def chosen(ranking: Sequence[tuple[float, Candidate]]) -> Candidate:
    """Return the candidate to ship: of candidates with nearly the best likelihood the one with the fewest changes.

    Source: Kass and Raftery, Bayes factors, J. Am. Stat. Assoc. 90 (1995), section 3.2.
    """
    tied = [candidate for value, candidate in ranking if value > ranking[0][0] - BARE_MENTION]
    return min(
        tied,
        key=lambda candidate: sum(
            ours != was for ours, was in zip(_fields(candidate.rig), _fields(TODAY), strict=True)
        ),
    )


def _fields(rig: Rig) -> tuple[object, ...]:
    return tuple(asdict(rig).values())


def _sum(judgement: Judged) -> dict[Rig, Vector]:
    return {rig: judgement.used[rig] + judgement.held[rig] for rig in judgement.used}


def _words(candidate: Candidate, plan: Plan) -> str:
    velocity, shaker, noise, road, level = candidate.text(plan)
    return (
        f"slip above {velocity} mm/s, lower edges {shaker} Hz (shaker), {noise} Hz (noise of the bump), {road} Hz "
        f"(road); noise {level}"
    )


def half_claims(judgement: Judged, winner: Candidate) -> list[Claim]:
    """Return the row that compares the agreement of the held-out and the used half."""
    _, _, used, held = judgement.numbers(winner)
    _, _, was_used, was_held = judgement.numbers(before(judgement.plan))
    return [
        OWN_CHECK.statement(
            "rows that agree, held-out half against the half that chose",
            f"within {100 * POINTS:g} points",
            f"{100 * held:.0f} % against {100 * used:.0f} %",
            abs(used - held) <= POINTS,
            f"the car before, which neither half chose, has {100 * was_held:.0f} % and {100 * was_used:.0f} %: the "
            f"draw made the halves unlike. The standard error of a difference of two such shares is "
            f"{100 * np.sqrt(used * (1 - used) / len(USED) + held * (1 - held) / len(HELD)):.0f} points",
        )
    ]


def side_claims(winner: Candidate, other: Mapping[str, tuple[float, Candidate]]) -> list[Claim]:
    """Return the rows on the side of the plate by other rows."""
    return [
        OWN_CHECK.statement(
            f"side of the plate chosen on {name} rows",
            f"plate {winner.rig.plate}",
            f"plate {candidate.rig.plate}",
            candidate.rig.plate == winner.rig.plate,
            "the seat is at -y by definition",
        )
        for name, (_, candidate) in other.items()
    ]


def side_table(judgement: Judged) -> str:
    """Return a table of the best candidate of every combination of sides, with the designed body."""
    plain = {rig: candidate for rig, candidate in judgement.used.items() if rig.body() == TODAY.body()}
    return rank_table(judgement, best(plain), "Evidence by side (seat at -y), body as designed, best numbers of each:")


COLUMNS = (
    *("sides", "body", "slip [mm/s]", "shaker [Hz]", "bump noise [Hz]", "road [Hz]", "noise, 1.5 mm bump"),
    *("ln L, chose", "ln L, held out", "agree, chose", "agree, held out"),
)


def rank_table(judgement: Judged, ranking: Sequence[tuple[float, Candidate]], head: str) -> str:
    """Return a table of candidates with their likelihoods."""
    rows = []
    for _, candidate in ranking:
        used, held, *shares = judgement.numbers(candidate)
        ends = (f"{used:.1f}", f"{held:.1f}", *(f"{100 * share:.0f} %" for share in shares))
        rows.append((candidate.rig.sides(), candidate.rig.body(), *candidate.text(judgement.plan), *ends))
    return f"{head}\n\n{markdown(COLUMNS, rows)}"


def velocity_table(judgement: Judged, rig: Rig) -> str:
    """Return a table of the best band edges at every slip velocity with their log-likelihoods."""
    rows, whole = [], judgement.used[rig]
    for position, velocity in enumerate(SLIP_VELOCITIES):
        only = np.full_like(whole, -np.inf)
        only[position] = whole[position]
        value, table_of_rig = best({rig: only})[0]
        _, shaker, _, road, level = table_of_rig.text(judgement.plan)
        rows.append(
            (f"{1e3 * velocity:g}", shaker, road, level, f"{value:.2f}", f"{judgement.numbers(table_of_rig)[1]:.2f}")
        )
    columns = ("slip [mm/s]", "shaker [Hz]", "road [Hz]", "noise, 1.5 mm bump", "ln L, chose", "ln L, held out")
    return f"Slip velocity and the edges that go with it, sides and body of the winner:\n\n{markdown(columns, rows)}"


def margin_table(judgement: Judged, ranking: Sequence[tuple[float, Candidate]]) -> str:
    """Return a table of the differences to the most likely rig, with standard errors over the seeds."""
    winner = ranking[0][1]
    rows = []
    for value, candidate in ranking[1:SHOWN]:
        error = jackknife([(judgement.of(which), which) for which in (winner, candidate)], judgement.plan)
        rows.append((candidate.rig.sides(), candidate.rig.body(), f"{ranking[0][0] - value:.2f} ± {error:.2f}"))
    columns = ("sides", "body", "less likely by [ln], standard error over the seeds")
    return f"Differences to the most likely rig:\n\n{markdown(columns, rows)}"


def own_noise(judgement: Judged, ranking: Sequence[tuple[float, Candidate]]) -> str:
    """Return a text on the gain in likelihood by a separate band edge for the noise of the bump."""
    value, candidate = best(judgement.used, own_noise=True)[0]
    cost = 0.5 * np.log(len(USED))
    return (
        f"One shaker makes the random inputs and the noise of the bump, so both have one edge. Two edges would gain "
        f"{value - ranking[0][0]:.2f} ({_words(candidate, judgement.plan)}); a further number has to gain more than "
        f"1/2 ln {len(USED)} = {cost:.2f} (Schwarz, Annals of Statistics 6, 1978)."
    )


def row_table(judgement: Judged, was: Candidate, winner: Candidate) -> str:
    """Return a table of all rows of the evidence: printed, before and now, with probabilities."""
    values = [values_of(judgement.of(candidate), candidate, judgement.plan) for candidate in (was, winner)]
    by_candidate = [probabilities(judgement.of(candidate), candidate, judgement.plan) for candidate in (was, winner)]
    rows = []
    for row in EVIDENCE:
        low, high = (f"{end:g}" if np.isfinite(end) else "" for end in row.interval)
        cells = []
        for ours, chance in zip(values, by_candidate, strict=True):
            cells += [f"{np.mean(ours[row.key]):.3g}", f"{chance[row.key]:.3f}"]
        first, second = (candidate[row.key] for candidate in by_candidate)
        change = "worse" if second < first - 0.1 else "better" if second > first + 0.1 else ""
        half = "chose" if row.key in USED else "held out"
        rows.append((row.name, row.place, half, f"{low} to {high} {row.unit}", *cells, change))
    columns = ("row", "place", "half", "printed", "before", "P", "now", "P", "")
    return f"All rows, before and now (P above {AGREES_ABOVE:g} agrees):\n\n{markdown(columns, rows)}"


main = Study(
    name="source_choice",
    parser=study_parser(
        "source_choice", StudySettings, quick="two rigs, short records", jobs="; one for each group of rigs"
    ),
    settings=StudySettings,
    load=lambda _: None,
    study=study,
)


if __name__ == "__main__":
    sys.exit(main())
