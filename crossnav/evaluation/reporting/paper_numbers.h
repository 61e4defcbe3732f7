// SPDX-License-Identifier: MIT
// The paper's results, to print beside ours; never a tuning target. Per cent; stages k = 1, 2, 3.
// tab:all_overall, tab:cfr_overall, the conditional figures, tab:supp_all_global,
// tab:supp_cfr_global, tab:full_object_distribution, tab:wo_hpoi_object_distribution,
// tab:single_object_results.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace crossnav::evaluation {

struct PaperRow {
  std::string_view method;   ///< as in the paper
  std::string_view variant;  ///< our variant that implements it
  double sr, spl, pr, ppl;
  std::array<double, 3> sr_cond, spl_cond, sr_global, spl_global;
};

/// All 927 episodes.
inline constexpr std::array<PaperRow, 3> kPaperAll = {{
    {"OneMap",
     "onemap",
     16.83,
     6.95,
     33.69,
     14.03,
     {54.58, 54.35, 56.73},
     {23.46, 24.81, 30.81},
     {54.58, 29.67, 16.83},
     {23.46, 13.54, 9.14}},
    {"w/o H-POI",
     "paper-no-history-poi",
     29.77,
     8.46,
     48.54,
     14.91,
     {70.33, 64.72, 65.40},
     {25.26, 25.68, 25.56},
     {70.33, 45.52, 29.77},
     {25.26, 18.06, 11.64}},
    {"LifelongCrossNav",
     "paper",
     29.13,
     9.64,
     48.40,
     16.70,
     {70.33, 65.03, 63.68},
     {25.26, 32.28, 34.58},
     {70.33, 45.74, 29.13},
     {25.26, 22.71, 15.82}},
}};

/// The 288 episodes that require a floor change.
inline constexpr std::array<PaperRow, 3> kPaperCrossFloor = {{
    {"OneMap",
     "onemap",
     0.00,
     0.00,
     18.52,
     7.97,
     {42.36, 31.15, 0},
     {17.82, 16.26, 0},
     {42.36, 13.19, 0},
     {17.82, 6.89, 0}},
    {"w/o H-POI",
     "paper-no-history-poi",
     7.29,
     1.91,
     28.94,
     9.16,
     {55.56, 43.13, 30.43},
     {19.00, 19.43, 12.62},
     {55.56, 23.96, 7.29},
     {19.00, 10.79, 3.02}},
    {"LifelongCrossNav",
     "paper",
     7.99,
     2.35,
     29.17,
     9.75,
     {55.56, 43.13, 33.33},
     {19.00, 23.38, 20.54},
     {55.56, 23.96, 7.99},
     {19.00, 12.99, 4.92}},
}};

/// Outcomes per goal category.
struct PaperOutcomes {
  std::string_view goal;
  int total, success, misdetection, stuck, out_of_time, not_reached, all_explored;
};

/// tab:full_object_distribution
inline constexpr std::array<PaperOutcomes, 6> kPaperOutcomes = {{
    {"chair", 363, 323, 13, 17, 9, 0, 1},
    {"toilet", 345, 267, 24, 20, 27, 0, 7},
    {"sofa", 372, 239, 84, 27, 14, 3, 5},
    {"tv_monitor", 291, 180, 30, 16, 50, 14, 1},
    {"plant", 276, 155, 8, 43, 59, 1, 10},
    {"bed", 356, 182, 163, 3, 3, 4, 1},
}};

/// tab:wo_hpoi_object_distribution
inline constexpr std::array<PaperOutcomes, 6> kPaperOutcomesWithoutHistory = {{
    {"chair", 362, 323, 10, 17, 10, 0, 2},
    {"toilet", 338, 261, 23, 24, 20, 0, 10},
    {"sofa", 376, 243, 73, 33, 18, 3, 6},
    {"tv_monitor", 290, 174, 28, 23, 48, 13, 4},
    {"plant", 277, 148, 8, 53, 58, 2, 8},
    {"bed", 358, 201, 133, 8, 9, 6, 1},
}};

/// The paper's outcomes of the method that `variant` implements; empty without a counterpart.
constexpr std::span<const PaperOutcomes> PaperOutcomesOf(std::string_view variant) {
  if (variant == "paper") return kPaperOutcomes;
  if (variant == "paper-no-history-poi") return kPaperOutcomesWithoutHistory;
  return {};
}

/// tab:single_object_results: HM3D ObjectNav, validation split, one goal.
struct PaperSingleRow {
  std::string_view method, variant;  ///< variant: our implementation, or empty
  bool zero_shot, multi_floor, llm;
  double sr, spl;
};
inline constexpr std::array<PaperSingleRow, 13> kPaperSingleObject = {{
    {"SGM", "", false, false, false, 60.2, 30.8},
    {"XGX", "", false, false, false, 72.9, 35.7},
    {"ZSON", "", true, false, false, 25.5, 12.6},
    {"VLFM", "", true, false, false, 52.5, 30.4},
    {"SG-Nav", "", true, false, true, 54.0, 24.9},
    {"OpenFMNav", "", true, false, true, 54.9, 24.4},
    {"OneMap", "onemap", true, false, false, 55.8, 37.4},
    {"InstructNav", "", true, false, true, 58.0, 20.9},
    {"ApexNav", "", true, false, true, 59.6, 33.0},
    {"BeliefMapNav", "", true, false, true, 61.4, 30.6},
    {"MFNP", "", true, true, true, 58.3, 26.7},
    {"ASCENT", "", true, true, true, 65.4, 33.5},
    {"LifelongCrossNav", "paper", true, true, false, 59.7, 28.0},
}};

}  // namespace crossnav::evaluation
