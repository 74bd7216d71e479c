"""Laws of the exterior mesh: areas, symmetry, orientation, trusses, convergence with density."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from birm3d.vehicle.mesher import ExteriorMesh, build_mesh, quad_areas, winding_number
from birm3d.vehicle.vehicle_file import VehicleFile, preset_path, read_vehicle_file, unit_paths

BOX = """
format_version = 1
name = "box"
title = "Plain box"
description = "For the laws of the mesher."
gvw_kg = 1000.0
[[source]]
id = "t"
text = "test"
status = "estimated"
[dimensions]
length_m = 4.0
width_m = 2.0
height_m = 1.5
wheelbase_m = 2.0
front_overhang_m = 1.0
source = ["t"]
status = "estimated"
[[solid]]
name = "all"
box_m = [[-3.0, 1.0], [-1.0, 1.0], [0.5, 1.5]]
mass_kg = 1000.0
source = ["t"]
status = "estimated"
[exterior]
element_size_m = 0.1
stations_m = [[1.0, 1.0, 0.5, 1.5], [-3.0, 1.0, 0.5, 1.5]]
source = ["t"]
status = "estimated"
# exterior goes on here
[[core]]
name = "core"
x_m = [-2.0, 0.0]
half_width_m = 0.5
z_m = [0.8, 1.2]
source = ["t"]
status = "estimated"
[zone.bumper]
panels = ["front"]
z_m = [0.0, 0.93]
k_initial_Pa_per_m = 1e6
knee_m = 0.1
k_hardening_Pa_per_m = 1e6
f_max_Pa = 1e6
k_unloading_Pa_per_m = 1e7
source = ["t"]
status = "estimated"
[zone.rest]
panels = ["front", "rear", "side", "top", "bottom"]
k_initial_Pa_per_m = 1e6
knee_m = 0.1
k_hardening_Pa_per_m = 1e6
f_max_Pa = 1e6
k_unloading_Pa_per_m = 1e7
source = ["t"]
status = "estimated"
"""

UPPER = """
[[exterior.upper]]
name = "cab"
base_x_m = [{front}, {rear}]
roof_m = [[{front}, 1.0, 2.5], [{rear}, 1.0, 2.5]]
"""


@pytest.fixture
def read(tmp_path):
    def _read(text: str = BOX) -> VehicleFile:
        path = tmp_path / "box.toml"
        path.write_text(text)
        return read_vehicle_file(path)

    return _read


# Vehicles that are another one scaled have a mesh like its: they are not looked at one by one.
SCALED_ALIKE = {"mash_1100c", "sedan_1500", "pickup_4x4_2500", "heavy_pickup", "cabover_7200"}
SCALED_ALIKE |= {"small_car", "mash_2270p", "mash_36000v_tractor", "mash_36000v_trailer", "mash_10000s"}


@pytest.fixture(scope="module", params=[name for name in unit_paths() if name not in SCALED_ALIKE])
def preset(request) -> tuple[VehicleFile, ExteriorMesh]:
    vehicle = read_vehicle_file(unit_paths()[request.param])
    return vehicle, build_mesh(vehicle)


def zone_area(mesh: ExteriorMesh) -> np.ndarray:
    return np.bincount(mesh.zone, mesh.area, len(mesh.zone_names))


@pytest.mark.parametrize("density", [0.01, 0.3, 1.0, 2.7])
def test_a_box_has_its_own_area(read, density):
    mesh = build_mesh(read(), density)
    assert mesh.area.sum() == pytest.approx(2 * (4 * 2 + 4 * 1 + 2 * 1), rel=1e-12)
    # The cut between the zones at z = 0.93 is a row of nodes: no zone gains or loses area with the mesh.
    np.testing.assert_allclose(zone_area(mesh), [2 * 0.43, 28 - 2 * 0.43], rtol=1e-12)


@pytest.mark.parametrize("density", [0.01, 0.3, 1.0, 2.7])
def test_zones_between_two_distances_from_the_middle_plane(read, density):
    rails = read(BOX.replace("z_m = [0.0, 0.93]", "z_m = [0.0, 0.93]\ny_m = [0.33, 0.47]"))
    mesh = build_mesh(rails, density)
    area = 2 * 0.14 * 0.43  # left and right
    np.testing.assert_allclose(zone_area(mesh), [area, 28 - area], rtol=1e-12)
    beside = np.abs(mesh.nodes[mesh.zone == 0, 1])
    assert beside.min() == pytest.approx(0.33, abs=1e-12)
    assert beside.max() == pytest.approx(0.47, abs=1e-12)
    mirrored = mesh.nodes * [1.0, -1.0, 1.0]
    assert {tuple(node) for node in mirrored.tolist()} == {tuple(node) for node in mesh.nodes.tolist()}


@pytest.mark.parametrize(("front", "rear"), [(0.5, -1.5), (1.0, -1.5), (0.5, -3.0), (1.0, -3.0)])
def test_an_upper_box_adds_its_sides_only(read, front, rear):
    text = BOX.replace("# exterior goes on here", UPPER.format(front=front, rear=rear))
    mesh = build_mesh(read(text))
    assert mesh.area.sum() == pytest.approx(28 + 2 * (2 + front - rear), rel=1e-12)


def test_every_element_shares_its_area_among_its_nodes(preset):
    _, mesh = preset
    assert mesh.area.sum() == pytest.approx(quad_areas(mesh.nodes, mesh.quads).sum(), rel=1e-12)
    assert (mesh.area > 0).all()
    assert (mesh.zone[mesh.quads] == mesh.zone[mesh.quads[:, :1]]).all()


def test_zone_areas_do_not_depend_on_the_mesh(preset):
    vehicle, mesh = preset
    finer = build_mesh(vehicle, 4.0)
    np.testing.assert_allclose(zone_area(finer), zone_area(mesh), rtol=0.01)
    assert finer.area.sum() == pytest.approx(mesh.area.sum(), rel=1e-3)


def test_the_error_of_the_area_falls_with_the_element_area(preset):
    # Bows and profiles are curved: second order in the edge, so first order in 1/density.
    vehicle, _ = preset
    total = [build_mesh(vehicle, density).area.sum() for density in (0.25, 4.0, 16.0)]
    # A trailer is a box: exact at once.
    assert abs(total[1] - total[2]) < max(0.35 * abs(total[0] - total[2]), 1e-9)


ELEMENTS = {
    **{"semi_tractor": 4570, "semi_trailer": 1440},
    # Lines of nodes where the engine ends.
    **{"passenger_car": 6332, "van_3500": 5772},
    # A bollard meets three columns of nodes. Trucks have a line of nodes where the front's middle ends.
    "cargo_truck": 6112,
    **{"cabover_7500": 7694, "bus_13t": 11652, "heavy_truck_29500": 7770},
}


def test_number_of_elements(preset):
    vehicle, mesh = preset
    assert len(mesh.quads) == pytest.approx(ELEMENTS.get(vehicle.name, 6000), rel=0.03)
    # Few elements on the edges of a trailer; the lines where a car's engine ends weigh less in a fine mesh.
    tolerance = {"semi_trailer": 0.1, "passenger_car": 0.06}.get(vehicle.name, 0.05)
    assert len(build_mesh(vehicle, 4.0).quads) == pytest.approx(4 * len(mesh.quads), rel=tolerance)


def test_spacing_is_nearly_uniform(preset):
    vehicle, mesh = preset
    edges = np.linalg.norm(mesh.nodes[np.roll(mesh.quads, 1, axis=1)] - mesh.nodes[mesh.quads], axis=2)
    size = vehicle.exterior.element_size_m
    assert 0.4 * size < edges.min()
    assert edges.max() < 1.7 * size


def test_several_nodes_across_a_bollard(preset):
    vehicle, mesh = preset
    if vehicle.kind == "semi_trailer":
        return  # above any bollard
    x = mesh.nodes[:, 0]
    y = np.unique(np.round(mesh.nodes[x > x.max() - 0.05, 1], 9))
    y = y[np.abs(y) < 0.5]
    assert np.diff(y).max() < 0.3 / 3


@pytest.mark.parametrize("density", [0.05, 1.0, 1.9])
def test_left_and_right_are_mirror_images(preset, density):
    vehicle, _ = preset
    mesh = build_mesh(vehicle, density)
    column = np.column_stack([mesh.zone, mesh.nodes, mesh.anchors, mesh.area])
    mirrored = column * np.array([1, 1, -1, 1, 1, -1, 1, 1])

    def ordered(rows: np.ndarray) -> np.ndarray:
        return rows[np.lexsort(np.round(rows[:, :4], 9).T)]

    np.testing.assert_allclose(ordered(mirrored), ordered(column), rtol=0, atol=1e-12)


def test_the_shell_is_closed_and_faces_outwards(preset):
    vehicle, _ = preset
    mesh = build_mesh(vehicle, 0.2)
    points, same = np.unique(np.round(mesh.nodes, 9), axis=0, return_inverse=True)
    quads = same.reshape(-1)[mesh.quads]
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    directed = {tuple(edge) for edge in edges.tolist()}
    assert len(directed) == len(edges)
    assert all((b, a) in directed for a, b in directed)  # every edge once in each direction
    corners = points[quads]
    middle = corners.mean(axis=1)
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(winding_number(middle + 0.005 * normal, mesh.nodes, mesh.quads), 0, atol=1e-6)
    np.testing.assert_allclose(winding_number(middle - 0.005 * normal, mesh.nodes, mesh.quads), 1, atol=1e-6)


def test_trusses_have_a_length_and_start_inside(preset):
    _, mesh = preset
    assert np.linalg.norm(mesh.nodes - mesh.anchors, axis=1).min() > 0.05
    anchors = np.unique(mesh.anchors, axis=0)[::7]
    np.testing.assert_allclose(winding_number(anchors, mesh.nodes, mesh.quads), 1, atol=1e-6)


@pytest.mark.parametrize("preset_name", ["passenger_car", "pickup", "paper_pickup"])
def test_trusses_are_long_enough_and_run_into_the_vehicle(preset_name):
    mesh = build_mesh(read_vehicle_file(preset_path(preset_name)))
    name = np.array(mesh.zone_names)[mesh.zone]
    truss = mesh.nodes - mesh.anchors
    length = np.linalg.norm(truss, axis=1)
    front = np.isin(name, ["engine", "bumper", "engine_bay"])
    middle = front & (np.abs(mesh.nodes[:, 1]) < 0.3)
    # A 60-mph head-on crash of a car crushes about 1.2 m.
    assert length[middle].min() > 1.2
    assert length[middle].max() < 2.2  # poles at 50 mph crush the fire wall, too
    assert (truss[front, 0] > 0.9 * length[front]).all()
    door = name == "door"
    assert (np.abs(truss[door, 1]) > 0.7 * length[door]).all()
    assert length[door].min() > 0.35


def test_the_mesh_fills_the_stated_dimensions(preset):
    vehicle, mesh = preset
    size = vehicle.dimensions
    assert mesh.nodes[:, 0].max() == pytest.approx(size.front_overhang_m, abs=0.01)
    assert np.ptp(mesh.nodes[:, 0]) == pytest.approx(size.length_m, abs=0.01)
    assert np.ptp(mesh.nodes[:, 1]) == pytest.approx(size.width_m, abs=0.01)
    assert mesh.nodes[:, 2].max() == pytest.approx(size.height_m, abs=0.01)


def test_arrays_are_read_only(preset):
    _, mesh = preset
    for field in dataclasses.fields(mesh)[:5]:
        with pytest.raises(ValueError, match="read-only"):
            getattr(mesh, field.name)[0] = 0


@pytest.mark.parametrize("density", [0.0, -1.0, 0.0099, 101.0, float("nan"), float("inf")])
def test_density_out_of_range_is_refused(read, density):
    with pytest.raises(ValueError, match=r"density must be between 0\.01 and 100, got"):
        build_mesh(read(), density)


def test_an_element_without_a_zone_is_refused(read):
    vehicle = read(BOX.replace('"front", "rear", "side"', '"front", "rear"'))
    with pytest.raises(ValueError, match=r"must belong to a zone.*side of body"):
        build_mesh(vehicle)


@pytest.mark.parametrize("core", ["x_m = [-2.0, 1.0]", "x_m = [-2.0, 1.5]"])
def test_a_core_that_leaves_the_exterior_is_refused(read, core):
    vehicle = read(BOX.replace("x_m = [-2.0, 0.0]", core))
    with pytest.raises(ValueError, match=r"core.*inside"):
        build_mesh(vehicle)
