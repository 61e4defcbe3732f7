// SPDX-License-Identifier: MIT
#include "crossnav/scenegraph/cut_rooms.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace crossnav::scenegraph {
namespace {

constexpr double kFar = 1e12;
constexpr double kDoorwayReach_m = 0.4;  // chosen: half a doorway in a thick wall

/// Squared distances along one line, from the distances across it: min over j of (i - j)^2 +
/// line[j].
void LowerEnvelope(std::vector<double>& line) {
  const int n = static_cast<int>(line.size());
  std::vector<int> hull(line.size());
  std::vector<double> from(line.size() + 1);
  int top = 0;
  hull[0] = 0, from[0] = -kFar, from[1] = kFar;
  const auto meet = [&](int a, int b) {
    return (line[b] + 1.0 * b * b - line[a] - 1.0 * a * a) / (2.0 * (b - a));
  };
  for (int q = 1; q < n; ++q) {
    double s = meet(hull[top], q);
    while (top > 0 && s <= from[top]) s = meet(hull[--top], q);
    hull[++top] = q, from[top] = s, from[top + 1] = kFar;
  }
  std::vector<double> out(line.size());
  for (int q = 0, k = 0; q < n; ++q) {
    while (from[k + 1] < q) ++k;
    out[q] = 1.0 * (q - hull[k]) * (q - hull[k]) + line[hull[k]];
  }
  line = std::move(out);
}

/// Basins of the watershed as a forest, with the widest place of each root.
class Basins {
 public:
  explicit Basins(std::size_t cells) : parent_(cells, -1), peak_(cells, 0) {}

  bool Has(std::size_t cell) const { return parent_[cell] >= 0; }
  int RootOf(int cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }
  void Make(int cell, float peak) { parent_[cell] = cell, peak_[cell] = peak; }
  void Join(int cell, int root) { parent_[cell] = root; }
  float PeakOf(int root) const { return peak_[root]; }
  /// The wider root stays.
  int Merge(int a, int b) {
    if (peak_[b] > peak_[a] || (peak_[b] == peak_[a] && b < a)) std::swap(a, b);
    parent_[b] = a;
    return a;
  }

 private:
  std::vector<int> parent_;
  std::vector<float> peak_;
};

/// Basins around `cell`, each once, the widest first.
std::vector<int> RootsAround(const GridFrame& frame, std::size_t cell, Basins& basins) {
  std::vector<int> roots;
  ForEachBeside(frame, cell, kAround, [&](std::size_t beside) {
    if (!basins.Has(beside)) return;
    const int root = basins.RootOf(static_cast<int>(beside));
    if (std::find(roots.begin(), roots.end(), root) == roots.end()) roots.push_back(root);
  });
  std::sort(roots.begin(), roots.end(), [&](int a, int b) {
    return basins.PeakOf(a) != basins.PeakOf(b) ? basins.PeakOf(a) > basins.PeakOf(b) : a < b;
  });
  return roots;
}

/// Assigns the cell to the deepest adjacent basin; merges basins that meet in a wide place here.
void Flood(const PlanGrid<float>& distance, std::size_t cell, double wide_cells, double share,
           Basins& basins) {
  const float here = distance.cells[cell];
  std::vector<int> roots = RootsAround(distance.frame, cell, basins);
  if (roots.empty()) return basins.Make(static_cast<int>(cell), here);
  int best = -1;
  float deepest = -1;
  ForEachBeside(distance.frame, cell, kAround, [&](std::size_t beside) {
    if (!basins.Has(beside) || distance.cells[beside] <= deepest) return;
    deepest = distance.cells[beside];
    best = static_cast<int>(beside);
  });
  basins.Join(static_cast<int>(cell), basins.RootOf(best));
  for (std::size_t i = 1; i < roots.size(); ++i) {
    const int a = basins.RootOf(roots[0]), b = basins.RootOf(roots[i]);
    const double smaller = std::min(basins.PeakOf(a), basins.PeakOf(b));
    if (a != b && (here >= wide_cells || here >= share * smaller)) roots[0] = basins.Merge(a, b);
  }
}

PlanGrid<int> Watershed(const PlanGrid<float>& distance, double wide_cells, double share) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < distance.cells.size(); ++i)
    if (distance.cells[i] > 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance.cells[a] > distance.cells[b];
  });
  Basins basins(distance.cells.size());
  for (const std::size_t cell : order) Flood(distance, cell, wide_cells, share, basins);
  PlanGrid<int> rooms(distance.frame, kNoRoom);
  for (const std::size_t cell : order) rooms.cells[cell] = basins.RootOf(static_cast<int>(cell));
  return rooms;
}

/// Grows rooms over cells with `may(cell)`, ring by ring.
template <class F>
void Grow(PlanGrid<int>& rooms, int rings, F&& may) {
  for (int k = 0; k < rings; ++k) {
    std::vector<std::pair<std::size_t, int>> gained;
    for (std::size_t i = 0; i < rooms.cells.size(); ++i) {
      if (rooms.cells[i] != kNoRoom || !may(i)) continue;
      int room = kNoRoom;
      ForEachBeside(rooms.frame, i, kSides, [&](std::size_t beside) {
        if (room == kNoRoom) room = rooms.cells[beside];
      });
      if (room != kNoRoom) gained.emplace_back(i, room);
    }
    if (gained.empty()) return;
    for (const auto& [cell, room] : gained) rooms.cells[cell] = room;
  }
}

std::map<int, int> CellsOfRooms(const PlanGrid<int>& rooms) {
  std::map<int, int> cells;
  for (const int room : rooms.cells)
    if (room != kNoRoom) ++cells[room];
  return cells;
}

/// The neighbour with the longest border, or kNoRoom.
int NeighbourOf(const PlanGrid<int>& rooms, int room) {
  std::map<int, int> border;
  for (std::size_t i = 0; i < rooms.cells.size(); ++i) {
    if (rooms.cells[i] != room) continue;
    ForEachBeside(rooms.frame, i, kSides, [&](std::size_t beside) {
      const int other = rooms.cells[beside];
      if (other != room && other != kNoRoom) ++border[other];
    });
  }
  const auto most =
      std::max_element(border.begin(), border.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == border.end() ? kNoRoom : most->first;
}

/// Smallest first; a small room without a neighbour is removed.
void JoinSmall(PlanGrid<int>& rooms, double min_cells) {
  for (;;) {
    const auto cells = CellsOfRooms(rooms);
    const auto least =
        std::min_element(cells.begin(), cells.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (least == cells.end() || least->second >= min_cells) return;
    const int to = NeighbourOf(rooms, least->first);
    std::replace(rooms.cells.begin(), rooms.cells.end(), least->first, to);
  }
}

/// Numbers rooms 0, 1, ... by their first cell.
void Renumber(PlanGrid<int>& rooms) {
  std::map<int, int> names;
  for (int& room : rooms.cells)
    if (room != kNoRoom)
      room = names.try_emplace(room, static_cast<int>(names.size())).first->second;
}

}  // namespace

PlanGrid<float> WallDistance(const PlanGrid<FloorCell>& plan) {
  const GridFrame& frame = plan.frame;
  std::vector<double> squares(frame.Size());
  for (std::size_t i = 0; i < squares.size(); ++i)
    squares[i] = plan.cells[i] == FloorCell::kOpen ? kFar : 0;
  const auto width = static_cast<std::size_t>(frame.width);
  const auto height = static_cast<std::size_t>(frame.height);
  std::vector<double> line(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) line[y] = squares[y * width + x];
    LowerEnvelope(line);
    for (std::size_t y = 0; y < height; ++y) squares[y * width + x] = line[y];
  }
  line.resize(width);
  PlanGrid<float> distance(frame, 0);
  for (std::size_t y = 0; y < height; ++y) {
    std::copy_n(squares.begin() + static_cast<std::ptrdiff_t>(y * width), width, line.begin());
    LowerEnvelope(line);
    for (std::size_t x = 0; x < width; ++x)
      distance.cells[y * width + x] =
          line[x] > 0 ? static_cast<float>(std::sqrt(line[x]) - 0.5) : 0.0F;
  }
  return distance;
}

PlanGrid<int> CutRooms(const PlanGrid<FloorCell>& plan, double cell_m,
                       const RoomCutConfig& config) {
  if (plan.cells.empty()) return {};
  PlanGrid<int> rooms =
      Watershed(WallDistance(plan), 0.5 * config.passage_m / cell_m, config.share);
  JoinSmall(rooms, config.min_area_m2 / (cell_m * cell_m));
  Grow(rooms, static_cast<int>(std::lround(kDoorwayReach_m / cell_m)), [&](std::size_t cell) {
    return plan.cells[cell] == FloorCell::kLintel || plan.cells[cell] == FloorCell::kOpen;
  });
  Renumber(rooms);
  return rooms;
}

}  // namespace crossnav::scenegraph
