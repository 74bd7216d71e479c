"""The page: it is whole, it parses, it needs no network and holds the numbers of the result."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle
from birm3d.filters import cfc
from html_reader import Page


@pytest.fixture(scope="module")
def result() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    return Simulation(car, Barrier.rigid_wall(), 20.0, 30.0).run()


@pytest.fixture(scope="module")
def text(result: Result, tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("page") / "crash.html"
    result.write_html(path, frames=11)
    return path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    return Page(text)


def data_of(page: Page) -> dict[str, Any]:
    return json.loads(page.texts["script"][0])  # type: ignore[no-any-return]


def test_tables_hold_the_outcome(page: Page, text: str, result: Result) -> None:
    cells = page.texts["td"]
    assert f"{result.metrics['exit_angle']:.1f}" in cells
    for name, value in result.metrics.items():
        assert cells[cells.index(name) + 1] == f"{value:.6g}"
    assert cells.count("✓ yes") == 3
    # A sentence beside numbers would leave their names no room on a phone.
    assert f'<tr><td colspan="3">{result.outcome_detail}</td></tr>' in text
    assert any("Passenger car, 1,814.4 kg" in cell for cell in cells)
    assert page.texts["pre"] == [result.report()]
    assert "<!--" not in "".join(page.texts["body"])


def test_numbers_are_those_of_the_result(page: Page, result: Result) -> None:
    data = data_of(page)
    step = data["every"]
    assert data["time"] == pytest.approx(result.time[::step] * 1e3, rel=1e-5)
    panels = {panel["title"]: panel for panel in data["panels"]}
    force = {curve["name"]: curve["y"] for curve in panels["Barrier force"]["curves"]}
    expected = cfc(result.barrier_normal_force / 1e3, 60, 1e-4)[::step]
    assert np.abs(np.array(force["along the normal, CFC 60"]) - expected).max() < 1e-5 * expected.max()
    energy = {curve["name"]: curve["y"] for curve in panels["Energy balance"]["curves"]}
    assert set(energy) == {name.replace("_", " ") for name in result.energy} - {"residual"}
    colors = [curve["color"] for curve in panels["Energy balance"]["curves"]]
    assert len(set(colors)) == len(colors)
    assert panels["Angles"]["unit"] == "deg"
    angles = np.array([curve["y"] for curve in panels["Angles"]["curves"]])
    assert (panels["Angles"]["range"] is None) == (np.ptp(angles) >= 1.0)  # else they are rounding errors
    rates = panels["Angular rates, body axes"]["curves"]
    assert [curve["name"] for curve in rates] == [f"{n} rate, CFC 180" for n in ("roll", "pitch", "yaw")]


def test_page_names_the_barrier_and_tables_its_loads(page: Page, result: Result) -> None:
    assert page.texts["title"] == page.texts["h1"]
    assert page.texts["h1"][0].endswith("at 30°: rigid wall without end")
    cells = page.texts["td"]
    (load,) = result.element_loads
    forces = [f"{force / 1e3:.0f}" for force in (load.peak_force, load.peak_force_50ms)]
    assert cells[cells.index("wall") :][:4] == ["wall", *forces, f"{load.height_at_peak:.2f}"]
    assert "overturning moment, 50-ms mean [kN m]" in page.texts["th"]
    # What came out is told first.
    assert page.texts["th"][0] == "outcome"


CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome") or shutil.which("chromium-browser")


@pytest.mark.skipif(CHROMIUM is None, reason="no browser to show the page with")
def test_page_on_a_phone(text: str, tmp_path: Path) -> None:
    """In a real browser, 375 px wide: nothing is wider, no mode bar, every panel is drawn."""
    (tmp_path / "page.html").write_text(text, encoding="utf-8")
    (tmp_path / "phone.html").write_text(
        """<!DOCTYPE html>
        <iframe id="phone" src="page.html" style="width:375px;height:800px;border:0"></iframe>
        <p id="seen"></p><script>
        const phone = document.getElementById("phone");
        phone.onload = () => setTimeout(() => {
          const page = phone.contentDocument;
          document.getElementById("seen").textContent = "SEEN " + JSON.stringify({
            width: page.documentElement.scrollWidth, buttons: page.querySelectorAll(".modebar-btn").length,
            plots: page.querySelectorAll(".main-svg").length, fonts: getComputedStyle(page.body).fontSize });
        }, 3000);</script>""",
        encoding="utf-8",
    )
    command = [
        str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
        f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=15000", "--dump-dom",
        (tmp_path / "phone.html").as_uri(),
    ]  # fmt: skip
    shown = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout
    found = re.search(r'<p id="seen">SEEN (\{.*?\})', shown)
    assert found, shown[-500:]
    seen = json.loads(found.group(1))
    assert seen["width"] <= 375
    assert seen["buttons"] == 0
    assert seen["plots"] > len(data_of(Page(text))["panels"])
    assert seen["fonts"] == "15px"


def test_plan_has_a_frame_for_each_place_of_the_slider(page: Page) -> None:
    plan = data_of(page)["plan"]
    assert len(plan["time"]) == len(plan["outlines"]) == 11
    assert all(len(path[0]) == 11 for path in plan["paths"])
    ((x, y),) = plan["outlines"][5]
    assert (x[0], y[0]) == (x[-1], y[-1])
    assert min(y) > -0.01  # in front of the face
    assert len(plan["barrier"][0]) == 2  # a box from above: two triangles
    assert plan["labels"][0] == "along the barrier's line [m]"


def test_page_needs_no_network(text: str, page: Page) -> None:
    for tag, attributes in page.attributes:
        for key in ("src", "href"):
            assert (attributes.get(key) or "data:").startswith("data:"), tag
    assert not re.search(r"@import|url\(", page.texts["style"][0])
    images = [attributes for tag, attributes in page.attributes if tag == "img"]
    assert any("crush of the right" in str(image["alt"]) for image in images)
    assert 3e6 < len(text) < 9e6  # plotly's script is in it


@pytest.mark.skipif(shutil.which("node") is None, reason="no node to run the page's script with")
def test_script_runs(text: str, tmp_path: Path) -> None:
    """With a document and a Plotly that only write down what is asked of them."""
    (tmp_path / "page.html").write_text(text, encoding="utf-8")
    (tmp_path / "run.js").write_text(
        """
        const text = require("fs").readFileSync(process.argv[2], "utf8");
        const scripts = [...text.matchAll(/<script[^>]*>([\\s\\S]*?)<\\/script>/g)].map((m) => m[1]);
        const calls = [], elements = {};
        const element = (id) => ({ id, value: "0", handlers: {}, appendChild() {},
          addEventListener(name, f) { this.handlers[name] = f; }, on() {} });
        global.document = { createElement: () => element("panel"),
          getElementById: (id) => (elements[id] ??= element(id)) };
        document.getElementById("data").textContent = scripts[0];
        global.Plotly = { newPlot: (div, traces) => calls.push([div.id, traces.length]),
          restyle: (div, update, traces) => calls.push(["restyle", update.x[0][0], traces]), relayout() {} };
        const shown = [];
        global.replayPanel = (box, data) => ({ show: (ms) => shown.push([box.id, data.time.length, ms]) });
        eval(scripts.at(-1));
        elements.slider.value = "5";
        elements.slider.handlers.input();
        console.log(JSON.stringify({ calls, shown, now: elements.now.value, max: elements.slider.max }));
        """,
        encoding="utf-8",
    )
    command = ["node", str(tmp_path / "run.js"), str(tmp_path / "page.html")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    outcome = json.loads(done.stdout)
    data = data_of(Page(text))
    assert outcome["max"] == 10
    # JavaScript rounds 222.25 up, Python to the even digit.
    assert re.fullmatch(r"\d+\.\d ms", outcome["now"])
    assert abs(float(outcome["now"].split()[0]) - data["plan"]["time"][5]) <= 0.05 + 1e-9
    assert outcome["shown"][-1] == ["replay", 11, data["plan"]["time"][5]]
    names = [call[0] for call in outcome["calls"]]
    assert names == ["panel"] * len(data["panels"]) + ["plan", "restyle", "restyle"]
    # barrier, path and first outline stay; outline and mass centre move
    assert outcome["calls"][-1] == ["restyle", data["plan"]["outlines"][5][0][0][0], [3, 4]]


def test_names_can_not_break_the_page(tmp_path: Path) -> None:
    block = Vehicle.from_arrays(
        name="</script><b>&x",
        mass=1000.0, inertia=1000.0 * np.eye(3), nodes=[[1.0, 0.0, 0.0]], anchors=[[0.0, 0.0, 0.0]],
        k_initial=1e6, k_unloading=1e6,
    )  # fmt: skip
    settings = Settings(ground=False, gravity=0.0)
    Simulation(block, None, 5.0, duration=0.05, settings=settings).run().write_html(tmp_path / "a.html")
    page = Page((tmp_path / "a.html").read_text(encoding="utf-8"))
    assert "b" not in page.texts
    assert page.texts["title"][0].startswith("</script><b>&x, 1,000 kg, 5.00 m/s")
    assert page.texts["title"][0].endswith("no barrier")
    assert "✗ no" in page.texts["td"]  # the outcome is not decided


def test_bad_arguments_and_missing_extra(
    result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(ValueError, match="frames must be >= 2, got 1"):
        result.write_html(tmp_path / "a.html", frames=1)
    with pytest.raises(ValueError, match="path must be a file"):
        result.write_html(tmp_path)
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    with pytest.raises(ImportError, match=r"plotly: pip install 'birm3d\[html\]'"):
        result.write_html(tmp_path / "a.html")
    assert list(tmp_path.iterdir()) == []
