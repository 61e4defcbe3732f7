# SPDX-License-Identifier: MIT
"""Settings in all their forms, and errors with the program's own text."""

import pickle
from pathlib import Path

import pytest

import crossnav


def test_nothing_is_the_paper() -> None:
    settings = crossnav.Config().to_dict()
    assert settings["map"]["voxel_m"] == 0.10
    assert settings["sensor"]["width_px"] == 640


def test_mapping_dotted_keys_text_and_file_mean_the_same(tmp_path: Path) -> None:
    file = tmp_path / "a.toml"
    file.write_text("[map]\nvoxel_m = 0.05\n", encoding="utf-8")
    forms = [{"map": {"voxel_m": 0.05}}, {"map.voxel_m": 0.05}, "[map]\nvoxel_m = 0.05", file]
    hashes = {crossnav.Config(form).hash for form in forms}
    assert len(hashes) == 1
    assert hashes != {crossnav.Config().hash}


def test_settings_survive_the_way_through_a_mapping() -> None:
    config = crossnav.Config({"policy.poi.use_history": False, "fusion.storage": "float"})
    assert crossnav.Config(config.to_dict()).hash == config.hash
    assert crossnav.Config(config).hash == config.hash


def test_an_unknown_key_is_an_error_with_its_neighbour_and_place() -> None:
    with pytest.raises(crossnav.Error) as caught:
        crossnav.Config({"map": {"voxel": 0.1}})
    assert str(caught.value) == 'config: unknown key "map.voxel"; did you mean "map.voxel_m"?'
    assert caught.value.where == "config"
    assert caught.value.code == "invalid"


def test_a_value_out_of_range_is_an_error() -> None:
    with pytest.raises(crossnav.Error, match=r'key "map.voxel_m" must be in \[0.02, 0.5\]'):
        crossnav.Config({"map.voxel_m": 7})
    with pytest.raises(crossnav.Error, match="line 1"):
        crossnav.Config("map = [")
    with pytest.raises(crossnav.Error, match="single value"):
        crossnav.Config({"map.voxel_m": [1, 2]})


def test_an_old_key_is_read_with_a_warning_that_names_both_keys() -> None:
    with pytest.warns(FutureWarning, match="crumb_m.*small_frontier_penalty_m"):
        config = crossnav.Config({"policy.explore.crumb_m": 7})
    assert config.to_dict()["policy"]["explore"]["small_frontier_penalty_m"] == 7


def test_a_variant_changes_what_it_names() -> None:
    settings = crossnav.Config(variant="no-history-poi").to_dict()
    assert settings["policy"]["poi"]["use_history"] is False
    with pytest.raises(crossnav.Error, match="unknown variant"):
        crossnav.Config(variant="best")


def test_errors_can_be_pickled() -> None:
    error = pickle.loads(pickle.dumps(crossnav.Error("is gone", "a.map", "not_found")))
    assert (str(error), error.where, error.code) == ("a.map: is gone", "a.map", "not_found")


def test_a_missing_file_is_named() -> None:
    with pytest.raises(crossnav.Error, match="no_such"):
        crossnav.load_map("no_such.map")
    with pytest.raises(crossnav.Error) as caught:
        crossnav.Scene("no_such_folder")
    assert caught.value.where == "no_such_folder"
    assert caught.value.code == "not_found"
