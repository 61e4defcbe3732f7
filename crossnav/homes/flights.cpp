// SPDX-License-Identifier: MIT
#include "crossnav/homes/flights.h"

#include <algorithm>
#include <cmath>

#include "crossnav/homes/piece_model.h"

namespace crossnav::homes {
namespace {

constexpr double kAround_m = 2.0;  // chosen: ground before and after the flight
constexpr double kRing_m = 0.35;   // chosen: a step away from the staircase
constexpr double kRingStep_m = 0.25;
constexpr double kMinRise_m = 0.5;  // chosen: less is a threshold

/// The triangles of `scene` near a staircase, without names.
sim::Scene Around(const sim::Scene& scene, const HomePiece& piece) {
  Box3 box;
  for (const Vector2d& p : Footprint(piece)) box.Add({p.x(), p.y(), 0});
  sim::Scene near;
  near.id = scene.id;
  near.materials = {sim::Material{}};
  for (const auto& t : scene.mesh.triangles) {
    Box3 reach;
    for (const auto v : t) reach.Add(scene.mesh.vertices[v].cast<double>());
    const bool is_near =
        reach.min.x() < box.max.x() + kAround_m && reach.max.x() > box.min.x() - kAround_m &&
        reach.min.y() < box.max.y() + kAround_m && reach.max.y() > box.min.y() - kAround_m;
    if (!is_near) continue;
    const auto first = static_cast<std::uint32_t>(near.mesh.vertices.size());
    for (const auto v : t) near.mesh.vertices.push_back(scene.mesh.vertices[v]);
    near.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  sim::UpdateDerived(near);
  return near;
}

/// Navigable points around the footprint at a height.
std::vector<Vector3d> RingAt(const sim::NavMesh& navmesh, const HomePiece& piece, double z_m) {
  std::vector<Vector3d> ring;
  HomePiece grown = piece;
  grown.width_m += 2 * kRing_m;
  grown.depth_m += 2 * kRing_m;
  const Polygon edge = Footprint(grown);
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const Vector2d &a = edge[i], &b = edge[(i + 1) % edge.size()];
    const int parts = std::max(1, static_cast<int>((b - a).norm() / kRingStep_m));
    for (int k = 0; k < parts; ++k) {
      const Vector2d p = a + (b - a) * (static_cast<double>(k) / parts);
      if (const auto q = navmesh.Snap({p.x(), p.y(), z_m}, 0.25, 0.25)) ring.push_back(*q);
    }
  }
  return ring;
}

}  // namespace

std::vector<Flight> FlightsOf(const HomePlan& plan) {
  std::vector<Flight> flights;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const HomePiece& piece = plan.pieces[i];
    if (piece.kind != PieceKind::kStairs) continue;
    Flight flight{i, plan.FloorOf(piece.level) + piece.bottom_m, 1e9};
    for (const HomeRoom& room : plan.rooms) {
      const double floor = plan.FloorOf(room.level);
      const bool is_above = floor > flight.foot_m + kMinRise_m;
      if (!room.has_floor || !is_above || floor > flight.foot_m + piece.height_m + 0.05) continue;
      flight.top_m = std::min(flight.top_m, floor);
    }
    if (flight.top_m < 1e9) flights.push_back(flight);
  }
  return flights;
}

Result<bool> IsClimbable(const sim::Scene& scene, const HomePlan& plan, const Flight& flight,
                         const sim::NavMeshSettings& settings) {
  const HomePiece& piece = plan.pieces[flight.piece];
  const auto navmesh = sim::NavMesh::Build(Around(scene, piece), settings);
  if (!navmesh) return tl::unexpected(navmesh.error());
  const auto below = RingAt(*navmesh, piece, flight.foot_m);
  const auto above = RingAt(*navmesh, piece, flight.top_m);
  if (below.empty() || above.empty()) return false;
  // Longer paths use another staircase.
  const double limit_m =
      3 * (flight.top_m - flight.foot_m) + 4 * (piece.width_m + piece.depth_m + 2 * kAround_m);
  for (const Vector3d& from : below) {
    const auto length_m = navmesh->Geodesic(from, above);
    if (length_m && *length_m < limit_m) return true;
  }
  return false;
}

Result<Substitutes> FixFlights(const HomePlan& plan, ModelStore& models,
                               const sim::NavMeshSettings& settings,
                               std::vector<std::string>& notes, Substitutes given) {
  Substitutes substitutes = std::move(given);
  for (const Flight& flight : FlightsOf(plan)) {
    std::vector<std::string> ignored;
    const HomePiece& piece = plan.pieces[flight.piece];
    const auto climbable =
        IsClimbable(BuildHome(plan, models, substitutes, ignored), plan, flight, settings);
    if (!climbable) return tl::unexpected(climbable.error());
    if (*climbable) continue;
    std::string why;
    std::optional<world::NamedObj> drawn;
    const auto own = substitutes.find(flight.piece);
    if (own != substitutes.end()) {
      drawn = own->second;
    } else if (const auto* model = models.Find(piece.model, why)) {
      drawn = Fitted(*model, piece);
    }
    const auto keep = drawn && own != substitutes.end() ? drawn : std::nullopt;
    bool is_fixed = false;
    const double rise_m = flight.top_m - flight.foot_m;
    for (auto& plain : PlainFlights(piece, rise_m, drawn ? &*drawn : nullptr)) {
      substitutes[flight.piece] = std::move(plain);
      const auto fixed =
          IsClimbable(BuildHome(plan, models, substitutes, ignored), plan, flight, settings);
      if (!fixed) return tl::unexpected(fixed.error());
      if (is_fixed = *fixed; is_fixed) break;
    }
    const std::string name = "the staircase '" + piece.name + "' ";
    notes.push_back(name + (is_fixed
                                ? "cannot be climbed as drawn and is replaced by a plain flight"
                                : "cannot be climbed, and no flight in its box leads up"));
    if (!is_fixed) substitutes.erase(flight.piece);
    if (!is_fixed && keep) substitutes[flight.piece] = *keep;
  }
  return substitutes;
}

}  // namespace crossnav::homes
