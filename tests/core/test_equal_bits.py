"""All processors give equal bits: AVX2, SSE2 and WebAssembly march every law to the same last digit."""

import ctypes
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.core.march_again import Fields, after, copied
from tests.core.recorded_march import ALL, recorded
from tests.patience import HANG
from vehicle.core.library import BINARIES, core
from vehicle.core.records import packed

MODULE = BINARIES / "wasm32-wasi" / "core.wasm"
START = 1 << 24
"""Address of the image in WebAssembly: beyond the module's own memory."""


@pytest.fixture(scope="module", params=ALL, ids=lambda case: f"{case[0]}, {'single' if case[1] else 'double'}")
def march(request: pytest.FixtureRequest) -> tuple[Fields, str]:
    case, single = request.param
    return recorded(case, single=single), "f" if single else "d"


def test_the_variant_fits_the_processor():
    """The compiler's own test of the processor is silently false in a library of zig."""
    flags = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").is_file() else ""
    assert core().core_variant() == (3 if " avx2 " in flags else 2 if " sse2 " in flags else core().core_variant())


@pytest.mark.skipif(core().core_variant() != 3, reason="this processor has one variant")
def test_both_variants_of_x86_give_equal_bits(march):
    fields, precision = march
    wide, narrow = (after(getattr(core(), f"march_{precision}{variant}"), fields) for variant in (3, 2))
    assert not np.array_equal(wide["x"], fields["x"]), "nothing moved"
    assert not np.isnan(wide["out"][np.asarray(fields["wanted"]) >= 0][..., :500]).any()
    for name, values in wide.items():
        np.testing.assert_array_equal(narrow[name], values, err_msg=name)


@pytest.mark.skipif(shutil.which("node") is None or not MODULE.is_file(), reason="node or the module is missing")
def test_webassembly_gives_equal_bits(march, tmp_path):
    fields, precision = march
    fields = {name: copied(value) for name, value in fields.items()}
    native = after(getattr(core(), f"core_march_{precision}"), fields)
    image, places = image_of(fields)
    path = tmp_path / "image"
    path.write_bytes(image)
    command = ["node", str(Path(__file__).with_name("march_in_wasm.mjs")), str(MODULE), str(path)]
    subprocess.run([*command, f"core_march_{precision}"], check=True, timeout=HANG)
    result = path.read_bytes()
    for name, values in native.items():
        found = np.frombuffer(result, values.dtype, values.size, places[name]).reshape(values.shape)
        np.testing.assert_array_equal(found, values, err_msg=name)


def image_of(fields: Fields) -> tuple[bytes, dict[str, int]]:
    """Return the memory of a march from address START on, the record 64 bytes after it, and where its arrays are."""
    record = packed("March", fields).memory
    size, places, parts = 64 + 64 * -(-ctypes.sizeof(record) // 64), dict[str, int](), list[Any]()
    for name, value in fields.items():
        if isinstance(value, np.ndarray):
            getattr(record, name).at, places[name] = START + size, size
            parts.append(value.tobytes() + bytes(-value.nbytes % 64))
            size += len(parts[-1])
    head = START.to_bytes(8, "little") + bytes(56) + bytes(record)
    return head + bytes(-len(head) % 64) + b"".join(parts), places
