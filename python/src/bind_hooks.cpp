// SPDX-License-Identifier: MIT
// Hooks in Python: the choice of the next place, and the belief in a claim.
#include <nanobind/trampoline.h>

#include <cmath>
#include <limits>

#include "hooks_handle.h"

namespace crossnav::python {

using agent::ExplorationOption;
using agent::Hooks;
using policy::ClaimVerdict;

namespace {

/// A copy of a claim that Python may keep.
struct ClaimOut {
  Vector3d p_center_world;
  int voxels;
  policy::Verification verification;
  ClaimVerdict verdict;
};

std::vector<double> OwnScores(const std::vector<ExplorationOption>& options) {
  std::vector<double> scores;
  for (const ExplorationOption& option : options) scores.push_back(option.score_m);
  return scores;
}

class PythonHooks : public Hooks {
 public:
  NB_TRAMPOLINE(Hooks);

  std::vector<double> ScoreExploration(const agent::Situation& now,
                                       std::span<const ExplorationOption> options) override {
    constexpr const char* kWhere = "Hooks.score_exploration";
    const nb::gil_scoped_acquire python;
    const nb::detail::ticket method(nb_trampoline, "score_exploration",
                                    nb::detail::str_hash("score_exploration"), false);
    if (!method.key.is_valid()) return Hooks::ScoreExploration(now, options);
    const std::vector<ExplorationOption> list(options.begin(), options.end());
    const nb::object answer = nb_trampoline.base().attr(method.key)(now.goal.goal, now.agent, list);
    std::vector<double> scores;
    if (!nb::try_cast(nb::module_::import_("builtins").attr("list")(answer), scores))
      Raise(ErrorCode::kInvalid, "must return numbers", kWhere);
    if (scores.size() != options.size())
      Raise(ErrorCode::kInvalid, "must return one score for each option", kWhere);
    for (const double score : scores)
      if (std::isnan(score)) Raise(ErrorCode::kInvalid, "a score is not a number", kWhere);
    return scores;
  }

  ClaimVerdict JudgeClaim(const agent::Situation& now, const agent::Claim& claim) override {
    const nb::gil_scoped_acquire python;
    const nb::detail::ticket method(nb_trampoline, "judge_claim",
                                    nb::detail::str_hash("judge_claim"), false);
    if (!method.key.is_valid()) return Hooks::JudgeClaim(now, claim);
    const ClaimOut out{claim.poi.p_center_world, static_cast<int>(claim.poi.voxels.size()),
                       claim.verification, claim.verdict};
    const nb::object answer =
        nb_trampoline.base().attr(method.key)(now.goal.goal, out, ToPython(now.obs));
    ClaimVerdict verdict = ClaimVerdict::kWeak;
    if (!nb::try_cast(answer, verdict))
      Raise(ErrorCode::kInvalid, "must return a crossnav.ClaimVerdict", "Hooks.judge_claim");
    return verdict;
  }
};

void BindQuestions(nb::module_& m) {
  nb::class_<ExplorationOption>(m, "ExplorationOption", "A place that could be looked at next.")
      .def_prop_ro(
          "kind",
          [](const ExplorationOption& o) { return std::string(policy::NameOf(o.candidate.kind)); },
          "As in the trace: traversable_frontier, stair_frontier, uninspected, search_view, "
          "sighting.")
      .def_prop_ro(
          "p_focus_world",
          [](const ExplorationOption& o) { return ToArray(o.candidate.p_focus_world); }, kOwnArray,
          "(3,) [m]: focus, e.g. the cluster's centre.")
      .def_prop_ro(
          "size", [](const ExplorationOption& o) { return o.candidate.size; }, "Voxels.")
      .def_ro("path_m", &ExplorationOption::path_m, "Path length [m], turns included.")
      .def_ro("way_m", &ExplorationOption::path_m, "Old name of path_m, until version 0.4.")
      .def_ro("score_m", &ExplorationOption::score_m, "The policy's own score; the least wins.");
  nb::enum_<ClaimVerdict>(m, "ClaimVerdict", "Verdict on a claim.")
      .value("AGREED", ClaimVerdict::kAgreed, "STOP here and now.")
      .value("WEAK", ClaimVerdict::kWeak, "Look from elsewhere.")
      .value("REFUTED", ClaimVerdict::kRefuted, "Give the object up.");
  nb::class_<ClaimOut>(m, "Claim", "Verification of a possible goal object by a frame.")
      .def_prop_ro(
          "p_center_world", [](const ClaimOut& c) { return ToArray(c.p_center_world); }, kOwnArray,
          "(3,) [m]")
      .def_ro("voxels", &ClaimOut::voxels, "Of the object, seen so far.")
      .def_prop_ro("confidence", [](const ClaimOut& c) { return c.verification.confidence; })
      .def_prop_ro("mask_quality", [](const ClaimOut& c) { return c.verification.mask_quality; })
      .def_prop_ro(
          "visibility", [](const ClaimOut& c) { return c.verification.visibility; },
          "Share of it that is in view.")
      .def_prop_ro("distance_m", [](const ClaimOut& c) { return c.verification.distance_m; })
      .def_prop_ro(
          "failed_check", [](const ClaimOut& c) { return c.verification.failed_check; },
          "The first of the policy's checks that did not pass; empty if all did.")
      .def_ro("verdict", &ClaimOut::verdict, "The policy's own.");
}

}  // namespace

agent::Hooks* HooksOf(const nb::object& hooks, const agent::Config& config) {
  if (hooks.is_none()) return nullptr;
  if (!nb::isinstance<Hooks>(hooks))
    Raise(ErrorCode::kInvalid, "must be a crossnav.Hooks", "hooks");
  if (config.policy.profile != "full")
    Raise(ErrorCode::kInvalid, "the literal method of the paper asks no hooks: use \"full\"",
          "policy.profile");
  return nb::cast<Hooks*>(hooks);
}

void BindHooks(nb::module_& m) {
  BindQuestions(m);
  nb::class_<Hooks, PythonHooks>(
      m, "Hooks", "Decisions to override; each gets the policy's own answer and may keep it.")
      .def(nb::init<>())
      .def(
          "score_exploration",
          [](Hooks&, const std::string&, const AgentPose&,
             const std::vector<ExplorationOption>& options) { return OwnScores(options); },
          "goal"_a, "agent"_a, "options"_a,
          nb::sig("def score_exploration(self, goal: str, agent: AgentPose, options: "
                  "collections.abc.Sequence[ExplorationOption]) -> "
                  "collections.abc.Sequence[float]"),
          "A score for each reachable place: the least is chosen, inf never.")
      .def(
          "judge_claim",
          [](Hooks&, const std::string&, const ClaimOut& claim, const Observation&) {
            return claim.verdict;
          },
          "goal"_a, "claim"_a, "observation"_a,
          "Whether an object in view is believed to be the goal.");
}

}  // namespace crossnav::python
