// SPDX-License-Identifier: MIT
// Saved memories: save_map, load_map, map_header.
#include "crossnav/store/map_file.h"

#include "crossnav/evaluation/records/result_records.h"
#include "map_handle.h"

namespace crossnav::python {
namespace {

nb::dict ToDict(const store::MapHeader& header) {
  nb::dict out;
  out["format"] = header.format;
  out["revision"] = header.revision;
  out["voxel_m"] = header.voxel_m;
  out["clearing"] = header.clearing;
  out["feature_dim"] = header.feature_dim;
  out["encoder_name"] = header.encoder_name;
  out["encoder_hash"] = evaluation::HexHash(header.encoder_hash);
  out["frame"] = header.frame;
  out["map_blocks"] = header.map_blocks;
  out["feature_blocks"] = header.feature_blocks;
  out["feature_rows"] = header.feature_rows;
  out["compacted_rows"] = header.compacted_rows;
  out["dropped_rows"] = header.dropped_rows;
  return out;
}

std::int64_t Save(const PathIn& path, const MapHandle& map, const MemoryHandle& memory,
                  const std::string& encoder_name, const std::string& frame) {
  store::SaveInfo info;
  info.encoder_name = encoder_name;
  info.frame = frame;
  info.flights = map.Flights();
  info.seen_stairs = map.SeenStairs();
  const nb::gil_scoped_release others_run;
  return Unwrap(store::SaveMemory(path.path, *map.map, *memory.memory, info)).revision;
}

nb::tuple Load(const PathIn& path, const Settings& settings, const std::string& encoder_name,
               bool skip_damaged) {
  const agent::Config config = ConfigOf(settings).agent;
  store::LoadOptions options;
  if (!settings.value.is_none()) options.map = config.map;
  options.fusion = config.fusion;
  options.encoder_name = encoder_name;
  options.skip_damaged = skip_damaged;
  auto loaded = [&] {
    const nb::gil_scoped_release others_run;
    return Unwrap(store::LoadMemory(path.path, options));
  }();
  auto map =
      std::make_unique<MapHandle>(std::make_unique<geometry::VoxelMap>(std::move(loaded.map)));
  map->flights = std::move(loaded.flights);
  map->seen_stairs = std::move(loaded.seen_stairs);
  auto memory = std::make_unique<MemoryHandle>(
      std::make_unique<memory::SemanticMemory>(std::move(loaded.memory)), config.query);
  return nb::make_tuple(std::move(map), std::move(memory), ToDict(loaded.header), loaded.damaged);
}

}  // namespace

void BindStore(nb::module_& m) {
  m.def("save_map", &Save, "path"_a, "map"_a, "memory"_a, "encoder_name"_a = "",
        "frame"_a = "episode",
        "Saves map and memory to one file, atomically; returns the file's revision. Blocks that "
        "did not change are not written again.");
  m.def("load_map", &Load, "path"_a, "config"_a = nb::none(), "encoder_name"_a = "",
        "skip_damaged"_a = false,
        nb::sig("def load_map(path: str | os.PathLike[str], config: crossnav._config.Settings = "
                "None, encoder_name: str = '', skip_damaged: bool = False) -> tuple[VoxelMap, "
                "SemanticMemory, dict[str, typing.Any], list[str]]"),
        "Reads a map file: (map, memory, header, what was damaged). An encoder's name that is "
        "given must be the file's.");
  m.def(
      "map_header",
      [](const PathIn& path) { return ToDict(Unwrap(store::ReadMapHeader(path.path))); }, "path"_a,
      nb::sig("def map_header(path: str | os.PathLike[str]) -> dict[str, typing.Any]"),
      "The header alone.");
}

}  // namespace crossnav::python
