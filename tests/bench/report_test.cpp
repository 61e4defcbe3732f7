// SPDX-License-Identifier: MIT
#include "crossnav/bench/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/record_builder.h"
#include "crossnav/bench/metrics_report.h"
#include "crossnav/bench/paper_numbers.h"

namespace crossnav::bench {
namespace {

std::vector<ReportRun> TwoRuns() {
  ReportRun full{"full", {}, "full", "oracle-perception", "aa", "bb", {}, {}};
  for (int i = 0; i < 10; ++i) {
    auto episode = test::MakeEpisode(std::to_string(i), 3, {{i < 5, 2.0, 4.0}});
    episode.cross_floor_required = i % 2 == 0;
    episode.first_transition_stage = i % 2 == 0 ? 1 : 0;
    full.episodes.push_back(episode);
  }
  ReportRun other = full;
  other.name = other.variant = "no-history-poi";
  return {full, other};
}

TEST(Report, FiguresCarryThePapersNumberOfTheirVariant) {
  const auto figures = CollectFigures(TwoRuns(), {50, 1});
  bool has_full = false, has_other = false;
  for (const ReportFigure& f : figures) {
    if (f.group == "all" && f.metric == "SR" && f.run == "full") has_full = *f.paper == 0.2913;
    if (f.group == "cfr" && f.metric == "SPL_cond_2" && f.run == "no-history-poi") {
      has_other = *f.paper == 0.1943;
    }
    if (f.group.starts_with("scene:")) {
      EXPECT_FALSE(f.paper);
    }
  }
  EXPECT_TRUE(has_full);
  EXPECT_TRUE(has_other);
}

TEST(Report, MarkdownHasEverySection) {
  const auto runs = TwoRuns();
  const auto figures = CollectFigures(runs, {50, 1});
  const std::string text = ReportMarkdown(runs, figures);
  for (const char* part : {"## All episodes", "floor change", "Conditional SR", "Conditional SPL",
                           "### Scenes", "### Categories", "### Outcomes", "29.13"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

TEST(Report, FailedEpisodesAreListedWithTheirReason) {
  auto runs = TwoRuns();
  runs[1].episodes[3].stages.clear();
  runs[1].episodes[3].failed = EpisodeFailure{"time", "took | long"};
  const std::string text = ReportMarkdown(runs, CollectFigures(runs, {50, 1}));
  EXPECT_NE(text.find("### Failed episodes"), std::string::npos);
  EXPECT_NE(text.find("| 3 | time | took / long |"), std::string::npos) << text;
  EXPECT_NE(MetricsText(runs[1].episodes, {50, 1}).find("failed: 1 time"), std::string::npos);
  const auto metrics = nlohmann::json::parse(MetricsJson(runs[1].episodes, {50, 1}));
  EXPECT_EQ(metrics["failed"]["time"], 1);
  EXPECT_EQ(ReportMarkdown({runs[0]}, {}).find("Failed"), std::string::npos);
}

TEST(Report, CsvHasOneRowPerFigure) {
  const auto figures = CollectFigures(TwoRuns(), {50, 1});
  const std::string csv = ReportCsv(figures);
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), figures.size() + 1);
}

TEST(Report, JsonAndMetricsJsonParse) {
  const auto runs = TwoRuns();
  const auto json = nlohmann::json::parse(ReportJson(runs, CollectFigures(runs, {50, 1})));
  EXPECT_EQ(json["runs"].size(), 2u);
  const auto metrics = nlohmann::json::parse(MetricsJson(runs[0].episodes, {50, 1}));
  EXPECT_DOUBLE_EQ(metrics["metrics"]["SR_cond_1"]["value"], 0.5);
  EXPECT_EQ(metrics["groups"]["cfr"]["episodes"], 5);
  EXPECT_EQ(metrics["outcomes"]["chair"]["misdetection"], 5);
}

TEST(Report, CountsTheCausesOfFailedStages) {
  auto runs = TwoRuns();
  for (EpisodeRecord& episode : runs[0].episodes) {
    StageRecord& stage = episode.stages[0];
    if (stage.success) continue;
    stage.outcome = Outcome::kOutOfTime;
    stage.extra.cause = StageCause{{{"go_to", 9}}, "go_to", true, "", {}, 0.5};
  }
  const std::string text = ReportMarkdown(runs, {});
  EXPECT_NE(text.find("### Causes of failure"), std::string::npos);
  EXPECT_NE(text.find("| go_to under way | 5 | 0 | 0 | 0 | 0 | 5 | 50 |"), std::string::npos)
      << text;
  EXPECT_EQ(CausesCsv(runs),
            "run,cause,outcome,stages\n"
            "full,go_to under way,out_of_time,5\n"
            "no-history-poi,stopped at the wrong object,misdetection,5\n");
  const auto causes = nlohmann::json::parse(ReportJson(runs, {}))["runs"][0]["causes"];
  EXPECT_EQ(causes["go_to under way"]["stages"], 5);
  EXPECT_EQ(causes["go_to under way"]["outcomes"]["out_of_time"], 5);
  EXPECT_EQ(causes["go_to under way"]["seen_share"], 0.5);
}

TEST(Report, PlotsAreClosedSvg) {
  const auto runs = TwoRuns();
  const auto figures = CollectFigures(runs, {50, 1});
  for (const std::string& svg : {StagePlotSvg(runs, figures, "SR_cond"), OutcomePlotSvg(runs[0])}) {
    EXPECT_TRUE(svg.starts_with("<svg"));
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
  }
}

TEST(PaperNumbers, AgreeWithThemselves) {
  for (const PaperOutcomes& p : kPaperOutcomes) {
    EXPECT_EQ(p.total,
              p.success + p.misdetection + p.stuck + p.out_of_time + p.not_reached + p.all_explored)
        << p.goal;
  }
  for (const auto& table : {kPaperAll, kPaperCrossFloor}) {
    for (const PaperRow& row : table) {
      const double g1 = row.sr_cond[0], g2 = g1 * row.sr_cond[1] / 100;
      const double g3 = g2 * row.sr_cond[2] / 100;
      EXPECT_NEAR((g1 + g2 + g3) / 3, row.pr, 0.02) << row.method;
      EXPECT_NEAR(g3, row.sr, 0.02) << row.method;
    }
  }
}

}  // namespace
}  // namespace crossnav::bench
