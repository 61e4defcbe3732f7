# SPDX-License-Identifier: MIT
"""What is held out is never trained on."""

import common
import furniture


def test_a_third_of_each_kind_is_held_out_by_its_name():
    models = [{"id": f"chair{i}", "kind": "chair"} for i in range(9)] + [
        {"id": f"bed{i}", "kind": "bed"} for i in range(2)] + [{"id": "book", "kind": "book"}]
    held = furniture.held_out_ids(models)
    assert sum(name.startswith("chair") for name in held) == 3
    assert sum(name.startswith("bed") for name in held) == 1
    assert "book" not in held
    assert furniture.held_out_ids(models[::-1]) == held


def test_held_out_houses_and_furniture_are_never_trained_on():
    seeds = {name: set(spec["seeds"]) for name, spec in common.SETS.items()}
    looked_at, held = [*common.TRAIN_SETS, *common.DEV_SETS], ["test", "test-2"]
    assert sorted(looked_at + held) == sorted(common.SETS)
    assert sum(len(rows) for rows in seeds.values()) == len(set().union(*seeds.values()))
    assert max(max(seeds[name]) for name in looked_at) < 5001 <= min(min(seeds[name]) for name in held)
    assert {common.SETS[name]["furniture"] for name in looked_at} == {"train", "program"}
    assert {common.SETS[name]["furniture"] for name in held} == {"held"}
    assert not set(common.STYLES) & set(common.TRAIN_SETS) and not set(common.LOOKED_AT) & set(common.HOMES)
    assert {home for name in common.TRAIN_STYLES for home in common.STYLES[name]["homes"]} == set(common.LOOKED_AT)
