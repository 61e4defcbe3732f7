// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/true_home.h"

#include <algorithm>
#include <map>

#include "crossnav/core/category_table.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::evaluation {
namespace {

using language::Fit;
using language::RoomType;

constexpr double kMostly = 0.7;  // chosen: of a thing's surface before it has a colour

/// Types that people call a room of the plan, the first its own.
std::vector<RoomType> TypesOf(world::RoomType type) {
  switch (type) {
    case world::RoomType::kLiving:
      return {RoomType::kLiving};
    case world::RoomType::kKitchen:
      return {RoomType::kKitchen};
    case world::RoomType::kDining:
    case world::RoomType::kMeeting:
      return {RoomType::kDining};
    case world::RoomType::kBedroom:
      return {RoomType::kBedroom};
    case world::RoomType::kBathroom:
      return {RoomType::kBathroom};
    case world::RoomType::kWc:
      return {RoomType::kWc, RoomType::kBathroom};
    case world::RoomType::kOffice:
      return {RoomType::kOffice};
    case world::RoomType::kHall:
    case world::RoomType::kStairwell:
      return {RoomType::kHall};
    case world::RoomType::kStorage:
      return {RoomType::kStorage};
    case world::RoomType::kGarage:
      return {RoomType::kGarage};
    case world::RoomType::kBalcony:
      return {RoomType::kBalcony};
    default:
      return {};
  }
}

/// Storey of each level.
std::vector<int> StoreysOf(const world::HousePlan& plan, language::KnownHome& home) {
  std::vector<int> storeys;
  for (const world::Level& level : plan.levels) {
    if (home.floors.empty() || level.floor_m - home.floors.back().height_m >= kStorey_m)
      home.floors.push_back({level.floor_m});
    storeys.push_back(static_cast<int>(home.floors.size()) - 1);
  }
  return storeys;
}

/// Room of the home for each room of the plan.
std::vector<int> AddRooms(const world::HousePlan& plan, language::KnownHome& home) {
  const std::vector<int> storeys = StoreysOf(plan, home);
  std::map<std::pair<int, int>, int> open;  // (level, group)
  std::vector<int> rooms;
  for (const world::Room& room : plan.rooms) {
    const auto next = static_cast<int>(home.rooms.size());
    const int index =
        room.open_group < 0
            ? next
            : open.emplace(std::pair(room.level, room.open_group), next).first->second;
    if (index == next) {
      home.rooms.emplace_back();
      home.rooms.back().floor = storeys[room.level];
      home.rooms.back().looked_at = 1;
    }
    for (const RoomType type : TypesOf(room.type))
      home.rooms[index].fits[static_cast<int>(type)] = Fit::kYes;
    rooms.push_back(index);
  }
  return rooms;
}

/// Mean and largest share of the colours of an instance's triangles.
struct Paint {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  std::map<std::uint32_t, double> by_colour;

  void Add(const Rgb8& rgb, double area_m2) {
    sum += area_m2 * Eigen::Vector3d(rgb.r, rgb.g, rgb.b);
    area += area_m2;
    by_colour[rgb.r << 16 | rgb.g << 8 | rgb.b] += area_m2;
  }
  /// Empty where no colour prevails.
  std::optional<Rgb8> Colour() const {
    double most = 0;
    for (const auto& [rgb, share] : by_colour) most = std::max(most, share);
    if (area <= 0 || most < kMostly * area) return std::nullopt;
    const auto channel = [&](int i) { return static_cast<std::uint8_t>(sum[i] / area + 0.5); };
    return Rgb8{channel(0), channel(1), channel(2)};
  }
};

std::map<int, Paint> PaintsOf(const sim::Scene& scene) {
  std::map<int, Paint> paints;
  const sim::TriangleMesh& mesh = scene.mesh;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int instance = mesh.triangle_instance[i];
    const sim::Material& material = scene.materials[mesh.triangle_material[i]];
    if (instance == 0 || material.texture >= 0) continue;
    const auto& t = mesh.triangles[i];
    const Vector3f a = mesh.vertices[t[1]] - mesh.vertices[t[0]],
                   b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    paints[instance].Add(material.colour, 0.5 * a.cross(b).norm());
  }
  return paints;
}

}  // namespace

std::string NameOf(const sim::SceneInstance& instance) {
  return CanonicalName(instance.category.empty() ? instance.name : instance.category);
}

bool HasWord(const sim::SceneInstance& instance) {
  return language::ThingWords().contains(NameOf(instance));
}

TrueHome TrueHomeOf(const world::HousePlan& plan, const sim::Scene& scene,
                    const std::set<int>& seen) {
  TrueHome truth;
  const std::vector<int> rooms = AddRooms(plan, truth.home);
  const auto paints = PaintsOf(scene);
  std::set<std::string> names;
  for (const sim::SceneInstance& instance : scene.instances) {
    if (!seen.contains(instance.id) || !HasWord(instance)) continue;
    language::Thing thing;
    thing.category = NameOf(instance);
    thing.box = instance.box;
    thing.p_center_world = instance.box.Center();
    thing.confidence = 1;
    thing.is_certain = true;
    if (instance.region >= 0 && instance.region < static_cast<int>(rooms.size())) {
      thing.room = rooms[instance.region];
      thing.floor = truth.home.rooms[*thing.room].floor;
    }
    if (const auto paint = paints.find(instance.id); paint != paints.end())
      thing.colour = paint->second.Colour();
    names.insert(thing.category);
    truth.home.things.push_back(std::move(thing));
    truth.instances.push_back(instance.id);
  }
  truth.home.asked.assign(names.begin(), names.end());
  return truth;
}

}  // namespace crossnav::evaluation
