"""The machine that the program runs on: its memory."""

import os


def physical_memory() -> float:
    """Return the memory of this machine [bytes]; infinity where the system does not say."""
    if os.name == "nt":
        return _windows_memory()
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError):
        return float("inf")


def _windows_memory() -> float:
    """Return the memory from GlobalMemoryStatusEx of Windows [bytes]."""
    import ctypes

    # MEMORYSTATUSEX: its length and the load [%] (32 bits each), the memory, and six further amounts (64 bits)
    status = (ctypes.c_uint64 * 8)()
    status[0] = ctypes.sizeof(status)
    success = ctypes.windll.kernel32.GlobalMemoryStatusEx(status)  # type: ignore[attr-defined, unused-ignore]
    return float(status[1]) if success else float("inf")
