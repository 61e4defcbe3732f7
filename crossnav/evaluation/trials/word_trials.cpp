// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/word_trials.h"

#include <algorithm>
#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/evaluation/running/survey.h"
#include "crossnav/evaluation/trials/graph_trials.h"
#include "crossnav/evaluation/trials/true_home.h"
#include "crossnav/language/resolve.h"
#include "crossnav/objects/object_book.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::evaluation {
namespace {

using language::KnownHome;
using language::Outcome;

constexpr double kAboutBox_m = 0.3;  // chosen: three voxels about the true box
constexpr int kWordStep_px = 2;      // chosen: as the survey

/// Records of all instances that there are words for, as ground truth detects them.
class Recorder {
 public:
  Recorder(const sim::Scene& scene, const RunConfig& config)
      : scene_(scene), config_(config), book_(config.agent.map.voxel_m) {
    for (const sim::SceneInstance& instance : scene.instances)
      if (HasWord(instance)) spoken_of_.insert(instance.id);
  }

  void Note(const Observation& obs, const InstanceImage& image) {
    std::map<int, Shown> shown;
    int last_id = 0;
    Shown* last = nullptr;
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u) {
        const int id = image.At(u, v);
        if (id != last_id) {
          last_id = id;
          last = spoken_of_.contains(id) ? &shown[id] : nullptr;
        }
        if (last != nullptr) AddPixel(obs, u, v, *last);
      }
    std::vector<objects::SeenObject> seen;
    std::vector<MaskImage> masks;
    masks.reserve(shown.size());
    for (auto& [id, what] : shown) {
      const sim::SceneInstance* instance = scene_.FindInstance(id);
      std::sort(what.voxels.begin(), what.voxels.end());
      what.voxels.erase(std::unique(what.voxels.begin(), what.voxels.end()), what.voxels.end());
      if (what.voxels.empty()) continue;
      const auto detection =
          sim::DetectionOf(what.view, config_.agent.sensor, config_.ground_truth);
      if (!detection) continue;
      seen_.insert(id);
      masks.push_back(MaskOf(image, id, what.view.box));
      const auto& box = what.view.box;
      seen.push_back({NameOf(*instance),
                      std::move(what.voxels),
                      detection->confidence,
                      &masks.back(),
                      {box.u0, box.v0, box.u1, box.v1}});
    }
    (void)book_.Note(seen, obs, {0, step_++});
  }

  const objects::ObjectBook& book() const { return book_; }
  const std::set<int>& seen() const { return seen_; }

 private:
  struct Shown {
    sim::SeenInstance view;
    std::vector<geometry::VoxelKey> voxels;
  };

  void AddPixel(const Observation& obs, int u, int v, Shown& shown) const {
    const float depth_m = obs.depth_m.At(u, v);
    const geometry::MapConfig& map = config_.agent.map;
    if (!(depth_m >= map.depth_min_m && depth_m <= map.depth_max_m)) return;
    shown.view.Add(u, v, depth_m);
    if (u % kWordStep_px != 0 || v % kWordStep_px != 0) return;
    shown.voxels.push_back(geometry::KeyOf(
        obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m), map.voxel_m));
  }

  static MaskImage MaskOf(const InstanceImage& image, int id, const perception::PixelBox& box) {
    MaskImage mask(image.width, image.height);
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) mask.At(u, v) = image.At(u, v) == id ? 1 : 0;
    return mask;
  }

  const sim::Scene& scene_;
  const RunConfig& config_;
  objects::ObjectBook book_;
  std::set<int> spoken_of_, seen_;
  std::int64_t step_ = 0;
};

/// Whether the found thing is the true one.
bool IsSame(const language::Thing& found, const language::Thing& truth) {
  const Vector3d& p = found.p_center_world;
  return found.category == truth.category &&
         (p.array() >= truth.box.min.array() - kAboutBox_m).all() &&
         (p.array() <= truth.box.max.array() + kAboutBox_m).all();
}

std::vector<std::string> WordsOf(const language::Description& d) {
  std::vector<std::string> words;
  if (d.floor) words.emplace_back("floor");
  if (d.room) words.emplace_back("room");
  if (d.colour) words.emplace_back("colour");
  for (const auto& phrase : d.relations) words.emplace_back(NameOf(phrase.relation));
  if (d.size) words.emplace_back("size");
  if (d.order != 0) words.emplace_back("ordinal");
  if (words.empty()) words.emplace_back("category alone");
  return words;
}

std::string ColourText(const std::optional<Rgb8>& rgb) {
  if (!rgb) return "none";
  return std::string(NameOf(language::NameColour(*rgb))) + " " + std::to_string(rgb->r) + " " +
         std::to_string(rgb->g) + " " + std::to_string(rgb->b);
}

/// Words of the description that the map's own record of the thing does not fit.
std::string Misfits(const language::Description& d, const language::Thing& truth,
                    const KnownHome& known) {
  const auto found = std::find_if(known.things.begin(), known.things.end(),
                                  [&](const auto& thing) { return IsSame(thing, truth); });
  if (found == known.things.end()) return "no record";
  std::string text;
  const auto check = [&](const language::Description& part, const std::string& word) {
    if (FitOf(part, known, *found) != language::Fit::kYes) text += " " + word;
  };
  language::Description part;
  part.noun = d.noun;
  if (d.floor) part.floor = d.floor, check(part, "floor"), part.floor.reset();
  if (d.room) part.room = d.room, check(part, "room"), part.room.reset();
  if (d.colour) part.colour = d.colour, check(part, "colour"), part.colour.reset();
  if (d.colour)
    text += " (true " + ColourText(truth.colour) + ", seen " + ColourText(found->colour) + ")";
  part.relations = d.relations;
  if (!d.relations.empty()) check(part, "relation");
  return text.empty() ? "others fit, too" : "misfits:" + text;
}

/// Contents of the rooms of the chosen things, by which rooms are told apart.
std::string RoomsText(const std::vector<int>& chosen, const KnownHome& known) {
  std::string text;
  for (const int i : chosen) {
    const std::optional<int> room = known.things[i].room;
    if (!room) continue;
    std::set<std::string> held;
    for (const language::Thing& thing : known.things)
      if (thing.room == room) held.insert(thing.category);
    text += "; room " + std::to_string(*room) + ":";
    for (const std::string& name : held) text += " " + name + ",";
    text.pop_back();
  }
  return text;
}

void Score(const DrawnWords& drawn, const KnownHome& truth, const KnownHome& known,
           WordTrial& trial) {
  const auto resolved = Resolve(drawn.description, known);
  bool is_right = false;
  switch (drawn.kind) {
    case WordKind::kClear:
      is_right = resolved.outcome == Outcome::kFound &&
                 IsSame(known.things[resolved.things.front()], truth.things[drawn.thing]);
      break;
    case WordKind::kAmbiguous:
      is_right = resolved.outcome == Outcome::kAmbiguous;
      break;
    case WordKind::kImpossible:
      is_right = resolved.outcome == Outcome::kAbsent || resolved.outcome == Outcome::kUnknown;
      break;
  }
  const bool is_wrong = !is_right && resolved.outcome == Outcome::kFound;
  trial.by_kind[drawn.kind].Add(is_right, is_wrong);
  if (!resolved.is_sure) ++trial.by_kind[drawn.kind].guesses;
  if (drawn.kind == WordKind::kClear)
    for (const std::string& word : WordsOf(drawn.description))
      trial.by_word[word].Add(is_right, is_wrong);
  if (is_right) return;
  std::string outcome(NameOf(resolved.outcome));
  if (!resolved.is_sure) outcome += ", a guess";
  if (!resolved.reason.empty()) outcome += ": " + resolved.reason;
  if (drawn.kind == WordKind::kClear)
    outcome += "; " + Misfits(drawn.description, truth.things[drawn.thing], known);
  if (drawn.description.room) outcome += RoomsText(resolved.things, known);
  trial.failures.push_back({drawn.kind, TextOf(drawn.description), std::move(outcome)});
}

std::vector<std::string> GoalNames() {
  std::vector<std::string> names;
  for (const std::string_view category : kCategories) names.push_back(SpacedName(category));
  return names;
}

int CountFound(const TrueHome& truth, const KnownHome& known) {
  int found = 0;
  for (const auto& thing : truth.home.things)
    found += std::any_of(known.things.begin(), known.things.end(),
                         [&](const auto& other) { return IsSame(other, thing); });
  return found;
}

}  // namespace

void WordScore::Add(bool is_right, bool is_wrong) {
  ++count;
  right += is_right ? 1 : 0;
  wrong += is_wrong ? 1 : 0;
}

WordScore& WordScore::operator+=(const WordScore& other) {
  count += other.count, right += other.right, wrong += other.wrong, guesses += other.guesses;
  return *this;
}

WordTrial& WordTrial::operator+=(const WordTrial& other) {
  things += other.things, things_found += other.things_found;
  for (const auto& [kind, score] : other.by_kind) by_kind[kind] += score;
  for (const auto& [word, score] : other.by_word) by_word[word] += score;
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
  return *this;
}

Result<WordTrial> TryWords(const WordTrialOptions& options, const RunConfig& config) {
  world::HouseParams params;
  params.seed = options.seed;
  params.edition = 2;
  params.has_textures = false;
  std::unique_ptr<SceneContext> context;
  const auto plan = PassedPlan(params, config, context);
  if (!plan) return tl::unexpected(plan.error());
  Recorder recorder(context->scene(), config);
  const auto survey = SurveyScene(*context, config, Known::kObjects,
                                  [&](const Observation& obs, const sim::Simulator& simulator) {
                                    recorder.Note(obs, simulator.last_frame().instance);
                                  });
  if (!survey) return tl::unexpected(survey.error());
  const auto graph = scenegraph::BuildGraph(survey->map, survey->memory, survey->flights);
  KnownHome known = language::HomeOf(graph, recorder.book().Confirmed());
  TrueHome truth = TrueHomeOf(*plan, context->scene(), recorder.seen());
  Rng rng(MixSeed(options.seed, 31));
  const auto& walkable = context->WalkablePoints();
  truth.home.p_robot_world = walkable[rng.Below(static_cast<std::uint32_t>(walkable.size()))];
  known.p_robot_world = truth.home.p_robot_world;
  // The ground floor is known to who lives there.
  for (std::size_t i = 0; i < truth.home.floors.size(); ++i)
    if (truth.home.floors[i].height_m < -kAboutBox_m)
      truth.home.ground_floor = static_cast<int>(i) + 1;
  known.ground_floor = truth.home.ground_floor;
  WordTrial trial;
  trial.house = plan->id;
  trial.things = static_cast<int>(truth.home.things.size());
  trial.things_found = CountFound(truth, known);
  for (int kind = 0; kind < kWordKinds; ++kind)
    for (const DrawnWords& drawn :
         DrawWords(truth.home, static_cast<WordKind>(kind), options.each, GoalNames(), rng))
      Score(drawn, truth.home, known, trial);
  return trial;
}

}  // namespace crossnav::evaluation
