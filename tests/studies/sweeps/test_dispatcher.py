"""Tasks of many cases: size from the computing time, and recovery from a case that kills its worker."""

from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool

import numpy as np
import pytest

from tests.studies.sweeps.sweep_samples import Peak, ShortRoad, grid
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.dispatcher import DIED, FILL, LARGEST, PER_WORKER, TASK_S, Dispatcher, in_groups


class Paced(Executor):
    """Executor that finishes tasks at submission, with a given computing time [s per case].

    The case `deadly` breaks the executor, the case `wrong` raises an error.
    """

    _max_workers = 2
    ran = "mujoco"

    def __init__(self, pace=0.0, deadly="", wrong=""):
        self.pace, self.deadly, self.wrong = pace, deadly, wrong
        self.tasks: list[list[str]] = []

    def submit(self, function, /, *arguments, **named):
        self.tasks.append([case.label for case in arguments[0]])
        future: Future[Block] = Future()
        if self.deadly in self.tasks[-1]:
            future.set_exception(BrokenProcessPool("killed"))
        elif self.wrong in self.tasks[-1]:
            future.set_exception(TypeError("no number"))
        else:
            results = [Result(values={"peak": 1.0}, engine=self.ran, seconds=self.pace)] * len(self.tasks[-1])
            future.set_result(Block.of(arguments[0], arguments[1], results))
        return future


def many(count, engine="auto"):
    cases = grid({"damper.viscous": range(count)}, [ShortRoad()], engine=engine)
    return cases


def worked(cases, executor):
    """Run cases and return the results by the labels of the cases."""
    results: dict[int, Result] = {}
    Dispatcher(lambda: executor, Peak()).work(
        cases, lambda numbers, block: results.update(zip(numbers, block.results(), strict=True))
    )
    assert set(results) == set(range(len(cases)))
    return {cases[number].label: result for number, result in results.items()}


@pytest.mark.parametrize(
    ("pace", "engine", "size"),
    [(0.004 * TASK_S, "auto", 250), (0.2 * TASK_S, "auto", FILL), (2.0 * TASK_S, "auto", 1),
     (0.2 * TASK_S, "mujoco", 5), (1e-6, "reduced", LARGEST)],
)  # fmt: skip
def test_tasks_take_about_a_second(pace, engine, size):
    executor = Paced(pace)
    worked(many(3000, engine), executor)
    sizes = [len(task) for task in executor.tasks]
    filled = size if engine == "mujoco" or size == 1 else -(-size // FILL) * FILL
    # A first single run of MuJoCo tells how long the sweep takes.
    assert sizes[0] == (FILL if engine == "reduced" else 1) and sizes[2 * PER_WORKER] == min(filled, LARGEST)
    # Towards the end tasks become smaller, so that all workers finish at the same time.
    assert sum(sizes) == 3000 and sizes[-1] <= FILL


def test_a_single_car_takes_the_reduced_engine_as_long_as_a_vector():
    """After the single runs that begin a sweep its tasks are full vectors, not one car after the other."""
    executor = Paced(0.6 * TASK_S)
    executor.ran = "reduced"
    worked(many(400), executor)
    sizes = [len(task) for task in executor.tasks]
    # 1 s over 0.6 s / 8 cars: 13 cars, in full vectors 16.
    assert sizes[0] == 1 and sizes[2 * PER_WORKER] == 2 * FILL


def test_tasks_contain_full_vectors_of_cars_with_all_their_inputs():
    roads = [ShortRoad(seed=seed) for seed in range(3)]
    cases = grid({"damper.viscous": range(100)}, roads, engine="reduced")
    executor = Paced(0.2 * TASK_S)
    worked(cases, executor)
    for task in executor.tasks[: 2 * PER_WORKER]:
        assert len(task) == 3 * FILL and len({label.partition(", ")[2] for label in task}) == FILL


def test_few_cases_are_shared_by_all_workers():
    executor = Paced()
    worked(many(6, "reduced"), executor)
    assert [len(task) for task in executor.tasks] == [3, 2, 1]


def test_only_the_deadly_case_fails():
    todo = many(40, "reduced")
    deadly = todo[13].label
    executor = Paced(deadly=deadly)
    results = worked(todo, executor)
    assert {key for key, result in results.items() if result.reason} == {deadly}
    assert results[deadly].reason == DIED
    assert [deadly] in executor.tasks and max(map(len, executor.tasks)) == FILL


def test_an_error_fails_only_its_case():
    todo = many(20)
    wrong = todo[3].label
    results = worked(todo, Paced(wrong=wrong))
    assert {key: result.reason for key, result in results.items() if result.reason} == {wrong: "TypeError: no number"}


def test_cases_of_a_car_are_consecutive():
    roads, values = [ShortRoad(seed=1), ShortRoad(seed=2)], {"damper.viscous": [1.0, 2.0]}
    cases = [*grid(values, roads), *grid(values, roads[:1], engine="mujoco"), *grid(values, roads, fixed=["gravity=9"])]
    assert in_groups(cases, np.arange(10)).tolist() == [0, 2, 1, 3, 6, 8, 7, 9, 4, 5]
