"""Whether the tests of the pages are skipped or fail on a machine without a browser."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

TEST = Path(__file__).with_name("test_browser.py")
pytest.importorskip("playwright.sync_api")


@pytest.mark.parametrize(("needed", "told"), [("1", "1 error"), ("0", "1 skipped"), (None, "1 skipped")])
def test_without_a_browser(needed: str | None, told: str, tmp_path: Path) -> None:
    environment = {**os.environ, "PATH": str(tmp_path)}
    environment.pop("BIRM3D_NEED_BROWSER", None)
    if needed is not None:
        environment["BIRM3D_NEED_BROWSER"] = needed
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*command, f"{TEST}::test_says_so_where_there_is_no_webgl"],
        env=environment,
        capture_output=True,
        text=True,
    )
    assert told in done.stdout
    assert "install Chromium" in done.stdout
    assert (done.returncode == 0) == (needed != "1")
