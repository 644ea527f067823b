"""Read WAV files of recorders: integers of 8 to 32 bits or floating point, relative to full scale."""

import struct
import warnings
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement, check_length, uniform_axis
from vehicle.signals.formats.optional_library import reading


def read(path: Path) -> Measurement:
    """Read all channels; integers become fractions of full scale; errors: see `read_record`."""
    from scipy.io import wavfile

    _check_chunks(path)
    with reading(path, "WAV", "export it as uncompressed WAV"), warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message="Chunk .* not understood")
        rate, data = wavfile.read(path)
    if data.size == 0 or rate <= 0:
        raise DataError(f"{path}: contains {data.size} samples at {rate} Hz, which is not a record; export it again")
    if not np.isfinite(data).all():
        raise DataError(f"{path}: contains numbers that are not finite; correct the record")
    values = data.reshape(len(data), -1).astype(np.float64)
    if data.dtype.kind == "u":
        values = (values - 128.0) / 128.0
    elif data.dtype.kind == "i":
        values /= -float(np.iinfo(data.dtype).min)
    axis = uniform_axis(len(values), 1.0 / rate)
    remark = "no unit, values are fractions of full scale; give the full scale, for example --unit '12.5 mm'"
    channels = tuple(
        Channel(name=f"channel {n + 1}", values=values[:, n].copy(), axis=axis, remark=remark)
        for n in range(values.shape[1])
    )
    return Measurement(path=path, format="wav", channels=channels)


def _check_chunks(path: Path) -> None:
    """Reject a chunk that claims more bytes than the file contains."""
    data = path.read_bytes()
    order = ">" if data[:4] == b"RIFX" else "<"
    position = 12
    while position + 8 <= len(data):
        name, size = data[position : position + 4], struct.unpack(f"{order}I", data[position + 4 : position + 8])[0]
        if name == b"data" and data[:4] == b"RF64":
            return
        check_length(path, size, len(data) - position - 8, f"chunk {name.decode('latin-1')!r}")
        if name == b"data":
            return
        position += 8 + size + size % 2
    raise DataError(f"{path}: contains no data; the file is truncated: export it again")
