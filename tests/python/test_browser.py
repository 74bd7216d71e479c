"""The pages in a real browser: nothing leaves the machine, no error, the slider moves, a phone shows them.

Without a browser these tests are skipped. With BIRM3D_NEED_BROWSER=1 in the environment they fail.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import birm3d
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle

NEEDED = os.environ.get("BIRM3D_NEED_BROWSER", "0") != "0"
if NEEDED:
    playwright = import_module("playwright.sync_api")
else:
    playwright = pytest.importorskip(
        "playwright.sync_api", reason="no playwright to drive a browser with: pip install '.[browser]'"
    )
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "google-chrome", "chromium-browser"))), None)
MISSING = "no browser to show the page with: install Chromium (Debian: apt install chromium)"
pytestmark = pytest.mark.skipif(CHROMIUM is None and not NEEDED, reason=MISSING)
PHONE, DESK = {"width": 375, "height": 800}, {"width": 1100, "height": 900}


@pytest.fixture(scope="module")
def result() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    return Simulation(car, Barrier.bollards(count=3), 15.0).run()


@pytest.fixture(scope="module")
def folder(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("browser") / "dossier"
    birm3d.dossier(result, folder)
    return folder


@pytest.fixture(scope="module")
def study_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The dossier of a study: percentiles, probabilities and the run that was varied."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    crash = Simulation(car, Barrier.bollards(count=3), 15.0)
    study = birm3d.sweep(crash, impact_speed=[14.0, 15.0, 16.0], progress=False)
    folder = tmp_path_factory.mktemp("browser_study") / "dossier"
    birm3d.dossier(study, folder)
    return folder


@pytest.fixture(scope="module")
def wall_page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a run at a wall, with the load on it by cell."""
    car = Vehicle.preset("passenger_car", mesh_density=0.2)
    path = tmp_path_factory.mktemp("browser_wall") / "wall.html"
    Simulation(car, Barrier.rigid_wall(), 12.0, 60.0).run().write_html(path, frames=21)
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    assert CHROMIUM is not None, MISSING
    with playwright.sync_playwright() as driver:
        # SwiftShader draws WebGL where there is no graphics card.
        options = ["--no-sandbox", "--enable-unsafe-swiftshader"]
        shown = driver.chromium.launch(executable_path=CHROMIUM, args=options)
        yield shown
        shown.close()


class Visit:
    """A page that was opened, what it asked for and what it complained of."""

    def __init__(self, browser: Any, path: Path, viewport: dict[str, int]) -> None:
        self.page = browser.new_page(viewport=viewport)
        self.asked: list[str] = []
        self.errors: list[str] = []
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("console", lambda told: self.errors.append(told.text) if told.type == "error" else None)
        self.page.goto(path.as_uri())
        self.page.wait_for_function("document.getElementById('now').value.endsWith('ms')")
        self.settle()

    def settle(self) -> None:
        """Let two frames be drawn."""
        self.page.evaluate("new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r)))")

    def set_slider(self, share: float) -> None:
        self.page.evaluate(
            "(share) => { const s = document.getElementById('slider');"
            "s.value = Number(s.min) + share * (Number(s.max) - Number(s.min));"
            "s.dispatchEvent(new Event('input')); }",
            share,
        )
        self.settle()

    def pixels(self) -> list[int]:
        """Colours that the replay shows, red, green and blue by turns."""
        found: list[int] = self.page.evaluate(
            "() => { const c = document.querySelector('.replay-canvas');"
            "const d = document.createElement('canvas');"
            "d.width = 160; d.height = 80; const t = d.getContext('2d'); t.drawImage(c, 0, 0, 160, 80);"
            "return Array.from(t.getImageData(0, 0, 160, 80).data).filter((_, i) => i % 4 < 3); }"
        )
        return found

    def close(self) -> None:
        self.page.close()


@pytest.fixture(params=["index.html", "histories.html"])
def path(request: pytest.FixtureRequest, folder: Path) -> Path:
    return folder / str(request.param)


@pytest.mark.parametrize("viewport", [PHONE, DESK], ids=["phone", "desk"])
def test_opens_offline_and_fits(browser: Any, path: Path, viewport: dict[str, int]) -> None:
    opens_offline_and_fits(browser, path, viewport)


def test_page_of_a_study(browser: Any, study_folder: Path) -> None:
    for viewport in (PHONE, DESK):
        opens_offline_and_fits(browser, study_folder / "index.html", viewport)
    visit = Visit(browser, study_folder / "index.html", DESK)
    visit.set_slider(0.0)
    first = visit.pixels()
    visit.set_slider(1.0)
    assert sum(abs(a - b) > 24 for a, b in zip(first, visit.pixels(), strict=True)) > 300
    assert "3 runs" in visit.page.inner_text("body")
    assert visit.errors == []
    visit.close()


def test_page_of_a_wall_shows_the_load_by_cell(browser: Any, wall_page: Path) -> None:
    for viewport in (PHONE, DESK):
        opens_offline_and_fits(browser, wall_page, viewport)
    visit = Visit(browser, wall_page, PHONE)
    picture = visit.page.get_by_alt_text("load on the wall by cell")
    assert 250 < picture.bounding_box()["width"] <= PHONE["width"]
    visit.close()


def test_nothing_shines_through_what_is_half_transparent(browser: Any, wall_page: Path) -> None:
    """The page below the picture is white: no colour of the scene is."""
    visit = Visit(browser, wall_page, DESK)
    assert visit.page.get_by_label("see through the barrier").is_checked()
    read = "document.querySelector('.replay-canvas').getContext('webgl2').getContextAttributes().alpha"
    assert visit.page.evaluate(read) is False
    visit.close()


def opens_offline_and_fits(browser: Any, path: Path, viewport: dict[str, int]) -> None:
    """Check that a page asks for nothing, complains of nothing, and is as wide as the screen at the most."""
    visit = Visit(browser, path, viewport)
    assert visit.asked[0] == path.as_uri()
    assert [url for url in visit.asked[1:] if not url.startswith(("data:", "blob:"))] == []
    assert visit.errors == []
    assert visit.page.evaluate("document.documentElement.scrollWidth") <= viewport["width"]
    assert visit.page.evaluate("parseFloat(getComputedStyle(document.body).fontSize)") >= 14
    broken = "Array.from(document.images).filter((i) => !i.complete || i.naturalWidth === 0).length"
    assert visit.page.evaluate(broken) == 0
    visit.close()


def test_slider_moves_the_replay(browser: Any, path: Path, result: Result) -> None:
    visit = Visit(browser, path, DESK)
    visit.set_slider(0.0)
    first = visit.pixels()
    assert len(set(first)) > 20  # something is drawn
    assert visit.page.locator("#now").inner_text() == "0.0 ms"
    visit.set_slider(1.0)
    last = visit.pixels()
    moved = sum(abs(a - b) > 24 for a, b in zip(first, last, strict=True))
    assert moved > 300
    end = float(visit.page.locator("#now").inner_text().split()[0])
    assert end == pytest.approx(1e3 * result.time[-1], abs=0.1)
    visit.page.get_by_role("button", name="above").click()
    visit.settle()
    assert visit.pixels() != last
    visit.page.get_by_role("button", name="Play").click()
    visit.page.wait_for_function("(end) => parseFloat(document.getElementById('now').value) < end", arg=end)
    visit.page.get_by_role("button", name="Stop").click()
    assert visit.errors == []
    visit.close()


def test_crush_shows_in_colour(browser: Any, folder: Path) -> None:
    """The page opens at the instant of the greatest crush; before the contact all is grey."""

    def warm(visit: Visit) -> int:
        seen = visit.pixels()
        return sum(r > b + 40 for r, b in zip(seen[::3], seen[2::3], strict=True))

    visit = Visit(browser, folder / "index.html", DESK)
    assert warm(visit) > 5
    visit.set_slider(0.0)
    assert warm(visit) == 0
    visit.close()


def test_says_so_where_there_is_no_webgl(browser: Any, folder: Path) -> None:
    page = browser.new_page(viewport=DESK)
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto((folder / "index.html").as_uri())
    assert "WebGL 2 is missing" in page.locator("#replay").inner_text()
    page.locator("#slider").evaluate("(s) => { s.value = s.max; s.dispatchEvent(new Event('input')); }")
    assert errors == []
    page.close()


def test_prints_to_paper(browser: Any, folder: Path) -> None:
    """No control is printed, and no table is wider than the paper."""
    visit = Visit(browser, folder / "index.html", {"width": 680, "height": 900})  # A4 within its margins
    visit.page.emulate_media(media="print")
    assert visit.page.locator("#slider").is_hidden()
    parts = "Array.from(document.querySelectorAll('table, figure, pre'))"
    assert visit.page.evaluate(f"{parts}.filter((e) => e.scrollWidth > 681).length") == 0
    content = visit.page.pdf(prefer_css_page_size=True)
    assert content.startswith(b"%PDF")
    assert content.count(b"/Type /Page\n") >= 8
    visit.close()
