"""Settings of a run on the shaker or a road with all its files, each declared once."""

from dataclasses import dataclass
from pathlib import Path

from vehicle.drawing.rendering.film_settings import FilmSettings
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination, ReportChoice
from vehicle.settings import Settings, engine_setting, part, setting, skip_setting, stated_errors_setting
from vehicle.signals.excitation.crank_speed import RPM
from vehicle.signals.excitation.input_settings import DriveInput, PlateSettings
from vehicle.signals.formats.formats import TABLES, WRITTEN
from vehicle.signals.records.measured_settings import MeasuredSettings


@dataclass(frozen=True, kw_only=True, slots=True)
class ShakerSettings(Settings):
    """Settings of a run on the shaker or a road, with all its files.

    Attributes:
        source: signals of the plates, or a drive on a road.
        destination: folder of the files; by default "runs" with the name of the input.
        film: film of the run.
        measured: measurement to compare with the run.
        report: report of the run.
        figures: write pictures (PNG).
    """

    source: PlateSettings | DriveInput
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    film: FilmSettings = part(FilmSettings)
    measured: MeasuredSettings = part(MeasuredSettings)
    report: ReportChoice = part(ReportChoice)
    engine: str = engine_setting("mujoco")
    stated_errors: bool = stated_errors_setting()
    law_band: bool = setting(
        "also run the car with the softest and with the firmest dampers that their tests leave open (the band of "
        "fit-damper), and state what comfort and stick do between them; three runs",
        False,
        action="store_true",
    )
    skip: float | None = skip_setting()
    rpm: str | None = setting(
        "speed of the crankshaft [1/min]; A:B is a run-up over --duration; A:B:STEP are steady speeds, a "
        "run each, as in `python -m vehicle orders`. Without --input and --road the road is level",
        metavar="N|A:B|A:B:STEP",
    )
    duration: float | None = setting(
        "length of a run-up of the crankshaft [s]", within="(0, inf)", type=float, metavar="S"
    )
    no_forces: bool = setting(
        "simulate without the applied forces of the car; the same as --set apply_forces=false",
        False,
        action="store_true",
    )
    controller: Path | None = setting(
        "FMU (FMI 2.0 or 3.0 co-simulation) that controls each semi-active damper: velocities in, damping "
        "coefficient out. It runs native code with all your rights, so you must allow it: --trust, or vehicle trust",
        type=Path,
        metavar="FILE.fmu",
    )
    trust: bool = setting(
        "allow the native code of the FMU controllers from now on: add them to your list (vehicle trust --list)",
        False,
        action="store_true",
    )
    timestep: float | None = setting(
        "time step of the integration [s]; default: time step of the vehicle file",
        within="(0, inf)",
        type=float,
        metavar="S",
    )
    time_format: str = setting("format of the time histories; default: %(default)s", "npz", choices=TABLES)
    channels: str | None = setting(
        "record more channels. loads: forces of all elements [N] and suspension travel [m], for `python -m "
        "vehicle loads`; names: some of these; all: also coefficients of semi-active dampers [N s/m] and "
        "applied forces (force_NAME, torque_NAME, angle_crank, speed_crank)",
        metavar="loads|all|NAME,...",
    )
    formats: tuple[str, ...] = setting(
        "also write the time histories in this format; mat, uff and h5 also contain FRFs and coherence, uff "
        "also the points of the car. May be repeated",
        (),
        flag="--format",
        action="append",
        choices=WRITTEN,
    )
    figures: bool = True
    video_mode: float | bool | None = setting(
        "show a mode beside the run: the one nearest to this frequency [Hz]; without a number the one with the "
        "largest share in the vertical acceleration of the seat rail",
        within="(0, inf)",
        type=float,
        nargs="?",
        const=True,
        metavar="HZ",
    )

    def require_forces(self) -> None:
        """Check that the crankshaft is not given a speed while its forces are left out.

        Raises:
            ConfigurationError: `rpm`, or a channel with the speed, beside `no_forces`.
        """
        if self.no_forces and (self.rpm is not None or any(text.startswith(RPM) for text in self.source.record.picks)):
            raise ConfigurationError(
                "--rpm has no effect with --no-forces, which leaves out the forces of the crankshaft; leave "
                "out one of them"
            )

    def require_no_others(self, why: str, *names: str) -> None:
        """Check that no settings of a single run are given but some.

        Args:
            why: reason, after "belongs to a run of a whole road, but".
            names: names of the settings that have an effect.

        Raises:
            ConfigurationError: the first other setting that is given.
        """
        parts = {
            "--video": self.film.video,
            "--measured": self.measured.measured,
            "--report": self.report.report,
        }
        flags = [flag for flag, value in parts.items() if value is not None]
        flags += [self.declared()[name]["flag"] for name in self.given(without=names)]
        for flag in flags:
            raise ConfigurationError(f"{flag}: belongs to a run of a whole road, but {why}; leave one of them out")

    def chosen_engine(self) -> tuple[str, str]:
        """Return the engine, and the reason if it differs from `engine`.

        Raises:
            ConfigurationError: the reduced engine cannot do what is asked.
        """
        needs = "--video" if self.film.video is not None else "--timestep" if self.timestep is not None else None
        if needs is None or self.engine == "mujoco":
            return self.engine, ""
        why = f"{needs}: the reduced engine " + (
            "does not store the positions that a video needs" if needs == "--video" else "chooses its time step itself"
        )
        if self.engine == "reduced":
            raise ConfigurationError(f"{why}; leave --engine reduced out, or {needs}")
        return "mujoco", why
