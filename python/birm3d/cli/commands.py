"""Command line: results on stdout, everything else on stderr."""

from __future__ import annotations

import os
import re
import sys
import warnings
from importlib import import_module
from typing import NamedTuple

import click

__all__ = ["COMMANDS", "main"]


class _Command(NamedTuple):
    module: str
    function: str
    help: str


COMMANDS = {
    "calibrate": _Command(
        "calibrate",
        "calibrate_file",
        "Fit scenes to measurements: FIT_FILE names scenes, measured curves and scalars, parameters.",
    ),
    "from-facts": _Command(
        "from_facts",
        "from_facts",
        "Make the file of a vehicle by its KIND and what is known of it; prints what was assumed.",
    ),
    "from-mesh": _Command(
        "from_mesh",
        "from_mesh",
        "Make the file of a vehicle whose skin is a MESH; prints what was assumed.",
    ),
    "loads": _Command(
        "loads",
        "loads",
        "Compute design loads of each element: a SCENE file, a result (.npz), or --vehicle and --speed.",
    ),
    "overlay": _Command(
        "overlay",
        "overlay",
        "Histories of several RESULTS (.npz of `birm3d run --save`, or capsules) in one figure.",
    ),
    "predict": _Command(
        "predict",
        "predict",
        "Metrics with bands: a SCENE file, or --vehicle and --speed; what is not known is drawn.",
    ),
    "rate": _Command(
        "rate",
        "rate",
        "Rate one crash by standards: a SCENE file, a result (.npz, .birm3d), or --vehicle and --speed.",
    ),
    "report": _Command(
        "report",
        "report",
        "Write the dossier of one crash: a SCENE file, a result (.npz, .birm3d), or --vehicle and --speed.",
    ),
    "rerun": _Command(
        "rerun",
        "rerun",
        "Run a CAPSULE (.birm3d) or a saved result (.npz) once more and compare it bit for bit.",
    ),
    "run": _Command("run", "run", "Run one crash: a SCENE file, or the options --vehicle and --speed."),
    "search": _Command(
        "search",
        "search",
        "Search for the greatest gap, the least height, segment mass or wall of a tube, or the worst offset.",
    ),
    "sweep": _Command(
        "sweep", "sweep", "Run a SCENE file, or --vehicle and --speed, with many values of what it has."
    ),
    "vehicles": _Command("vehicles", "vehicles", "List the vehicles that come with the package."),
}
"""Name of a command -> its module, its function, and the first sentence of its help.

A module is loaded when its command runs: ``birm3d --help`` loads none.
"""


# As birm3d.base.complaints.Complaints ends the warnings of studies.
_ROWS = re.compile(r" \(row \d+(?:, the worst of ([\d,]+) in [\d,]+ runs: rows [^()]*)?\)$")


class _Commands(click.Group):
    """The commands of COMMANDS."""

    def list_commands(self, _ctx: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, _ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        place = COMMANDS[cmd_name]
        command = getattr(import_module(f".{place.module}", __package__), place.function)
        assert isinstance(command, click.Command)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        limit = formatter.width - 6 - max(map(len, COMMANDS))
        shown = [click.Command(name, help=COMMANDS[name].help) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(str(one.name), one.get_short_help_str(limit)) for one in shown])


def _show_version(context: click.Context, _option: click.Parameter, wanted: bool) -> None:
    """Print version and source; hashes of the package's files are made only then."""
    if wanted:
        from .._source import installed_source
        from .._version import __version__

        click.echo(f"birm3d {__version__}, {installed_source()}")
        context.exit()


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_show_version,
    help="Show version, hash of the sources and commit, and exit.",
)
def _cli() -> None:
    """Impact response of vehicles and security or roadside barriers."""


def _show_warning(message: Warning | str, *_: object) -> None:
    """Show a warning as one line, without the line of this package that it comes from.

    Rows of a study are named by `birm3d sweep` alone, whose tables have them.
    """
    context = click.get_current_context(silent=True)
    text = str(message)
    if context is None or context.info_name != "sweep":
        text = _ROWS.sub(lambda found: f" (in {found[1] or 1} of the runs)", text)
    click.echo(f"birm3d: warning: {text}", err=True)


# Python evaluates the class of an except clause only when there is an error. So imports come only then.
def _study_stopped() -> type[Exception]:
    from ..study.runner import StudyStoppedError

    return StudyStoppedError


def _unstable() -> type[Exception]:
    from .._core import UnstableError

    return UnstableError


def main() -> None:
    """Entry point: errors that users can mend end with one line on stderr and exit code 2."""
    warnings.showwarning = _show_warning  # type: ignore[assignment]
    try:
        _cli(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt) as error:
        # click turns Ctrl-C into Abort; its cause may be a StudyInterrupted, which says what is finished.
        click.echo(str(error.__cause__ or error) or "stopped", err=True)
        sys.exit(130)
    except _study_stopped() as error:
        click.echo(f"birm3d: {error}", err=True)
        sys.exit(1)
    except (ValueError, _unstable(), ImportError) as error:  # ImportError: an extra is not installed
        click.echo(f"birm3d: {error}", err=True)
        sys.exit(2)
    except BrokenPipeError:  # the reader of stdout has stopped, as head does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:  # the disk is full, or a file has vanished
        place = "" if error.filename is None else f"{error.filename}: "
        click.echo(f"birm3d: {place}{error.strerror or error}", err=True)
        sys.exit(1)
