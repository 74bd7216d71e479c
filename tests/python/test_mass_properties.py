"""Mass, mass centre and inertia of solids (paper Eq. 2-7), editing of the GVW, and free tumbling."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from birm3d import Vehicle, _core, scenes
from birm3d.vehicle.vehicle_file import unit_paths
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

# Corners of a unit cube about 0: 0-3 counter-clockwise below, 4-7 above.
CUBE = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]
) * (0.5)
DENSITY = 750.0


def close(actual: np.ndarray, expected: np.ndarray, tolerance: float = 1e-12) -> None:
    """Equal to `tolerance` of the greatest entry: sums of a few dozen terms, rounded."""
    assert np.abs(actual - expected).max() <= tolerance * np.abs(expected).max()


def inertia_of(second_moments: np.ndarray) -> np.ndarray:
    return np.trace(second_moments) * np.eye(3) - second_moments


def parallelepiped(A: np.ndarray, center: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:  # noqa: N803
    """Corners, mass, inertia: second moments of the unit cube (1/12) transform as A C A^T."""
    mass = DENSITY * np.linalg.det(A)
    return CUBE @ A.T + center, mass, inertia_of(mass * A @ A.T / 12.0)


def random_shear(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    A = np.diag(rng.uniform(0.5, 2.0, 3)) + np.triu(rng.uniform(-0.5, 0.5, (3, 3)), 1)  # noqa: N806
    return Rotation.random(rng=rng).as_matrix() @ A


def test_box() -> None:
    a, b, c = 4.0, 1.8, 0.6
    properties = _core.mass_properties([CUBE * [a, b, c] + [1.0, -2.0, 3.0]], [DENSITY])
    mass = DENSITY * a * b * c
    assert properties.mass == pytest.approx(mass, rel=1e-14)
    close(properties.center_of_mass, np.array([1.0, -2.0, 3.0]))
    close(properties.inertia, mass / 12.0 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b]))


@given(seed=st.integers(0, 10**6))
def test_sheared_boxes(seed: int) -> None:
    center = np.array([1.0, -0.4, 0.7])
    corners, mass, inertia = parallelepiped(random_shear(seed), center)
    properties = _core.mass_properties([corners], [DENSITY])
    assert properties.mass == pytest.approx(mass, rel=1e-12)
    close(properties.center_of_mass, center)
    close(properties.inertia, inertia)
    assert _core.solid_volumes([corners])[0] == pytest.approx(mass / DENSITY, rel=1e-12)


@pytest.mark.parametrize(("low", "high"), [(0.2, 1.0), (1.0, 0.3), (1e-3, 1.0)])
def test_wedge(low: float, high: float) -> None:
    """A hood: height from `low` at x = 0 to `high` at x = 2, width 1.5, flat below."""
    length, width = 2.0, 1.5
    slope = (high - low) / length
    x, z = np.array([0.0, length]), np.array([low, high])
    h = 0.5 * width
    corners = np.array(
        [
            [x[0], -h, 0.0], [x[1], -h, 0.0], [x[1], h, 0.0], [x[0], h, 0.0],
            [x[0], -h, z[0]], [x[1], -h, z[1]], [x[1], h, z[1]], [x[0], h, z[0]],
        ]
    )  # fmt: skip

    def integral(power_x: int, power_z: int) -> float:
        """Of x^i height(x)^j over the length, term by term."""
        total = 0.0
        for k in range(power_z + 1):
            c = math.comb(power_z, k) * low ** (power_z - k) * slope**k
            total += c * length ** (power_x + k + 1) / (power_x + k + 1)
        return total

    mass = DENSITY * width * integral(0, 1)
    center = DENSITY * width / mass * np.array([integral(1, 1), 0.0, integral(0, 2) / 2.0])
    xx, zz, xz = integral(2, 1), integral(0, 3) / 3.0, integral(1, 2) / 2.0
    yy = integral(0, 1) * width**2 / 12.0
    moments = DENSITY * width * np.array([[xx, 0.0, xz], [0.0, yy, 0.0], [xz, 0.0, zz]])
    properties = _core.mass_properties([corners], [DENSITY])
    assert properties.mass == pytest.approx(mass, rel=1e-12)
    close(properties.center_of_mass, center)
    # Moments about the origin, from which the centre's are subtracted: a digit is lost.
    close(properties.inertia, inertia_of(moments - mass * np.outer(center, center)), 1e-11)


def renumberings() -> list[list[int]]:
    """The 24 turns of a cube as renumberings of its corners."""
    result = []
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product([1.0, -1.0], repeat=3):
            turn = np.zeros((3, 3))
            turn[range(3), axes] = signs
            if np.linalg.det(turn) > 0.0:
                turned = CUBE @ turn.T
                result.append([int(np.abs(CUBE - corner).sum(axis=1).argmin()) for corner in turned])
    return result


@pytest.mark.parametrize("order", renumberings())
def test_the_numbering_of_corners_does_not_matter(order: list[int]) -> None:
    corners, mass, inertia = parallelepiped(random_shear(3), np.array([0.3, 0.1, 0.2]))
    properties = _core.mass_properties([corners[order]], [DENSITY])
    assert properties.mass == pytest.approx(mass, rel=1e-12)
    close(properties.inertia, inertia)


def test_mirrored_solid() -> None:
    mirror = np.diag([1.0, -1.0, 1.0])
    corners, mass, inertia = parallelepiped(random_shear(5), np.array([0.3, 0.8, 0.2]))
    # Seen in a mirror the corners go clockwise: they are numbered anew.
    properties = _core.mass_properties([(corners @ mirror)[[1, 0, 3, 2, 5, 4, 7, 6]]], [DENSITY])
    assert properties.mass == pytest.approx(mass, rel=1e-12)
    close(properties.center_of_mass, np.array([0.3, -0.8, 0.2]))
    close(properties.inertia, mirror @ inertia @ mirror)


@given(seed=st.integers(0, 10**6))
def test_moved_and_turned_bodies(seed: int) -> None:
    rng = np.random.default_rng(seed)
    solids = np.array([parallelepiped(random_shear(seed + i), rng.normal(size=3))[0] for i in range(3)])
    densities = rng.uniform(100.0, 1000.0, 3)
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    here = _core.mass_properties(solids, densities)
    there = _core.mass_properties(solids @ turn.T + shift, densities)
    assert there.mass == pytest.approx(here.mass, rel=1e-12)
    close(there.center_of_mass, turn @ here.center_of_mass + shift)
    close(there.inertia, turn @ here.inertia @ turn.T)


def test_parallel_axis_theorem() -> None:
    corners, mass, inertia = parallelepiped(random_shear(11), np.zeros(3))
    arm = np.array([0.0, 1.5, -0.5])
    pair = _core.mass_properties([corners + arm, corners - arm], [DENSITY, DENSITY])
    assert pair.mass == pytest.approx(2.0 * mass, rel=1e-12)
    close(pair.inertia, 2.0 * (inertia + mass * inertia_of(np.outer(arm, arm))))
    assert np.abs(pair.center_of_mass).max() < 1e-15


@given(share=st.floats(0.05, 0.95), axis=st.integers(0, 2))
def test_parts_make_the_whole(share: float, axis: int) -> None:
    shear, center = random_shear(7), np.array([1.0, 2.0, 0.5])
    whole = _core.mass_properties([CUBE @ shear.T + center], [DENSITY])
    cut = share - 0.5
    low, high = CUBE.copy(), CUBE.copy()
    low[:, axis] = np.minimum(low[:, axis], cut)
    high[:, axis] = np.maximum(high[:, axis], cut)
    parts = _core.mass_properties([low @ shear.T + center, high @ shear.T + center], [DENSITY, DENSITY])
    assert parts.mass == pytest.approx(whole.mass, rel=1e-12)
    close(parts.center_of_mass, whole.center_of_mass)
    close(parts.inertia, whole.inertia)


def test_a_solid_without_density_adds_nothing() -> None:
    one = _core.mass_properties([CUBE], [DENSITY])
    two = _core.mass_properties([CUBE, CUBE + 5.0], [DENSITY, 0.0])
    assert two.mass == one.mass
    close(two.inertia, one.inertia)


def bad_solids() -> dict[str, np.ndarray]:
    flat = CUBE * [1.0, 1.0, 0.0]
    folded = CUBE.copy()
    folded[4:, 2] = -0.5  # the top in the plane of the bottom
    collapsed = CUBE.copy()
    collapsed[4] = collapsed[0]  # a missing edge
    twisted = CUBE.copy()
    twisted[[4, 6]] = twisted[[6, 4]]
    infinite = CUBE.copy()
    infinite[2, 1] = math.nan
    return {
        "inverted": CUBE[[4, 5, 6, 7, 0, 1, 2, 3]],
        "mirrored": CUBE * [1.0, -1.0, 1.0],
        "flat": flat,
        "folded": folded,
        "collapsed": collapsed,
        "twisted": twisted,
        "not finite": infinite,
    }


@pytest.mark.parametrize("name", bad_solids())
def test_bad_solids_are_refused_by_number(name: str) -> None:
    with pytest.raises(ValueError, match=r"solid\[2\].*must be.*, got"):
        _core.mass_properties([CUBE, CUBE, bad_solids()[name]], [1.0, 1.0, 1.0])


@pytest.mark.parametrize(
    ("densities", "naming"),
    [
        ([1.0], r"densities must be one for each of the 2 solids, got 1"),
        ([1.0, -2.0], r"densities\[1\] must be finite and >= 0, got -2"),
        ([1.0, math.nan], r"densities\[1\] must be finite and >= 0, got nan"),
        ([0.0, 0.0], r"mass of the solids must be > 0, got 0"),
    ],
)
def test_bad_densities_are_refused(densities: list[float], naming: str) -> None:
    with pytest.raises(ValueError, match=naming):
        _core.mass_properties([CUBE, CUBE], densities)


# ---- GVW of presets ----------------------------------------------------------------------------------------


def moments_about_origin(vehicle: Vehicle) -> np.ndarray:
    """Mass, first and second moments in the axes of the vehicle's file: what adds up over solids."""
    c, m = vehicle.center_of_mass, vehicle.mass
    inertia = vehicle.inertia + m * inertia_of(np.outer(c, c))
    return np.concatenate([[m], m * c, inertia.ravel()])


@pytest.mark.filterwarnings("ignore::birm3d.MassWarning")  # half as much again is much for a heavy truck
@pytest.mark.parametrize("name", Vehicle.presets())
def test_gvw_is_met_exactly(name: str) -> None:
    vehicle = Vehicle.preset(name, mesh_density=0.1)
    for gvw in (0.6, 0.97, 1.0, 1.03, 1.5):
        heavy = vehicle.with_gvw(gvw * vehicle.mass)
        assert heavy.mass == pytest.approx(gvw * vehicle.mass, rel=1e-12)
        direct = Vehicle.preset(name, gvw=gvw * vehicle.mass, mesh_density=0.1)
        assert direct == heavy


WITHOUT_LOAD_SPACE = ("passenger_car", "minivan", "pickup", "paper_pickup")
LOAD_SPACE = ("cargo_truck", "semi_trailer")


@pytest.mark.parametrize("name", WITHOUT_LOAD_SPACE)
def test_payload_takes_what_is_added(name: str) -> None:
    vehicle = Vehicle.preset(name, mesh_density=0.1)
    full = moments_about_origin(vehicle)
    more = moments_about_origin(vehicle.with_gvw(1.2 * vehicle.mass))
    # What is added has the mass centre and the inertia of the payload: mass and moments grow in proportion.
    added = (more - full) / (more[0] - full[0])
    for gvw in (1.05, 1.1, 1.6):
        expected = full + (gvw - 1.0) * vehicle.mass * added
        close(moments_about_origin(vehicle.with_gvw(gvw * vehicle.mass)), expected)
    # The mass centre moves towards it, and does not pass it.
    payload, center = added[1:4], vehicle.center_of_mass
    heavier = vehicle.with_gvw(1.6 * vehicle.mass).center_of_mass
    assert np.linalg.norm(payload - center) > 0.05
    close(heavier - center, (payload - center) * (0.6 / 1.6), 1e-9)
    # And it is the payload that the file names.
    solids = [solid for solid in vehicle._file.solids if solid.payload]
    masses = np.array([solid.mass for solid in solids])
    middles = np.array([np.mean(solid.corners, axis=0) for solid in solids])
    close(payload, masses @ middles / masses.sum(), 1e-9)


@pytest.mark.parametrize("name", [*WITHOUT_LOAD_SPACE, *LOAD_SPACE])
def test_below_the_unladen_mass_the_structure_is_rescaled(name: str) -> None:
    vehicle = Vehicle.from_file(unit_paths()[name], mesh_density=0.1)
    unladen = sum(solid.mass for solid in vehicle._file.solids if not solid.payload)
    empty, half = vehicle.with_gvw(unladen), vehicle.with_gvw(0.5 * unladen)
    close(half.center_of_mass, empty.center_of_mass)
    close(half.inertia, 0.5 * empty.inertia)


@pytest.mark.parametrize("name", Vehicle.presets())
def test_what_hangs_on_the_mass_centre_follows_it(name: str) -> None:
    vehicle = Vehicle.preset(name, mesh_density=0.1)
    heavy = vehicle.with_gvw(1.4 * vehicle.mass)
    for light_part, heavy_part in (
        (vehicle.nodes, heavy.nodes),
        (vehicle.anchors, heavy.anchors),
        (vehicle.wheels[:, :3], heavy.wheels[:, :3]),
    ):
        close(light_part + vehicle.center_of_mass, heavy_part + heavy.center_of_mass)
    assert heavy.mass_center_height == heavy.center_of_mass[2]


# ---- load spaces -------------------------------------------------------------------------------------------


@pytest.fixture(params=LOAD_SPACE)
def truck(request: pytest.FixtureRequest) -> Vehicle:
    return Vehicle.from_file(unit_paths()[request.param], mesh_density=0.1)


def unladen(vehicle: Vehicle) -> float:
    return sum(solid.mass for solid in vehicle._file.solids if not solid.payload)


def goods(vehicle: Vehicle, payload: float, height: float) -> np.ndarray:
    """Mass, first and second moments of a box of goods on the floor of the load space, from formulas."""
    (solid,) = (solid for solid in vehicle._file.solids if solid.payload)
    low, high = np.array(solid.box_m).T
    high[2] = low[2] + height
    center, size = 0.5 * (low + high), high - low
    moments = np.diag(size**2 / 12.0) + np.outer(center, center)
    return np.concatenate([[payload], payload * center, payload * inertia_of(moments).ravel()])


@pytest.mark.parametrize("share", [0.01, 0.3, 1.0, 1.2])
def test_goods_stand_on_the_floor_at_their_density(truck: Vehicle, share: float) -> None:
    empty = moments_about_origin(truck.with_payload(0.0))
    payload = share * (truck.mass - unladen(truck))
    (solid,) = (solid for solid in truck._file.solids if solid.payload)
    height = share * (solid.box_m[2][1] - solid.box_m[2][0])
    loaded = truck.with_payload(payload)
    assert loaded.mass == pytest.approx(unladen(truck) + payload, rel=1e-12)
    close(moments_about_origin(loaded), empty + goods(truck, payload, height), 1e-11)
    close(moments_about_origin(truck.with_gvw(loaded.mass)), moments_about_origin(loaded))


def test_the_mass_centre_rises_with_the_load(truck: Vehicle) -> None:
    payload = truck.mass - unladen(truck)
    empty, *heights = (truck.with_payload(s * payload).mass_center_height for s in (0.0, 0.5, 1.0, 1.3, 3.0))
    assert empty < heights[1]
    assert (np.diff(heights) > 0.0).all()
    # More than by weight alone: half the goods as high as all of them stand higher than half the goods.
    as_high = truck.with_payload(0.5 * payload, height=truck_height(truck)).mass_center_height
    assert heights[0] < as_high < heights[1]


def test_next_to_no_goods_are_no_error(truck: Vehicle) -> None:
    empty = truck.with_payload(0.0)
    for payload in (1e-12, 1e-6, 1e-3):
        loaded = truck.with_payload(f"{payload} kg")
        assert loaded.mass_center_height == pytest.approx(empty.mass_center_height, abs=1e-6)
        assert loaded.inertia == pytest.approx(empty.inertia, rel=1e-5, abs=1e-6)


def truck_height(truck: Vehicle) -> float:
    (solid,) = (solid for solid in truck._file.solids if solid.payload)
    return solid.box_m[2][1] - solid.box_m[2][0]


def test_a_full_space_takes_denser_goods(truck: Vehicle) -> None:
    (solid,) = (solid for solid in truck._file.solids if solid.payload)
    space = solid.fills_to_m - solid.box_m[2][0]
    payload = 5.0 * (truck.mass - unladen(truck))
    empty = moments_about_origin(truck.with_payload(0.0))
    close(moments_about_origin(truck.with_payload(payload)), empty + goods(truck, payload, space), 1e-11)


def test_density_and_height_of_goods(truck: Vehicle) -> None:
    empty = moments_about_origin(truck.with_payload(0.0))
    dense, high = truck.with_payload(1500.0, density=800.0), truck.with_payload(1500.0, height=1.1)
    (solid,) = (solid for solid in truck._file.solids if solid.payload)
    floor = solid.volume / truck_height(truck)
    close(moments_about_origin(dense), empty + goods(truck, 1500.0, 1500.0 / (800.0 * floor)), 1e-11)
    close(moments_about_origin(high), empty + goods(truck, 1500.0, 1.1), 1e-11)
    # The density stays with later weights and meshes.
    more = dense.with_gvw(dense.mass + 1500.0)
    close(moments_about_origin(more), empty + goods(truck, 3000.0, 3000.0 / (800.0 * floor)), 1e-11)
    close(more.with_mesh_density(0.2).inertia, more.inertia)
    assert more != truck.with_gvw(more.mass)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"payload": -1.0}, r"payload must be finite and >= 0, got -1"),
        ({"payload": math.nan}, r"payload must be finite and >= 0, got nan"),
        ({"payload": 100.0, "density": 0.0}, r"density must be finite and > 0, got 0"),
        ({"payload": 100.0, "height": 0.0}, r"height must be > 0 and at most .* m; got 0"),
        ({"payload": 100.0, "height": 9.0}, r"height must be > 0 and at most .*, [1-3]\.\d+ m; got 9"),
        ({"payload": 9e4, "density": 100.0}, r"density must be at least .* for 90000 kg to fit, got 100"),
        (
            {"payload": 100.0, "density": 1.0, "height": 1.0},
            r"density must not be given together with height",
        ),
    ],
)
def test_bad_loads_are_refused(truck: Vehicle, arguments: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        truck.with_payload(**arguments)


def test_loads_need_a_place() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    heavier = car.with_payload(400.0)
    close(moments_about_origin(heavier), moments_about_origin(car.with_gvw(heavier.mass)))
    with pytest.raises(ValueError, match="density of a payload needs a vehicle with a load space"):
        car.with_payload(400.0, density=300.0)
    with pytest.raises(ValueError, match="payload needs a vehicle whose file names one"):
        scenes.elastic_block(100).with_payload(100.0)


# ---- free tumbling -----------------------------------------------------------------------------------------

INERTIA = np.diag([1200.0, 3100.0, 3900.0])


@pytest.mark.parametrize("spin", [[0.3, 4.0, 0.2], [3.0, 0.5, -1.0], [1e-6, 5.0, 1e-6], [0.0, 0.0, 6.0]])
def test_tumbling_keeps_energy_and_angular_momentum(spin: list[float]) -> None:
    energy, momentum, orientation = _core.tumble(INERTIA, spin, 5e-3, 10_000)
    start = INERTIA @ spin
    assert np.abs(energy / (0.5 * np.dot(spin, start)) - 1.0).max() < 1e-12
    assert np.abs(momentum - start).max() < 1e-12 * np.linalg.norm(start)
    assert np.abs(np.linalg.norm(orientation, axis=1) - 1.0).max() < 1e-14
    # The same energy from the orientations alone: the angular momentum that stands still in the world, seen
    # in body axes.
    seen = Rotation.from_quat(orientation, scalar_first=True).inv().apply(start)
    assert np.abs(0.5 * (seen**2 @ (1.0 / np.diag(INERTIA))) / energy - 1.0).max() < 1e-12


def test_the_intermediate_axis_flips() -> None:
    """Dzhanibekov: a spin about the middle axis turns over again and again, one about the others does not."""
    spin = np.array([1e-3, 5.0, 0.0])
    _, _, orientation = _core.tumble(INERTIA, spin, 2e-3, 20_000)
    seen = Rotation.from_quat(orientation, scalar_first=True).inv().apply(INERTIA @ spin)
    about_middle = seen[:, 1] / (INERTIA @ spin)[1]
    flips = np.flatnonzero(np.diff(np.sign(about_middle)) != 0)
    assert len(flips) >= 4
    assert about_middle.min() < -0.999
    # Equally spaced: half a period of Euler's equations each time, to its sampling.
    gaps = np.diff(flips)
    assert np.ptp(gaps[1:]) <= 2
    for steady in ([5.0, 1e-3, 0.0], [0.0, 1e-3, 5.0]):
        _, _, orientation = _core.tumble(INERTIA, steady, 2e-3, 20_000)
        seen = Rotation.from_quat(orientation, scalar_first=True).inv().apply(INERTIA @ steady)
        axis = int(np.argmax(steady))
        assert (seen[:, axis] > 0.999 * (INERTIA @ steady)[axis]).all()


def test_tumbling_converges_to_eulers_equations_at_second_order() -> None:
    spin, duration = np.array([0.4, 4.0, -0.3]), 2.0
    turned = Rotation.from_euler("xyz", [0.3, -0.2, 0.5]).as_matrix()
    inertia = turned @ INERTIA @ turned.T  # products of inertia as well
    inverse = np.linalg.inv(inertia)

    def rates(_t: float, y: np.ndarray) -> np.ndarray:
        w, q = y[:3], y[3:]
        q_rate = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
        return np.concatenate([inverse @ -np.cross(w, inertia @ w), q_rate])

    start = np.concatenate([spin, [1.0, 0.0, 0.0, 0.0]])
    exact = solve_ivp(rates, (0.0, duration), start, method="DOP853", rtol=1e-12, atol=1e-12).y[3:, -1]
    errors = []
    for steps in (200, 400, 800, 1600):
        q = _core.tumble(inertia, spin, duration / steps, steps)[2][-1]
        errors.append(min(np.abs(q - exact).max(), np.abs(q + exact).max()))
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert (np.abs(orders - 2.0) < 0.1).all(), f"errors {errors}, orders {orders}"
    assert errors[-1] < 1e-4
