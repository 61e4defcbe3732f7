// SPDX-License-Identifier: MIT
#include "crossnav/world/furniture/groups.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crossnav::world {
namespace {

using std::numbers::pi;

struct Maker {
  const FurnitureSource& source;
  Rng& rng;

  std::optional<ObjectModel> Make(std::string_view kind) const { return source.Make(kind, rng); }

  Group Single(ObjectModel model, double clear_front_m) const {
    Group g;
    g.clear_front_m = clear_front_m;
    g.Add(std::move(model), Vector3d::Zero());
    return g;
  }

  /// Puts `kind` on the top of `below`, which is at `p`.
  void OnTop(Group& g, std::string_view kind, const ObjectModel& below, const Vector3d& p) const {
    if (below.top_m < 0) return;
    auto model = Make(kind);
    if (model) g.Add(std::move(*model), p + Vector3d(0, 0, below.top_m));
  }

  Group Bed() const {
    Group g;
    auto bed = Make("bed");
    const Vector3d size = bed->Size();
    g.clear_front_m = 0.6;
    const int sides = rng.Int(0, 2);
    for (int side = 0; side < sides; ++side) {
      auto table = Make("bedside table");
      const double s = side == 0 ? 1 : -1;
      const double x = s * (0.5 * size.x() + 0.5 * table->Size().x() + 0.05);
      const Vector3d p(x, -0.5 * size.y() + 0.5 * table->Size().y(), 0);
      if (rng.Chance(0.6)) OnTop(g, "table lamp", *table, p);
      g.Add(std::move(*table), p);
    }
    g.Add(std::move(*bed), Vector3d::Zero());
    return g;
  }

  Group Desk() const {
    Group g;
    auto desk = Make("desk");
    const Vector3d size = desk->Size();
    auto chair = Make(rng.Chance(0.6) ? "office chair" : "chair");
    const double y = 0.5 * size.y() + 0.5 * chair->Size().y() + 0.02;
    if (rng.Chance(0.65)) {
      OnTop(g, "computer monitor", *desk, {0, -0.12, 0});
    } else {
      OnTop(g, "laptop", *desk, {0, 0, 0});
    }
    const double yaw_rad = pi + rng.Uniform(-0.3, 0.3);
    g.Add(std::move(*chair), {rng.Uniform(-0.1, 0.1), y, 0}, yaw_rad);
    g.Add(std::move(*desk), Vector3d::Zero());
    g.clear_front_m = 0.3;
    return g;
  }

  Group Sofa() const {
    Group g;
    auto sofa = Make("couch");
    const double front = 0.5 * sofa->Size().y();
    g.clear_front_m = 0.5;
    if (rng.Chance(0.75)) {
      auto table = Make("coffee table");
      const double y = front + 0.35 + 0.5 * table->Size().y();
      const Vector3d p(0, y, 0);
      if (rng.Chance(0.5)) OnTop(g, rng.Chance(0.5) ? "vase" : "book", *table, p);
      g.Add(std::move(*table), p);
      if (rng.Chance(0.6)) g.Add(*Make("rug"), p);
    }
    g.Add(std::move(*sofa), Vector3d::Zero());
    return g;
  }

  Group Tv() const {
    Group g;
    auto stand = Make("tv stand");
    OnTop(g, "tv", *stand, {0, -0.05, 0});
    g.Add(std::move(*stand), Vector3d::Zero());
    g.clear_front_m = 0.6;
    return g;
  }

  Group Dining() const {
    Group g;
    auto table = Make("dining table");
    const Vector3d size = table->Size();
    const int along = size.x() > 1.3 ? 2 : 1;
    if (rng.Chance(0.5)) OnTop(g, rng.Chance(0.5) ? "bowl" : "vase", *table, {0, 0, 0});
    const std::uint64_t look = rng.Next();  // the same look for the whole set
    for (double side : {-1.0, 1.0}) {
      for (int i = 0; i < along; ++i) {
        Rng same(look);
        auto chair = source.Make("dining chair", same);
        const double x = along == 1 ? 0 : (i == 0 ? -0.25 : 0.25) * size.x();
        const double y = side * (0.5 * size.y() + 0.5 * chair->Size().y() + 0.03);
        g.Add(std::move(*chair), {x, y, 0}, (side > 0 ? pi : 0) + rng.Uniform(-0.2, 0.2));
      }
    }
    g.Add(std::move(*table), Vector3d::Zero());
    g.clear_front_m = 0.45;
    return g;
  }

  Group Kitchen(double space_m) const {
    Group g;
    const std::uint64_t look = rng.Next();
    std::vector<std::string_view> row = {"kitchen cabinet", "sink", "kitchen cabinet", "stove"};
    if (rng.Chance(0.8)) row.push_back("refrigerator");
    while (row.size() < 7 && rng.Chance(0.5)) row.insert(row.begin(), "kitchen cabinet");
    if (rng.Chance(0.5)) std::reverse(row.begin(), row.end());
    double x = 0;
    for (auto kind : row) {
      Rng same(look);
      auto unit = source.Make(kind, same);
      const double w = unit->Size().x();
      if (x + w > std::min(space_m - 0.1, 4.4)) continue;
      const Vector3d p(x + 0.5 * w, 0.5 * unit->Size().y(), 0);
      if (kind == "kitchen cabinet") {
        if (rng.Chance(0.3)) OnTop(g, rng.Chance(0.5) ? "bowl" : "vase", *unit, p);
        Rng again(look);
        auto upper = source.Make("kitchen upper cabinet", again);
        const double depth_m = upper->Size().y();
        g.Add(std::move(*upper), {p.x(), 0.5 * depth_m, 1.45});
        g.items.back().is_optional = true;
      }
      g.Add(std::move(*unit), p);
      x += w + 0.004;
    }
    g.clear_front_m = 0.8;
    return g;
  }

  Group Washbasin() const {
    Group g;
    auto basin = Make("washbasin");
    const double back = -0.5 * basin->Size().y();
    g.Add(std::move(*basin), Vector3d::Zero());
    if (rng.Chance(0.75)) {
      auto mirror = Make("mirror");
      g.Add(std::move(*mirror), {0, back + 0.03, 1.1});
    }
    g.clear_front_m = 0.5;
    return g;
  }

  Group TableWithChairs() const {
    Group g;  // a pair of garden chairs with a plant between them
    auto chair = Make("chair"), other = Make("chair");
    g.Add(std::move(*chair), {-0.55, 0, 0});
    g.Add(std::move(*other), {0.55, 0, 0});
    g.Add(*Make("potted plant"), {0, 0, 0});
    g.clear_front_m = 0.2;
    return g;
  }
};

double ClearanceOf(std::string_view kind) {
  if (kind == "wardrobe" || kind == "toilet" || kind == "bathtub" || kind == "shower") return 0.55;
  if (kind == "potted plant" || kind == "floor lamp" || kind == "picture" || kind == "box" ||
      kind == "trash can" || kind == "basket" || kind == "mirror" || kind == "curtain") {
    return 0.02;
  }
  return 0.45;
}

}  // namespace

void Group::Add(ObjectModel model, const Vector3d& p_group, double yaw_rad) {
  Pose T = Pose::Identity();
  T.translate(p_group);
  T.rotate(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()));
  items.push_back({std::move(model), T, false});
}

void Group::Settle() {
  Box3 box;
  for (const auto& item : items) {
    const Box3 b = BoxAt(item.model, item.T_group_object);
    box.Add(b.min);
    box.Add(b.max);
  }
  const Vector3d shift(-0.5 * (box.min.x() + box.max.x()), -box.min.y(), 0);
  for (auto& item : items) item.T_group_object.pretranslate(shift);
  body = {box.min.x() + shift.x(), 0, box.max.x() + shift.x(), box.max.y() + shift.y()};
  height_m = box.max.z();
}

std::optional<Group> MakeGroup(std::string_view kind, const FurnitureSource& source, double space_m,
                               Rng& rng) {
  const Maker maker{source, rng};
  Group group;
  if (kind == "bed group") {
    group = maker.Bed();
  } else if (kind == "desk group") {
    group = maker.Desk();
  } else if (kind == "sofa group") {
    group = maker.Sofa();
  } else if (kind == "tv group") {
    group = maker.Tv();
  } else if (kind == "dining group") {
    group = maker.Dining();
  } else if (kind == "kitchen group") {
    group = maker.Kitchen(space_m);
  } else if (kind == "washbasin group") {
    group = maker.Washbasin();
  } else if (kind == "balcony group") {
    group = maker.TableWithChairs();
  } else {
    auto model = source.Make(kind, rng);
    if (!model) return std::nullopt;
    group = maker.Single(std::move(*model), ClearanceOf(kind));
  }
  if (group.items.empty()) return std::nullopt;
  group.Settle();
  return group;
}

}  // namespace crossnav::world
