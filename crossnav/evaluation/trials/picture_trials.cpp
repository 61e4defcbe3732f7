// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/picture_trials.h"

#include <algorithm>

#include "crossnav/agent/state.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/evaluation/episodes/picture_view.h"
#include "crossnav/evaluation/generation/goal_pictures.h"
#include "crossnav/evaluation/running/survey.h"
#include "crossnav/evaluation/trials/graph_trials.h"
#include "crossnav/perception/goal_picture.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::evaluation {
namespace {

constexpr double kAboutObject_m = 0.3;  // chosen: three voxels about the true box

/// The memory and the records of an agent that has looked at the whole house.
class Onlooker {
 public:
  Onlooker(const RunConfig& config, perception::PerceptionSuite& suite)
      : config_(config.agent), suite_(suite), world_(config.agent) {}

  Result<void> Look(const Observation& obs) {
    const auto features = suite_.encoder->EncodeImage(obs);
    if (!features) return tl::unexpected(features.error());
    const auto& ends = world_.map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    world_.map.UpdateStates();
    world_.memory.FuseRuns(ends.runs(), obs.depth_m, obs.camera, obs.T_world_camera,
                           {features->rows, features->cols, features->dim, features->data});
    for (const std::string_view category : kCategories)
      if (auto ok = NoteObjects(obs, category); !ok) return ok;
    return {};
  }

  const agent::World& world() const { return world_; }

 private:
  Result<void> NoteObjects(const Observation& obs, std::string_view category) {
    auto found = suite_.detector->Detect(obs, category);
    if (!found) return tl::unexpected(found.error());
    for (perception::Detection& detection : *found)
      if (auto ok = suite_.segmenter->Segment(obs, detection); !ok) return ok;
    const policy::ObjectConfig& object = config_.policy.object;
    std::vector<objects::SeenObject> seen;
    for (const policy::Sighting& sighting :
         policy::LiftDetections(*found, obs, config_.map, object, object.secondary_confidence)) {
      const auto& detection = (*found)[static_cast<std::size_t>(sighting.detection)];
      seen.push_back({SpacedName(category),
                      sighting.voxels,
                      sighting.confidence,
                      &detection.mask,
                      {detection.box.u0, detection.box.v0, detection.box.u1, detection.box.v1}});
    }
    (void)world_.objects.Note(seen, obs, {0, notes_++});
    return {};
  }

  const agent::Config& config_;
  perception::PerceptionSuite& suite_;
  agent::World world_;
  std::int64_t notes_ = 0;
};

bool IsOf(const objects::ObjectRecord& record, const sim::SceneInstance& instance) {
  const Vector3d& p = record.centre_world_m;
  return (p.array() >= instance.box.min.array() - kAboutObject_m).all() &&
         (p.array() <= instance.box.max.array() + kAboutObject_m).all();
}

Result<PictureTrial> JudgePicture(const StagePicture& picture, const sim::SceneInstance& instance,
                                  const agent::World& world, perception::PerceptionSuite& suite) {
  auto pictured = agent::PicturedGoalOf(picture.picture, suite);
  if (!pictured) return tl::unexpected(pictured.error());
  auto text = suite.encoder->EncodeText(pictured->category);
  if (!text) return tl::unexpected(text.error());
  agent::GoalState goal;
  goal.goal = pictured->category;
  goal.text = std::move(*text);
  goal.pictured = std::move(*pictured);
  PictureTrial trial;
  trial.category = instance.category;
  trial.read_as = goal.goal;
  double best = -1e9;
  for (const objects::ObjectRecord& record : world.objects.Confirmed()) {
    if (record.category != SpacedName(goal.goal)) continue;
    PicturePair pair;
    pair.is_same = IsOf(record, instance);
    pair.likeness = LikenessAt(world, goal, record.voxels, record.centre_world_m);
    pair.log_odds = LogOdds(pair.likeness, goal.pictured->encoder_name);
    trial.has_record |= pair.is_same;
    trial.rivals += pair.is_same ? 0 : 1;
    if (pair.log_odds > best) trial.is_right = pair.is_same;
    best = std::max(best, pair.log_odds);
    trial.pairs.push_back(pair);
  }
  return trial;
}

/// Objects to take pictures of.
std::vector<const sim::SceneInstance*> ObjectsOf(const SceneContext& context, PictureTaker& taker,
                                                 int each, Rng& rng) {
  std::vector<const sim::SceneInstance*> chosen;
  for (const std::string_view category : kCategories) {
    std::vector<const sim::SceneInstance*> all;
    for (const sim::SceneInstance& instance : context.scene().instances)
      if (instance.category == category) all.push_back(&instance);
    if (all.size() < 2) continue;
    rng.Shuffle(all);
    int left = each;
    for (const sim::SceneInstance* instance : all)
      if (left > 0 && !taker.HasTwin(*instance)) {
        chosen.push_back(instance);
        --left;
      }
  }
  return chosen;
}

}  // namespace

Result<PictureTrials> TryPictures(std::uint64_t seed, int each, const RunConfig& config,
                                  const MakePerception& make_perception) {
  world::HouseParams params;
  params.seed = seed;
  params.edition = 2;
  std::unique_ptr<SceneContext> context;
  const auto plan = PassedPlan(params, config, context);
  if (!plan) return tl::unexpected(plan.error());
  PictureTaker taker(*context);
  Rng rng(MixSeed(seed, 47));
  std::vector<std::pair<StagePicture, const sim::SceneInstance*>> pictures;
  sim::KnownPictures known;
  for (const sim::SceneInstance* instance : ObjectsOf(*context, taker, each, rng))
    if (auto taken = taker.TakeOf(*instance, rng)) {
      known[perception::NameOfPicture(taken->picture)] = ViewOf(*taken);
      pictures.emplace_back(std::move(*taken), instance);
    }
  sim::Simulator simulator(context->scene(), context->navmesh(), context->caster(),
                           config.agent.sensor, config.agent.action);
  auto suite = make_perception
                   ? make_perception(simulator)
                   : sim::GroundTruthPerception(simulator, config.ground_truth, std::move(known));
  if (!suite) return tl::unexpected(suite.error());
  Onlooker onlooker(config, *suite);
  for (const AgentPose& pose : SurveyPoses(*context)) {
    if (auto ok = simulator.Reset(pose); !ok) return tl::unexpected(ok.error());
    if (auto ok = onlooker.Look(simulator.Observe()); !ok) return tl::unexpected(ok.error());
  }
  PictureTrials result{plan->id, {}};
  for (const auto& [picture, instance] : pictures) {
    auto trial = JudgePicture(picture, *instance, onlooker.world(), *suite);
    if (!trial) return tl::unexpected(trial.error());
    result.trials.push_back(std::move(*trial));
  }
  return result;
}

}  // namespace crossnav::evaluation
