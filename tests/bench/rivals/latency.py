"""W6: import, time to the first result and memory of W2 (W1 where that is all), each in a fresh process.

All counted beyond Python and NumPy, which every rival needs. Import is that of the rival's own package;
the first result is building the scene of N nodes and one run at its setting of about 1 ms; memory is the
growth of the greatest resident set over both.
"""

from __future__ import annotations

import importlib
import json
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

PACKAGE = {
    "ours": "birm3d",
    "mujoco_callback": "mujoco",
    "mujoco_contact": "mujoco",
    "bullet": "pybullet",
    "exudyn_rows": "exudyn",
    "opensees": "openseespy.opensees",
}
PROGRAM = Path(__file__).parents[1] / "bench_rivals.py"
# In a process that has nothing but NumPy, and what else it can not do without: what it costs to import.
IMPORT = "import time, numpy; t = time.perf_counter(); import {}; print('seconds', time.perf_counter() - t)"
BEFORE = {
    "opensees": f"import sys; sys.path.insert(0, {str(PROGRAM.parent)!r}); "
    "from rivals.opensees import load_libraries; load_libraries(); "
}


def resident(what: str) -> float:
    """VmRSS or VmHWM of this process [MB]."""
    text = Path("/proc/self/status").read_text(encoding="utf-8")
    found = re.search(rf"^{what}:\s*(\d+) kB", text, re.MULTILINE)
    if found is None:
        raise RuntimeError(f"/proc/self/status has no {what}")
    return int(found[1]) / 1024.0


def measure(module: str, n: int) -> str:
    """In the child: the first result and the memory beyond what all rivals need here, as JSON."""
    from .definition import W1, W2, AbsentError, vehicle

    package = importlib.import_module(f"rivals.{module}")
    rival = package.RIVALS[0]
    case = W1 if "W2" in rival.wrong else W2
    vehicle(case, 10)
    # The greatest so far is forgotten, so that it is that of the rival.
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    before = resident("VmRSS")
    begin = time.perf_counter()
    try:
        error, _ = case.error(rival.build(case, n)(1e-3))
    except AbsentError as reason:
        return json.dumps({"reason": str(reason)})
    taken = time.perf_counter() - begin
    return json.dumps(
        {"case": case.name, "first": taken, "error": float(error), "memory": resident("VmHWM") - before}
    )


def child(*arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    if done.returncode != 0:
        raise RuntimeError(done.stderr[-2000:])
    return done.stdout


def table(modules: Sequence[str], n: int) -> str:
    lines = [f"W6: beyond Python and NumPy, N = {n:,}; memory and first result as a growth"]
    lines.append(f"{'':20s}{'import [s]':>12s}{'first [s]':>12s}{'of':>5s}{'error':>10s}{'memory [MB]':>13s}")
    for module in modules:
        report = child(str(PROGRAM), "--child", module, str(n)).strip().splitlines()
        found = json.loads(next(line for line in reversed(report) if line.startswith("{")))
        if "reason" in found:
            lines.append(f"{module:20s}  {found['reason']}")
            continue
        package = PACKAGE.get(module)
        taken = 0.0
        if package is not None:
            printed = child("-c", BEFORE.get(module, "") + IMPORT.format(package))
            taken = float(next(x for x in printed.splitlines() if x.startswith("seconds")).split()[1])
        lines.append(
            f"{module:20s}{taken:12.3f}{found['first']:12.3f}{found['case']:>5s}{found['error']:10.1e}"
            f"{found['memory']:13.1f}"
        )
    return "\n".join(lines)
