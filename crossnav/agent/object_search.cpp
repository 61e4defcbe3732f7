// SPDX-License-Identifier: MIT
#include "crossnav/agent/object_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "crossnav/agent/exploration_candidates.h"
#include "crossnav/agent/explore.h"
#include "crossnav/agent/passing_sights.h"
#include "crossnav/agent/poi_targets.h"
#include "crossnav/agent/search_shares.h"
#include "crossnav/agent/search_tours.h"
#include "crossnav/agent/search_views.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/objects/alias.h"
#include "crossnav/policy/frontier_worth.h"
#include "crossnav/scenegraph/build_graph.h"

namespace crossnav::agent {

using geometry::VoxelKey;
using objects::KnownAs;
using policy::Candidate;
using policy::CandidateKind;
using policy::SearchPatch;

namespace {

constexpr double kWide_m = 0.4;    // chosen: reaches into the next patch
constexpr double kHintGain = 0.5;  // chosen: half of the hints are the goal
constexpr double kCommit = 0.8;    // chosen: price of the target in progress, as a share
constexpr double kStay = 0.5;    // chosen: likewise of its room and floor: coming back costs a way
constexpr double kAround_m = 6;  // chosen: patches about the agent, a view and a step
constexpr int kRefresh_steps = 6;     // chosen: as policy.explore.reconsider_steps
constexpr double kMostUnseen = 0.2;   // chosen: of a search without a view left
constexpr double kMostPrice_m = 400;  // chosen: for the chance of finding the goal
constexpr double kLowPrice_m = 140;   // chosen: likewise where it is probably gone
constexpr double kBeside_m = 0.5;  // chosen: the middle of a remembered place and the record's box
constexpr double kCutOff = 0.05;   // chosen: a room or a floor, not corners
constexpr double kClose = 0.6;     // chosen: of the range, near enough for small things
constexpr double kLeftOver = 0.2;  // chosen: of a room's area that earlier days left unseen; the
                                   // rest is in walls

void UpdateAllFloors(StepState& now) {
  const auto& graph = now.world.revision->graph;
  const double eye_m = now.config.sensor.camera_height_m;
  for (std::size_t floor = 0; floor < graph.plans.size(); ++floor) {
    const auto& frame = graph.plans[floor].frame;
    now.world.full.field.Update(now.world.map, graph.floors[floor].height_m, eye_m,
                                {frame.x0, frame.y0, 0},
                                {frame.x0 + frame.width - 1, frame.y0 + frame.height - 1, 0});
  }
}

void UpdateAround(StepState& now) {
  const double voxel_m = now.config.map.voxel_m;
  const Vector3d reach(kAround_m, kAround_m, 0);
  now.world.full.field.Update(now.world.map, now.world.level_m, now.config.sensor.camera_height_m,
                              geometry::KeyOf(now.agent.p_world - reach, voxel_m),
                              geometry::KeyOf(now.agent.p_world + reach, voxel_m));
}

/// The point that the camera looks at from `place`: on the ground, or as high as the camera.
Vector3d FocusOf(const Situation& now, const VoxelKey& place, const SearchView& view) {
  constexpr double kLevel_m = 3.0;  // chosen: any way off; it tells views of other headings apart
  const double camera_m = now.config.sensor.camera_height_m;
  const Vector3d ahead(std::cos(view.heading_rad), std::sin(view.heading_rad), 0);
  const Vector3d p_foot = FootOf(place, now.config.map.voxel_m);
  if (view.pitch_rad >= 0) return p_foot + Vector3d(0, 0, camera_m) + kLevel_m * ahead;
  return p_foot + camera_m / std::tan(std::max(-view.pitch_rad, DegToRad(10))) * ahead;
}

double ArrivalHeading(const Situation& now, const std::vector<VoxelKey>& path) {
  constexpr std::size_t kHeading = 5;  // chosen: places of a path that give its direction
  if (path.size() < 2) return now.agent.yaw_rad;
  const VoxelKey along = path.back() - path[path.size() - 1 - std::min(kHeading, path.size() - 1)];
  return std::atan2(along.y, along.x);
}

/// Area of the known ground [m2].
double KnownArea(const Situation& now) {
  const double voxel_m = now.config.map.voxel_m;
  double area_m2 = 0;
  for (const auto& [cell, patch] : now.world.full.field.patches())
    if (patch.height_m < kFurnitureTop_m) area_m2 += patch.columns * voxel_m * voxel_m;
  return std::max(area_m2, 1.0);
}

/// Ground in an area that earlier days left unseen. Walls explain no more than a room's area.
double LeftOver(double unseen_m2) {
  const double in_walls_m2 = std::min(unseen_m2, kRoom_m2);
  return kLeftOver * in_walls_m2 + (unseen_m2 - in_walls_m2);
}

/// Probability of what lies behind an explored candidate; 0 = not worth going to.
double GainOf(const Situation& now, const ExplorationCandidate& found, double known_m2) {
  switch (found.type) {
    case ExplorationClass::kHint:
    case ExplorationClass::kHintFromAfar:
      return kHintGain;
    case ExplorationClass::kFlight:
      return 1.0 / static_cast<double>(1 + now.world.levels_m.size());
    case ExplorationClass::kUninspected:
      return 0;
    case ExplorationClass::kFrontier:
      break;
  }
  if (!IsOnFloor(now.world, FootOf(found.place, now.config.map.voxel_m).z())) return 0;
  const double gain =
      policy::UnseenBeyond(now.world.ground, found.place, now.config.policy.explore.view_range_m) /
      known_m2;
  return gain < kLeastGain ? 0 : gain;
}

/// Prices of one search: metres for the probability. Keeps a reference to the situation.
class SearchPrices {
 public:
  explicit SearchPrices(const Situation& now)
      : now_(now),
        start_m_(now.config.policy.explore.start_m),
        known_m2_(KnownArea(now)),
        is_over_(IsSearchOver(now)),
        views_(now),
        tours_(now),
        candidates_(now) {
    const Pursuit& pursuit = PursuitOf(now.goal.full.activity);
    if (IsExploring(pursuit)) current_ = &PursuedIn(pursuit)->target;
    if (current_ && current_->kind == CandidateKind::kSearchView)
      current_room_ = tours_.RoomOf(current_->standing.front());
  }

  /// The least price that a candidate at the end of `path_m` can have.
  double Least(double path_m, double gain) const {
    return std::min(kCommit, kStay) * (path_m + start_m_) / gain;
  }
  /// The least price that anything farther than `path_m` can have.
  double Least(double path_m) const {
    return Least(path_m, std::max(kHintGain, tours_.most_gain()));
  }
  double best() const { return best_; }
  std::vector<PricedCandidate> Take() {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      GroundTarget& target = all_[i].target;
      target.score_m = tours_.Score(rooms_[i], target.score_m, current_room_, kStay);
      target.candidate.score = -target.score_m;
    }
    return std::move(all_);
  }

  /// Frontiers, flights and hints at `place`.
  void AddExplored(const planner::GroundSearch& search, const VoxelKey& place, double path_m) {
    for (ExplorationCandidate& found : candidates_.At(place)) {
      const double gain = GainOf(now_, found, known_m2_);
      const bool is_pocket =
          found.type == ExplorationClass::kFrontier && gain * known_m2_ < kRoom_m2;
      if (gain <= 0 || (is_over_ && is_pocket)) continue;
      const bool is_old = found.type == ExplorationClass::kFrontier && now_.world.revision;
      Add(std::move(found.candidate), search.PathTo(place), path_m,
          is_old ? LeftOver(gain * known_m2_) / known_m2_ : gain, {});
    }
  }

  /// The best view from the first place of each coarse cell.
  void AddView(const planner::GroundSearch& search, const VoxelKey& place, double path_m) {
    if (!asked_.insert(ViewCellOf(place)).second) return;
    const double bound = views_.Bound(place);
    if (bound < kLeastGain) return;
    const auto room = tours_.RoomOf(place);
    if (!tours_.CanBeChosen(room, path_m, Least(path_m, bound), best_, kStay)) return;
    std::vector<VoxelKey> path = search.PathTo(place);
    auto view = views_.From(place, path_m, ArrivalHeading(now_, path));
    if (!view) return;
    Candidate candidate;
    candidate.kind = CandidateKind::kSearchView;
    candidate.p_focus_world = FocusOf(now_, place, *view);
    candidate.standing = {place};
    candidate.beyond = std::move(view->cells);
    candidate.size = static_cast<int>(candidate.beyond.size());
    const auto& explore = now_.config.policy.explore;
    if (IsSpent(now_.goal.full.attempts, candidate.kind, candidate.p_focus_world,
                explore.same_place_m, explore.max_choices))
      return;
    Add(std::move(candidate), std::move(path), view->cost_m, view->gain, room);
  }

 private:
  bool IsCurrent(const Candidate& candidate) const {
    return current_ && current_->kind == candidate.kind &&
           (current_->p_focus_world - candidate.p_focus_world).norm() <=
               2 * now_.config.policy.explore.same_place_m;
  }

  void Add(Candidate candidate, std::vector<VoxelKey> path, double cost_m, double gain,
           std::optional<int> room) {
    PricedCandidate priced;
    GroundTarget& target = priced.target;
    target.cost_m = cost_m;
    target.score_m = (cost_m + start_m_) / gain * (IsCurrent(candidate) ? kCommit : 1);
    target.path = std::move(path);
    target.candidate = std::move(candidate);
    best_ = std::min(best_, tours_.Add(room, cost_m, target.score_m));
    all_.push_back(std::move(priced));
    rooms_.push_back(room);
  }

  const Situation& now_;
  double start_m_, known_m2_;
  bool is_over_;
  SearchViews views_;
  SearchTours tours_;
  ExplorationCandidates candidates_;
  const Candidate* current_ = nullptr;  // the target in progress
  std::set<VoxelKey> asked_;
  double best_ = std::numeric_limits<double>::infinity();
  std::vector<PricedCandidate> all_;
  std::vector<std::optional<int>> rooms_;  // of `all_`
  std::optional<int> current_room_;
};

/// The goal was seen and not approached, or a believed record was not visited, because no way leads
/// there.
bool HasPlaceBeyondReach(const Situation& now) {
  if (!now.goal.live.Stable(now.config.policy.object).empty()) return true;
  const auto& book = now.world.objects;
  const std::string category = KnownAs(book.records(), now.goal.goal);
  const auto is_believed = [&](const HistoryPoi& poi) {
    return std::any_of(book.records().begin(), book.records().end(), [&](const auto& record) {
      return record.category == category && record.views > 0 && !book.IsGone(record) &&
             record.box_world_m.exteriorDistance(poi.p_center_world) <= kBeside_m;
    });
  };
  const auto& history = now.goal.history;
  return std::any_of(history.begin(), history.end(),
                     [&](const HistoryPoi& poi) { return !poi.is_exhausted && is_believed(poi); });
}

bool HasPlaceLeft(const Situation& now) {
  const auto& history = now.goal.history;
  return std::any_of(history.begin(), history.end(),
                     [&](const HistoryPoi& poi) { return IsToBeVisited(now, poi); });
}

/// Whether `price_m` is low for the chance of finding the goal. Prices are per share, and shares
/// are probabilities from before the search.
bool IsWorth(const Situation& now, double price_m) {
  const double unseen = now.goal.full.search->unseen;
  const double gone = objects::OddsOfAbsence(unseen);
  const double limit_m = gone >= now.config.memory.absent_from ? kLowPrice_m : kMostPrice_m;
  return price_m * unseen <= limit_m * (1 - gone);
}

/// Probabilities of the patches and of what is left to see.
void Weigh(const World& world, const GoalState& goal, ObjectSearch* search) {
  search->step = world.step;
  search->shares = SharesOf(world, goal, search->odds);
  search->unseen = 0;
  for (const auto& [cell, patch] : world.full.field.patches())
    if (const auto it = search->shares.find(cell); it != search->shares.end())
      search->unseen += it->second * Unnoticed(world.full.field, cell, patch, *search);
}

}  // namespace

void BeginSearchWhereDue(StepState& now) {
  auto& search = now.goal.full.search;
  if (search || !now.world.revision || HasPlaceLeft(now)) return;
  UpdateRooms(&now.world);
  LocateObjects(&now.world);
  const std::string category = KnownAs(now.world.objects.records(), now.goal.goal);
  search.emplace();
  search->was_noticed = WasNoticedThroughout(now.world, now.goal.goal);
  const NoticeRanges ranges = RangesOfNotice(now.world, now.goal, now.config);
  search->notice_range_m = ranges.probably_m;
  search->sure_range_m = ranges.surely_m;
  search->missed = ranges.missed;
  const Vector3d sides_m = UsualSides(now.world, category);
  search->is_tall = sides_m.z() >= SearchPatch::kHigh_m;
  search->is_wide = sides_m.head<2>().maxCoeff() >= kWide_m;
  search->hidden = PatchesOutOfSight(now, *search);
  search->odds = OddsOf(now.world, now.goal);
  Weigh(now.world, now.goal, &*search);
}

void UpdateSearch(StepState& now) {
  auto& search = now.goal.full.search;
  if (now.world.step % kRefresh_steps == 0 && StandsOnFloor(now)) UpdateAround(now);
  if (now.world.revision && now.world.step == 0) UpdateAllFloors(now);
  now.world.full.field.Look(now.obs, now.config.policy.explore.inspect_range_m);
  BeginSearchWhereDue(now);
  if (!search || (search->step >= 0 && now.world.step - search->step < kRefresh_steps)) return;
  if (!search->odds.empty() && UpdateRooms(&now.world)) {
    LocateObjects(&now.world);
    search->odds = OddsOf(now.world, now.goal);
  }
  Weigh(now.world, now.goal, &*search);
}

bool BeginCloseSearch(StepState& now) {
  auto& search = now.goal.full.search;
  if (search) return false;
  search.emplace();
  search->notice_range_m = kClose * now.config.policy.explore.inspect_range_m;
  search->sure_range_m = search->notice_range_m;
  UpdateSearch(now);
  return true;
}

bool LeaveOutHidden(StepState& now) {
  auto& search = now.goal.full.search;
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  if (!search || !now.world.revision || !start) return false;
  const auto before = search->hidden.size();
  search->hidden.merge(PatchesOutOfReach(now, *start, *search));
  if (search->hidden.size() == before) return false;
  Weigh(now.world, now.goal, &*search);
  return true;
}

void SearchNearer(StepState& now, double share_of_range) {
  now.world.full.field.BeginGoal();
  if (auto& search = now.goal.full.search) {
    search->notice_range_m *= share_of_range;
    search->sure_range_m *= share_of_range;
    search->was_noticed = false;
    search->settled.clear();
    search->step = -1;
  }
}

std::vector<PricedCandidate> PriceSearch(const Situation& now, const VoxelKey& start) {
  SearchPrices prices(now);
  planner::GroundSearch search(now.world.ground, now.config.planner, start, RulesOf(now));
  while (const auto place = search.Next()) {
    const double path_m = search.cost() * now.config.map.voxel_m;
    // A hook may prefer candidates that are far away.
    if (!now.hooks && prices.Least(path_m) >= prices.best()) break;
    prices.AddExplored(search, *place, path_m);
    prices.AddView(search, *place, path_m);
  }
  if (IsSearchOver(now) && !IsWorth(now, prices.best())) return {};
  return prices.Take();
}

bool IsViewOpen(const Situation& now, const Candidate& view) {
  if (!now.goal.full.search) return false;
  const ObjectSearch& search = *now.goal.full.search;
  const auto& patches = now.world.full.field.patches();
  double gain = 0;
  for (const VoxelKey& cell : view.beyond) {
    const auto patch = patches.find(cell);
    const auto share = search.shares.find(cell);
    if (patch != patches.end() && share != search.shares.end())
      gain += share->second * Unnoticed(now.world.full.field, cell, patch->second, search);
  }
  return gain >= kLeastGain;
}

void SettleView(StepState& now, const Candidate& view) {
  if (auto& search = now.goal.full.search)
    search->settled.insert(view.beyond.begin(), view.beyond.end());
}

bool IsPartCutOff(const Situation& now) {
  const auto& search = now.goal.full.search;
  const auto start = now.world.ground.StandingAt(now.agent.p_world);
  if (!search || !start) return false;
  double unseen = 0;
  for (const VoxelKey& cell : PatchesOutOfReach(now, *start, *search))
    if (const auto share = search->shares.find(cell); share != search->shares.end())
      unseen += share->second * Unnoticed(now.world.full.field, cell,
                                          now.world.full.field.patches().at(cell), *search);
  return unseen >= kCutOff;
}

bool IsSearchOver(const Situation& now) {
  const auto& search = now.goal.full.search;
  return search && now.world.revision && !HasPlaceBeyondReach(now) && search->unseen <= kMostUnseen;
}

}  // namespace crossnav::agent
