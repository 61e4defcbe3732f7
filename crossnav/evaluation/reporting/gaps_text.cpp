// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "crossnav/evaluation/reporting/gaps.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

std::string DifferenceLine(const char* name, const std::optional<PairedDifference>& gain,
                           const char* runs) {
  if (!gain) return {};
  return fmt::format("  {:<32} {:7.2f} [{:.1f}, {:.1f}]  {}\n", name, 100 * gain->difference,
                     100 * gain->interval.low, 100 * gain->interval.high, runs);
}

std::string PartLine(const char* name, double share) {
  return fmt::format("  {:<32} {:7.2f}\n", name, 100 * share);
}

/// Parts of the best-informed run: the loss without search.
std::string PartsText(const RunGaps& run) {
  std::string text = PartLine("detours", run.parts.detour) +
                     PartLine("approach", run.parts.approach) +
                     PartLine("other instance or place", run.parts.place) +
                     PartLine("failed episodes", run.parts.failed);
  if (run.parts.unknown > 0) text += PartLine("not recorded", run.parts.unknown);
  return text;
}

const RunGaps* Find(const Gaps& gaps, const std::string& variant) {
  for (const RunGaps& run : gaps.runs) {
    if (run.variant == variant) return &run;
  }
  return nullptr;
}

/// From the first run to the shortest path, in SPL points.
std::string AttributionText(const Gaps& gaps) {
  const RunGaps* full = Find(gaps, "full");
  const RunGaps* objects = Find(gaps, "known-objects");
  if (full == nullptr || objects == nullptr || !gaps.geometry || !gaps.search) return {};
  return fmt::format("\nfrom SPL {:.2f} (full) to 100, in points\n", 100 * full->spl) +
         DifferenceLine("geometry unknown", gaps.geometry, "full to known-map") +
         DifferenceLine("search order (objects unknown)", gaps.search,
                        "known-map to known-objects") +
         "  left in known-objects:\n" + PartsText(*objects);
}

Json PartsJson(const GapParts& parts) {
  return {{"failed", parts.failed},
          {"detour", parts.detour},
          {"approach", parts.approach},
          {"place", parts.place},
          {"unknown", parts.unknown}};
}

Json DifferenceJson(const std::optional<PairedDifference>& gain) {
  if (!gain) return nullptr;
  return {{"value", gain->difference}, {"low", gain->interval.low}, {"high", gain->interval.high}};
}

}  // namespace

std::string GapsText(const std::vector<Gaps>& all) {
  std::string text;
  for (const Gaps& gaps : all) {
    text += fmt::format("{}{}{} episodes; per cent, and points of SPL that each part costs\n",
                        text.empty() ? "" : "\n",
                        gaps.track.empty() ? "" : "track " + gaps.track + ": ", gaps.episodes);
    text += fmt::format("  {:<24} {:<14} {:>6} {:>6} {:>7} {:>7} {:>8} {:>6}\n", "run", "variant",
                        "SR", "SPL", "detour", "appr.", "place", "failed");
    for (const RunGaps& run : gaps.runs) {
      text +=
          fmt::format("  {:<24} {:<14} {:6.2f} {:6.2f} {:7.2f} {:7.2f} {:8.2f} {:6.2f}\n", run.name,
                      run.variant, 100 * run.sr, 100 * run.spl, 100 * run.parts.detour,
                      100 * run.parts.approach, 100 * run.parts.place, 100 * run.parts.failed);
    }
    text += fmt::format("\n  {:<24} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9}\n", "mean of a stage",
                        "stages", "forward", "turn", "look", "d* m", "length m");
    for (const RunGaps& run : gaps.runs) {
      const StageMeans& m = run.means;
      text += fmt::format("  {:<24} {:>7} {:8.1f} {:8.1f} {:8.1f} {:9.2f} {:9.2f}\n", run.name,
                          m.stages, m.forward, m.turn, m.look, m.shortest_m, m.length_m);
    }
    text += AttributionText(gaps);
  }
  return text;
}

std::string GapsJson(const std::vector<Gaps>& all) {
  Json tracks = Json::array();
  for (const Gaps& gaps : all) {
    Json runs = Json::array();
    for (const RunGaps& run : gaps.runs) {
      const StageMeans& m = run.means;
      runs.push_back({{"run", run.name},
                      {"variant", run.variant},
                      {"sr", run.sr},
                      {"spl", run.spl},
                      {"gap", PartsJson(run.parts)},
                      {"stages", m.stages},
                      {"forward", m.forward},
                      {"turn", m.turn},
                      {"look", m.look},
                      {"shortest_m", m.shortest_m},
                      {"length_m", m.length_m}});
    }
    tracks.push_back({{"track", gaps.track},
                      {"episodes", gaps.episodes},
                      {"runs", std::move(runs)},
                      {"geometry_unknown", DifferenceJson(gaps.geometry)},
                      {"search_order", DifferenceJson(gaps.search)}});
  }
  return Json({{"tracks", std::move(tracks)}}).dump(1);
}

}  // namespace crossnav::evaluation
