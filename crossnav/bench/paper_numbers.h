// SPDX-License-Identifier: MIT
// The paper's results, to print beside ours and never to tune to. Per cent; stages k = 1, 2, 3.
// Tables: tab:all_overall, tab:cfr_overall, the conditional tables, tab:supp_all_global,
// tab:supp_cfr_global, tab:full_object_distribution, tab:wo_hpoi_object_distribution.
#pragma once

#include <array>
#include <string_view>

namespace crossnav::bench {

struct PaperRow {
  std::string_view method;   ///< as in the paper
  std::string_view variant;  ///< ours that stands beside it
  double sr, spl, pr, ppl;
  std::array<double, 3> sr_cond, spl_cond;
};

/// All 927 episodes.
inline constexpr std::array<PaperRow, 3> kPaperAll = {{
    {"OneMap", "planar", 16.83, 6.95, 33.69, 14.03, {54.58, 54.35, 56.73}, {23.46, 24.81, 30.81}},
    {"w/o H-POI",
     "no-history-poi",
     29.77,
     8.46,
     48.54,
     14.91,
     {70.33, 64.72, 65.40},
     {25.26, 25.68, 25.56}},
    {"LifelongCrossNav",
     "full",
     29.13,
     9.64,
     48.40,
     16.70,
     {70.33, 65.03, 63.68},
     {25.26, 32.28, 34.58}},
}};

/// The 288 episodes that require a floor change.
inline constexpr std::array<PaperRow, 3> kPaperCrossFloor = {{
    {"OneMap", "planar", 0.00, 0.00, 18.52, 7.97, {42.36, 31.15, 0}, {17.82, 16.26, 0}},
    {"w/o H-POI",
     "no-history-poi",
     7.29,
     1.91,
     28.94,
     9.16,
     {55.56, 43.13, 30.43},
     {19.00, 19.43, 12.62}},
    {"LifelongCrossNav",
     "full",
     7.99,
     2.35,
     29.17,
     9.75,
     {55.56, 43.13, 33.33},
     {19.00, 23.38, 20.54}},
}};

/// Outcomes of the full method per goal category.
struct PaperOutcomes {
  std::string_view goal;
  int total, success, misdetection, stuck, out_of_time, not_reached, all_explored;
};
inline constexpr std::array<PaperOutcomes, 6> kPaperOutcomes = {{
    {"chair", 363, 323, 13, 17, 9, 0, 1},
    {"toilet", 345, 267, 24, 20, 27, 0, 7},
    {"sofa", 372, 239, 84, 27, 14, 3, 5},
    {"tv_monitor", 291, 180, 30, 16, 50, 14, 1},
    {"plant", 276, 155, 8, 43, 59, 1, 10},
    {"bed", 356, 182, 163, 3, 3, 4, 1},
}};

/// Single-object navigation on HM3D ObjectNav, validation split.
inline constexpr double kPaperSingleObjectSr = 59.7, kPaperSingleObjectSpl = 28.0;

}  // namespace crossnav::bench
