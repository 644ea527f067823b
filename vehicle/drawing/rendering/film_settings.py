"""Settings of the film of a run, each declared once: for Python and the options of commands."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, setting


@dataclass(frozen=True, kw_only=True, slots=True)
class FilmSettings(Settings):
    """Settings of the film of a run.

    Attributes:
        video: path of the film, or "" for the default path; without it no film is made.
    """

    video: str | None = None
    video_start: float | None = setting(
        "start of the video in the record [s]; default: chosen by the program",
        within="[0, inf)", type=float, metavar="S"
    )  # fmt: skip
    video_duration: float | None = setting(
        "length of the video [s]; default: 10, less for a bump or an obstacle. A video in slow motion shows a "
        "shorter part of the record",
        within="[0.1, inf)", type=float, metavar="S"
    )  # fmt: skip
    slow_motion: float | None = setting(
        "play N times slower; default: 1, at least 4 for a bump or an obstacle, and more if a wheel moves faster "
        "than 15 Hz; --video-start and --video-duration do not change it",
        within="[1, inf)", type=float, metavar="N"
    )  # fmt: skip
    exaggeration: float | None = setting(
        "show the motion N times larger; default: chosen by the program",
        within="[0.001, inf)", type=float, metavar="N"
    )  # fmt: skip

    def path(self, default: str) -> Path:
        """Return the path of the film, or a default.

        Raises:
            ConfigurationError: it does not end in .mp4.
        """
        name = Path(self.video or default)
        if name.suffix != ".mp4":
            raise ConfigurationError(f"--video {name}: must end in .mp4; set FILE.mp4")
        return name

    def require_inside(self, length: float) -> None:
        """Check that the film is within a record.

        Args:
            length: of the record [s].

        Raises:
            ConfigurationError: it begins too late.
        """
        if self.video_start is None:
            return
        chosen = self.video_duration is not None and self.slow_motion is not None
        latest = length - (self.video_duration / self.slow_motion if chosen else 0.0)  # type: ignore[operator]
        if not 0.0 <= self.video_start <= latest:
            raise ConfigurationError(
                f"--video-start {self.video_start:g}: must be 0 to {latest:g} s, so that the video is within the record"
            )

    def values(self) -> dict[str, Any]:
        """Return the settings of a `Take` by name."""
        return {
            "start": self.video_start,
            "duration": self.video_duration,
            "slow": self.slow_motion,
            "exaggeration": self.exaggeration,
        }
