"""A measurement of any format, or another run, compared with a run or the folder of a run."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Run
from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.frf_comparison import (
    BANDS,
    FrfComparison,
    checked_edges,
    compare_responses,
    other_plates,
)
from vehicle.runs.comparison.record_comparison import RecordComparison, compare_records, unlike_copies
from vehicle.runs.comparison.simulated import Simulated, of_folder, of_run
from vehicle.signals.analysis.phase_delay import phase_delay
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.counterpart import PARTS, SAME_MOTION, response_faults, run_times
from vehicle.signals.records.delays import PLATES, Delay, split_delay
from vehicle.signals.records.exchanged import exchange_finding, exchanged_responses
from vehicle.signals.records.finding import Finding
from vehicle.signals.records.group_delays import ChannelLag, GroupDelay, group_delays
from vehicle.signals.records.measured import Measured, read_measured
from vehicle.signals.records.run_findings import beside_run
from vehicle.threads import one_blas_thread

LARGEST_DRIFT = 0.1
"""Maximum drift of a clock [-]; a larger value means a wrong sampling rate."""

PHASE_STEP = 0.05
"""Time by which lags of FRFs count as equal, in periods of the highest line [-]: 18 degrees of phase there."""


def compare(
    run: Run | Simulated | Path | str,
    measured: Measured | Run | Path | str,
    channels: Mapping[str, str] | None = None,
    *,
    choice: Choice | None = None,
    inverted: Collection[str] = (),
    delay: Delay = 0.0,
    drift: float = 0.0,
    window: float | None = None,
    bands: tuple[float, ...] | None = None,
) -> Comparison:
    """Compare measured responses and time histories, or those of another run, with those of a run.

    Args:
        run: a run, the folder of a run, or the result of `of_folder`.
        measured: measurement file of any format, or the result of `read_measured`; or the run that is the reference,
            whose channels all have the names of the model.
        channels: channel of the model to channel of the file, as {"knuckle_fr_acc_z": "Dof 12 +Z"}: number, exact name,
            pattern with *, or place and direction; by default equal names.
        choice: units, rate and excerpt of the file.
        inverted: channels measured with the opposite sign.
        delay: the measurement began this long after the run [s]; or delays that are taken out, as
            {"accelerations": 0.0123, "record": 0.5}: a group, channel or pattern, and the start of the record.
        drift: the clock of the measurement is slow by this share [-].
        window: length of the Hann windows that the measured responses were averaged over [s]; by default the local
            rational model of the whole record.
        bands: rising edges of the bands of the table [Hz]; octaves by default.

    Returns:
        FRAC, errors per band, RMS ratio, correlation, time shift and ISO 18571 rating, worst first; `print` shows them.

    Raises:
        ConfigurationError: the file or channel does not exist, a delay, drift or band is out of range, or channels,
            units or signs are chosen for a run.
        DataError: bad data, or no common channel.
    """
    begin, delays = split_delay(delay)
    require_drift(drift)
    edges = None if bands is None else checked_edges(bands, f"bands {bands}")
    if isinstance(run, Simulated):
        simulated = run
    else:
        simulated = of_run(run) if isinstance(run, Run) else of_folder(Path(run))
    if isinstance(measured, Run):
        if channels or choice is not None or inverted:
            raise ConfigurationError(
                "channels, choice, inverted: work only with a measurement file; a run has the channels of the "
                "model, so leave them out"
            )
        if isinstance(run, Run):
            simulated = replace(simulated, name=run_words(run))
        measured = reference_of(measured, window)
    if isinstance(measured, Measured) and delays:
        raise ConfigurationError(
            f"delay {delays}: the delay of a group of channels can be removed only while the file is read; give "
            "the file name instead of read data, or Choice(delays=...) to read_measured"
        )
    if not isinstance(measured, Measured):
        asked = choice or Choice()
        asked = replace(asked, channels={**asked.channels, **(channels or {})}, delays={**asked.delays, **delays})
        names = tuple(simulated.record.channels)
        measured = read_measured(Path(measured), names, asked, inverted=inverted, window=window)
    return comparison_of(measured, simulated, edges=edges, delay=begin, drift=drift, window=window)


def run_words(run: Run) -> str:
    """Return car, input and changed parameters of a run, to distinguish runs on one input."""
    return ", ".join([f"{run.car.vehicle.name} on {run.signal.source}", *run.car.overrides])


def reference_of(run: Run, window: float | None = None) -> Measured:
    """Return a run in place of a measurement.

    Args:
        window: length of Hann windows of its FRFs [s]; see `Run.frf`.

    Returns:
        Time histories of all channels and FRFs of all accelerations; no FRFs without recorded plates and, with a
        notice, where a plate repeats another with a delay, as on a road.
    """
    simulated = of_run(run)
    names = [name for name in run.car.vehicle.acceleration_channels if name in simulated.record.channels]
    plates = [f"plate_{wheel}_displacement" for wheel in run.recording.excited]
    frf, notices = None, tuple[str, ...]()
    if names and all(plate in simulated.record.channels for plate in plates):
        try:
            frf = simulated.responses(names, window)
        except DataError as error:
            notices = (f"no FRFs: {error}",)
    return Measured(
        file=Measurement(path=Path(run_words(run).replace("/", "_")), format="run", channels=()),
        frf=frf,
        record=simulated.record,
        notices=notices,
        start=float(run.time[0]),
    )


@one_blas_thread()
def comparison_of(
    measured: Measured,
    simulated: Simulated,
    *,
    edges: tuple[float, ...] | None = None,
    delay: float = 0.0,
    drift: float = 0.0,
    window: float | None = None,
    command: str = "",
) -> Comparison:
    """Compare a measurement with a run.

    Args:
        measured: measurement with the channel names of the run.
        edges: edges of the bands [Hz]; octaves by default.
        delay: the measurement began this long after the run [s].
        drift: the clock of the measurement is slow by this share [-].
        window: length of the Hann windows [s] for both, see `read_measured`.
        command: command with the options --delay and --drift for the advice, if the current one lacks them.

    Raises:
        DataError: no common channel.
    """
    responses: tuple[FrfComparison, ...] = ()
    signatures, notices = None, list(measured.notices)
    if measured.frf is not None:
        outputs = set(measured.frf.channels)
        names = [name for name in simulated.record.channels if name in outputs]
        other = simulated.responses(names, window) if names else None
        if other is None:
            notices.append("the run has no FRFs to compare with")
        else:
            responses, signatures = compare_responses(measured.frf, other, edges or BANDS)
            notices += other_plates(measured.frf, other)
    records: tuple[RecordComparison, ...] = ()
    judged: set[str] = set()
    delays: tuple[GroupDelay, ...] = ()
    if measured.record is not None:
        times = run_times(measured.record, delay, drift, measured.start)
        begin, text = _settled_part(measured, simulated, times)
        records, parts = compare_records(measured.record, simulated.record, times, begin)
        beside = beside_run(
            measured, measured.record, simulated.record, times, delay=delay, drift=drift, parts=parts, command=command
        )
        notices += [*text, *beside.findings, *unlike_copies(records)]
        judged = {part.channel for part in beside.parts if part.reliable_shift}
        delays = beside.delays
    elif responses:
        step = PHASE_STEP / float(responses[0].frequency[-1])
        delays = group_delays(response_lags(responses, measured.delays), step, PLATES)
        notices += [finding for group in delays for finding in group.advice(step, command)]
    notices += response_findings(measured, [each for each in responses if each.channel not in judged])
    if not responses and not records:
        raise DataError(
            f"{measured.file.path}: has no channel in common with the run {simulated.name}; set --map "
            "CHANNEL=NAME, or record the channel in the run with --channels"
        )
    return Comparison(
        measured=measured.file.path.name,
        simulated=simulated.name,
        responses=responses,
        signatures=signatures,
        records=records,
        delays=delays,
        notices=tuple(notices),
        tyres=simulated.tyres,
    )


def _settled_part(measured: Measured, simulated: Simulated, times: Vector) -> tuple[float, list[str]]:
    """Return the time of the run from which time histories are compared [s], and a notice if it is not the first.

    The run begins at rest; a record in motion is compared after the settling of the run. An excerpt of a file begins
    where the user wants, and another run begins at rest too.
    """
    record, settled = measured.record, simulated.settled
    if record is None or measured.file.format == "run" or record.time[0] > measured.start + record.step:
        return -math.inf, []
    begin, end = float(simulated.record.time[0] + settled), min(float(times[-1]), float(simulated.record.time[-1]))
    if settled == 0.0 or times[0] >= begin:
        return -math.inf, []
    if end - begin < settled:
        return -math.inf, [
            f"the run takes about {settled:g} s to settle from rest, most of this record; use a longer record"
        ]
    return begin, [
        f"time histories are compared from {settled:g} s of the run on, when it has settled from rest; stuck dampers "
        "take longer: set --from S to begin later"
    ]


def response_findings(measured: Measured, responses: Sequence[FrfComparison]) -> list[Finding]:
    """Return the findings on measured FRFs against the run: exchanged channels, signs and units."""
    findings: list[Finding] = []
    exchanged: dict[str, str] = {}
    for plate in dict.fromkeys(each.plate for each in responses):
        of_plate = [each for each in responses if each.plate == plate]
        tables = (np.array([getattr(each, side) for each in of_plate]) for side in ("measured", "simulated"))
        exchanged |= exchanged_responses([each.channel for each in of_plate], *tables)
    findings += exchange_finding(exchanged, measured.mapped, complete=measured.by_name)
    for each in responses:
        if each.channel not in exchanged:
            weight = np.nan_to_num(each.measured_coherence, nan=1.0) * np.nan_to_num(each.simulated_coherence, nan=1.0)
            findings += response_faults(each.channel, each.measured, each.simulated, weight)
    return findings


def response_lags(responses: Sequence[FrfComparison], taken_out: Mapping[str, float]) -> list[ChannelLag]:
    """Return the lags of measured FRFs against those of the run, where their phases agree after it.

    Args:
        responses: compared FRFs.
        taken_out: channel -> delay that was taken out [s].
    """
    lags = []
    for each in responses:
        weight = np.nan_to_num(each.measured_coherence, nan=1.0) * np.nan_to_num(each.simulated_coherence, nan=1.0)
        delay = phase_delay(each.frequency, each.simulated, each.measured, weight)
        if delay is not None and delay.agreement >= SAME_MOTION:
            out = taken_out.get(each.channel, 0.0)
            lags.append(ChannelLag(channel=each.channel, lag=delay.delay + out, error=delay.error, taken_out=out))
    return lags


def require_drift(drift: float) -> None:
    """Check the drift of the clock of a measurement against that of the run.

    Args:
        drift: the clock of the measurement is slow by this share [-].

    Raises:
        ConfigurationError: a number that is not finite, or a drift of more than a tenth.
    """
    if not abs(drift) <= LARGEST_DRIFT:
        raise ConfigurationError(
            f"--drift {PARTS * drift:g}: must be -100000 to 100000 parts per million; for another rate give --rate HZ"
        )
