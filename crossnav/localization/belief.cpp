// SPDX-License-Identifier: MIT
#include "crossnav/localization/belief.h"

#include <algorithm>
#include <array>
#include <utility>

#include "crossnav/localization/pose_search.h"

namespace crossnav::localization {

std::string_view NameOf(Status status) {
  switch (status) {
    case Status::kLocalising:
      return "localising";
    case Status::kKnown:
      return "known";
    case Status::kUnknown:
      return "unknown";
  }
  return "";
}

void Belief::Search(const LocalScan& scan, const Vector3d& p_foot_odom) {
  std::vector<Hypothesis> all = SearchPoses(map_.dense, map_.places, scan, p_foot_odom, config_);
  all.insert(all.end(), hypotheses_.begin(), hypotheses_.end());
  Keep(std::move(all), scan, p_foot_odom);
}

void Belief::Recheck(const LocalScan& scan, const Vector3d& p_foot_odom) {
  Keep(std::exchange(hypotheses_, {}), scan, p_foot_odom);
}

/// Keeps the hypotheses with the best agreement, one of each similar pose.
void Belief::Keep(std::vector<Hypothesis> all, const LocalScan& scan, const Vector3d& p_foot_odom) {
  const auto points = RefinePoints(scan, p_foot_odom, config_);
  for (Hypothesis& h : all) {
    const bool is_older = !h.verdicts.empty();
    if (is_older) Refine(map_.dense, points, p_foot_odom, config_, h);
    CheckBeams(map_.dense, scan.beams(), h);
  }
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.agreement > b.agreement;
  });
  hypotheses_.clear();
  for (Hypothesis& h : all) {
    const bool is_listed =
        std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& other) {
          return IsSame(h.T_map_odom, other.T_map_odom, p_foot_odom, config_);
        });
    if (!is_listed) hypotheses_.push_back(std::move(h));
    if (static_cast<int>(hypotheses_.size()) >= config_.kept) break;
  }
  Judge(scan, p_foot_odom);
}

/// Whether a lead is decisive, as a share of all beams or by the beams that differ: floors that
/// look alike agree on most beams.
bool Belief::IsAhead(const Lead& lead, std::size_t beams) const {
  if (lead.share(beams) >= config_.least_lead) return true;
  return lead.share(beams) >= config_.least_share && lead.sigmas() >= config_.least_sigmas;
}

/// A flat wall leaves two degrees of freedom open: shifts along it score the same.
bool Belief::IsPinned(const std::vector<Vector3f>& points, const Vector3d& p_foot_odom) const {
  const Pose& T = hypotheses_.front().T_map_odom;
  const Vector3d p = T * p_foot_odom;
  const double yaw = YawOf(T), shift = config_.pinned_m, turn = DegToRad(config_.pinned_deg);
  const double most = config_.pinned_share * ScorePose(map_.dense, points, T);
  constexpr std::array<std::array<double, 2>, 8> kAround = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.7, 0.7}, {0.7, -0.7}, {-0.7, 0.7}, {-0.7, -0.7}}};
  for (const auto& [x, y] : kAround) {
    const Pose shifted = PlaceAt(p + shift * Vector3d(x, y, 0), yaw, p_foot_odom);
    if (ScorePose(map_.dense, points, shifted) > most) return false;
  }
  return ScorePose(map_.dense, points, PlaceAt(p, yaw + turn, p_foot_odom)) <= most &&
         ScorePose(map_.dense, points, PlaceAt(p, yaw - turn, p_foot_odom)) <= most;
}

void Belief::Judge(const LocalScan& scan, const Vector3d& p_foot_odom) {
  opinion_ = LocalizeStep{};
  if (hypotheses_.empty()) return;
  const Hypothesis& best = hypotheses_.front();
  const std::size_t beams = scan.beams().size();
  opinion_.T_map_odom = best.T_map_odom;
  opinion_.agreement = best.agreement;
  opinion_.lead = 1;
  opinion_.is_pinned = IsPinned(RefinePoints(scan, p_foot_odom, config_), p_foot_odom);
  for (std::size_t i = 1; i < hypotheses_.size(); ++i) {
    const Lead lead = LeadOf(best, hypotheses_[i]);
    opinion_.rivals += IsAhead(lead, beams) ? 0 : 1;
    if (lead.share(beams) >= opinion_.lead) continue;
    opinion_.lead = lead.share(beams);
    opinion_.nearest = lead;
  }
  const bool is_sure = static_cast<int>(beams) >= config_.least_beams && opinion_.is_pinned &&
                       best.agreement >= config_.least_agreement && opinion_.rivals == 0;
  if (is_sure) opinion_.status = Status::kKnown;
}

}  // namespace crossnav::localization
