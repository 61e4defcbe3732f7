// SPDX-License-Identifier: MIT
#include "lifelong_houses.h"

#include <fmt/format.h>

#include <map>

#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/lifelong/visit_maker.h"
#include "crossnav/evaluation/running/worker_pool.h"
#include "crossnav/world/change/house_days.h"
#include "crossnav/world/house/house_generator.h"
#include "suite_buildings.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;

/// Origin of the houses. Drawn homes (evaluation::DrawnHomes) and imported buildings come in turn,
/// each several times.
enum class Origin { kGenerated, kDrawn, kImported };

struct LifelongSuite {
  const char* name;
  std::uint64_t first_seed;
  int houses;  ///< 0: kTimesABuilding for each imported building
  int days;    ///< after the first
  Origin origin = Origin::kGenerated;
  bool is_of_classes = false;  ///< goals are categories, of which the house has one instance each
};
constexpr int kTimesABuilding = 3;  // chosen: as often as a drawn home; other nights each time
// Seeds 7001 to 7040 are run to report only.
constexpr LifelongSuite kSuites[] = {
    {"crossnav-lifelong-1", 7001, 40, 3},
    {"crossnav-lifelong-1-week", 7001, 40, 6},
    {"crossnav-lifelong-1-drawn", 1, 27, 3, Origin::kDrawn},
    {"crossnav-lifelong-1-bim", 1, 0, 3, Origin::kImported},
    {"crossnav-lifelong-1-classes", 7001, 40, 3, Origin::kGenerated, true},
    {"crossnav-lifelong-1-val", 8101, 10, 3},
    {"crossnav-lifelong-1-dev", 8111, 30, 3},
    {"crossnav-lifelong-1-mini", 8001, 1, 2}};
constexpr std::uint64_t kSeedsAHouse = 5;  // chosen: that may be tried for each house
Result<LifelongSuite> SuiteOf(const std::string& name) {
  for (const LifelongSuite& suite : kSuites) {
    if (name == suite.name) return suite;
  }
  return Fail(
      ErrorCode::kNotFound,
      "no suite of this name; there are crossnav-lifelong-1, -week, -drawn, -bim, -classes, "
      "-val, -dev and -mini",
      name);
}

/// Changes of each night of the suite: one per track, or the two that ask for a search elsewhere.
std::vector<world::ChangeKind> NightOf(const LifelongSuite& suite) {
  using world::ChangeKind;
  if (suite.is_of_classes) return {ChangeKind::kOtherFloor, ChangeKind::kOtherFurniture};
  return {ChangeKind::kSameFurniture, ChangeKind::kOtherFurniture, ChangeKind::kOtherRoom,
          ChangeKind::kOtherFloor,    ChangeKind::kRemoved,        ChangeKind::kDoorClosed};
}

/// Settings for making visits, independent of the user's settings.
evaluation::RunConfig MakerConfig() {
  evaluation::RunConfig config;
  config.dataset.certificate = "detection";
  return config;
}

struct HouseSource {
  LifelongSuite suite;
  fs::path jar;                     ///< of Sweet Home 3D, for drawn homes
  std::vector<fs::path> buildings;  ///< scene folders, for imported buildings
  LifelongPlace place;
};

/// Scene folder of the first day; empty if the seed gives no house.
Result<fs::path> FirstDay(std::uint64_t seed, const HouseSource& source) {
  const std::uint64_t index = seed - source.suite.first_seed;
  if (source.suite.origin == Origin::kDrawn) {
    return ImportDrawnHome(source.jar, index % evaluation::DrawnHomes().size(),
                           static_cast<int>(seed), source.place.scenes());
  }
  if (source.suite.origin == Origin::kImported) {
    return CopyBuilding(source.buildings[index % source.buildings.size()], static_cast<int>(seed),
                        source.place.scenes());
  }
  world::HouseParams params;
  params.seed = seed;
  params.floors = seed % 3 == 0 ? 3 : 2;
  const auto house = world::GenerateHouse(params, source.place.scenes());
  if (!house && house.error().code == ErrorCode::kInvalid) return fs::path();
  if (!house) return tl::unexpected(house.error());
  if (source.suite.is_of_classes) {
    if (auto ok = world::RewriteWithOneOfEachCategory(house->folder); !ok)
      return tl::unexpected(ok.error());
  }
  return house->folder;
}

/// House with its days and visits; empty text if the seed gives no house.
Result<std::string> MakeHouse(std::uint64_t seed, const HouseSource& source) {
  const auto first = FirstDay(seed, source);
  if (!first) return tl::unexpected(first.error());
  if (first->empty()) return std::string();
  const LifelongSuite& suite = source.suite;
  const fs::path scenes = source.place.scenes();
  world::DaysOptions options;
  options.seed = seed;
  options.days = suite.days;
  options.kinds = NightOf(suite);
  options.only_by_category = suite.is_of_classes;
  options.may_be_fewer = suite.origin != Origin::kGenerated;  // another seed is no other home
  const auto days = world::WriteDays(*first, scenes, options);
  if (!days && days.error().code == ErrorCode::kInvalid) return std::string();
  if (!days) return tl::unexpected(days.error());
  const evaluation::RunConfig config = MakerConfig();
  std::vector<evaluation::VisitDay> visited;
  for (int day = 0; day <= suite.days; ++day) {
    evaluation::VisitDay next;
    const std::string id = day == 0 ? first->filename().string()
                                    : (*days)[static_cast<std::size_t>(day) - 1].list.scene;
    auto context = evaluation::SceneContext::Load(scenes, id, config);
    if (!context) return tl::unexpected(context.error());
    next.scene_id = id;
    next.context = std::move(*context);
    if (day > 0) next.list = (*days)[static_cast<std::size_t>(day) - 1].list;
    visited.push_back(std::move(next));
  }
  const auto visits = evaluation::MakeVisits(visited, seed);
  if (!visits && visits.error().code == ErrorCode::kInvalid) return std::string();
  if (!visits) return tl::unexpected(visits.error());
  return evaluation::VisitsText(*visits);
}

Result<void> MakeHouses(const HouseSource& source, int jobs, int wanted, std::uint64_t& seed,
                        std::vector<evaluation::HouseVisit>& visits, int& houses,
                        Console& console) {
  std::map<int, std::string> texts;
  const std::uint64_t first = seed;
  evaluation::PoolTask task;
  task.count = wanted;
  task.jobs = jobs;
  task.work = [&](int item) { return MakeHouse(first + static_cast<std::uint64_t>(item), source); };
  task.deliver = [&](int item, const evaluation::ItemAnswer& answer) -> Result<void> {
    if (answer.end != evaluation::ItemEnd::kDone) {
      return Fail(answer.error.code, answer.error.Message(),
                  fmt::format("house of seed {}", first + static_cast<std::uint64_t>(item)));
    }
    texts[item] = answer.text;
    console.Progress(fmt::format("house {} of {}", houses + static_cast<int>(texts.size()),
                                 source.suite.houses));
    return {};
  };
  if (auto ok = evaluation::RunPool(task); !ok) return ok;
  seed += static_cast<std::uint64_t>(wanted);
  for (const auto& [item, text] : texts) {
    if (text.empty()) continue;
    auto file = evaluation::ParseVisits(text, source.suite.name);
    if (!file) return tl::unexpected(file.error());
    ++houses;
    for (auto& visit : file->visits) visits.push_back(std::move(visit));
  }
  return {};
}

/// Error: the archive of drawn homes, or the folder of imported buildings, is not there.
Result<HouseSource> SourceOf(const LifelongSuite& suite, const SuiteOptions& options) {
  HouseSource source{suite, options.homes, {}, LifelongPlaceOf(options)};
  if (suite.origin == Origin::kDrawn) {
    if (auto ok = CheckHomesArchive(source.jar); !ok) return tl::unexpected(ok.error());
  }
  if (suite.origin == Origin::kImported) {
    auto buildings = ListBuildings(options.buildings, options.name);
    if (!buildings) return tl::unexpected(buildings.error());
    source.buildings = std::move(*buildings);
    source.suite.houses = kTimesABuilding * static_cast<int>(source.buildings.size());
  }
  return source;
}

}  // namespace

LifelongPlace LifelongPlaceOf(const SuiteOptions& options) {
  return {fs::path(options.out) / options.name};
}

Result<evaluation::VisitFile> EnsureVisits(const SuiteOptions& options, Console& console) {
  const auto suite = SuiteOf(options.name);
  if (!suite) return tl::unexpected(suite.error());
  const LifelongPlace place = LifelongPlaceOf(options);
  std::error_code ignored;
  if (fs::exists(place.visits(), ignored)) return evaluation::ReadVisits(place.visits());
  if (auto ok = evaluation::CheckOutputFile(place.visits(), "--out"); !ok) {
    return tl::unexpected(ok.error());
  }
  const auto source = SourceOf(*suite, options);
  if (!source) return tl::unexpected(source.error());
  fs::remove_all(place.scenes(), ignored);  // of a make that was interrupted
  std::vector<evaluation::HouseVisit> visits;
  int houses = 0;
  const int in_all = source->suite.houses;
  std::uint64_t seed = suite->first_seed;
  const std::uint64_t last = seed + kSeedsAHouse * static_cast<std::uint64_t>(in_all);
  while (houses < in_all) {
    if (seed >= last) return Fail(ErrorCode::kInvalid, "too few seeds give a house", suite->name);
    const int wanted = in_all - houses;
    if (auto ok = MakeHouses(*source, options.jobs, wanted, seed, visits, houses, console); !ok) {
      return tl::unexpected(ok.error());
    }
  }
  console.EndProgress();
  if (auto ok = WriteFileAtomically(place.visits(), evaluation::VisitsText(visits)); !ok) {
    return tl::unexpected(ok.error());
  }
  return evaluation::ReadVisits(place.visits());
}

}  // namespace crossnav::app
