// SPDX-License-Identifier: MIT
#include "depth_noise_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace crossnav::app {

using Json = nlohmann::ordered_json;

namespace {

Json Document(const evaluation::DepthStatistics& statistics) {
  Json sigmas = Json::array(), lost = Json::array();
  for (int d = 0; d < 4; ++d) {
    Json row = {{"from_m", evaluation::kDistances_m[d]}, {"sigma_m", Json::array()}};
    for (int a = 0; a < 4; ++a) row["sigma_m"].push_back(statistics.SigmaOf(d, a));
    sigmas.push_back(std::move(row));
  }
  for (int k = 0; k < 4; ++k)
    lost.push_back(static_cast<double>(statistics.lost[k]) /
                   std::max(1.0, static_cast<double>(statistics.lit[k])));
  return {{"sigmas", sigmas},
          {"lost_by_light", lost},
          {"edges", statistics.edges},
          {"flying_share", static_cast<double>(statistics.flying) /
                               std::max(1.0, static_cast<double>(statistics.edges))}};
}

}  // namespace

std::string NoiseJson(const evaluation::DepthStatistics& statistics) {
  return Document(statistics).dump();
}

std::string NoiseText(const evaluation::DepthStatistics& statistics) {
  const Json noise = Document(statistics);
  std::string text = "  noise about planes [mm], angles of 0, 30, 60, 75 degrees and more:";
  for (const Json& row : noise["sigmas"]) {
    text += fmt::format(" | from {} m:", row["from_m"].get<double>());
    for (const Json& sigma : row["sigma_m"])
      text += sigma.get<double>() > 0 ? fmt::format(" {:.1f}", 1000 * sigma.get<double>()) : " -";
  }
  text += "\n  lost pixels by light up to 16, 32, 64, 255:";
  for (const Json& share : noise["lost_by_light"])
    text += fmt::format(" {:.1f} %", 100 * share.get<double>());
  return text + fmt::format("; at edges {:.0f} % of {} lie between both sides\n",
                            100 * noise["flying_share"].get<double>(), noise["edges"].get<long>());
}

}  // namespace crossnav::app
