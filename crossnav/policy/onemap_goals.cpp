// SPDX-License-Identifier: MIT
#include "crossnav/policy/onemap_goals.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

#include "crossnav/core/cells.h"

namespace crossnav::policy {
namespace {

constexpr Column kColumnSides[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

Column operator+(const Column& a, const Column& b) {
  return {a.x + b.x, a.y + b.y};
}

double SimilarityAt(const OneMapView& view, const Column& c, double otherwise) {
  const auto it = view.similarity.find(c);
  return it == view.similarity.end() ? otherwise : it->second;
}

bool IsExplored(const OneMapView& view, const Column& c) {
  return view.map.IsExplored(c, view.config);
}

/// Visits columns in order of their steps from `seeds`, as long as `may_enter`; `visit` returns
/// false to stop.
template <class Enter, class Visit>
void Flood(const std::vector<Column>& seeds, int max_steps, const Enter& may_enter,
           const Visit& visit) {
  std::set<Column> seen(seeds.begin(), seeds.end());
  std::deque<std::pair<Column, int>> queue;
  for (const Column& seed : seeds) queue.emplace_back(seed, 0);
  while (!queue.empty()) {
    const auto [column, steps] = queue.front();
    queue.pop_front();
    if (!visit(column)) return;
    if (steps == max_steps) continue;
    for (const Column& side : kColumnSides) {
      const Column next = column + side;
      if (may_enter(next) && seen.insert(next).second) queue.emplace_back(next, steps + 1);
    }
  }
}

/// Sets of columns that touch at sides or corners, each sorted.
std::vector<std::vector<Column>> Clusters(std::set<Column> rest) {
  std::vector<std::vector<Column>> clusters;
  while (!rest.empty()) {
    std::vector<Column> cluster{*rest.begin()};
    rest.erase(rest.begin());
    for (std::size_t i = 0; i < cluster.size(); ++i)
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          const auto it = rest.find(cluster[i] + Column{dx, dy});
          if (it == rest.end()) continue;
          cluster.push_back(*it);
          rest.erase(it);
        }
    std::sort(cluster.begin(), cluster.end());
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

Column MiddleOf(const std::vector<Column>& columns) {
  double x = 0, y = 0;
  for (const Column& c : columns) x += c.x, y += c.y;
  x /= static_cast<double>(columns.size()), y /= static_cast<double>(columns.size());
  return *std::min_element(columns.begin(), columns.end(), [&](const Column& a, const Column& b) {
    return std::hypot(a.x - x, a.y - y) < std::hypot(b.x - x, b.y - y);
  });
}

/// Unexplored and nothing that blocks: unobserved columns may be anything.
bool IsOpen(const OneMapView& view, const Column& c) {
  if (IsExplored(view, c)) return false;
  return view.standing.contains(c) || !view.map.IsObserved(c);
}

/// Open columns beside explored ground with a place to stand.
std::set<Column> FrontierColumns(const OneMapView& view) {
  std::set<Column> border;
  for (const auto& [column, standing] : view.standing) {
    if (!IsExplored(view, column)) continue;
    for (const Column& side : kColumnSides)
      if (IsOpen(view, column + side)) border.insert(column + side);
  }
  return border;
}

bool HasUnexploredGround(const OneMapView& view, const std::vector<Column>& frontier) {
  const double wanted = view.config.min_unexplored_m2 / (view.voxel_m * view.voxel_m);
  double count = 0;
  Flood(
      frontier, -1, [&](const Column& c) { return IsOpen(view, c); },
      [&](const Column&) { return ++count < wanted; });
  return count >= wanted;
}

/// Largest cosine within one column, where any is known: OneMap blurs its map.
double BlurredSimilarity(const OneMapView& view, const Column& c) {
  double best = -1;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      best = std::max(best, SimilarityAt(view, c + Column{dx, dy}, -1));
  return best;
}

/// Largest cosine + 1 within the depth behind the frontier's middle.
double FrontierScore(const OneMapView& view, const Column& middle) {
  double best = 0;
  Flood(
      {middle}, CellsFloor(view.config.frontier_depth_m, view.voxel_m),
      [&](const Column& c) { return view.map.IsObserved(c) && !IsExplored(view, c); },
      [&](const Column& c) {
        best = std::max(best, 1 + BlurredSimilarity(view, c));
        return true;
      });
  return best;
}

void AddFrontiers(const OneMapView& view, std::vector<OneMapGoal>* goals) {
  for (auto& frontier : Clusters(FrontierColumns(view))) {
    if (!HasUnexploredGround(view, frontier)) continue;
    const Column middle = MiddleOf(frontier);
    goals->push_back({true, middle, std::move(frontier), FrontierScore(view, middle)});
  }
}

/// Largest value within `window` of each element of a row of `n`, `stride` apart.
void MaxFilter(const std::vector<double>& from, std::size_t first, std::size_t stride, int n,
               int window, std::vector<double>* to) {
  for (int i = 0; i < n; ++i) {
    double largest = -2;
    for (int j = std::max(0, i - window); j <= std::min(n - 1, i + window); ++j)
      largest = std::max(largest, from[first + static_cast<std::size_t>(j) * stride]);
    (*to)[first + static_cast<std::size_t>(i) * stride] = largest;
  }
}

/// The columns that are the largest within the peak window, best first.
std::vector<Column> Peaks(const OneMapView& view) {
  const int window = CellsFloor(view.config.peak_window_m, view.voxel_m);
  Column lo = view.similarity.begin()->first, hi = lo;
  for (const auto& [c, similarity] : view.similarity) {
    lo = {std::min(lo.x, c.x), std::min(lo.y, c.y)};
    hi = {std::max(hi.x, c.x), std::max(hi.y, c.y)};
  }
  const int nx = hi.x - lo.x + 1, ny = hi.y - lo.y + 1;
  const auto width = static_cast<std::size_t>(nx);
  const auto at = [&](const Column& c) {
    return static_cast<std::size_t>(c.y - lo.y) * width + static_cast<std::size_t>(c.x - lo.x);
  };
  std::vector<double> field(width * static_cast<std::size_t>(ny), -2), rows = field,
                                                                       largest = field;
  for (const auto& [c, similarity] : view.similarity) field[at(c)] = similarity;
  for (int y = 0; y < ny; ++y)
    MaxFilter(field, static_cast<std::size_t>(y) * width, 1, nx, window, &rows);
  for (int x = 0; x < nx; ++x)
    MaxFilter(rows, static_cast<std::size_t>(x), width, ny, window, &largest);
  std::vector<Column> peaks;
  for (const auto& [c, similarity] : view.similarity)
    if (similarity >= largest[at(c)]) peaks.push_back(c);
  std::stable_sort(peaks.begin(), peaks.end(),
                   [&](const Column& a, const Column& b) { return field[at(a)] > field[at(b)]; });
  return peaks;
}

/// High-similarity regions of explored ground that were not checked for this goal yet.
void AddPointsOfInterest(const OneMapView& view, std::vector<OneMapGoal>* goals) {
  if (view.similarity.empty()) return;
  const auto [low, high] =
      std::minmax_element(view.similarity.begin(), view.similarity.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  const double least = low->second, range = high->second - low->second;
  if (range <= 0) return;
  std::set<Column> taken;
  for (const Column& peak : Peaks(view)) {
    if (taken.contains(peak)) continue;
    const double floor = view.config.cluster_share * (view.similarity.at(peak) - least);
    OneMapGoal goal{false, peak, {}, 1 + view.similarity.at(peak)};
    Flood(
        {peak}, -1,
        [&](const Column& c) {
          return !taken.contains(c) && SimilarityAt(view, c, least - 1) - least >= floor;
        },
        [&](const Column& c) { return goal.columns.push_back(c), true; });
    taken.insert(goal.columns.begin(), goal.columns.end());
    std::sort(goal.columns.begin(), goal.columns.end());
    const bool is_open = IsExplored(view, peak) && !view.map.IsChecked(peak, view.config);
    if (is_open && goal.columns.size() >= 2) goals->push_back(std::move(goal));
  }
}

}  // namespace

double DistanceOf(const Column& a, const Column& b, double voxel_m) {
  return voxel_m * std::hypot(a.x - b.x, a.y - b.y);
}

std::vector<OneMapGoal> OneMapGoals(const OneMapView& view) {
  std::vector<OneMapGoal> goals;
  AddPointsOfInterest(view, &goals);
  AddFrontiers(view, &goals);
  std::stable_sort(goals.begin(), goals.end(), [](const OneMapGoal& a, const OneMapGoal& b) {
    return a.score != b.score ? a.score > b.score : a.center < b.center;
  });
  return goals;
}

int ChooseOneMapGoal(const std::vector<OneMapGoal>& goals, const OneMapGoal* last,
                     const OneMapView& view) {
  if (goals.empty()) return -1;
  if (last == nullptr) return 0;
  int nearest = 0;
  const auto distance_m = [&](int i) {
    return DistanceOf(goals[static_cast<std::size_t>(i)].center, last->center, view.voxel_m);
  };
  for (int i = 1; i < static_cast<int>(goals.size()); ++i)
    if (distance_m(i) < distance_m(nearest)) nearest = i;
  const bool is_there = distance_m(nearest) <= view.config.same_goal_m;
  const double score = goals[static_cast<std::size_t>(nearest)].score;
  return is_there && score + view.config.keep_score > last->score ? nearest : 0;
}

bool HasConsensus(const Column& column, const OneMapView& view) {
  if (view.similarity.empty()) return false;
  std::vector<double> sorted;
  for (const auto& [c, similarity] : view.similarity) sorted.push_back(similarity);
  const auto at = static_cast<std::size_t>(view.config.consensus_quantile *
                                           static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
  const int reach = CellsFloor(view.config.consensus_reach_m, view.voxel_m);
  for (int dx = -reach; dx <= reach; ++dx)
    for (int dy = -reach; dy <= reach; ++dy)
      if (SimilarityAt(view, column + Column{dx, dy}, -2) >= sorted[at]) return true;
  return false;
}

}  // namespace crossnav::policy
