"""What threads can do to one simulation and to an ensemble, for a module built with ThreadSanitizer."""

import copy
import pickle
import threading
import time

import birm3d
import numpy as np

THREADS = 4
SECONDS = 20.0

ENTRIES = (
    lambda s: s.run(),
    lambda s: s.step(),
    lambda s: s.result(),
    lambda s: s.reset(),
    lambda s: s.restore(s.snapshot()),
    lambda s: s.state_hash(),
    lambda s: s.time,
    copy.copy,
    pickle.dumps,
    lambda s: birm3d.sweep(s, impact_speed=[2.0, 3.0], metrics=["peak_normal_force"], progress=False),
)


def main() -> None:
    """Let threads call whatever they like, then compare the bits of a run with those of before."""
    simulation = birm3d.scenes.w2(40)
    expected = simulation.run().state_hash
    counts = {"done": 0, "refused": 0}
    until = time.monotonic() + SECONDS

    def hammer(seed: int) -> None:
        random = np.random.default_rng(seed)
        while time.monotonic() < until:
            try:
                ENTRIES[random.integers(len(ENTRIES))](simulation)
                counts["done"] += 1
            except birm3d.BusyError:
                counts["refused"] += 1

    threads = [threading.Thread(target=hammer, args=(seed,)) for seed in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    simulation.reset()
    assert simulation.run().state_hash == expected
    study = birm3d.ensemble([birm3d.scenes.w2(40) for _ in range(50)], progress=False)
    assert not study.failed
    print(f"one simulation, {THREADS} threads: {counts['done']} calls done, {counts['refused']} refused")


if __name__ == "__main__":
    main()
