"""The dossier: a folder with one page that opens offline, a capsule and tables."""

from __future__ import annotations

import datetime
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from ..assessment import DesignLoad
from ..base.arguments import checked
from ..result.result import Result
from ..study import Study
from ..study.class_draws import check_draws
from ..study.predict import Prediction
from .folder import PAGE, check_folder, write_folder

if TYPE_CHECKING:
    from .study_case import Case

__all__ = ["dossier"]

_FRAMES = 21  # instants of the plan view beside the page: its outlines take long to compute


@checked
def dossier(
    result: Result | Study | Prediction,
    folder: str | Path,
    *,
    study: Study | None = None,
    draws: int = 16,
    standards: Sequence[str] | None = None,
    vehicle_class: str | None = None,
    design_loads: DesignLoad | None = None,
    title: str | None = None,
    project: str = "",
    client: str = "",
    author: str = "",
    date: str | None = None,
) -> Path:
    """Write a folder whose ``index.html`` is the dossier of a run; return the path of the page.

    The page opens without a network and prints to PDF. The verdict comes first, then scene, vehicle and its
    sources, loads on each element, occupant risk, replay and histories. Uncertainty and the given tests
    nearest to the scene follow. Energy and momentum balance have the form of NCHRP W179 and EN 16303. The end
    is what was left out, warnings, versions and state hash. Beside it are the capsule (``run.birm3d``, see
    :meth:`birm3d.Result.capsule`), the loads and the metrics as CSV, and with the extra ``html`` the
    interactive page of :meth:`birm3d.Result.write_html`. Ratings are always indicative.

    Parameters
    ----------
    result
        A run, also one that was loaded; or a study: then the run is that of the scene that was varied. Of a
        prediction the run is that of its scene, and the bands are its own.
    folder
        New, empty, or that of an earlier dossier, which is replaced.
    study
        Beside a run: its percentiles and probabilities show how far the inputs move the numbers.
    draws
        Vehicles of the class that are run in the same scene, for the bands beside the numbers and the
        probabilities beside the ratings; a power of 2 from 8, or 0. See :func:`birm3d.predict`.
    standards
        To rate by, see :func:`birm3d.rate`. ``None``: those for security barriers where the path is within 45
        degrees of square to the barrier, else MASH and EN 1317; of them those that know the vehicle.
    vehicle_class
        What the standards call the vehicle, as ``"PU"``, see :func:`birm3d.rate`; ``None``: by its kind and
        mass. Give it for a vehicle whose mass no standard has.
    design_loads
        What the elements have to carry, see :func:`birm3d.design_load`; ``None``: that of this run alone.
    title, project, client, author, date
        Of the title block; ``None``: the scene, and today.

    Raises
    ------
    ValueError
        If the folder is a file, has other files or can not be written to. If the run is too short or does not
        run again to the same bits. If a study has no scene, or a standard that was asked for does not know
        the vehicle.
    """
    path = check_folder(folder)
    if draws:
        check_draws("draws", draws)
    prediction = result if isinstance(result, Prediction) else None
    run, beside = _run_and_study(result, study)
    if len(run.time) < 2:
        raise ValueError(f"result must have at least 2 rows, got {len(run.time)}")
    if not run.scene.impact_speed > 0.0:
        raise ValueError(f"result must be of a vehicle that moves, got {run.scene.impact_speed} m/s")
    from .study_case import Asked, case_of

    asked = Asked(None if standards is None else tuple(standards), vehicle_class)
    case = case_of(run, beside, asked, design_loads, prediction, draws)
    facts = {
        "project": project,
        "prepared for": client,
        "prepared by": author,
        "date": datetime.date.today().isoformat() if date is None else date,
    }
    write_folder(path, _files(case, title, facts))
    return path / PAGE


def _run_and_study(result: Result | Study | Prediction, study: Study | None) -> tuple[Result, Study | None]:
    if isinstance(result, Result):
        return result, study
    if isinstance(result, Prediction):
        return _run_and_study(result.study, None)[0], study
    if study is not None:
        raise ValueError("study must be None where result is a study, got both")
    if result._scene is None:
        raise ValueError(
            "result must be a study that knows the scene that was varied, got one of a file or an ensemble; "
            "dossier(result, folder, study=study) takes a run beside it"
        )
    from ..simulation import Simulation

    return Simulation.from_scene(result._scene).run(), result


def _files(case: Case, title: str | None, facts: dict[str, str]) -> dict[str, bytes]:
    from .loads import loads_csv, metrics_csv
    from .page import page
    from .provenance import CAPSULE

    with tempfile.TemporaryDirectory() as place:
        case.run.capsule(Path(place) / CAPSULE)
        files = {CAPSULE: (Path(place) / CAPSULE).read_bytes()}
        if find_spec("plotly") is not None:
            interactive = Path(place) / "histories.html"
            # The dossier has pictures of the crush.
            case.result.write_html(interactive, frames=min(_FRAMES, len(case.result.time)), crush=False)
            files[interactive.name] = interactive.read_bytes()
    files["metrics.csv"] = metrics_csv(case.result)
    if case.result.scene.barrier is not None:
        files["loads.csv"] = loads_csv(case.result)
    if isinstance(case.design_loads, DesignLoad):
        with tempfile.TemporaryDirectory() as place:
            table = Path(place) / "design_loads.csv"
            case.design_loads.to_csv(table)
            files[table.name] = table.read_bytes()
    files[PAGE] = page(case, title, facts, files).encode()
    return files
