"""The machine that the program runs on: its memory."""

import os
from pathlib import Path

FREE = ("MemAvailable:", "SwapFree:")
"""Lines of /proc/meminfo of Linux that add up to the memory that a program can still take."""


def physical_memory() -> float:
    """Return the memory of this machine [bytes]; infinity where the system does not say."""
    if os.name == "nt":
        return _windows_memory(1)
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError):
        return float("inf")


def free_memory() -> float:
    """Return the memory that is free on this machine, with free swap [bytes]; all memory where this is unknown.

    Source: proc_meminfo(5), "estimate of how much memory is available for starting new applications, without swapping".
    """
    if os.name == "nt":
        return _windows_memory(2)
    try:
        lines = [line.split() for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines()]
        free = {cells[0]: 1024.0 * float(cells[1]) for cells in lines if cells and cells[0] in FREE}
        return sum(free[name] for name in FREE)
    except (OSError, ValueError, IndexError, KeyError):
        return physical_memory()


def _windows_memory(position: int) -> float:
    """Return an amount of GlobalMemoryStatusEx of Windows [bytes]: all memory at position 1, the free one at 2."""
    import ctypes

    # MEMORYSTATUSEX: its length and the load [%] (32 bits each), the memory, and six further amounts (64 bits)
    status = (ctypes.c_uint64 * 8)()
    status[0] = ctypes.sizeof(status)
    success = ctypes.windll.kernel32.GlobalMemoryStatusEx(status)  # type: ignore[attr-defined, unused-ignore]
    return float(status[position]) if success else float("inf")
