// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/stair_draw.h"

#include <algorithm>
#include <cmath>

namespace crossnav::world {
namespace {

constexpr Range kFirstRiser_m{0.15, 0.21};   // edition 1: limits of building codes
constexpr Range kSecondRiser_m{0.10, 0.29};  // edition 2: the navmesh climbs 0.30 m

// chosen: after building codes (comfortable), old town houses (steep), ladders to lofts (attic).
constexpr StairRange kShallow{{0.120, 0.155}, {0.30, 0.35}, {0.90, 1.40}};
constexpr StairRange kComfortable{{0.160, 0.200}, {0.24, 0.30}, {0.80, 1.20}};
constexpr StairRange kSteep{{0.190, 0.240}, {0.18, 0.24}, {0.70, 1.00}};
constexpr StairRange kLadderLike{{0.220, 0.280}, {0.15, 0.20}, {0.65, 0.90}};

std::optional<StairParams> DrawFirst(StairKind kind, const Storeys& storeys, Rng& rng) {
  StairParams stair;
  stair.kind = kind;
  const double most = storeys.most_m;
  const int fewest = static_cast<int>(std::ceil(most / kFirstRiser_m.hi)),
            highest = static_cast<int>(std::floor(storeys.least_m / kFirstRiser_m.lo));
  if (fewest > highest) return std::nullopt;
  stair.risers =
      std::clamp(static_cast<int>(std::lround(most / rng.Uniform(0.165, 0.195))), fewest, highest);
  stair.tread_m = std::clamp(0.63 - 2 * most / stair.risers, 0.24, 0.32);  // Blondel's rule
  const bool is_spiral = kind == StairKind::kSpiral;
  stair.width_m = is_spiral ? rng.Uniform(0.8, 1.0) : rng.Uniform(0.8, 1.2);
  stair.slab_m = storeys.slab_m;
  DrawStairBody(stair, rng);
  stair.rise_m = most;
  return stair;
}

std::optional<StairParams> DrawSecond(StairKind kind, const Storeys& storeys, Rng& rng) {
  StairParams stair;
  stair.kind = kind;
  const StairRange range = DrawStairRange(kind, rng);
  const auto risers = RisersFor(storeys, range.riser_m.Draw(rng), kSecondRiser_m);
  if (!risers) return std::nullopt;
  stair.risers = *risers;
  stair.tread_m = range.tread_m.Draw(rng);
  stair.width_m = kind == StairKind::kSpiral ? rng.Uniform(0.8, 1.0) : range.width_m.Draw(rng);
  const bool has_landing = kind == StairKind::kU || kind == StairKind::kStraightLanding;
  if (has_landing && rng.Chance(0.4)) stair.landing_m = rng.Uniform(1.3, 2.2);
  stair.slab_m = storeys.slab_m;
  DrawStairBody(stair, rng);
  stair.rise_m = storeys.most_m;
  return stair;
}

}  // namespace

StairKind DrawStairKind(const Edition& edition, StairUse use, Rng& rng) {
  using enum StairKind;
  if (use == StairUse::kCellar) return kBasement;
  if (use == StairUse::kAttic) return StairKind::kAttic;
  constexpr StairKind kFirst[] = {kStraight, kStraightLanding, kL,      kU,
                                  kU,        kWinder,          kSpiral, kDouble};
  constexpr StairKind kSecond[] = {kStraight, kStraightLanding, kL,      kU,      kU,       kWinder,
                                   kWinder,   kHalfWinder,      kSpiral, kDouble, kStraight};
  if (!edition.has_wide_stairs) return kFirst[rng.Below(std::size(kFirst))];
  return kSecond[rng.Below(std::size(kSecond))];
}

StairRange DrawStairRange(StairKind kind, Rng& rng) {
  const double draw = rng.Uniform();
  if (kind == StairKind::kAttic) return draw < 0.7 ? kLadderLike : kSteep;
  if (kind == StairKind::kBasement)
    return draw < 0.3 ? kLadderLike : draw < 0.75 ? kSteep : kComfortable;
  if (kind == StairKind::kSpiral) return kComfortable;
  return draw < 0.2 ? kShallow : draw < 0.65 ? kComfortable : kSteep;
}

std::optional<int> RisersFor(const Storeys& storeys, double wanted_riser_m, const Range& limit_m) {
  const int fewest = static_cast<int>(std::ceil(storeys.most_m / limit_m.hi));
  const int highest = static_cast<int>(std::floor(storeys.least_m / limit_m.lo));
  if (fewest > highest) return std::nullopt;
  return std::clamp(static_cast<int>(std::lround(storeys.most_m / wanted_riser_m)), fewest,
                    highest);
}

std::optional<StairParams> DrawStair(const Edition& edition, StairKind kind, const Storeys& storeys,
                                     Rng& rng) {
  return edition.has_wide_stairs ? DrawSecond(kind, storeys, rng) : DrawFirst(kind, storeys, rng);
}

void DrawStairBody(StairParams& stair, Rng& rng) {
  stair.body = static_cast<StairBody>(rng.Int(0, 2));
  stair.rail_style = rng.Chance(0.5) ? 0 : rng.Int(1, 2);
}

}  // namespace crossnav::world
