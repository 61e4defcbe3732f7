// SPDX-License-Identifier: MIT
// SemanticMemory: fuse, similarity, query.
#include <cmath>

#include "map_handle.h"

namespace crossnav::python {

using memory::MemoryCluster;
using memory::SemanticMemory;

void CheckText(const SemanticMemory& memory, std::span<const float> text) {
  if (memory.Dim() != 0 && static_cast<int>(text.size()) != memory.Dim())
    Raise(ErrorCode::kMismatch,
          "has " + std::to_string(text.size()) + " numbers, the memory's features " +
              std::to_string(memory.Dim()),
          "text");
  double sum = 0;
  for (const float value : text) sum += static_cast<double>(value) * value;
  if (!(sum > 0 && std::isfinite(sum)))
    Raise(ErrorCode::kInvalid, "must be finite and not zero", "text");
}

SemanticMemory CopyOf(const SemanticMemory& memory) {
  SemanticMemory copy(memory.config(), memory.VoxelSize(), memory.Dim());
  for (std::int64_t row = 0; row < memory.Size(); ++row) copy.AppendRow(memory.RowAt(row));
  copy.AddDropped(memory.Counters().dropped_rows);
  return copy;
}

namespace {

using FloatsOut = Array<float, nb::ndim<1>>;

std::span<const float> SpanOf(const VectorIn& vector) {
  return {vector.data(), vector.size()};
}

void Fuse(MemoryHandle& self, MapHandle& map, const GridIn& features) {
  if (!self.owned)
    Raise(ErrorCode::kInvalid, "belongs to an agent, which alone writes it", "memory");
  if (map.ends == nullptr)
    Raise(ErrorCode::kInvalid, "has no frame yet: call its integrate first", "map");
  if (map.map->config().voxel_m != self.memory->VoxelSize())
    Raise(ErrorCode::kMismatch, "has another voxel size than the memory", "map");
  const int dim = static_cast<int>(features.shape(2));
  if (features.size() == 0 || (self.memory->Dim() != 0 && dim != self.memory->Dim()))
    Raise(ErrorCode::kMismatch, "must be rows x cols x dim, with the memory's dimension",
          "features");
  const InUse mine(self.in_use), frame(map.in_use);
  const memory::FeatureGridView view{static_cast<int>(features.shape(0)),
                                     static_cast<int>(features.shape(1)),
                                     dim,
                                     {features.data(), features.size()}};
  const nb::gil_scoped_release others_run;
  self.owned->FuseRuns(map.ends->runs(), map.depth_m, map.camera, map.T_world_camera, view);
}

std::vector<MemoryCluster> Query(MemoryHandle& self, const VectorIn& text, std::optional<int> top_k,
                                 const std::vector<VectorIn>& background) {
  if (self.memory->Size() == 0) return {};
  CheckText(*self.memory, SpanOf(text));
  std::vector<std::vector<float>> others;
  for (const VectorIn& vector : background) {
    CheckText(*self.memory, SpanOf(vector));
    others.emplace_back(vector.data(), vector.data() + vector.size());
  }
  memory::QueryConfig config = self.query;
  if (top_k) config.top_k = *top_k;
  if (config.top_k < 1) Raise(ErrorCode::kInvalid, "must be at least 1", "top_k");
  const InUse guard(self.in_use);
  const nb::gil_scoped_release others_run;
  return memory::Query(*self.memory, SpanOf(text), config, others);
}

FloatsOut Similarity(MemoryHandle& self, const VectorIn& text) {
  if (self.memory->Size() == 0) return ToArray<FloatsOut>(std::vector<float>(), {0});
  CheckText(*self.memory, SpanOf(text));
  std::vector<float> values;
  {
    const InUse guard(self.in_use);
    const nb::gil_scoped_release others_run;
    values = self.memory->Similarity(SpanOf(text));
  }
  const std::size_t count = values.size();
  return ToArray<FloatsOut>(std::move(values), {count});
}

void CheckRow(const MemoryHandle& self, std::int64_t row) {
  if (row < 0 || row >= self.memory->Size()) throw nb::index_error("no such row");
}

FloatsOut Feature(const MemoryHandle& self, std::int64_t row) {
  CheckRow(self, row);
  std::vector<float> values = self.memory->FeatureAt(row);
  const std::size_t count = values.size();
  return ToArray<FloatsOut>(std::move(values), {count});
}

FloatsOut Weights(const MemoryHandle& self) {
  std::vector<float> values(static_cast<std::size_t>(self.memory->Size()));
  for (std::size_t row = 0; row < values.size(); ++row)
    values[row] = self.memory->WeightAt(static_cast<std::int64_t>(row));
  const std::size_t count = values.size();
  return ToArray<FloatsOut>(std::move(values), {count});
}

void BindCluster(nb::module_& m) {
  nb::class_<MemoryCluster>(m, "MemoryCluster", "One place in the memory that answers a query.")
      .def_prop_ro(
          "p_center_world", [](const MemoryCluster& c) { return ToArray(c.p_center_world); },
          kOwnArray, "(3,) [m], weighted by similarity.")
      .def_prop_ro(
          "box_min", [](const MemoryCluster& c) { return ToArray(c.box.min); }, kOwnArray,
          "(3,) [m]")
      .def_prop_ro(
          "box_max", [](const MemoryCluster& c) { return ToArray(c.box.max); }, kOwnArray,
          "(3,) [m]")
      .def_prop_ro(
          "voxels",
          [](const MemoryCluster& c) {
            return ToArray(std::span<const geometry::VoxelKey>(c.voxels));
          },
          kOwnArray, "(N, 3) int32, sorted keys.")
      .def_ro("rows", &MemoryCluster::rows, "Supporting rows, ascending.")
      .def_ro("score", &MemoryCluster::score, "Comparable within one query only.")
      .def_ro("similarity", &MemoryCluster::similarity, "Mean cosine of the best quarter.")
      .def_prop_ro(
          "p_best_view_world", [](const MemoryCluster& c) { return ToArray(c.p_best_view_world); },
          kOwnArray, "(3,) [m], camera position it was best seen from.")
      .def_ro("best_view_yaw_rad", &MemoryCluster::best_view_yaw_rad)
      .def_ro("best_view_pitch_rad", &MemoryCluster::best_view_pitch_rad);
}

}  // namespace

void BindMemory(nb::module_& m) {
  BindCluster(m);
  nb::class_<MemoryHandle>(m, "SemanticMemory",
                           "One feature row per surface voxel. World frame, metres.")
      .def(
          "__init__",
          [](MemoryHandle* self, const Settings& settings, int dim) {
            const agent::Config config = ConfigOf(settings).agent;
            if (dim < 0 || dim > 65536) Raise(ErrorCode::kInvalid, "must be 0 to 65536", "dim");
            new (self) MemoryHandle(
                std::make_unique<SemanticMemory>(config.fusion, config.map.voxel_m, dim),
                config.query);
          },
          "config"_a = nb::none(), "dim"_a = 0,
          "Settings of [fusion], [query] and map.voxel_m; dim 0 takes the first frame's.")
      .def("fuse", &Fuse, "map"_a, "features"_a,
           "Lifts features (rows x cols x dim float32, covering the whole image) to the surface "
           "voxels of the frame that `map` integrated last.")
      .def("query", &Query, "text"_a, "top_k"_a = nb::none(),
           "background"_a = std::vector<VectorIn>(),
           "Places that answer a text vector (dim,), best first; empty where nothing stands out.")
      .def("similarity", &Similarity, "text"_a, "Cosine of every row with the text, (N,) float32.")
      .def("feature", &Feature, "row"_a, "(dim,) float32.")
      .def_prop_ro(
          "keys", [](const MemoryHandle& self) { return ToArray(self.memory->Keys()); }, kOwnArray,
          "(N, 3) int32 voxel keys, in row order.")
      .def_prop_ro("weights", &Weights, kOwnArray, "(N,) float32, cumulative confidence.")
      .def_prop_ro("dim", [](const MemoryHandle& self) { return self.memory->Dim(); })
      .def_prop_ro("voxel_m", [](const MemoryHandle& self) { return self.memory->VoxelSize(); })
      .def_prop_ro("bytes", [](const MemoryHandle& self) { return self.memory->Bytes(); })
      .def("__len__", [](const MemoryHandle& self) { return self.memory->Size(); });
}

}  // namespace crossnav::python
