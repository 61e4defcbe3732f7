// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/world/house/house_generator.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Counts = std::map<std::string, int>;

/// Statistics of a set of houses.
struct Totals {
  int asked = 0, plans = 0;
  std::vector<std::string> failed;  ///< messages
  std::map<int, int> floors;
  Counts stairs, rooms, instances, refusals;
  std::vector<double> area_m2, cpu_s, wall_s, megabytes, largest_mb;

  int Passed() const { return asked - static_cast<int>(failed.size()); }
};

double LargestFile(const fs::path& folder) {
  std::uintmax_t most = 0;
  for (const auto& file : fs::directory_iterator(folder)) most = std::max(most, file.file_size());
  return static_cast<double>(most) / 1e6;
}

void Add(const Counts& from, Counts& to) {
  for (const auto& [name, count] : from) to[name] += count;
}

void Add(const world::HouseReport& house, Totals& totals) {
  totals.plans += house.attempts;
  ++totals.floors[house.floors];
  Add(house.stairs, totals.stairs);
  Add(house.rooms, totals.rooms);
  Add(house.instances, totals.instances);
  Add(house.refusals, totals.refusals);
  totals.area_m2.push_back(house.area_m2);
  totals.megabytes.push_back(static_cast<double>(house.bytes) / 1e6);
  totals.largest_mb.push_back(LargestFile(house.folder));
}

std::string CountsText(const Counts& counts) {
  std::string text;
  for (const auto& [name, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text.empty() ? "none" : text;
}

std::string SpreadText(const std::vector<double>& values, int digits) {
  return fmt::format("{:.{}f} / {:.{}f} / {:.{}f}", evaluation::PercentileOf(values, 0.5), digits,
                     evaluation::PercentileOf(values, 0.95), digits,
                     evaluation::PercentileOf(values, 1), digits);
}

std::string Table(const Totals& t) {
  std::string floors, text = "| quantity | figure |\n|---|---|\n";
  for (const auto& [count, houses] : t.floors) {
    floors += fmt::format("{}{} of {}", floors.empty() ? "" : ", ", houses, count);
  }
  const auto row = [&](const char* what, const std::string& figure) {
    text += fmt::format("| {} | {} |\n", what, figure);
  };
  row("houses that passed", fmt::format("{} of {}", t.Passed(), t.asked));
  row("plans that passed", fmt::format("{} of {} drawn", t.Passed(), t.plans));
  row("why plans did not", CountsText(t.refusals));
  row("floors", floors);
  row("stairs", CountsText(t.stairs));
  row("walkable m2, median / p95 / max", SpreadText(t.area_m2, 0));
  row("rooms", CountsText(t.rooms));
  row("goal objects", CountsText(t.instances));
  row("CPU seconds a house, median / p95 / max", SpreadText(t.cpu_s, 2));
  row("MB a house, all files, median / p95 / max", SpreadText(t.megabytes, 1));
  row("MB of its largest file, median / p95 / max", SpreadText(t.largest_mb, 1));
  for (const std::string& failed : t.failed) text += "\nfailed: " + failed;
  return text;
}

Json SpreadJson(const std::vector<double>& values) {
  return {{"median", evaluation::PercentileOf(values, 0.5)},
          {"p95", evaluation::PercentileOf(values, 0.95)},
          {"max", evaluation::PercentileOf(values, 1)}};
}

Json Document(const Totals& t, const world::FurniturePack* pack) {
  Json floors = Json::object();
  for (const auto& [count, houses] : t.floors) floors[std::to_string(count)] = houses;
  return {{"furniture_pack", pack != nullptr ? Json(pack->hash()) : Json(nullptr)},
          {"asked", t.asked},
          {"passed", t.Passed()},
          {"plans", t.plans},
          {"failed", t.failed},
          {"refusals", t.refusals},
          {"floors", std::move(floors)},
          {"stairs", t.stairs},
          {"rooms", t.rooms},
          {"instances", t.instances},
          {"area_m2", SpreadJson(t.area_m2)},
          {"cpu_s", SpreadJson(t.cpu_s)},
          {"wall_s", SpreadJson(t.wall_s)},
          {"house_mb", SpreadJson(t.megabytes)},
          {"largest_file_mb", SpreadJson(t.largest_mb)}};
}

}  // namespace

Result<void> WorldStats(const WorldOptions& options, const CommonOptions& /*common*/,
                        Console& console) {
  const auto pack = OpenFurniture(options.furniture, console);
  if (!pack) return tl::unexpected(pack.error());
  const world::FurniturePack* source = *pack ? &**pack : nullptr;
  const fs::path place = fs::temp_directory_path() / fmt::format("crossnav_stats_{}", ::getpid());
  Totals totals;
  for (int i = 0; i < options.count; ++i) {
    console.Progress(fmt::format("house {} of {}", i + 1, options.count));
    const world::HouseParams params = options.ParamsOf(i);
    const std::clock_t cpu = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const auto house = world::GenerateHouse(params, place, source);
    ++totals.asked;
    if (house) {
      const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
      totals.cpu_s.push_back(static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
      totals.wall_s.push_back(wall.count());
      Add(*house, totals);
    } else {
      totals.plans += world::AttemptsFor(params);
      totals.failed.push_back(house.error().Message());
    }
    std::error_code ignored;
    fs::remove_all(place, ignored);
  }
  console.EndProgress();
  console.Print(Table(totals));
  console.Document(Document(totals, source));
  return {};
}

}  // namespace crossnav::app
