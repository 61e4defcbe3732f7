# SPDX-License-Identifier: MIT
"""VoxelMap and SemanticMemory on a wall that is known by construction."""

import numpy as np
import pytest
from conftest import Wall

import crossnav


def wall_map(wall: type[Wall]) -> crossnav.VoxelMap:
    voxel_map = crossnav.VoxelMap()
    assert voxel_map.integrate(wall.depth_m, wall.camera, wall.T_world_camera) > 0
    return voxel_map


def test_a_frame_makes_the_wall_occupied_and_the_way_to_it_known(wall: type[Wall]) -> None:
    states = wall_map(wall).states_at(np.array([wall.p_hit_world, (1.0, 0.0, 1.05), (3.0, 0, 1)]))
    assert states[0] == crossnav.VoxelState.OCCUPIED
    assert states[2] == crossnav.VoxelState.UNKNOWN
    keys, all_states, inflated = wall_map(wall).voxels()
    assert keys.shape == (len(all_states), 3) and keys.dtype == np.int32
    assert all_states.dtype == np.uint8 and inflated.dtype == np.bool_
    surface = keys[all_states == crossnav.VoxelState.OCCUPIED]
    assert set(surface[:, 0]) == {20}  # 2.0 m / 0.10 m


def test_the_wall_blocks_the_sight(wall: type[Wall]) -> None:
    voxel_map = wall_map(wall)
    assert voxel_map.has_line_of_sight((0, 0, 1), (1.9, 0, 1))
    assert not voxel_map.has_line_of_sight((0, 0, 1.05), (3, 0, 1.05))


def test_the_body_makes_a_place_to_stand(wall: type[Wall]) -> None:
    voxel_map = wall_map(wall)
    voxel_map.observe_body((0, 0, 0), 1.0)
    found = voxel_map.nearest_free((0, 0, 0.05), 0.5)
    assert found is not None and np.linalg.norm(found[:2]) < 0.2
    assert voxel_map.stats()["traversable"] > 0


def test_what_the_library_would_abort_on_is_an_exception(wall: type[Wall]) -> None:
    voxel_map = crossnav.VoxelMap()
    with pytest.raises(crossnav.Error, match="one size"):
        voxel_map.integrate(np.zeros((4, 4), np.float32), wall.camera, wall.T_world_camera)
    with pytest.raises(crossnav.Error, match="rigid transform"):
        voxel_map.integrate(wall.depth_m, wall.camera, np.full((4, 4), np.nan))
    with pytest.raises(crossnav.Error, match="focal"):
        crossnav.CameraIntrinsics(32, 24, 0.0, 1.0, 1.0, 1.0)
    with pytest.raises(crossnav.Error, match="finite"):
        voxel_map.observe_body((np.nan, 0, 0), 1.0)


def test_depth_of_another_type_is_refused_rather_than_misread(wall: type[Wall]) -> None:
    with pytest.raises(TypeError):
        crossnav.VoxelMap().integrate(
            np.full((24, 32), 2000, np.uint16), wall.camera,  # type: ignore[arg-type]
            wall.T_world_camera)


def test_features_are_found_again_where_they_were_seen(wall: type[Wall]) -> None:
    voxel_map = wall_map(wall)
    memory = crossnav.SemanticMemory()
    features = np.zeros((2, 2, 8), np.float32)
    features[:, 0, 0] = 1  # left half
    features[:, 1, 1] = 1  # right half
    memory.fuse(voxel_map, features)
    assert len(memory) > 0 and memory.dim == 8
    similarity = memory.similarity(np.eye(8, dtype=np.float32)[0])
    left = memory.keys[:, 1] > 10  # y is left; beyond a metre nothing is blended
    assert similarity.shape == (len(memory),)
    assert (similarity[left] > 0.9).all()
    assert memory.weights.min() > 0
    assert memory.feature(0).shape == (8,)


def test_a_query_tells_the_place_that_stands_out(wall: type[Wall]) -> None:
    voxel_map = wall_map(wall)
    memory = crossnav.SemanticMemory()
    features = np.zeros((12, 16, 8), np.float32)
    features[..., 1] = 1
    features[5:8, 2:4] = np.eye(8, dtype=np.float32)[0]  # a patch on the left
    memory.fuse(voxel_map, features)
    clusters = memory.query(np.eye(8, dtype=np.float32)[0], top_k=1)
    assert len(clusters) == 1
    assert clusters[0].p_center_world[1] > 0.5
    assert clusters[0].p_center_world[0] == pytest.approx(2.05, abs=0.1)
    assert (clusters[0].box_min <= clusters[0].p_center_world).all()


def test_wrong_vectors_are_exceptions(wall: type[Wall]) -> None:
    voxel_map = wall_map(wall)
    memory = crossnav.SemanticMemory(dim=8)
    with pytest.raises(crossnav.Error, match="integrate first"):
        memory.fuse(crossnav.VoxelMap(), np.ones((2, 2, 8), np.float32))
    with pytest.raises(crossnav.Error, match="dimension"):
        memory.fuse(voxel_map, np.ones((2, 2, 4), np.float32))
    memory.fuse(voxel_map, np.ones((2, 2, 8), np.float32))
    with pytest.raises(crossnav.Error, match="3 numbers, the memory's features 8"):
        memory.query(np.ones(3, np.float32))
    with pytest.raises(crossnav.Error, match="not zero"):
        memory.similarity(np.zeros(8, np.float32))
    with pytest.raises(IndexError):
        memory.feature(len(memory))
