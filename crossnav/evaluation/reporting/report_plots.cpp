// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "crossnav/evaluation/reporting/paper_numbers.h"
#include "crossnav/evaluation/reporting/report.h"

namespace crossnav::evaluation {
namespace {

constexpr std::array<std::string_view, 6> kRunColours = {"#d62728", "#1f77b4", "#2ca02c",
                                                         "#9467bd", "#ff7f0e", "#8c564b"};
constexpr std::array<std::string_view, kOutcomeNames.size()> kOutcomeColours = {
    "#2ca02c", "#bcbd22", "#d62728", "#7f7f7f", "#9467bd", "#ff7f0e"};

std::string Escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '<') {
      escaped += "&lt;";
    } else if (c == '&') {
      escaped += "&amp;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Rect(double x, double y, double width, double height, std::string_view colour) {
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
      "fill=\"{}\"/>\n",
      x, y, width, height, colour);
}

std::string Line(double x0, double y0, double x1, double y1, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0,
                     x1, y1, style);
}

std::string Text(double x, double y, const std::string& text, std::string_view anchor = "start") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     Escape(text));
}

std::string Open(double width, double height, const std::string& title) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
             "height=\"{1}\" font-family=\"sans-serif\" font-size=\"12\">\n"
             "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
             width, height) +
         Text(10, 18, title);
}

constexpr double kLeft = 50, kTop = 40, kHeight = 240, kGroupWidth = 170;

double Y(double percent) {
  return kTop + kHeight * (1 - percent / 100);
}

std::string Axis(double right) {
  std::string svg;
  for (int percent = 0; percent <= 100; percent += 20) {
    svg += Line(kLeft, Y(percent), right, Y(percent), "stroke=\"#ddd\"");
    svg += Text(kLeft - 6, Y(percent) + 4, std::to_string(percent), "end");
  }
  return svg;
}

const ReportFigure* FindAll(const std::vector<ReportFigure>& figures, const std::string& run,
                            const std::string& metric) {
  for (const ReportFigure& f : figures) {
    if (f.run == run && f.group == "all" && f.metric == metric) return &f;
  }
  return nullptr;
}

std::string Bar(const ReportFigure& figure, double x, double width, std::string_view colour) {
  const double value = 100 * figure.value;
  std::string svg = Rect(x, Y(value), width, Y(0) - Y(value), colour);
  const double middle = x + width / 2;
  if (figure.interval) {
    svg += Line(middle, Y(100 * figure.interval->low), middle, Y(100 * figure.interval->high),
                "stroke=\"black\"");
  }
  if (figure.paper) {
    svg += Line(x - 2, Y(100 * *figure.paper), x + width + 2, Y(100 * *figure.paper),
                "stroke=\"black\" stroke-width=\"2\" stroke-dasharray=\"4 2\"");
  }
  return svg;
}

std::array<int, kOutcomeNames.size()> CountsOf(const PaperOutcomes& p) {
  return {p.success, p.not_reached, p.misdetection, p.all_explored, p.stuck, p.out_of_time};
}

/// A bar of shares, from left to right.
std::string Stack(const std::array<int, kOutcomeNames.size()>& counts, double y,
                  const std::string& label) {
  constexpr double kStart = 170, kWidth = 400, kBar = 14;
  double total = 0;
  for (const int count : counts) total += count;
  std::string svg = Text(kStart - 8, y + 11, fmt::format("{} ({:.0f})", label, total), "end");
  double x = kStart;
  for (std::size_t i = 0; i < counts.size() && total > 0; ++i) {
    const double width = kWidth * counts[i] / total;
    svg += Rect(x, y, width, kBar, kOutcomeColours[i]);
    x += width;
  }
  return svg;
}

}  // namespace

std::string StagePlotSvg(const std::vector<ReportRun>& runs,
                         const std::vector<ReportFigure>& figures, const std::string& metric) {
  int goals = 0;
  while (!runs.empty() &&
         FindAll(figures, runs[0].name, fmt::format("SR_global_{}", goals + 1)) != nullptr) {
    ++goals;
  }
  const double right = kLeft + kGroupWidth * goals;
  const double bottom = kTop + kHeight;
  std::string svg = Open(right + 20, bottom + 40 + 18 * static_cast<double>(runs.size()),
                         metric + " per stage, per cent (dashed: the paper)");
  svg += Axis(right);
  const double bar =
      (kGroupWidth - 40) / static_cast<double>(std::max<std::size_t>(1, runs.size()));
  for (int k = 0; k < goals; ++k) {
    const double x = kLeft + kGroupWidth * k + 20;
    svg += Text(x + (kGroupWidth - 40) / 2, bottom + 16, fmt::format("k={}", k + 1), "middle");
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const auto* figure = FindAll(figures, runs[r].name, fmt::format("{}_{}", metric, k + 1));
      if (figure == nullptr) continue;
      svg += Bar(*figure, x + bar * static_cast<double>(r) + 2, bar - 4,
                 kRunColours[r % kRunColours.size()]);
    }
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double y = bottom + 26 + 18 * static_cast<double>(r);
    svg += Rect(kLeft, y, 12, 12, kRunColours[r % kRunColours.size()]);
    svg += Text(kLeft + 18, y + 11, runs[r].name);
  }
  return svg + "</svg>\n";
}

std::string OutcomePlotSvg(const ReportRun& run) {
  const OutcomeTable table = CountOutcomes(run.episodes);
  std::string svg = Open(600, 60 + 44 * 7.0 + 20 * 6, run.name + ": outcomes per goal");
  double y = 36;
  for (const auto& [goal, counts] : table) {
    svg += Stack(counts, y, goal);
    y += 18;
    for (const PaperOutcomes& paper : PaperOutcomesOf(run.variant)) {
      if (paper.goal != goal) continue;
      svg += Stack(CountsOf(paper), y, "paper");
      y += 18;
    }
    y += 8;
  }
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    svg += Rect(170, y, 12, 12, kOutcomeColours[i]);
    svg += Text(188, y + 11, std::string(kOutcomeNames[i]));
    y += 18;
  }
  return svg + "</svg>\n";
}

}  // namespace crossnav::evaluation
