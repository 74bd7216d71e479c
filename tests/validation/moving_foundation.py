"""A published test of one bollard on a shallow foundation, with the moment of the foundation varied.

    python tests/validation/moving_foundation.py

DSC635 (security_barrier_tests.csv): 6,804 kg at 50 mph. The load bed came 1.87 m past the rear face of the
post, and ended less than 0.6 m past it. The moment of its foundation is not published.
"""

from __future__ import annotations

from birm3d import Barrier, Foundation, Simulation, Vehicle, units

MOMENTS = (None, 1000e3, 900e3, 800e3, 760e3, 750e3, 600e3)  # N m
DIAMETER, HEIGHT = 0.4, 1.118  # m
SOLID = {"wall_thickness": 0.5 * DIAMETER, "yield_stress": 1e9}  # stronger than any of the foundations


def main() -> None:
    truck = Vehicle.preset("cargo_truck", gvw=6804.0)
    print("moment [kN m]  bed past the rear face, at most [m]  at the end  tilt [deg]  last [m/s]  outcome")
    for moment in MOMENTS:
        yields = {} if moment is None else SOLID | {"foundation": Foundation(moment, 0.5, mass=3000.0)}
        post = Barrier.bollards(count=1, diameter=DIAMETER, height=HEIGHT, **yields)
        run = Simulation(truck, post, units.mph(50)).run()
        bed = run.sensor("load_bed_leading_edge").position[:, 0] - 0.5 * DIAMETER
        tilt = run.metrics["post_tilt"] if moment else 0.0
        name = "rigid" if moment is None else f"{moment / 1e3:.0f}"
        last = run.final_velocity[0]
        print(f"{name:>13s}  {bed.max():35.2f}  {bed[-1]:10.2f}  {tilt:10.0f}  {last:10.1f}  {run.outcome}")


if __name__ == "__main__":
    main()
