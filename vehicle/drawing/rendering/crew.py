"""Frames of a film drawn by several processes, each with a canvas of its own, taken in their order."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import closing
from multiprocessing import get_context
from multiprocessing.connection import Connection

import numpy as np

from vehicle.drawing.rendering.backend import variables
from vehicle.drawing.rendering.layout import Picture
from vehicle.drawing.rendering.shot import Shot
from vehicle.errors import OutputError
from vehicle.threads import one_thread_each

WORTH_A_PROCESS = 40
"""Frames that take longer to draw than a process to start."""

MOST = 8
"""Processes beyond which the encoder is the slowest."""


def drawing_jobs() -> int:
    """How many processes this machine has for a film: its processors."""
    return min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, MOST)


def drawn_by(jobs: int, shot: Shot, backend: str) -> Iterator[Picture]:
    """All frames of a shot in their order, (height, width, 3) each.

    Process k of n draws the frames k, k + n, k + 2 n and so on. Each is one frame ahead at most: it waits until its
    frame is taken.

    Args:
        jobs: processes at most; a film of few frames is drawn here.
        shot: what is drawn.
        backend: OpenGL backend, one of `BACKENDS`.

    Raises:
        OutputError: a process ended before its frames were drawn.
    """
    count = min(jobs, shot.cut.frames // WORTH_A_PROCESS)
    if count < 2:
        yield from shot.frames(backend)
        return
    context = get_context("spawn")
    ends, crew = [], []
    for number in range(count):
        here, there = context.Pipe(duplex=False)
        ends.append(here)
        crew.append(context.Process(target=_draw, args=(shot, backend, number, count, there), daemon=True))
        with one_thread_each():
            crew[-1].start()
        there.close()  # so that the end of the process is the end of the pipe
    shape = (shot.layout.height, shot.layout.width, 3)
    try:
        for number in range(shot.cut.frames):
            yield np.frombuffer(ends[number % count].recv_bytes(), dtype=np.uint8).reshape(shape)
    except EOFError:
        raise OutputError(
            "the film: a process that draws ended; its own error stands above (out of memory where there is none)"
        ) from None
    finally:
        for process in crew:
            process.terminate()
            process.join()


def _draw(shot: Shot, backend: str, first: int, every: int, there: Connection) -> None:
    """Draw every so manieth frame and send it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process ends the others
    os.environ.update(variables(backend))
    try:
        with closing(shot.frames(backend, first, every)) as frames:  # type: ignore[type-var]
            for frame in frames:
                there.send_bytes(frame.tobytes())
    except BrokenPipeError:
        pass  # nobody wants them any more
