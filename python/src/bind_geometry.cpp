// SPDX-License-Identifier: MIT
// VoxelMap: integrate, states as arrays, line of sight.
#include "crossnav/geometry/map_blocks.h"
#include "map_handle.h"

namespace crossnav::python {

using geometry::Voxel;
using geometry::VoxelKey;
using geometry::VoxelMap;
using geometry::VoxelState;

VoxelMap& MapHandle::Writable() {
  if (!owned) Raise(ErrorCode::kInvalid, "belongs to an agent, which alone writes it", "map");
  return *owned;
}

VoxelMap CopyOf(const VoxelMap& map) {
  return Unwrap(geometry::ImportBlocks(geometry::ExportBlocks(map), map.config()));
}

namespace {

using PointsIn = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using StatesOut = Array<std::uint8_t, nb::ndim<1>>;
using FlagsOut = Array<bool, nb::ndim<1>>;

std::int64_t Integrate(MapHandle& self, const DepthIn& depth_m, const CameraIntrinsics& camera,
                       const PoseIn& T_world_camera) {
  VoxelMap& map = self.Writable();
  CheckCamera(camera, depth_m.shape(0), depth_m.shape(1));
  const InUse guard(self.in_use);
  self.T_world_camera = ToPose(T_world_camera);
  self.depth_m = ToImage(depth_m);
  self.camera = camera;
  const nb::gil_scoped_release others_run;
  self.ends = &map.Integrate(self.depth_m, self.camera, self.T_world_camera);
  return static_cast<std::int64_t>(map.UpdateStates().size());
}

void ObserveBody(MapHandle& self, const Point& p_world_foot, double camera_height_m) {
  VoxelMap& map = self.Writable();
  if (!(camera_height_m > 0 && camera_height_m <= 5))
    Raise(ErrorCode::kInvalid, "must lie between 0 and 5", "camera_height_m");
  map.ObserveBody(ToPoint(p_world_foot, "p_world_foot"), camera_height_m);
  map.UpdateStates();
}

nb::tuple Voxels(const MapHandle& self) {
  std::vector<VoxelKey> keys;
  std::vector<std::uint8_t> states, inflated;
  self.map->ForEach([&](const VoxelKey& key, const Voxel& voxel) {
    keys.push_back(key);
    states.push_back(static_cast<std::uint8_t>(voxel.state));
    inflated.push_back(voxel.is_inflated ? 1 : 0);
  });
  const std::size_t count = keys.size();
  return nb::make_tuple(
      ToArray(std::span<const VoxelKey>(keys)), ToArray<StatesOut>(std::move(states), {count}),
      ToArray<StatesOut>(std::move(inflated), {count}).cast().attr("view")("bool"));
}

StatesOut StatesAt(const MapHandle& self, const PointsIn& p_world) {
  std::vector<std::uint8_t> states(p_world.shape(0));
  VoxelMap::Cursor cursor(*self.map);
  const double voxel_m = self.map->config().voxel_m;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Vector3d p = ToPoint({{p_world(i, 0), p_world(i, 1), p_world(i, 2)}}, "p_world");
    states[i] = static_cast<std::uint8_t>(cursor.At(geometry::KeyOf(p, voxel_m)).state);
  }
  return ToArray<StatesOut>(std::move(states), {p_world.shape(0)});
}

std::optional<PointOut> NearestFree(const MapHandle& self, const Point& p_world, double radius_m) {
  if (!(radius_m >= 0 && radius_m <= 100))
    Raise(ErrorCode::kInvalid, "must lie between 0 and 100", "radius_m");
  VoxelKey found;
  if (!self.map->NearestFree(ToPoint(p_world, "p_world"), radius_m, &found)) return std::nullopt;
  return ToArray(geometry::CenterOf(found, self.map->config().voxel_m));
}

nb::dict Stats(const MapHandle& self) {
  const geometry::MapStats stats = self.map->Stats();
  nb::dict out;
  out["known"] = stats.known;
  out["occupied"] = stats.occupied;
  out["traversable"] = stats.traversable;
  out["blocks"] = stats.blocks;
  out["bytes"] = stats.bytes;
  return out;
}

Array<double, nb::ndim<2>> ToRows(const std::vector<Vector3d>& points) {
  std::vector<double> rows;
  for (const Vector3d& p : points) rows.insert(rows.end(), p.data(), p.data() + 3);
  return ToArray<Array<double, nb::ndim<2>>>(std::move(rows), {points.size(), 3});
}

/// Each flight as a dict of its ends, its steps, its number of walks, and its viewing and trial
/// places.
nb::list Flights(const MapHandle& self) {
  nb::list out;
  for (const geometry::StairFlight& flight : self.Flights()) {
    nb::list tries;
    for (const geometry::FlightTry& attempt : flight.tries) {
      nb::dict one;
      one["p_from_world"] = nb::cast(ToArray(attempt.p_from_world));
      one["is_up"] = attempt.is_up;
      one["ending"] = std::string(NameOf(attempt.ending));
      tries.append(one);
    }
    nb::dict one;
    one["id"] = flight.id;
    one["p_foot_world"] = nb::cast(ToArray(flight.p_foot_world));
    one["p_top_world"] = nb::cast(ToArray(flight.p_top_world));
    one["direction_up"] = nb::cast(ToArray(flight.DirectionUp()));
    one["steps_world"] = nb::cast(ToRows(flight.steps_world));
    one["confidence"] = flight.confidence;
    one["walked_up"] = flight.walked_up;
    one["walked_down"] = flight.walked_down;
    one["seen_from_world"] = nb::cast(ToRows(flight.seen_from_world));
    one["tries"] = tries;
    out.append(one);
  }
  return out;
}

void BindMap(nb::module_& m) {
  nb::class_<MapHandle>(m, "VoxelMap",
                        "The support-aware sparse voxel map. World frame, z up, metres.")
      .def(
          "__init__",
          [](MapHandle* self, const Settings& config) {
            new (self) MapHandle(std::make_unique<VoxelMap>(ConfigOf(config).agent.map));
          },
          "config"_a = nb::none(), "Settings of the section [map].")
      .def("integrate", &Integrate, "depth_m"_a.noconvert(), "camera"_a, "T_world_camera"_a,
           "One frame: end voxels become occupied, rays before them free; states follow. depth_m: "
           "H x W float32, planar [m]. Returns how many states changed.")
      .def("observe_body", &ObserveBody, "p_world_foot"_a, "camera_height_m"_a,
           "The robot's own cylinder is free, the voxel under its foot supports it.")
      .def("voxels", &Voxels,
           nb::sig("def voxels(self) -> tuple[numpy.typing.NDArray[numpy.int32], "
                   "numpy.typing.NDArray[numpy.uint8], numpy.typing.NDArray[numpy.bool_]]"),
           "Every observed voxel, in order of first observation: keys (N, 3), states (N,) as "
           "VoxelState, inflated (N,). Centre of a key: (key + 0.5) * voxel_m.")
      .def("states_at", &StatesAt, "p_world"_a, "VoxelState of each of the (N, 3) points.")
      .def(
          "has_line_of_sight",
          [](const MapHandle& self, const Point& a, const Point& b) {
            return self.map->HasLineOfSight(ToPoint(a, "a_world"), ToPoint(b, "b_world"));
          },
          "a_world"_a, "b_world"_a, "No surface voxel is strictly between the two points.")
      .def("nearest_free", &NearestFree, "p_world"_a, "radius_m"_a,
           "Centre of the nearest voxel that one can stand in, or None.")
      .def_prop_ro(
          "flights", &Flights, nb::sig("def flights(self) -> list[dict[str, typing.Any]]"),
          "Stairs that were walked: p_foot_world and p_top_world (3,), steps_world (N, 3), "
          "confidence, walked_up, walked_down.")
      .def("stats", &Stats, nb::sig("def stats(self) -> dict[str, int]"),
           "Numbers of voxels and blocks, and bytes held.")
      .def_prop_ro("voxel_m", [](const MapHandle& self) { return self.map->config().voxel_m; })
      .def_prop_ro(
          "revision", [](const MapHandle& self) { return self.map->Revision(); },
          "Grows with every change of a state.")
      .def("__len__", [](const MapHandle& self) { return self.map->Stats().known; });
}

}  // namespace

void BindGeometry(nb::module_& m) {
  nb::enum_<VoxelState>(m, "VoxelState", nb::is_arithmetic(),
                        "State of a voxel; UNKNOWN is the absence of a state.")
      .value("UNKNOWN", VoxelState::kUnknown)
      .value("OCCUPIED", VoxelState::kOccupied)
      .value("TRAVERSABLE", VoxelState::kTraversable)
      .value("TRAVERSABLE_STAIR", VoxelState::kTraversableStair)
      .value("TRAVERSABLE_FAKE", VoxelState::kTraversableFake)
      .value("STAIR", VoxelState::kStair)
      .value("STAIR_EXPANDED", VoxelState::kStairExpanded)
      .value("FAKE_STAIR", VoxelState::kFakeStair);
  BindMap(m);
}

}  // namespace crossnav::python
