// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/lifelong/visit_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "crossnav/core/rng.h"

namespace crossnav::evaluation {
namespace {

using Json = nlohmann::ordered_json;

/// A figure of one goal in one house, or of the pair of two runs' goals.
struct Sample {
  std::string house;
  double value = 0;
};

double MeanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// Mean over goals. The bootstrap draws houses with all their goals, or goals of a single house.
Figure MeanByHouses(const std::vector<Sample>& samples, const BootstrapConfig& bootstrap) {
  std::map<std::string, std::vector<double>> by_house;
  std::vector<double> all;
  const bool is_one_house = std::all_of(samples.begin(), samples.end(), [&](const Sample& sample) {
    return sample.house == samples.front().house;
  });
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::string group = is_one_house ? std::to_string(i) : samples[i].house;
    by_house[group].push_back(samples[i].value);
    all.push_back(samples[i].value);
  }
  std::vector<std::vector<double>> groups;
  for (auto& [house, values] : by_house) groups.push_back(std::move(values));
  Rng rng(bootstrap.seed);
  std::vector<double> means;
  for (int r = 0; r < bootstrap.resamples && !groups.empty(); ++r) {
    std::vector<double> drawn;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      const auto& group = groups[rng.Below(static_cast<std::uint32_t>(groups.size()))];
      drawn.insert(drawn.end(), group.begin(), group.end());
    }
    means.push_back(MeanOf(drawn));
  }
  std::sort(means.begin(), means.end());
  Figure figure{MeanOf(all), {}};
  if (means.empty()) return figure;
  const auto at = [&](double share) {
    return means[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(means.size() - 1)))];
  };
  figure.interval = {at(0.025), at(0.975)};
  return figure;
}

/// Goals of one track with their houses and days.
struct TrackGoal {
  const VisitRecord* visit;
  const GoalRecord* goal;
};

std::vector<TrackGoal> GoalsOf(const VisitResults& results, std::string_view track) {
  std::vector<TrackGoal> goals;
  for (const VisitRecord& visit : results.records) {
    for (const GoalRecord& goal : visit.goals) {
      if (goal.track == track) goals.push_back({&visit, &goal});
    }
  }
  return goals;
}

TrackFigures FiguresOfTrack(const std::vector<TrackGoal>& goals, const BootstrapConfig& bootstrap) {
  TrackFigures figures;
  std::set<std::pair<std::string, int>> visits;
  std::vector<Sample> spl, unspent;
  int successes = 0;
  for (const auto& [visit, goal] : goals) {
    visits.emplace(visit->house, visit->day);
    successes += goal->success ? 1 : 0;
    if (!goal->is_absent) spl.push_back({visit->house, goal->Spl()});
    unspent.push_back(
        {visit->house, 1.0 - static_cast<double>(goal->actions) / std::max(1, goal->budget)});
    figures.stale_visits += goal->stale_visits;
    if (goal->revised_after == 0) continue;
    ++figures.revised;
    figures.revised_after += goal->revised_after;
  }
  const auto count = static_cast<int>(goals.size());
  figures.goals = count;
  figures.visits = static_cast<int>(visits.size());
  figures.success = {static_cast<double>(successes) / count, WilsonInterval(successes, count)};
  figures.unspent = MeanByHouses(unspent, bootstrap);
  if (!spl.empty()) figures.spl = MeanByHouses(spl, bootstrap);
  figures.stale_visits /= count;
  if (figures.revised > 0) figures.revised_after /= figures.revised;
  return figures;
}

std::string Percent(const Figure& figure) {
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * figure.value, 100 * figure.interval.low,
                     100 * figure.interval.high);
}

std::string Points(const Figure& figure) {
  return fmt::format("{:+.1f} [{:+.1f}, {:+.1f}]", 100 * figure.value, 100 * figure.interval.low,
                     100 * figure.interval.high);
}

Json ToJson(const Figure& figure) {
  return {{"value", figure.value}, {"low", figure.interval.low}, {"high", figure.interval.high}};
}

}  // namespace

std::vector<std::pair<std::string, TrackFigures>> FiguresOf(const VisitResults& results,
                                                            const BootstrapConfig& bootstrap) {
  std::vector<std::pair<std::string, TrackFigures>> all;
  for (const std::string_view track : kVisitTracks) {
    const auto goals = GoalsOf(results, track);
    if (!goals.empty()) all.emplace_back(track, FiguresOfTrack(goals, bootstrap));
  }
  return all;
}

Result<VisitComparison> CompareVisits(const VisitResults& a, const VisitResults& b,
                                      const BootstrapConfig& bootstrap, bool is_forced) {
  VisitRun same = b.run;
  same.memory_mode = a.run.memory_mode;
  const bool is_alike = same == a.run;
  const bool is_comparable = is_alike || (is_forced && b.run.suite_hash == a.run.suite_hash);
  if (!is_comparable) {
    return Fail(ErrorCode::kMismatch,
                "cannot be compared with memory " + a.run.memory_mode +
                    ": suite, settings, variant, perception or version differ (--force compares "
                    "runs of one suite)",
                "memory " + b.run.memory_mode);
  }
  VisitComparison comparison{a.run.memory_mode, b.run.memory_mode, {}, !is_alike};
  for (const std::string_view track : kVisitTracks) {
    std::map<std::tuple<std::string, int, std::string>, const GoalRecord*> in_b;
    for (const auto& [visit, goal] : GoalsOf(b, track)) {
      in_b[{visit->house, visit->day, goal->goal}] = goal;
    }
    std::vector<Sample> success, spl;
    std::set<std::string> houses;
    for (const auto& [visit, goal] : GoalsOf(a, track)) {
      const auto other = in_b.find({visit->house, visit->day, goal->goal});
      if (other == in_b.end()) continue;
      houses.insert(visit->house);
      success.push_back({visit->house, static_cast<double>(other->second->success) -
                                           static_cast<double>(goal->success)});
      if (!goal->is_absent) {
        spl.push_back({visit->house, other->second->Spl() - goal->Spl()});
      }
    }
    if (success.empty()) continue;
    TrackDifference difference;
    difference.goals = static_cast<int>(success.size());
    difference.houses = static_cast<int>(houses.size());
    difference.success = MeanByHouses(success, bootstrap);
    if (!spl.empty()) difference.spl = MeanByHouses(spl, bootstrap);
    comparison.tracks.emplace_back(track, difference);
  }
  return comparison;
}

std::string VisitReportMarkdown(const std::string& suite, const std::vector<VisitResults>& runs,
                                const std::vector<VisitComparison>& comparisons) {
  std::string text = fmt::format("# {}\n", suite);
  for (const VisitResults& run : runs) {
    text += fmt::format(
        "\n## memory = {}\n\n{} perception, settings {}, suite {}\n\n"
        "| track | visits | goals | success % | SPL % | stale visits a goal | actions until "
        "revised "
        "| budget unspent % |\n|---|---|---|---|---|---|---|---|\n",
        run.run.memory_mode, run.run.perception, run.run.config_hash, run.run.suite_hash);
    for (const auto& [track, f] : FiguresOf(run)) {
      text += fmt::format(
          "| {} | {} | {} | {} | {} | {:.2f} | {} | {} |\n", track, f.visits, f.goals,
          Percent(f.success), f.spl ? Percent(*f.spl) : "-", f.stale_visits,
          f.revised > 0 ? fmt::format("{:.0f} ({} goals)", f.revised_after, f.revised) : "-",
          Percent(f.unspent));
    }
    std::string failures;
    for (const VisitRecord& record : run.records) {
      if (record.failure.empty()) continue;
      failures += fmt::format("- {} day {}: {}\n", record.house, record.day, record.failure);
    }
    if (!failures.empty()) text += "\nNot played:\n\n" + failures;
  }
  for (const VisitComparison& comparison : comparisons) {
    text += fmt::format(
        "\n## {} against {}, in pairs{}\n\n| track | goals | houses | success, points | SPL, "
        "points "
        "|\n|---|---|---|---|---|\n",
        comparison.name_b, comparison.name_a, comparison.is_forced ? " (settings differ)" : "");
    for (const auto& [track, d] : comparison.tracks) {
      text += fmt::format("| {} | {} | {} | {} | {} |\n", track, d.goals, d.houses,
                          Points(d.success), d.spl ? Points(*d.spl) : "-");
    }
  }
  return text;
}

std::string VisitReportJson(const std::vector<VisitResults>& runs,
                            const std::vector<VisitComparison>& comparisons) {
  Json list = Json::array(), pairs = Json::array();
  for (const VisitResults& run : runs) {
    Json tracks = Json::object();
    for (const auto& [track, f] : FiguresOf(run)) {
      tracks[track] = {{"visits", f.visits},
                       {"goals", f.goals},
                       {"success", ToJson(f.success)},
                       {"spl", f.spl ? ToJson(*f.spl) : Json(nullptr)},
                       {"stale_visits", f.stale_visits},
                       {"revised", f.revised},
                       {"revised_after", f.revised_after},
                       {"unspent", ToJson(f.unspent)}};
    }
    list.push_back({{"memory", run.run.memory_mode}, {"tracks", std::move(tracks)}});
  }
  for (const VisitComparison& comparison : comparisons) {
    Json tracks = Json::object();
    for (const auto& [track, d] : comparison.tracks) {
      tracks[track] = {{"goals", d.goals},
                       {"houses", d.houses},
                       {"success", ToJson(d.success)},
                       {"spl", d.spl ? ToJson(*d.spl) : Json(nullptr)}};
    }
    pairs.push_back({{"before", comparison.name_a},
                     {"after", comparison.name_b},
                     {"settings_differ", comparison.is_forced},
                     {"tracks", std::move(tracks)}});
  }
  return Json({{"runs", std::move(list)}, {"comparisons", std::move(pairs)}}).dump(1);
}

}  // namespace crossnav::evaluation
