// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/reporting/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crossnav/evaluation/reporting/metrics_report.h"
#include "crossnav/evaluation/reporting/paper_numbers.h"
#include "evaluation/record_builder.h"

namespace crossnav::evaluation {
namespace {

std::vector<ReportRun> TwoRuns() {
  ReportRun full{"paper", {}, "paper", "oracle-perception", "aa", "bb", {}, {}};
  for (int i = 0; i < 10; ++i) {
    auto episode = test::MakeEpisode(std::to_string(i), 3, {{i < 5, 2.0, 4.0}});
    episode.cross_floor_required = i % 2 == 0;
    episode.first_transition_stage = i % 2 == 0 ? 1 : 0;
    full.episodes.push_back(episode);
  }
  ReportRun other = full;
  other.name = other.variant = "paper-no-history-poi";
  return {full, other};
}

TEST(Report, FiguresCarryThePapersNumberOfTheirVariant) {
  const auto figures = CollectFigures(TwoRuns(), {50, 1});
  bool has_full = false, has_other = false;
  for (const ReportFigure& f : figures) {
    if (f.group == "all" && f.metric == "SR" && f.run == "paper") has_full = *f.paper == 0.2913;
    if (f.group == "cfr" && f.metric == "SPL_cond_2" && f.run == "paper-no-history-poi") {
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
            "paper,go_to under way,out_of_time,5\n"
            "paper-no-history-poi,stopped at the wrong object,misdetection,5\n");
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

// The paper's method stands beside the profile `paper`; our navigator is no method of the paper.
TEST(Report, OurNavigatorHasNoNumberOfThePaper) {
  auto runs = TwoRuns();
  runs[0].variant = "full";
  for (const ReportFigure& f : CollectFigures({runs[0]}, {50, 1})) EXPECT_FALSE(f.paper);
  const std::string text = ReportMarkdown({runs[0]}, {});
  EXPECT_EQ(text.find("*paper: chair*"), std::string::npos);
  EXPECT_NE(ReportMarkdown({TwoRuns()[0]}, {}).find("| *paper: chair* | 363 | 323 | 0 | 13 | 1 |"),
            std::string::npos);
}

TEST(Report, HasTheGlobalTablesAndTheOutcomesWithoutHistory) {
  const auto runs = TwoRuns();
  const std::string text = ReportMarkdown(runs, CollectFigures(runs, {50, 1}));
  for (const char* row : {"## Global SR, all episodes", "## Global SPL, floor change required",
                          "| *paper: w/o H-POI* | 70.33 | 45.52 | 29.77 |",
                          "| *paper: OneMap* | 17.82 | 6.89 | 0.00 |",
                          "| *paper: bed* | 358 | 201 | 6 | 133 | 1 | 8 | 9 |"})
    EXPECT_NE(text.find(row), std::string::npos) << row;
}

TEST(Report, EpisodesWithOneGoalAppearBesideTheSingleObjectTable) {
  ReportRun run{"mine", {}, "paper", "oracle-perception", "aa", "bb", {}, {}};
  for (int i = 0; i < 4; ++i)
    run.episodes.push_back(test::MakeEpisode(std::to_string(i), 1, {{i < 3, 2.0, 4.0}}));
  const auto figures = CollectFigures({run}, {50, 1});
  const std::string text = ReportMarkdown({run}, figures);
  EXPECT_NE(text.find("| *paper: LifelongCrossNav* | yes | yes | no | 2000 | 59.7 | 28.0 |"),
            std::string::npos);
  EXPECT_NE(text.find("| *paper: XGX* | no | no | no | 2000 | 72.9 | 35.7 |"), std::string::npos);
  EXPECT_EQ(text.find("16.83"), std::string::npos);
  for (const ReportFigure& f : figures) {
    if (f.group == "all" && f.metric == "SR") {
      EXPECT_DOUBLE_EQ(*f.paper, 0.597);
    }
  }
}

TEST(PaperNumbers, AgreeWithThemselves) {
  for (const char* variant : {"paper", "paper-no-history-poi"}) {
    int success = 0;
    for (const PaperOutcomes& p : PaperOutcomesOf(variant)) {
      EXPECT_EQ(p.total, p.success + p.misdetection + p.stuck + p.out_of_time + p.not_reached +
                             p.all_explored)
          << p.goal;
      success += p.success;
    }
    const auto row = std::find_if(kPaperAll.begin(), kPaperAll.end(),
                                  [&](const PaperRow& r) { return r.variant == variant; });
    EXPECT_NEAR(success, 9.27 * (row->sr_global[0] + row->sr_global[1] + row->sr_global[2]), 4)
        << variant;
  }
  for (const auto& table : {kPaperAll, kPaperCrossFloor}) {
    for (const PaperRow& row : table) {
      double reached = 100;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(reached * row.spl_cond[k] / 100, row.spl_global[k], 0.02) << row.method;
        reached *= row.sr_cond[k] / 100;
        EXPECT_NEAR(reached, row.sr_global[k], 0.02) << row.method;
      }
      EXPECT_NEAR((row.sr_global[0] + row.sr_global[1] + row.sr_global[2]) / 3, row.pr, 0.02)
          << row.method;
      EXPECT_NEAR(reached, row.sr, 0.02) << row.method;
    }
  }
}

}  // namespace
}  // namespace crossnav::evaluation
