// SPDX-License-Identifier: MIT
// A house on later days, generated or imported. Overnight, objects are moved, removed and added,
// doors closed, passages and flights barred, at plausible places. The house stays usable
// (day_gate.h). Same seed, same bytes.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/core/rng.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/world/change/changes.h"
#include "crossnav/world/change/house_view.h"

namespace crossnav::world {

/// Every kind once.
std::vector<ChangeKind> AllChangeKinds();

struct DaysOptions {
  std::uint64_t seed = 1;
  int days = 1;
  std::vector<ChangeKind> kinds = AllChangeKinds();  ///< applied each night, in this order
  sim::NavMeshSettings navmesh = {};
  /// Where no draw passes the gate, draws with fewer and fewer kinds, the last one with none.
  /// False: an error; suites rely on it.
  bool may_be_fewer = false;
  /// Only objects that are the one instance of their category change; kinds without such an object
  /// are missing.
  bool only_by_category = false;
};

/// A house on one day.
struct HouseDay {
  sim::Scene scene;
  DayChanges list;
  std::vector<ChangeKind> missing;     ///< kinds for which the house has no place
  std::set<std::pair<int, int>> shut;  ///< rooms behind a bar (floor, region)
  int attempts = 0;                    ///< draws until one passed the gate
};

/// Draws the days of a house in order; writes no files.
class HouseCalendar {
 public:
  /// Error: as ViewHouse.
  static Result<HouseCalendar> Begin(sim::Scene first, const DaysOptions& options);

  /// The next day. Error: no draw passed the gate, with the reasons.
  Result<HouseDay> Next();

  const sim::Scene& first() const { return *first_; }

 private:
  HouseCalendar(std::unique_ptr<sim::Scene> first, HouseView view, sim::NavMesh first_spare,
                const DaysOptions& options)
      : first_(std::move(first)),
        view_(std::move(view)),
        first_spare_(std::move(first_spare)),
        options_(options),
        evening_(*first_) {}

  Result<HouseDay> Draw(const HouseView& evening, int attempt) const;
  /// Kinds that an attempt makes.
  std::vector<ChangeKind> KindsOf(int attempt, Rng& rng) const;

  std::unique_ptr<sim::Scene> first_;
  HouseView view_;            // of the first day
  sim::NavMesh first_spare_;  // of the first day, with room to spare
  DaysOptions options_;
  sim::Scene evening_;          // of the previous day, without its boards
  std::vector<Change> barred_;  // on the previous day
  int day_ = 0;
};

struct DayReport {
  std::filesystem::path folder;
  DayChanges list;
  std::vector<ChangeKind> missing;
};

/// Reads the scene of `house`, writes `<out_dir>/<id>-day1` ... with their lists of changes; an
/// empty `out_dir` is the folder that holds the house.
Result<std::vector<DayReport>> WriteDays(const std::filesystem::path& house,
                                         const std::filesystem::path& out_dir,
                                         const DaysOptions& options);

/// Removes all but one instance of each category that people move (chair, sofa, plant, screen).
/// The instance that stays may move, if one may; instances with a load stay, too. Error: as
/// ViewHouse.
Result<void> KeepOneOfEachCategory(sim::Scene& scene, const sim::NavMeshSettings& navmesh = {});

/// The same for the scene in the folder `house`.
Result<void> RewriteWithOneOfEachCategory(const std::filesystem::path& house);

}  // namespace crossnav::world
