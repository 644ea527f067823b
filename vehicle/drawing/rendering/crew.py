"""Drawing of the frames of a film by several processes, each with a separate canvas."""

import os
import signal
from collections.abc import Iterator
from contextlib import closing
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Protocol

import numpy as np

from vehicle.drawing.rendering.backend import variables
from vehicle.drawing.rendering.layout import Layout, Picture
from vehicle.drawing.rendering.shot import Cut
from vehicle.errors import OutputError
from vehicle.threads import one_thread_each, processors


class Drawable(Protocol):
    """Excerpt for drawing frame by frame, in other processes too."""

    @property
    def layout(self) -> Layout:
        """Return the layout of the frame."""

    @property
    def cut(self) -> Cut:
        """Return the excerpt."""

    def frames(self, backend: str, first: int = 0, every: int = 1) -> Iterator[Picture]:
        """Draw frames; see `Shot.frames`."""


WORTH_A_PROCESS = 40
"""Minimum number of frames for each process: fewer are drawn faster than a process starts."""

MOST = 8
"""Maximum number of processes; with more, the encoder is the bottleneck."""


def drawing_jobs() -> int:
    """Return the number of processes for a film: the number of processors, up to `MOST`."""
    return min(processors(), MOST)


def drawn_by(jobs: int, shot: Drawable, backend: str) -> Iterator[Picture]:
    """Yield all frames of a shot in order, (height, width, 3) each.

    Process k of n draws the frames k, k + n, k + 2 n and so on. Each process is at most one frame ahead: it waits until
    its frame is received.

    Args:
        jobs: maximum number of processes; a film of few frames is drawn in this process.
        backend: OpenGL backend, one of `BACKENDS`.

    Raises:
        OutputError: a process ended before its frames were drawn.
    """
    count = min(jobs, shot.cut.frames // WORTH_A_PROCESS)
    if count < 2:
        yield from shot.frames(backend)
        return
    context = get_context("spawn")
    ends, processes = [], []
    for number in range(count):
        receiver, sender = context.Pipe(duplex=False)
        ends.append(receiver)
        processes.append(context.Process(target=_draw, args=(shot, backend, number, count, sender), daemon=True))
        with one_thread_each():
            processes[-1].start()
        sender.close()  # so that the pipe ends with the process
    shape = (shot.layout.height, shot.layout.width, 3)
    try:
        for number in range(shot.cut.frames):
            yield np.frombuffer(ends[number % count].recv_bytes(), dtype=np.uint8).reshape(shape)
    except EOFError:
        raise OutputError(
            "video: a drawing process ended; see its error message above, or use less memory if there is no message"
        ) from None
    finally:
        for process in processes:
            process.terminate()
            process.join()


def _draw(shot: Drawable, backend: str, first: int, every: int, sender: Connection) -> None:
    """Draw every n-th frame and send it to the main process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the main process ends the others
    os.environ.update(variables(backend))
    try:
        with closing(shot.frames(backend, first, every)) as frames:  # type: ignore[type-var]
            for frame in frames:
                sender.send_bytes(frame.tobytes())
    except BrokenPipeError:
        pass  # the main process needs no more frames
