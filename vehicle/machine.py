"""The machine that the program runs on: its memory."""

import os
from pathlib import Path

FREE = ("MemAvailable:", "SwapFree:")
"""Lines of /proc/meminfo of Linux that add up to the memory that a program can still take."""

MEMINFO, CONTAINER = Path("/proc/meminfo"), Path("/sys/fs/cgroup")
"""File of the memory of Linux, and folder with the limits of a container."""


def physical_memory() -> float:
    """Return the memory of this machine or its container [bytes]; infinity if unknown."""
    if os.name == "nt":
        return _windows_memory(1)
    try:
        memory = float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError):
        memory = float("inf")
    return min(memory, _container_memory()[0])


def free_memory() -> float:
    """Return the memory that is free on this machine, with free swap [bytes]; all memory where this is unknown.

    In a container no more than is free below its limit, where cached files count as used.

    Source: proc_meminfo(5), "estimate of how much memory is available for starting new applications, without swapping".
    """
    if os.name == "nt":
        return _windows_memory(4)
    try:
        lines = [line.split() for line in MEMINFO.read_text(encoding="ascii").splitlines()]
        free = {cells[0]: 1024.0 * float(cells[1]) for cells in lines if cells and cells[0] in FREE}
        return min(sum(free[name] for name in FREE), _container_memory()[1])
    except (OSError, ValueError, IndexError, KeyError):
        return physical_memory()


def _container_memory() -> tuple[float, float]:
    """Return the limit of a container and what is free below it [bytes]; infinity without limit.

    Source: Linux, Documentation/admin-guide/cgroup-v2.rst, memory.max ("max" is none) and memory.current.
    """
    try:
        limit, used = [
            float((CONTAINER / name).read_text(encoding="ascii").replace("max", "inf"))
            for name in ("memory.max", "memory.current")
        ]
    except (OSError, ValueError):
        return float("inf"), float("inf")
    return limit, max(limit - used, 0.0)


def _windows_memory(position: int) -> float:
    """Return an amount of GlobalMemoryStatusEx of Windows [bytes]: at 1 all memory, at 4 free with page file."""
    import ctypes

    # MEMORYSTATUSEX: its length and the load [%] (32 bits each), the memory, and six further amounts (64 bits)
    status = (ctypes.c_uint64 * 8)()
    status[0] = ctypes.sizeof(status)
    success = ctypes.windll.kernel32.GlobalMemoryStatusEx(status)  # type: ignore[attr-defined, unused-ignore]
    return float(status[position]) if success else float("inf")
