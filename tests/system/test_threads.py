"""Commands use one thread for linear algebra, unless the user has set a number."""

from __future__ import annotations

import os

from vehicle.threads import THREADS, prefer_one_thread


def test_one_thread_unless_the_user_has_set_a_number(monkeypatch):
    for name in THREADS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    prefer_one_thread()
    assert [os.environ.get(name) for name in THREADS] == [None, "3", None, None]
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    prefer_one_thread()
    assert [os.environ.pop(name) for name in THREADS] == ["1"] * len(THREADS)
