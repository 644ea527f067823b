"""Destination of results from --output and --force; chosen and locked before anything is computed."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.runs.output.folder import check_files, check_study
from vehicle.runs.output.free_names import free_file, free_files, free_folder, named, named_file
from vehicle.runs.output.locks import claim

REPORT = "report.html"
"""Default name of a report."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Destination:
    """Folder or file of results: named by the user, or the next free name after a default.

    A chosen path is locked until `held` is closed.

    Attributes:
        output: folder or file; None takes the default of the study.
        force: replace files of an earlier run.
        resume: continue an unfinished study.
        tell: called with a notice if the default exists.
        held: exit stack that holds the locks.
    """

    output: Path | None = None
    force: bool = False
    resume: bool = False
    tell: Callable[[str], object] = field(default=lambda _: None, compare=False, repr=False)
    held: ExitStack = field(default_factory=ExitStack, compare=False, repr=False)

    def folder(self, default: Path, *, protect: tuple[Path, ...] = ()) -> Path:
        """Choose the folder of the results, and lock it.

        Args:
            default: folder without `output`; if it exists, the next free name is taken, with a notice.
            protect: input files; a folder that holds one of them is never replaced.

        Raises:
            ConfigurationError: the folder `output` exists, and `force` is missing or it contains files of the user.
            OutputError: it cannot be written.
        """
        if self.output is not None or self.force:
            return named(self.held, self.output or default, force=self.force, protect=protect)
        return self._said(default, free_folder(self.held, default, protect=protect))

    def study_folder(self, default: Path, *, rows: Sequence[str] = ()) -> Path:
        """Choose the folder of a sweep or a search, and lock it; its files are made in `study_folder`.

        Args:
            default: folder without `output`, see `folder`.
            rows: names of the files of finished rows, see `vehicle.runs.output.folder.study_folder`.

        Raises:
            ConfigurationError, OutputError: see `check_study`.
        """
        if not (self.output is not None or self.force or self.resume):
            return self._said(default, free_folder(self.held, default))
        folder = self.output or default
        self.held.enter_context(claim(folder.resolve()))
        check_study(folder, force=self.force, resume=self.resume, rows=rows)
        return folder

    def files(self, folder: Path, names: Sequence[str]) -> list[Path]:
        """Choose and lock the files that are added to a folder with other files.

        Args:
            folder: folder without `output`; if one of the files exists, all get the next free number, with a notice.
            names: of the files.

        Raises:
            ConfigurationError: a file exists in the folder `output`, and `force` is missing or it is of the user.
            OutputError: the folder cannot be written.
        """
        if self.output is not None or self.force:
            folder = self.output or folder
            check_files(folder, names, force=self.force)
            self.held.enter_context(claim(folder.resolve() / names[0]))
            return [folder / name for name in names]
        files = free_files(self.held, folder, names)
        self._said(folder / names[0], files[0])
        return files

    def file(self, default: Path, *, ending: str = "", protect: tuple[Path, ...] = ()) -> Path:
        """Choose the file of the results, and lock it; errors are those of `folder`.

        Args:
            default: file without `output`; if it exists, the next free name is taken, with a notice.
            ending: required ending of the name.
            protect: input files; they are never replaced.
        """
        if self.output is not None or self.force:
            return named_file(self.held, self.output or default, ending=ending, force=self.force, protect=protect)
        return self._said(default, free_file(self.held, default))

    def further_file(self, path: Path, option: str, *, ending: str = "", protect: tuple[Path, ...] = ()) -> Path:
        """Check and lock a further file that the user names, see `named_file`."""
        return named_file(self.held, path, option, ending=ending, force=self.force, protect=protect)

    def beside(self, name: Path, option: str, folder: Path) -> Path:
        """Check the path of a further file: a plain name in the folder of the results, or a free path outside it.

        Args:
            option: of the path, for messages.
        """
        if name.parent == Path():
            return name
        if name.resolve().parent == folder.resolve():
            return Path(name.name)
        if folder.resolve() in name.resolve().parents:
            raise ConfigurationError(
                f"{option} {name}: must be a file name without a folder, in the output folder; set {name.name}"
            )
        return self.further_file(name, option)

    def _said(self, default: Path, chosen: Path) -> Path:
        """Tell the user if the chosen path is not the default; return the chosen path."""
        if chosen != default:
            self.tell(f"notice: {default} exists; writing {chosen} (--force replaces {default})")
        return chosen


@dataclass(frozen=True, kw_only=True, slots=True)
class ReportChoice:
    """Report of the results.

    Attributes:
        report: its path, or "" for `REPORT` in the folder of the results; without it no report is made.
        author, project: names at its top.
    """

    report: str | None = None
    author: str = ""
    project: str = ""

    def path(self, destination: Destination, folder: Path) -> Path | None:
        """Return the path of the report; a plain name is in the folder of the results.

        Raises:
            ConfigurationError: the name does not end in .html, or the path is not free.
        """
        if self.report is None:
            return None
        name = Path(self.report or REPORT)
        if name.suffix != ".html":
            raise ConfigurationError(f"--report {name}: must end in .html; give FILE.html")
        return destination.beside(name, "--report", folder)
