// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visit_maker.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/core/rng.h"
#include "crossnav/world/change/object_words.h"

namespace crossnav::evaluation {
namespace {

constexpr double kDetour_m = 1.5;          // chosen: least detour around a closed door
constexpr double kStaleNear_m = 1.5;       // as for STOP: a nearer instance is not gone
constexpr double kMinStart_m = 1.0;        // as dataset.min_first_goal_m
constexpr int kStarts = 60;                // chosen: draws of a start
constexpr int kMostStatic = 3;             // chosen: static goals of a later day with other goals
constexpr double kStartRounding_m = 1e-4;  // precision of the files

/// Instances of a goal.
int CountOf(const sim::Scene& scene, const std::string& goal, bool is_category) {
  return static_cast<int>(
      std::count_if(scene.instances.begin(), scene.instances.end(), [&](const auto& instance) {
        return !instance.box.empty() && (is_category ? instance.category : instance.name) == goal;
      }));
}

/// Name of one object alone, with one instance before and `now` instances after; empty without such
/// a name.
std::string OwnNameOf(const std::string& category, const std::string& name, int now,
                      const sim::Scene& before, const sim::Scene& after) {
  const auto is_only = [&](const std::string& goal, bool is_category) {
    return !goal.empty() && CountOf(before, goal, is_category) == 1 &&
           CountOf(after, goal, is_category) == now;
  };
  if (is_only(category, true)) return category;
  if (!IsCategory(name) && is_only(name, false)) return name;
  return {};
}

std::vector<int> FloorsReached(const SceneContext& context, const std::string& goal,
                               const Vector3d& p_world) {
  std::vector<int> floors;
  for (const auto& [floor, places] : context.PlacesOf(goal).on_floor) {
    if (context.navmesh().Geodesic(p_world, places)) floors.push_back(floor);
  }
  return floors;
}

/// Makes the visits of one house.
class Maker {
 public:
  Maker(const std::vector<VisitDay>& days, std::uint64_t seed) : days_(days), seed_(seed) {}

  Result<std::vector<HouseVisit>> Make() {
    std::vector<HouseVisit> later;
    for (std::size_t day = 1; day < days_.size(); ++day) {
      auto visit = MakeLater(day);
      if (!visit) return tl::unexpected(visit.error());
      later.push_back(std::move(*visit));
    }
    auto first = MakeFirst(later);
    if (!first) return tl::unexpected(first.error());
    later.insert(later.begin(), std::move(*first));
    return later;
  }

 private:
  const SceneContext& At(std::size_t day) const { return *days_[day].context; }

  /// Categories and names of one instance that can be found from `p_world` on the day.
  std::vector<std::string> Findable(std::size_t day, const Vector3d& p_world) const {
    std::set<std::string> names;
    for (const std::string_view category : kCategories) names.emplace(category);
    std::vector<std::string> goals;
    for (const std::string& name : names) {
      if (!FloorsReached(At(day), name, p_world).empty()) goals.push_back(name);
    }
    return goals;
  }

  /// Furniture and movable objects with a name of their own, as the goals of the other tracks have.
  std::set<std::string> FindableAlone(std::size_t day, const Vector3d& p_world) const {
    std::set<std::string> goals;
    for (const sim::SceneInstance& instance : At(day).scene().instances) {
      if (!world::IsLandmark(instance.name) && !world::IsMovable(instance.name, instance.category))
        continue;
      const std::string goal =
          OwnNameOf(instance.category, instance.name, 1, At(day - 1).scene(), At(day).scene());
      if (!goal.empty() && !FloorsReached(At(day), goal, p_world).empty()) goals.insert(goal);
    }
    return goals;
  }

  /// Goals that may have stayed: behind a closed door first, then objects with a name of their own,
  /// because an object with an instance on each floor is found soon without a memory.
  std::vector<std::string> Stayed(std::size_t day, const Vector3d& start_world, Rng& rng) const {
    const std::set<std::string> alone = FindableAlone(day, start_world);
    std::set<std::string> all = alone;
    for (const std::string& goal : Findable(day, start_world)) all.insert(goal);
    std::vector<std::string> goals(all.begin(), all.end());
    rng.Shuffle(goals);
    std::stable_partition(goals.begin(), goals.end(),
                          [&](const std::string& goal) { return alone.count(goal) > 0; });
    std::stable_partition(goals.begin(), goals.end(), [&](const std::string& goal) {
      return TrackOf(day, start_world, goal) == "doors";
    });
    return goals;
  }

  /// Goals without a changed instance in this night.
  bool IsStatic(std::size_t day, const std::string& goal) const {
    return std::none_of(days_[day].list.changes.begin(), days_[day].list.changes.end(),
                        [&](const world::Change& change) {
                          return change.category == goal || change.name == goal;
                        });
  }

  /// Stale places: an instance of the goal stood there on an earlier day, none on `day`.
  std::vector<Vector3d> StalePlaces(std::size_t day, const std::string& goal) const {
    std::vector<Vector3d> stale;
    for (std::size_t d = 1; d <= day; ++d) {
      for (const world::Change& change : days_[d].list.changes) {
        if (!change.from || (change.category != goal && change.name != goal)) continue;
        const Vector3d& p = change.from->p_world;
        const auto& targets = At(day).TargetsOf(goal);
        const bool is_taken = std::any_of(targets.begin(), targets.end(), [&](const auto& target) {
          return target.box.HorizontalDistance(p) < kStaleNear_m &&
                 std::abs(target.box.min.z() - p.z()) < kStaleNear_m;
        });
        if (!is_taken) stale.push_back(p);
      }
    }
    return stale;
  }

  VisitGoal GoalAt(std::size_t day, const std::string& goal, std::string_view track,
                   const Vector3d& p_world) const {
    VisitGoal made;
    made.goal = goal;
    made.track = track;
    made.is_absent = At(day).TargetsOf(goal).empty();
    made.floors = FloorsReached(At(day), goal, p_world);
    made.stale_world = StalePlaces(day, goal);
    return made;
  }

  /// Whether the place that the goal left can be reached on the day; otherwise nobody can tell that
  /// the goal is gone.
  bool IsOldPlaceReached(std::size_t day, const std::string& goal, const Vector3d& p_world) const {
    const auto& targets = At(day - 1).TargetsOf(goal);
    return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
      return At(day).navmesh().Geodesic(p_world, target.viewpoints_world).has_value();
    });
  }

  std::vector<VisitGoal> ChangedGoals(std::size_t day, const Vector3d& p_world) const {
    std::vector<VisitGoal> goals;
    for (const world::Change& change : days_[day].list.changes) {
      const bool is_moved = world::IsMove(change.kind);
      if (!is_moved && change.kind != world::ChangeKind::kRemoved) continue;
      const std::string goal = OwnNameOf(change.category, change.name, is_moved ? 1 : 0,
                                         At(day - 1).scene(), At(day).scene());
      if (goal.empty()) continue;
      VisitGoal made = GoalAt(day, goal, world::NameOf(change.kind), p_world);
      if (made.is_absent == is_moved || (is_moved && made.floors.empty())) continue;
      if (made.is_absent && !IsOldPlaceReached(day, goal, p_world)) continue;
      goals.push_back(std::move(made));
    }
    return goals;
  }

  /// Distance to a goal from a place that may not be walkable on that day.
  std::optional<double> Distance(std::size_t day, const Vector3d& p_world,
                                 const std::string& goal) const {
    return At(day).DistanceToGoalFromAbout(p_world, goal);
  }

  /// Track of a goal that stayed: behind a door that was closed overnight, or static.
  std::string TrackOf(std::size_t day, const Vector3d& from_world, const std::string& goal) const {
    const bool has_bars = std::any_of(
        days_[day].list.changes.begin(), days_[day].list.changes.end(),
        [](const auto& change) { return change.kind >= world::ChangeKind::kDoorClosed; });
    if (!has_bars) return "static";
    const auto before_m = Distance(day - 1, from_world, goal);
    const auto now_m = Distance(day, from_world, goal);
    return before_m && now_m && *now_m > *before_m + kDetour_m ? "doors" : "static";
  }

  /// End of a search for the goal from `from_world`.
  Vector3d StopOf(std::size_t day, const Vector3d& from_world, const std::string& goal) const {
    std::vector<Vector3d> places;
    for (const Target& target : At(day).TargetsOf(goal)) {
      if (!target.is_confirmable) continue;
      places.insert(places.end(), target.viewpoints_world.begin(), target.viewpoints_world.end());
    }
    std::size_t nearest = 0;
    if (places.empty() || !At(day).navmesh().Geodesic(from_world, places, &nearest)) {
      return from_world;
    }
    return places[nearest];
  }

  std::optional<AgentPose> DrawStart(std::size_t day, Rng& rng) const {
    const auto& navmesh = At(day).navmesh();
    for (int i = 0; i < kStarts; ++i) {
      const auto p = navmesh.RandomPoint(rng);
      const double yaw_rad = WrapAngle(DegToRad(rng.Int(0, 359)));
      if (!p) continue;
      AgentPose start;
      for (int axis = 0; axis < 3; ++axis) {
        start.p_world[axis] = std::round((*p)[axis] / kStartRounding_m) * kStartRounding_m;
      }
      start.yaw_rad = yaw_rad;
      const bool is_on_floor =
          std::any_of(navmesh.Floors().begin(), navmesh.Floors().end(),
                      [&](const auto& floor) { return floor.GapTo(start.p_world.z()) <= 0.1; });
      if (is_on_floor && Findable(day, start.p_world).size() >= 3) return start;
    }
    return std::nullopt;
  }

  /// Orders the goals, each from the previous stop, first a goal that a closed door makes farther;
  /// sets the tracks of goals that stayed.
  void Arrange(std::size_t day, HouseVisit& visit, Rng& rng) const {
    const Vector3d& start = visit.start.p_world;
    rng.Shuffle(visit.goals);
    const auto far_enough = std::find_if(visit.goals.begin(), visit.goals.end(), [&](auto& goal) {
      const auto first_m = Distance(day, start, goal.goal);
      return goal.is_absent || (first_m && *first_m >= kMinStart_m);
    });
    const auto behind_door = std::find_if(visit.goals.begin(), visit.goals.end(), [&](auto& goal) {
      return goal.track == "static" && TrackOf(day, start, goal.goal) == "doors";
    });
    const auto first = behind_door != visit.goals.end() ? behind_door : far_enough;
    if (first != visit.goals.end()) std::iter_swap(visit.goals.begin(), first);
    Vector3d from = visit.start.p_world;
    for (VisitGoal& goal : visit.goals) {
      if (goal.track == "static") goal.track = TrackOf(day, from, goal.goal);
      if (!goal.is_absent) from = StopOf(day, from, goal.goal);
    }
  }

  Result<HouseVisit> MakeLater(std::size_t day) const {
    Rng rng(MixSeed(seed_, day));
    HouseVisit visit = Begin(day);
    const auto start = DrawStart(day, rng);
    if (!start) return NoVisit(visit);
    visit.start = *start;
    visit.goals = ChangedGoals(day, start->p_world);
    const std::vector<std::string> stayed = Stayed(day, start->p_world, rng);
    int of_static = 0;
    for (const std::string& goal : stayed) {
      const auto count = static_cast<int>(visit.goals.size());
      if (!IsStatic(day, goal) || count >= kMostVisitGoals) continue;
      if (of_static >= kMostStatic && count >= kLeastVisitGoals) break;
      visit.goals.push_back(GoalAt(day, goal, "static", start->p_world));
      ++of_static;
    }
    if (static_cast<int>(visit.goals.size()) < kLeastVisitGoals) return NoVisit(visit);
    Arrange(day, visit, rng);
    return visit;
  }

  Result<HouseVisit> MakeFirst(const std::vector<HouseVisit>& later) const {
    Rng rng(MixSeed(seed_, 0));
    HouseVisit visit = Begin(0);
    const auto start = DrawStart(0, rng);
    if (!start) return NoVisit(visit);
    visit.start = *start;
    std::vector<std::string> wanted;
    for (const bool has_stayed : {false, true}) {
      for (const HouseVisit& day : later) {
        for (const VisitGoal& goal : day.goals) {
          if ((goal.track == "static" || goal.track == "doors") == has_stayed)
            wanted.push_back(goal.goal);
        }
      }
    }
    for (const std::string& goal : Findable(0, start->p_world)) wanted.push_back(goal);
    std::set<std::string> taken;
    for (const std::string& goal : wanted) {
      if (static_cast<int>(visit.goals.size()) >= kMostVisitGoals) break;
      if (!taken.insert(goal).second) continue;
      VisitGoal made = GoalAt(0, goal, "first", start->p_world);
      if (!made.floors.empty()) visit.goals.push_back(std::move(made));
    }
    if (static_cast<int>(visit.goals.size()) < kLeastVisitGoals) return NoVisit(visit);
    Arrange(0, visit, rng);
    return visit;
  }

  HouseVisit Begin(std::size_t day) const {
    HouseVisit visit;
    visit.house = days_.front().context->scene().id;
    visit.day = static_cast<int>(day);
    visit.scene_id = days_[day].scene_id;
    return visit;
  }

  tl::unexpected<Error> NoVisit(const HouseVisit& visit) const {
    return Fail(ErrorCode::kInvalid, "fewer than five goals can be reached from one start",
                visit.scene_id);
  }

  const std::vector<VisitDay>& days_;
  std::uint64_t seed_;
};

}  // namespace

Result<std::vector<HouseVisit>> MakeVisits(const std::vector<VisitDay>& days, std::uint64_t seed) {
  return Maker(days, seed).Make();
}

std::vector<std::string> CheckVisit(const SceneContext& context, const HouseVisit& visit) {
  std::vector<std::string> problems;
  const auto start = context.navmesh().Snap(visit.start.p_world);
  if (!start) return {"the start lies off the navmesh"};
  for (const VisitGoal& goal : visit.goals) {
    const bool has_none = context.TargetsOf(goal.goal).empty();
    if (has_none != goal.is_absent) {
      problems.push_back(goal.goal + (has_none ? " is not there" : " is there"));
    }
    if (FloorsReached(context, goal.goal, *start) != goal.floors) {
      problems.push_back(goal.goal + ": other floors hold a reachable instance");
    }
    if (!goal.is_absent && goal.floors.empty()) {
      problems.push_back(goal.goal + " cannot be reached");
    }
  }
  return problems;
}

}  // namespace crossnav::evaluation
