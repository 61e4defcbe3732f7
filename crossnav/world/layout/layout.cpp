// SPDX-License-Identifier: MIT
#include "crossnav/world/layout/layout.h"

#include <algorithm>
#include <cmath>

#include "crossnav/world/layout/stair_draw.h"

namespace crossnav::world {
namespace {

constexpr double kMinCell_m = 2.0;     // chosen: narrower cells are cupboards
constexpr double kMinStrip_m = 2.5;    // chosen: depth of a usable room
constexpr double kDeepCell_m = 5.2;    // chosen: deeper cells are divided
constexpr double kOfficeCell_m = 2.6;  // chosen: a desk and a shelf
constexpr double kUsefulRest_m = 1.6;  // chosen: depth behind a shaft that still makes a room

struct Interval {
  double lo, hi;
};

/// Free intervals of [0, end] beside `taken`, sorted.
std::vector<Interval> Free(double end, std::vector<Interval> taken) {
  std::sort(taken.begin(), taken.end(),
            [](const Interval& a, const Interval& b) { return a.lo < b.lo; });
  std::vector<Interval> free;
  double at = 0;
  for (const Interval& t : taken) {
    if (t.lo > at + 1e-6) free.push_back({at, std::min(t.lo, end)});
    at = std::max(at, t.hi);
  }
  if (at < end - 1e-6) free.push_back({at, end});
  return free;
}

/// Widths that fill `total` with cells between kMinCell_m and `most`.
std::vector<double> Slice(double total, double most, bool wants_small, Rng& rng) {
  std::vector<double> widths;
  double left = total;
  if (wants_small && left > 2 * kMinCell_m + 0.6) {
    widths.push_back(rng.Uniform(kMinCell_m, std::min(2.6, left - kMinCell_m)));
    left -= widths.back();
  }
  while (left > most) {
    const double least = std::max(0.6 * most, kMinCell_m);
    const double w = std::min(rng.Uniform(least, most), left - kMinCell_m);
    widths.push_back(w);
    left -= w;
  }
  widths.push_back(left);
  rng.Shuffle(widths);
  return widths;
}

struct Drawing {
  const LayoutParams& params;
  Rng& rng;
  HouseLayout house;
  const Edition& edition = EditionOf(params.edition);

  double StripDepth(bool is_north) const {
    return is_north ? house.depth_m - house.corridor_y1 : house.corridor_y0;
  }

  std::vector<Interval> Taken(bool is_north, int lo, int hi) const {
    std::vector<Interval> taken;
    for (const Shaft& s : house.shafts) {
      if (s.is_north == is_north && s.lo <= hi && s.hi >= lo) {
        taken.push_back({s.x0, s.x0 + s.width_m});
      }
    }
    return taken;
  }

  /// Whether a strip that ends at `end_m` leaves a rest beside its shafts that is too narrow for a
  /// cell.
  bool HasSliver(int level, double end_m) const {
    for (const bool is_north : {false, true}) {
      for (const Interval& in : Free(end_m, Taken(is_north, level, level))) {
        if (in.hi - in.lo < kMinCell_m) return true;
      }
    }
    return false;
  }

  /// Places the shaft in [0, end_m] so that the rest beside it is empty or a cell.
  bool PlaceShaft(Shaft shaft, double end_m) {
    const StairBlock block = MakeStairBlock(shaft.params);
    shaft.width_m = block.width_m;
    shaft.depth_m = block.depth_m;
    for (int attempt = 0; attempt < 30; ++attempt) {
      shaft.is_north = rng.Chance(0.5);
      if (StripDepth(shaft.is_north) < shaft.depth_m) continue;
      const auto free = Free(end_m, Taken(shaft.is_north, shaft.lo, shaft.hi));
      if (free.empty()) continue;
      const Interval in = free[rng.Below(static_cast<std::uint32_t>(free.size()))];
      const double slack = in.hi - in.lo - shaft.width_m;
      if (slack < 0) continue;
      double offset = 0;  // against the left neighbour
      if (slack > kMinCell_m && rng.Chance(0.4)) offset = slack;
      if (slack > 2 * kMinCell_m && rng.Chance(0.6)) {
        offset = rng.Uniform(kMinCell_m, slack - kMinCell_m);
      }
      if (slack > 1e-6 && slack < kMinCell_m) continue;
      shaft.x0 = in.lo + offset;
      house.shafts.push_back(shaft);
      return true;
    }
    return false;
  }

  Storeys StoreysOf(int lo, int hi) const {
    Storeys storeys{1e9, 0, params.slab_m};
    for (int k = lo; k < hi; ++k) {
      const double rise_m = params.rises_m[static_cast<std::size_t>(k)];
      storeys.least_m = std::min(storeys.least_m, rise_m);
      storeys.most_m = std::max(storeys.most_m, rise_m);
    }
    return storeys;
  }

  bool AddShaft(int lo, int hi, StairUse use, double end_m) {
    for (int attempt = 0; attempt < 6; ++attempt) {
      Shaft shaft;
      shaft.lo = lo;
      shaft.hi = hi;
      const auto kind = DrawStairKind(edition, use, rng);
      const auto stair = DrawStair(edition, kind, StoreysOf(lo, hi), rng);
      if (!stair) return false;
      shaft.params = *stair;
      const bool is_straight = kind == StairKind::kStraight || kind == StairKind::kStraightLanding;
      shaft.is_enclosed = use == StairUse::kCellar || (is_straight && rng.Chance(0.3)) ||
                          (use == StairUse::kAttic && rng.Chance(0.6));
      shaft.params.has_right_rail = !shaft.is_enclosed;
      if (PlaceShaft(shaft, end_m)) return true;
    }
    return false;
  }

  bool AddShafts(double end_m) {
    int lo = 0;
    const int top = params.levels - 1, main_top = params.has_attic ? top - 1 : top;
    if (params.has_basement && top >= 1) {
      if (!AddShaft(0, 1, StairUse::kCellar, end_m)) return false;
      lo = 1;
    }
    while (lo < main_top) {
      // Usually one shaft through all levels; sometimes the next storey has its stair elsewhere.
      const int hi = rng.Chance(0.7) ? main_top : lo + 1;
      if (!AddShaft(lo, hi, StairUse::kMain, end_m)) return false;
      lo = hi;
    }
    if (lo < top && !AddShaft(lo, top, StairUse::kAttic, end_m)) return false;
    // The second stair of an office is an escape stair; it is omitted if it does not fit.
    if (params.is_office && top > 0) AddShaft(0, top, StairUse::kMain, end_m);
    return true;
  }

  /// Cells of a strip of a level; `voids` stay open.
  void FillStrip(int level, bool is_north, double end_m, const std::vector<Rect>& voids) {
    LevelLayout& out = house.levels[static_cast<std::size_t>(level)];
    const double depth = StripDepth(is_north);
    if (depth < 0.5) return;
    const double near = is_north ? house.corridor_y1 : house.corridor_y0;
    const auto rect = [&](double x0, double x1, double d0, double d1) {
      const double ya = is_north ? near + d0 : near - d0, yb = is_north ? near + d1 : near - d1;
      return Rect{x0, std::min(ya, yb), x1, std::max(ya, yb)};
    };
    auto taken = Taken(is_north, level, level);
    for (const Rect& v : voids) {
      if ((v.y0 >= house.corridor_y1 - 1e-6) != is_north) continue;
      taken.push_back({v.x0, v.x1});
      out.cells.push_back({v, -1, false, true});
    }
    bool wants_small = rng.Chance(0.75);
    const double most = params.is_office ? kOfficeCell_m : std::clamp(24 / depth, 3.4, 6.5);
    for (const Interval& in : Free(end_m, taken)) {
      double x = in.lo;
      for (double w : Slice(in.hi - in.lo, most, wants_small, rng)) {
        AddCell(out, rect, x, x + w, depth);
        x += w;
      }
      wants_small = false;
    }
    AddRests(level, is_north, depth, out, rect);
  }

  template <class MakeRect>
  void AddCell(LevelLayout& out, MakeRect rect, double x0, double x1, double depth) {
    const bool is_divided = depth > kDeepCell_m && x1 - x0 > 2.4 && rng.Chance(0.85);
    const double front = is_divided ? depth * rng.Uniform(0.5, 0.62) : depth;
    out.cells.push_back({rect(x0, x1, 0, front), -1, false, false});
    if (!is_divided) return;
    const int parent = static_cast<int>(out.cells.size()) - 1;
    out.cells.push_back({rect(x0, x1, front, depth), parent, false, false});
  }

  /// The space behind a shaft becomes a small room with a door to a neighbour if it is deep enough;
  /// otherwise it stays closed.
  template <class MakeRect>
  void AddRests(int level, bool is_north, double depth, LevelLayout& out, MakeRect rect) {
    for (const Shaft& s : house.shafts) {
      if (s.is_north != is_north || level < s.lo || level > s.hi) continue;
      if (depth - s.depth_m < kUsefulRest_m) continue;
      const Rect rest = rect(s.x0, s.x0 + s.width_m, s.depth_m, depth);
      for (std::size_t i = 0; i < out.cells.size(); ++i) {
        const Cell& c = out.cells[i];
        if (c.is_void) continue;
        const bool touches =
            std::abs(c.rect.x1 - rest.x0) < 1e-6 || std::abs(c.rect.x0 - rest.x1) < 1e-6;
        const double shared = std::min(c.rect.y1, rest.y1) - std::max(c.rect.y0, rest.y0);
        if (!touches || shared < 1.5) continue;
        out.cells.push_back({rest, static_cast<int>(i), false, false});
        break;
      }
    }
  }

  bool Draw() {
    const double aspect = rng.Uniform(1.15, 1.75);
    house.width_m = std::sqrt(params.area_m2 * aspect);
    if (params.is_office) house.width_m = params.area_m2 / rng.Uniform(8.2, 9.4);
    house.depth_m = params.area_m2 / house.width_m;
    const double corridor = rng.Uniform(1.35, params.area_m2 > 110 ? 2.0 : 1.55);
    const double rest = house.depth_m - corridor;
    double south = rest * rng.Uniform(0.42, 0.58);
    if (rest < 2 * kMinStrip_m) south = rng.Chance(0.5) ? rest : 0.0;
    if (south > 0 && rest - south > 0) {
      south = std::clamp(south, kMinStrip_m, std::max(kMinStrip_m, rest - kMinStrip_m));
    }
    house.corridor_y0 = south;
    house.corridor_y1 = south + corridor;
    house.levels.resize(static_cast<std::size_t>(params.levels));

    std::vector<double> ends;
    double shortest = house.width_m;
    for (int level = 0; level < params.levels; ++level) {
      const bool has_end_room =
          params.area_m2 > 75 && (rng.Chance(0.6) || (params.is_office && level == 0));
      const double room = has_end_room ? rng.Uniform(3.6, std::min(6.0, 0.38 * house.width_m)) : 0;
      ends.push_back(house.width_m - std::max(0.0, room));
      shortest = std::min(shortest, ends.back());
    }
    if (!AddShafts(shortest)) return false;
    for (int level = 0; edition.number > 1 && level < params.levels; ++level) {
      double& end = ends[static_cast<std::size_t>(level)];
      if (HasSliver(level, end)) end = shortest;
    }
    std::optional<Rect> gallery;
    for (int level = 0; level < params.levels; ++level) {
      LevelLayout& out = house.levels[static_cast<std::size_t>(level)];
      const double end = ends[static_cast<std::size_t>(level)];
      out.corridor = {0, house.corridor_y0, end, house.corridor_y1};
      std::vector<Rect> voids;
      if (gallery && gallery->x1 <= end - kMinCell_m) voids.push_back(*gallery);
      gallery.reset();
      FillStrip(level, false, end, voids);
      FillStrip(level, true, end, voids);
      if (end < house.width_m - 1) {
        out.cells.push_back({{end, 0, house.width_m, house.depth_m}, -1, true, false});
      }
      const bool is_basement = params.has_basement && level == 0;
      if (level + 1 < params.levels && !is_basement && rng.Chance(0.3))
        gallery = DrawGallery(level, shortest);
    }
    return true;
  }

  /// A cell on the corridor that may extend through the next level.
  std::optional<Rect> DrawGallery(int level, double end_m) const {
    for (const Cell& c : house.levels[static_cast<std::size_t>(level)].cells) {
      if (c.parent >= 0 || c.is_void || c.is_end_room || c.rect.Area() < 14) continue;
      const bool is_north = c.rect.y0 >= house.corridor_y1 - 1e-6;
      bool is_free = c.rect.x1 <= end_m;
      for (const Interval& t : Taken(is_north, level + 1, level + 1)) {
        is_free = is_free && (c.rect.x1 <= t.lo + 1e-6 || c.rect.x0 >= t.hi - 1e-6);
      }
      // The rest beside it on the level above must be empty or a cell.
      auto taken = Taken(is_north, level + 1, level + 1);
      taken.push_back({c.rect.x0, c.rect.x1});
      for (const Interval& f : Free(end_m, taken)) is_free = is_free && f.hi - f.lo >= kMinCell_m;
      if (is_free) return c.rect;
    }
    return std::nullopt;
  }
};

}  // namespace

Rect RectOf(const HouseLayout& layout, const Shaft& shaft) {
  return shaft.is_north ? Rect{shaft.x0, layout.corridor_y1, shaft.x0 + shaft.width_m,
                               layout.corridor_y1 + shaft.depth_m}
                        : Rect{shaft.x0, layout.corridor_y0 - shaft.depth_m,
                               shaft.x0 + shaft.width_m, layout.corridor_y0};
}

StairBlock StairIn(const HouseLayout& layout, const Shaft& shaft, int level, double rise_m) {
  StairParams params = shaft.params;
  params.rise_m = rise_m;
  if (level > shaft.lo && params.body == StairBody::kSolid) params.body = StairBody::kClosed;
  params.is_continued = level + 1 < shaft.hi;
  StairBlock block = MakeStairBlock(params);
  const Rect rect = RectOf(layout, shaft);
  if (shaft.is_north) {
    block.stair = Moved(std::move(block.stair), {rect.x0, rect.y0, 0}, 0);
    for (double* x : {&block.entry_x0, &block.entry_x1, &block.exit_x0, &block.exit_x1}) {
      *x += rect.x0;
    }
  } else {
    block.stair = Moved(std::move(block.stair), {rect.x1, rect.y1, 0}, 2);
    for (double* x : {&block.entry_x0, &block.entry_x1, &block.exit_x0, &block.exit_x1}) {
      *x = rect.x1 - *x;
    }
    std::swap(block.entry_x0, block.entry_x1);
    std::swap(block.exit_x0, block.exit_x1);
  }
  return block;
}

std::optional<HouseLayout> DrawLayout(const LayoutParams& params, Rng& rng) {
  Drawing drawing{params, rng, {}};
  if (!drawing.Draw()) return std::nullopt;
  return std::move(drawing.house);
}

}  // namespace crossnav::world
