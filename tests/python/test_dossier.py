"""The dossier: every number is that of the API, nothing comes from elsewhere, folders are not mixed."""

from __future__ import annotations

import base64
import dataclasses
import json
import math
import re
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import birm3d
import html_reader
import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Study, Vehicle, scenes
from birm3d.assessment.criteria import Criterion
from birm3d.assessment.rating import Rating
from birm3d.assessment.rating_bands import band_rows
from birm3d.reporting.given_tests import _facts, errors, given_tests, nearest
from birm3d.reporting.likeness import Facts
from birm3d.reporting.loads import _gives_way
from birm3d.reporting.numbers import percent
from birm3d.reporting.page import _mark
from birm3d.reporting.shares import share_of_runs
from birm3d.reporting.uncertainty import _bands
from birm3d.reporting.verdict import _judges
from birm3d.result.skin import skins_at
from birm3d.result.summary import element_rows, headline_rows
from birm3d.study.shown_columns import parameter_words
from scipy import stats

FACTS = {"project": "Plaza <north>", "client": "City", "author": "A. Engineer", "date": "2030-01-02"}


class Page(html_reader.Page):
    """The page of a dossier, with its tables by their captions."""

    def __init__(self, path: Path) -> None:
        self.tables: dict[str, list[list[str]]] = {}
        super().__init__(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        super().handle_starttag(tag, attrs)
        if tag == "tr":
            self.rows.append([])
        if tag == "table":
            self.rows: list[list[str]] = []

    def handle_endtag(self, tag: str) -> None:
        super().handle_endtag(tag)
        if tag == "caption":
            self.tables[re.sub(r"^Table \d+\. ", "", self.texts["caption"][-1])] = self.rows
        if tag in ("td", "th"):
            self.rows[-1].append(self.texts[tag][-1].replace("\u00a0", " "))

    def table(self, beginning: str) -> list[list[str]]:
        """Rows of the table whose caption begins so, without the head."""
        (found,) = [rows for caption, rows in self.tables.items() if caption.startswith(beginning)]
        return found[1:]


def tidy(text: str) -> str:
    text = text.replace("+-", "±").replace("<=", "≤").replace(">=", "≥").replace("^2", "²")
    return re.sub(r"(\d)%", r"\1 %", text)


def crash(**settings: Any) -> Simulation:
    truck = Vehicle.preset("cargo_truck", mesh_density=0.15)
    return Simulation(truck, Barrier.bollards(), 21.3, settings=Settings(**settings))


@pytest.fixture(scope="module")
def result() -> Result:
    return crash().run()


@pytest.fixture(scope="module")
def folder(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dossier") / "report"
    assert birm3d.dossier(result, folder, title="Posts", **FACTS) == folder / "index.html"
    return folder


@pytest.fixture(scope="module")
def page(folder: Path) -> Page:
    return Page(folder / "index.html")


def test_verdict_comes_first(page: Page, result: Result) -> None:
    headings = page.texts["h2"]
    assert headings[0] == "1. Verdict"
    assert [re.sub(r"^\d+\. ", "", text) for text in headings[1:5]] == [
        "Scene", "Motion and crush", "Loads on the barrier", "Occupant risk",
    ]  # fmt: skip
    glance = dict(page.table("At a glance"))
    assert glance["What happens to the vehicle?"] == f"{result.outcome}: {result.outcome_detail}"
    rating = birm3d.rate(result, "ASTM F2656")
    assert glance["Rating by ASTM F2656, indicative"].startswith(
        f"{rating.designation} (vehicle M); contained"
    )
    most = max(result.element_loads, key=lambda load: load.peak_force_50ms)
    assert f"up to {most.peak_force_50ms / 1e3:,.0f} kN" in glance["What does the barrier have to carry?"]
    crush = result.metrics["dynamic_crush"]
    assert crush > 0.75
    assert glance["Is the crush within what was tested?"].startswith(f"NO: greatest {crush:.2f} m, and ")
    assert page.texts["h1"] == ["Posts"]
    assert page.texts["dd"][:4] == list(FACTS.values())


def test_ratings_and_risk_are_those_of_the_api(page: Page, result: Result) -> None:
    for standard in ("ASTM F2656", "SD-STD-02.01"):
        rating = birm3d.rate(result, standard)
        rows = [[one.name, tidy(one.shown), tidy(one.limit), one.verdict] for one in rating.criteria]
        assert [row[:4] for row in page.table(f"Rating, {rating.title}")] == rows
    assert [row[0] for row in page.table("Standards that do not rate")] == [
        "ISO 22343-1",
        "IWA 14-1",
        "PAS 68",
    ]
    risk = birm3d.occupant_risk(result)
    rows = [[one.name, one.shown, tidy(one.limit), one.verdict] for one in risk.criteria]
    assert [row[:4] for row in page.table("Occupant risk")] == rows
    cautions = " ".join(page.texts["p"])
    assert "Indicative" in cautions
    assert birm3d.rate(result, "ASTM F2656").caution.partition(" Indicative")[0] in cautions


def test_numbers_are_those_of_the_api(page: Page, result: Result, folder: Path) -> None:
    headlines = [list(map(tidy, row)) for row in headline_rows(result) if row[0]][1:]
    assert [[*row[:2], row[3]] for row in page.table("Headline numbers")] == headlines
    assert page.table("Loads on each element") == [list(row) for row in element_rows(result)]
    cells = {row[0]: row[1] for row in page.table("All metrics")}
    assert cells == {name: f"{value:.6g}" for name, value in result.metrics.items()}
    lines = (folder / "metrics.csv").read_text(encoding="utf-8").splitlines()[1:]
    values = {line.split(",")[0]: float(line.split(",")[1]) for line in lines}
    assert values == dict(result.metrics)
    (load, *_) = [load for load in result.element_loads if load.touched]
    row = (folder / "loads.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    assert row[0] == load.name
    assert float(row[2]) == load.peak_force_50ms
    energy = {row[0]: row for row in page.table("Energy balance")}
    for name, history in result.energy.items():
        if name != "residual":
            last = energy[name.replace("_", " ")][2]
            assert last == f"{history[-1] / 1e3:,.2f}".removeprefix("-" if last == "0.00" else "")
    assert page.texts["pre"] == [result.report()]
    facts = dict(page.table("Reproduction"))
    assert facts["state hash"] == f"{result.state_hash:016x}"
    settings = dict(page.table("Settings"))
    assert settings["tolerance"] == f"{result.scene.settings.tolerance:g}"
    assert len(settings) == len(dataclasses.fields(Settings))


def test_design_loads_are_those_of_the_api(page: Page, result: Result, folder: Path) -> None:
    loads = birm3d.design_load(result)
    rows = page.table("Design loads")
    assert [row[0] for row in rows] == [row.name for row in loads if row.touched]
    head = page.texts["th"]
    assert "design equivalent static force [kN]" in head
    most = loads.governing
    force = most.design["equivalent_static_force"]
    assert force > most.equivalent_static_force
    answer = dict(page.table("At a glance"))["What does its foundation have to carry?"]
    assert answer.startswith(f"{most.name}: design with an equivalent static force {force / 1e3:,.0f} kN")
    static = most.design["equivalent_static_moment"] / 1e3
    assert tidy(f"a 50-ms mean without dynamic factor; equivalent static moment {static:,.0f} kN m") in answer
    assert "design moment, 50-ms mean, no dynamic factor [kN m]" in head
    assert tidy("design equivalent static moment [kN m]") in head
    assert loads.caution in " ".join(" ".join(page.texts["p"]).split())  # per cent has a fixed space
    assert "The vehicle is heavy, and its force is computed lower" in loads.caution
    assert (folder / "design_loads.csv").read_text(encoding="utf-8").count("bollard") == len(loads)


def test_every_number_has_the_band_of_the_class(page: Page, result: Result) -> None:
    """Headlines, ratings, design loads and occupant risk beside 16 vehicles, as the API has them."""
    predicted = birm3d.predict(Simulation.from_scene(result.scene), 16)
    headlines = {row[0]: row[2] for row in page.table("Headline numbers")}
    for label, name, size, form in (
        ("dynamic crush (greatest of the skin)", "dynamic_crush", 1.0, ".3f"),
        ("peak 50-ms mean of the force along the normal", "peak_force_50ms", 1e3, ".0f"),
    ):
        low, high = (format(end[name] / size, form) for end in (predicted.low, predicted.high))
        assert headlines[label] == f"{low} to {high}"
    # Where most of the 16 stay at the bollards, there is no band of how they leave.
    leaving = {"exit speed": "exit_speed", "exit angle from the barrier's line": "exit_angle"}
    without = {label for label, name in leaving.items() if name not in predicted.low}
    assert {label for label, band in headlines.items() if " to " not in band} == without
    assert all(headlines[label] == "–" for label in without)
    glance = dict(page.table("At a glance"))
    rated = birm3d.rate(predicted, "ASTM F2656")
    shares = ", ".join(f"{name} {share:.0%}" for name, share in rated.probability.items())
    assert f"Of 16 vehicles of the class: {tidy(shares)}" in glance["Rating by ASTM F2656, indicative"]
    found = {row[0]: row[4:] for row in page.table("Rating, ASTM F2656")}
    assert found == {name: [tidy(band), tidy(share)] for name, _, band, _, share in rated.rows}
    assert re.fullmatch(r"-?\d\.\d\d to -?\d\.\d\d m", found["penetration past the rear face"][0])
    loads = birm3d.design_load(result, draws=16)
    low, high = (end / 1e3 for end in loads.governing.band["equivalent_static_force"])
    own = loads.governing.equivalent_static_force / 1e3
    told = f"this vehicle {own:,.0f} kN, 80 % of the class {low:,.0f} to {high:,.0f} kN"
    assert tidy(told) in glance["What does its foundation have to carry?"]
    force, moment = (
        max(result.metrics[name], predicted.high[name]) / 1e3
        for name in ("peak_element_force_50ms", "peak_overturning_moment_50ms")
    )
    told = f"upper ends {force:,.0f} kN and {moment:,.0f} kN m"
    assert glance["What does the barrier have to carry?"].endswith(told)
    risk = birm3d.occupant_risk(predicted)
    assert [row[4:] for row in page.table("Occupant risk")] == [[row[2], tidy(row[4])] for row in risk.rows]
    drawn = page.table("What differs between vehicles of the class")
    scatter = {name: one for name, one in result.scene.vehicle.scatter.items() if name != "bed_fixings"}
    assert [row[1] for row in drawn] == [f"{one.median:.2f}" for one in scatter.values()]
    rows = {row[0]: row for row in page.table("This run beside 80 % of the vehicles")}
    assert rows["dynamic crush (greatest of the skin)"][1] == f"{result.metrics['dynamic_crush']:.4g}"
    assert predicted.caution in page.texts["p"]


def test_without_bands_the_page_says_why(tmp_path: Path) -> None:
    box = Simulation(Vehicle.preset("paper_pickup", mesh_density=0.1), Barrier.bollards(count=1), 10.0).run()
    told = Page(birm3d.dossier(box, tmp_path / "box"))
    reason = "the vehicle's file does not say how its class scatters"
    assert f"There are no bands of the vehicle's class: {reason}." in told.texts["p"]
    assert {row[2] for row in told.table("Headline numbers")} == {"–"}
    with pytest.raises(ValueError, match="draws must be a power of 2 from 8 to 1024, got 10"):
        birm3d.dossier(box, tmp_path / "none", draws=10)


@pytest.mark.filterwarnings("ignore::birm3d.CoreContactWarning")  # one car of the class strikes its core
def test_occupants_are_judged_by_the_standard_that_rates(tmp_path: Path) -> None:
    """A car that meets MASH and not EN 1317: the answer at the top is that of the rating below it."""
    car = Vehicle.preset("mash_1100c", mesh_density=0.1)
    run = Simulation(car, Barrier.jersey(), 27.0, 25.0).run()
    risk = birm3d.occupant_risk(run)
    assert risk.passed("MASH")
    assert not risk.passed("EN 1317")
    predicted = birm3d.predict(Simulation.from_scene(run.scene), 8)
    told = dict(Page(birm3d.dossier(predicted, tmp_path / "car")).table("At a glance"))
    assert told["Would occupants be at risk?"].startswith("the limits of MASH are met")


def test_momentum_balance_closes(page: Page, result: Result) -> None:
    rows = {row[0]: row[1:] for row in page.table("Momentum balance")}
    change = result.scene.vehicle.mass * (result.velocity[-1] - result.velocity[0]) / 1e3
    assert [float(cell.replace(",", "")) for cell in rows["change of momentum"]] == pytest.approx(
        change, abs=1e-3
    )
    assert all(abs(float(cell)) < 1e-9 for cell in rows["difference"])


def test_verification_says_what_applies(page: Page, result: Result) -> None:
    rows = {row[0]: row[1:] for row in page.table("Verification")}
    (energy,) = [row for name, row in rows.items() if "10 %" in name]
    assert energy == [tidy(percent(result.metrics["energy_residual"])), "10 %", "pass"]
    assert not re.search(r"\de-\d", " ".join(cell for row in rows.values() for cell in row))
    assert sum(row[-1].startswith("not applicable") for row in rows.values()) == 3
    assert not any(row[-1].startswith("FAIL") for row in rows.values())


def test_vehicle_has_its_sources_and_bands(page: Page, result: Result) -> None:
    file = result.scene.vehicle._file
    assert file is not None
    assert [row[0] for row in page.table("Cargo truck: sources")] == [source.id for source in file.sources]
    bands = page.table("Cargo truck: mass properties")
    assert len(bands) == len(file.targets)
    assert all("±" in row[1] for row in bands)
    zones = [row[0] for row in page.table("Cargo truck: stiffness zones")]
    assert zones == [
        name.replace(".across", ", across the vehicle").replace("_", " ")
        for name in result.scene.vehicle.zones
    ]
    facts = page.table("Cargo truck: facts")
    assert all(row[2] for row in facts)
    assert dict((row[0], row[2]) for row in facts)["length"] == "outline"


def test_titles_have_the_vehicle_in_words(page: Page, folder: Path) -> None:
    assert "cargo_truck" not in " ".join([*page.texts["caption"], *page.texts["h1"], *page.texts["p"]])
    assert dict(page.table("Scene"))["vehicle"] == "Cargo truck, 6,803.9 kg"


def test_a_run_that_nobody_rates_says_so_at_a_glance(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    page = Page(birm3d.dossier(Simulation(car, Barrier.bollards(), 8.0).run(), tmp_path / "a", draws=0))
    glance = dict(page.table("At a glance"))
    assert glance["Rating, indicative"] == (
        "none: car of 1,814 kg is no test vehicle of ASTM F2656, ISO 22343-1, IWA 14-1, PAS 68, SD-STD-02.01"
    )
    why = dict(page.table("Standards that do not rate"))
    assert why["SD-STD-02.01"] == "it knows no car of 1,814 kg, but 15,000-lb truck (truck, 6,804 ±140 kg)"
    told = glance["How well does the model do in given tests nearby?"]
    assert told.endswith("none of these tests has both this kind of vehicle and this kind of barrier")


def test_inputs_of_a_study_are_words() -> None:
    assert parameter_words("barrier.spacing") == "barrier: spacing"
    assert parameter_words("zone.front.k_initial") == "zone front: k initial"
    assert parameter_words("impact_speed") == "impact speed"


def test_each_zone_has_a_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The law of the wheel house along the vehicle has the source of its own block."""
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: [])
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    page = Page(birm3d.dossier(Simulation(car, Barrier.rigid_wall(), 5.0).run(), tmp_path / "a", draws=0))
    rows = {row[0]: row[2:] for row in page.table("Passenger car: stiffness zones")}
    assert rows["wheel house, along the vehicle"] == ["calibrated", "fit-small-overlap, folding-front"]
    assert all(status and source for status, source in rows.values())


def test_later_contacts_are_counted_not_averaged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The mean number of later contacts would say nothing; the share of runs with one has an interval."""
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: [])
    drawn = birm3d.monte_carlo(crash(), {"impact_speed": stats.norm(21.0, 1.0)}, n=12, progress=False)
    columns = {**drawn.metrics, "later_contacts": np.array([2.0, 1.0, 0.0, 3.0] + 8 * [0.0])}
    monkeypatch.setattr(drawn, "metrics", columns)
    page = Page(birm3d.dossier(drawn, tmp_path / "a", draws=8))
    rows = {row[0]: row[1:] for row in page.table("Outcomes of the study")}
    low, high = stats.binomtest(3, 12).proportion_ci(0.95, method="wilson")
    assert rows["any outcome, with a contact after the values at separation"] == [
        "3 of 12, 25 %",
        f"{100 * low:.0f} to {100 * high:.0f} %",
    ]
    beside = [row[0] for row in page.table("This run beside")]
    assert not any("values at separation" in label for label in beside)
    assert any("a contact after" in row[0] for row in page.table("Outcomes of the vehicles"))


def test_given_tests_are_computed_by_this_version(page: Page, result: Result) -> None:
    found = nearest(result.scene)
    rows = page.table("Given tests nearest")
    twice = [one for one in found for _ in range(1 if one.rating is None else 2)]  # containment, class
    assert [row[0] for row in rows] == [one.test.name for one in twice]
    assert [row[6] for row in rows] == ["yes" if one.test.fitted else "no" for one in twice]
    (pitch,) = [row for row in rows if row[0] == "15,000-lb truck, bollards"]
    own = scenes.truck_at_bollards().run().metrics["max_pitch"]
    assert pitch[3:6] == ["23 deg", f"{own:.3g} deg", tidy(f"{own / 23.0 - 1.0:+.0%}")]
    assert pitch[2] == "greatest pitch"
    glance = dict(page.table("At a glance"))["How well does the model do in given tests nearby?"]
    off = median(map(abs, errors(found)))
    assert tidy(f"median error {off:.0%} in {len(errors(found))} value") in glance
    assert "(WRONG: 8-in posts with a rail, 43.5 mph; 8-in pipe, one, pickup at 30 mph)" in glance
    assert tidy(f"15,000-lb truck, bollards, greatest pitch: {own / 23.0 - 1.0:+.0%}") in glance
    # Rigid posts can not give way.
    gave_way = {"8-in posts with a rail, 43.5 mph", "8-in pipe, one, pickup at 30 mph"}
    wrong = {
        quantity: {row[0] for row in rows if row[2] == quantity and row[5] == "WRONG"}
        for quantity in ("containment", "class or penetration")
    }
    assert wrong["containment"] == gave_way
    assert wrong["class or penetration"] == gave_way | {"DSC635, one shallow bollard"}
    judged = {row[0]: row[3:6] for row in rows if row[2] == "class or penetration"}
    assert judged["RSA surface-mount bollards"][0::2] == ["–", "not published"]
    assert judged["DSC720-1M, fixed bollard"][0::2] == ["P1, at most 0.5 m", "right"]
    assert "class or penetration computed as published in 2 of 5 tests (WRONG: " in glance


def test_penetration_beside_the_published_one_is_part_of_the_verdict(page: Page, result: Result) -> None:
    """A truck at bollards: DSC635 went 1.87 m past its datum, the computed truck stays short of it."""
    told = dict(page.table("At a glance"))["How did penetration compare in given tests nearby?"]
    (shallow,) = [one for one in nearest(result.scene) if one.test.name.startswith("DSC635")]
    assert shallow.rating is not None
    short = f"{-shallow.rating.penetration:.2f} m short of the datum"
    assert f"DSC635, one shallow bollard: computed {short}, published dynamic 1.87 m" in told
    assert told.endswith("rely on no computed penetration")
    assert "pickup" not in told  # another group of vehicles


def test_given_tests_nearest_to_scenes() -> None:
    tests = given_tests()
    assert len({test.name for test in tests}) > 40
    for test in (tests[0], tests[3], tests[-1], tests[-12]):
        scene = test.simulation().scene
        assert _facts(test.recipe)._replace(mass=0.0) == Facts.of(scene)._replace(mass=0.0)
        assert _facts(test.recipe).mass == pytest.approx(Facts.of(scene).mass)
        first = nearest(scene, 1)
        assert first[0].alike == ("vehicle", "barrier", "speed", "angle")
        assert first[0].scene.vehicle.mass == pytest.approx(scene.vehicle.mass)
    with_number = [one for one in nearest(tests[0].simulation().scene, 1)]
    assert [one.test.quantity for one in with_number] == [
        "peak_normal_force_cfc60", "max_displacement", "restitution",
    ]  # fmt: skip
    for one in with_number:
        assert one.error == one.computed / one.test.measured - 1.0
    assert errors(with_number) == []  # fitted: no prediction


def test_capsule_runs_again(folder: Path, result: Result) -> None:
    again = birm3d.rerun(folder / "run.birm3d")
    assert again.same
    assert again.found_hash == result.state_hash


def test_page_needs_no_network(page: Page, folder: Path) -> None:
    for tag, attributes in page.attributes:
        assert (attributes.get("src") or "data:").startswith("data:"), tag
        link = attributes.get("href") or "#"
        if link.startswith("#"):
            assert link == "#" or any(other.get("id") == link[1:] for _, other in page.attributes)
        elif not link.startswith("data:"):
            assert (folder / link).is_file()
    assert not re.search(
        r"@import|url\(|https?://(?!www\.w3\.org)", "".join(page.texts["style"] + page.texts["script"])
    )
    assert len(page.source) < 5e6
    assert "Plaza &lt;north&gt;" in page.source
    ids = [attributes["id"] for _, attributes in page.attributes if "id" in attributes]
    assert len(ids) == len(set(ids))


def test_replay_is_the_run(page: Page, result: Result) -> None:
    data = json.loads(page.texts["script"][0])

    def lengths(text: str) -> np.ndarray:
        return np.frombuffer(base64.b64decode(text), "<i2") * data["unit"]

    k = len(data["time"]) // 2
    framed = result.with_frames(60)
    ((skin,),) = skins_at(framed, [data["time"][k] / 1e3])
    (unit,) = data["units"]
    nodes = lengths(unit["rest"]).reshape(-1, 3).copy()
    moving = np.frombuffer(base64.b64decode(unit["moving"]), "<u4")
    nodes[moving] += lengths(unit["moved"]).reshape(len(data["time"]), -1, 3)[k]
    assert np.abs(nodes - skin.nodes).max() < 2e-3
    assert unit["center"][k] == pytest.approx(skin.center, abs=1e-3)
    w, x, y, z = unit["rotation"][k]
    first_axis = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    assert first_axis == pytest.approx(skin.rotation[:, 0], abs=1e-5)
    assert data["time"][0] <= data["instant"] <= data["time"][-1]
    assert len(data["barrier"]) == 5


def test_the_same_run_gives_the_same_page(folder: Path, tmp_path: Path) -> None:
    """Also from the capsule that lies beside it; an earlier dossier is replaced."""
    again = birm3d.load(folder / "run.birm3d")
    page = birm3d.dossier(again, tmp_path, title="Posts", **FACTS)
    assert page.read_bytes() == (folder / "index.html").read_bytes()
    loads = birm3d.design_load(again, natural_period=0.05, ductility=3.0)
    birm3d.dossier(
        again, tmp_path, title="Other", standards=["ASTM F2656-07"], design_loads=loads, date="2030-01-03"
    )
    other = Page(page)
    assert "ductility 3" in dict(other.table("At a glance"))["What does its foundation have to carry?"]
    assert other.texts["h1"] == ["Other"]
    assert len([caption for caption in other.tables if caption.startswith("Rating, ")]) == 1


def test_folders_are_not_mixed(
    result: Result,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: Callable[..., int],
    capsys: pytest.CaptureFixture[str],
) -> None:
    file = tmp_path / "file"
    file.write_text("mine", encoding="utf-8")
    full = tmp_path / "full"
    full.mkdir()
    (full / "letter.txt").write_text("mine", encoding="utf-8")
    places = {
        file: "folder must be a folder, got the file",
        full: "other files: letter.txt",
        tmp_path / "none" / "deep": "must be in a folder that exists",
    }
    if sys.platform == "linux":
        places[Path("/proc/dossier")] = "must be one that can be written to"

    def never(*arguments: object, **more: object) -> None:
        raise AssertionError("the run began")

    monkeypatch.setattr("birm3d.reporting.study_case.case_of", never)
    monkeypatch.setattr(Simulation, "run", never)
    for place, message in places.items():
        with pytest.raises(ValueError, match=message):
            birm3d.dossier(result, place)
        options = ["--vehicle", "passenger_car", "--speed", "30mph", "--output", str(place)]
        assert command("report", *options) == 2
        told = capsys.readouterr().err
        assert "--output must" in told
        assert message.removeprefix("folder must ") in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "full"]


def test_bad_arguments(result: Result, tmp_path: Path) -> None:
    place = tmp_path / "report"
    with pytest.raises(ValueError, match="standard must be one of"):
        birm3d.dossier(result, place, standards=["ASTM F9999"])
    with pytest.raises(ValueError, match="PAS 68 knows"):
        birm3d.dossier(result, place, standards=["PAS 68"])
    with pytest.raises(ValueError, match="at least 2 rows"):
        birm3d.dossier(crash().result(), place)
    other = Simulation.from_scene(result.scene).run()
    other.state_hash ^= 1
    with pytest.raises(ValueError, match="must run again to the same bits"):
        birm3d.dossier(other, place)
    assert not place.exists()


@pytest.fixture(scope="module")
def study() -> Study:
    return birm3d.sweep(crash(), impact_speed=[20.5, 21.0, 22.352], progress=False)


def test_bands_of_a_drawn_study_and_load_on_a_wall(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Histories of a Monte Carlo study as bands; of a rigid wall the load by cell. A grid is no draw."""
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    wall = Simulation(car, Barrier.rigid_wall(), 10.0)
    unknown = {"impact_speed": stats.norm(10.0, 0.5)}
    drawn = birm3d.monte_carlo(wall, unknown, n=8, progress=False)
    text = birm3d.dossier(drawn, tmp_path / "drawn").read_text(encoding="utf-8")
    assert "Deceleration and travel over time: median and 80 % of 8 runs" in text
    assert "Load on the barrier by cell" in text
    grid = birm3d.sweep(wall, impact_speed=np.linspace(9.0, 10.0, 8).tolist(), progress=False)
    assert list(_bands(grid)) == []


def test_study(study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)  # no plotly: no second page
    page = Page(birm3d.dossier(study, tmp_path / "a"))
    summary = study.summary()
    rows = {row[0]: row[1:] for row in page.table("Percentiles of the study")}
    found = summary["dynamic_crush"]
    own = crash().run().metrics["dynamic_crush"]
    numbers = (own, found.p05, found.median, found.p95, found.mean, found.standard_deviation)
    assert rows["dynamic crush (greatest of the skin)"] == [
        *(f"{x:.4g}" for x in numbers if x is not None),
        "m",
        "3",
    ]
    assert page.table("Inputs of the study") == [["impact speed", "20.5 to 22.352", "m/s"]]
    classes = page.table("Share of the runs in each class")  # a grid is no draw: no probability, no interval
    rated = birm3d.rate(study, "ASTM F2656").designation
    assert {name: text for name, text, _ in classes} == {
        name: f"{rated.count(name)} of 3, {100 * rated.count(name) / 3:.0f} %" for name in rated
    }
    answers = dict(page.table("At a glance"))
    assert answers["What happens in the 3 runs of the study?"] == "stopped in 3 of 3, 100 %"
    assert answers["What does its foundation have to carry?"].startswith("this run alone, bollard 3: ")
    assert "95 % interval (" not in page.source
    assert "A share of them is no probability" in page.source
    with pytest.raises(ValueError, match="got both"):
        birm3d.dossier(study, tmp_path / "b", study=study)
    study.save(tmp_path / "study.csv")
    loaded = Study.load(tmp_path / "study.csv")
    with pytest.raises(ValueError, match="knows the scene that was varied"):
        birm3d.dossier(loaded, tmp_path / "b")


def test_verdict_says_what_share_of_a_study_meets_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Counts of a Monte Carlo study, with the intervals of scipy; heavy trucks have no rating."""
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))
    unknown = {"impact_speed": stats.norm(21.0, 1.0), "vehicle.gvw": stats.norm(6800.0, 120.0)}
    drawn = birm3d.monte_carlo(crash(), unknown, n=16, progress=False)
    page = Page(birm3d.dossier(drawn, tmp_path / "drawn", draws=0))
    rated = birm3d.rate(drawn, "ASTM F2656")
    n = len(rated.ratings)
    assert 0 < n < 16
    answers = dict(page.table("At a glance"))

    def interval(count: int, of: int) -> str:
        found = stats.binomtest(count, of).proportion_ci(0.95, method="wilson")
        return f"{100 * found.low:.0f} to {100 * found.high:.0f} %"

    ended = drawn.outcome.count("stopped")
    expected = f"stopped in {ended} of 16, {100 * ended / 16:.0f} % (95 % interval {interval(ended, 16)})"
    assert answers["What happens in the 16 runs of the study?"].startswith(expected)
    classes = answers["Rating of these runs by ASTM F2656, indicative"]
    unrated = {"no rating: the standard has no vehicle of that mass": 16 - n}
    for name, count in [*Counter(rated.designation).items(), *unrated.items()]:
        share = f"{count} of 16, {100 * count / 16:.0f} % (95 % interval {interval(count, 16)})"
        assert f"{name} in {share}" in classes
    rows = {row[0]: row[1:] for row in page.table("The study beside the verdict by ASTM F2656")}
    *_, met, band = rows["all of these, and contained"]
    fitting = [rating for rating in rated.ratings if not rating.unmet]
    good = sum(rating.passed for rating in fitting)
    assert 0 < len(fitting) <= n
    share = f"{good} of {len(fitting)}, {100 * good / len(fitting):.0f} %"
    assert (met, band) == (share, interval(good, len(fitting)))
    rest = rows["without a verdict by the standard"][3]
    assert rest.startswith(f"{16 - len(fitting)} of 16: ")
    assert f"the standard has no vehicle of that mass {16 - n}" in rest
    assert page.source.index("The study beside the verdict") < page.source.index("Replay, colours show")


def test_shares_of_runs_have_no_more_digits_than_the_runs_tell() -> None:
    assert [share_of_runs(*pair) for pair in ((1, 3), (0, 8), (8, 8))] == ["33%", "0%", "100%"]
    few, many, most = (share_of_runs(*pair) for pair in ((1, 399), (999, 1000), (1999, 2000)))
    assert (few, many, most) == ("0.25%", "99.9%", "99.95%")


def test_small_shares_have_no_powers_of_ten() -> None:
    told = [percent(share) for share in (0.0, 5e-13, 7.3e-5, 2.3e-4, 5.6e-3, 0.052, 0.1)]
    assert told == ["0%", "below 0.0001%", "0.0073%", "0.023%", "0.56%", "5.2%", "10.0%"]


def test_bands_of_criteria_have_the_digits_of_their_medians() -> None:
    masses = [Criterion("mass", mass, "kg", "", True) for mass in (6703.33, 6814.21, 6911.89)]
    ratings = [Rating("", "", 0.0, True, (mass,), (), "") for mass in masses]
    ((_, median, band, *_),) = band_rows(ratings)
    assert median == "6,814.2 kg"
    assert re.fullmatch(r"6,7\d\d\.\d to 6,\d{3}\.\d kg", band)


def test_occupants_of_a_heavy_truck_are_not_judged_as_those_of_a_car(page: Page) -> None:
    told = "MASH and EN 1317 do not judge this for so heavy a vehicle: limits are those for cars and pickups."
    assert told in page.texts["p"]
    answer = dict(page.table("At a glance"))["Would occupants be at risk?"]
    assert answer.startswith("MASH does not judge this for so heavy a vehicle; its limits for cars and")
    assert answer.endswith("of 16 vehicles of the class meet all of them")
    foundation = dict(page.table("At a glance"))["What does its foundation have to carry?"]
    assert re.search(
        r"natural period 0\.1 s \(assumed; up to \d\.\d\d times as much at 0\.\d+ s\)", foundation
    )


def block() -> Simulation:
    vehicle = scenes.laboratory_block(16, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=6e7)
    return Simulation(vehicle, Barrier.rigid_wall(), 10.0, settings=Settings(ground=False, gravity=0.0))


def alone() -> Simulation:
    return Simulation(Vehicle.preset("passenger_car", mesh_density=0.1), None, 10.0, duration=0.05)


def articulated() -> Simulation:
    semi = Vehicle.preset("semi_truck", mesh_density=0.05)
    return Simulation(semi, Barrier.jersey(height=1.07), 20.0, 20.0, duration=0.15)


def free_standing() -> Simulation:
    car = Vehicle.preset("passenger_car", mesh_density=0.15).with_zone("bumper", k_unloading=3e8)
    return Simulation(
        car, Barrier.jersey(length=12.0, segments=4, free_standing=True), 25.0, 20.0, duration=0.3
    )


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
@pytest.mark.parametrize("make", [block, alone, articulated, free_standing])
def test_other_kinds_of_runs(make: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))
    result = make().run()
    page = Page(birm3d.dossier(result, tmp_path / "a"))
    assert not (tmp_path / "a" / "histories.html").exists()
    assert dict(page.table("Reproduction"))["state hash"] == f"{result.state_hash:016x}"
    data = json.loads(page.texts["script"][0])
    assert len(data["units"]) == len(result.scene.vehicle.units)
    text = " ".join(page.texts["p"])
    assert ("those of the leading unit" in text) is (len(data["units"]) > 1)
    if make is block:
        assert "given as arrays" in text
    elif make is alone:
        assert "nothing is rated" in text
        assert "the outcome is decided" in [row[0] for row in page.table("Verification") if row[-1] == "FAIL"]
    elif make is articulated:
        assert [name for name, _ in page.table("Standards that do not rate")] == ["MASH", "EN 1317"]
        assert len([caption for caption in page.tables if caption.endswith(": sources")]) == 2
    else:
        assert ["changed" in row for row in page.table("Passenger car: stiffness") if row[0] == "bumper"] == [
            True
        ]
        part = data["barrier"][1]
        moved = np.array(part["center"]) + np.array(part["shift"])
        assert np.abs(moved[-1, :2] - result.segment_position[-1, 1]).max() < 1e-3
        yaw = math.radians(result.segment_yaw[-1, 1])
        assert np.array(part["turn"])[-1, [0, 3]] == pytest.approx([math.cos(yaw), math.sin(yaw)], abs=1e-5)


def test_a_verdict_is_a_word_of_its_own() -> None:
    """Vehicles and barriers whose names begin with one are no verdicts."""
    assert _mark("Passenger car, 900.0 kg") == _mark("rightmost bollard") == _mark("NOTE") == ""
    assert _mark("pass") == _mark("pass: class B") == _mark("right") == "good"
    assert _mark("FAIL: beyond C") == _mark("WRONG") == _mark("NOT contained") == "bad"


def test_vehicle_class_takes_the_place_of_kind_and_mass(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Callable[..., int]
) -> None:
    """A pickup of 2,045 kg is none of ASTM F2656: it is rated as PU where that is asked for."""
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    monkeypatch.setattr("birm3d.reporting.study_case.nearest", lambda scene: nearest(scene, 1))
    pickup = Vehicle.preset("pickup", mesh_density=0.1).with_gvw(2045.0)
    result = Simulation(pickup, Barrier.bollards(count=1), 13.4).run()
    with pytest.raises(ValueError, match="vehicle_class= takes its place"):
        birm3d.dossier(result, tmp_path / "a", standards=["ASTM F2656"], draws=0)
    page = Page(birm3d.dossier(result, tmp_path / "a", vehicle_class="PU", draws=0))
    glance = dict(page.table("At a glance"))
    rating = birm3d.rate(result, "ASTM F2656", vehicle_class="PU")
    assert glance["Rating by ASTM F2656, indicative"].startswith(f"{rating.designation} (vehicle PU); ")
    assert "IWA 14-1" in [row[0] for row in page.table("Standards that do not rate")]
    place = tmp_path / "run.npz"
    result.save(place)
    options = ["-o", str(tmp_path / "b"), "--standard", "ASTM F2656", "--vehicle-class", "PU", "--draws", "0"]
    assert command("report", str(place), *options) == 0
    drawn = Page(
        birm3d.dossier(result, tmp_path / "a", standards=["ASTM F2656"], vehicle_class="PU", draws=8)
    )
    assert "limit" in drawn.source
    assert "no rating: mass" in dict(drawn.table("At a glance"))["Rating by ASTM F2656, indicative"]


def test_command_line(
    folder: Path,
    study: Study,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: Callable[..., int],
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("birm3d.reporting.build.find_spec", lambda name: None)
    out, runs = tmp_path / "out", tmp_path / "study.csv"
    study.save(runs)
    options = ["-o", str(out), "--project", "Plaza", "--study", str(runs)]
    assert command("report", str(folder / "run.birm3d"), *options) == 0
    assert capsys.readouterr().out.strip() == str(out / "index.html")
    page = Page(out / "index.html")
    assert "Plaza" in page.texts["dd"]
    assert page.table("Outcomes of the study")[0] == ["stopped", "3 of 3, 100 %", "–"]
    assert command("rerun", str(out / "run.birm3d")) == 0


@pytest.mark.filterwarnings("ignore::birm3d.TippingWarning")
def test_a_free_standing_barrier_is_not_called_rigid(tmp_path: Path) -> None:
    page = Page(birm3d.dossier(free_standing().run(), tmp_path / "report", draws=0))
    assert not any("The barrier is rigid" in text for text in page.texts["p"])
    assert any("The segments stand free" in text for text in page.texts["p"])


@pytest.mark.parametrize(
    ("barrier", "told"),
    [
        (Barrier.bollards(), "The barrier is rigid"),
        (
            Barrier.bollards(diameter=0.273, wall_thickness=0.016),
            "the plastic moment of their tubes of 376 kN m limits",
        ),
        (
            Barrier.bollards(wall_thickness=0.02, foundation=birm3d.Foundation(moment="250 kN m")),
            "the moment of their foundation of 250 kN m limits",
        ),
        (Barrier.jersey(length=60.0, segments=20, free_standing=True), "The segments stand free"),
    ],
)
def test_what_limits_the_force_is_that_of_the_barrier(barrier: Barrier, told: str) -> None:
    words = _gives_way(barrier)
    assert told in words
    assert ("is rigid" in words) == (barrier.yields() is None and barrier.stands_free() is None)
    assert ("stronger than" in words) == (barrier.yields() is not None)


def test_impulse_of_the_design_loads_ends_with_the_separation(page: Page) -> None:
    (note,) = [text for text in page.texts["p"] if "Impulse:" in text]
    assert "until the vehicle leaves the barrier or comes to rest; what follows is not in it" in note


def test_a_limit_of_the_old_edition_is_not_exceeded_by_the_new_one() -> None:
    """PHD had a limit in 1998; the rating reports it, and so does the first page."""
    old = Criterion("PHD (EN 1317-2:1998)", 21.0, "g", "20 g", False)
    new = Criterion("THIV (EN 1317-2)", 40.0, "km/h", "33 km/h", False)
    assert [_judges("EN 1317", one) for one in (old, new)] == [False, True]


def test_other_outcomes_of_the_class_stand_in_the_first_answer(tmp_path: Path) -> None:
    """No standard knows this car; a gap that stops it lets some of its class through."""
    car, row = Vehicle.preset("passenger_car", mesh_density=0.2), Barrier.bollards(count=4, spacing=1.88)
    crash = Simulation(car, row, "30 mph")
    outcomes = birm3d.predict(crash, 16, progress=False).outcomes
    assert set(outcomes) == {"stopped", "passed"}
    page = Page(birm3d.dossier(crash.run(), tmp_path / "report"))
    answer = dict(page.table("At a glance"))["What happens to the vehicle?"]
    shares = ", ".join(f"{word} {share:.0%}" for word, share in outcomes.items())
    assert answer.startswith("stopped: ")
    assert answer.endswith(f". Of 16 vehicles of the class: {tidy(shares)}")


def test_vehicles_of_the_class_without_a_rating_are_told(tmp_path: Path) -> None:
    """A run that ends early is over for this truck, and not for all of its class."""
    scene = Simulation(crash().scene.vehicle, Barrier.bollards(), 21.3, duration=0.15)
    predicted = birm3d.predict(scene, 8, progress=False)
    rated = birm3d.rate(predicted, "ASTM F2656")
    assert 0 < len(rated.failed) < 8
    page = Page(birm3d.dossier(scene.run(), tmp_path / "report", draws=8))
    answer = dict(page.table("At a glance"))["Rating by ASTM F2656, indicative"]
    shares = ", ".join(f"{name} {share:.0%}" for name, share in rated.probability.items())
    assert f"no rating: outcome not decided {len(rated.failed) / 8:.0%}" in shares
    assert answer.endswith(f". Of 8 vehicles of the class: {tidy(shares)}")
