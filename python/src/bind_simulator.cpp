// SPDX-License-Identifier: MIT
// Scene and Simulator: load, reset, step, observe, judge; ground-truth perception.
#include "crossnav/sim/sensing/simulator.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/episodes/picture_view.h"
#include "crossnav/evaluation/generation/goal_pictures.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/perception/goal_picture.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/ground_truth_pictures.h"
#include "perception_handle.h"
#include "scene_handle.h"

namespace crossnav::python {
namespace {

/// State shared by simulators and their perception.
struct Body {
  explicit Body(const SceneHandle& s, const evaluation::RunConfig& c)
      : scene(s),
        config(c),
        simulator(s.context->scene(), s.context->navmesh(), s.context->caster(), c.agent.sensor,
                  c.agent.action) {
    simulator.UseNoise(c.noise, 0);
  }
  SceneHandle scene;
  evaluation::RunConfig config;
  sim::Simulator simulator;
  sim::KnownPictures pictures;  ///< taken by take_picture
  bool is_placed = false;
  std::atomic<bool> in_use{false};
};

using RgbOut = Array<std::uint8_t, nb::shape<-1, -1, 3>>;

struct SimulatorHandle {
  std::shared_ptr<Body> body;
};

Body& Placed(const SimulatorHandle& self) {
  if (!self.body->is_placed)
    Raise(ErrorCode::kInvalid, "stands nowhere yet: call reset first", "simulator");
  return *self.body;
}

// --- Ground truth that keeps its simulator alive ------------------------------------------------

struct TrueDetector : perception::Detector {
  TrueDetector(std::shared_ptr<Body> b, std::unique_ptr<Detector> i)
      : body(std::move(b)), inner(std::move(i)) {}
  Result<std::vector<perception::Detection>> Detect(const Observation& obs,
                                                    std::string_view goal) override {
    return inner->Detect(obs, goal);
  }
  std::shared_ptr<Body> body;
  std::unique_ptr<Detector> inner;
};
struct TrueSegmenter : perception::Segmenter {
  TrueSegmenter(std::shared_ptr<Body> b, std::unique_ptr<Segmenter> i)
      : body(std::move(b)), inner(std::move(i)) {}
  Result<void> Segment(const Observation& obs, perception::Detection& detection) override {
    return inner->Segment(obs, detection);
  }
  std::shared_ptr<Body> body;
  std::unique_ptr<Segmenter> inner;
};
struct TrueStairs : perception::StairSegmenter {
  TrueStairs(std::shared_ptr<Body> b, std::unique_ptr<StairSegmenter> i)
      : body(std::move(b)), inner(std::move(i)) {}
  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    return inner->SegmentStairs(obs);
  }
  std::shared_ptr<Body> body;
  std::unique_ptr<StairSegmenter> inner;
};
struct TrueEncoder : perception::DenseEncoder {
  TrueEncoder(std::shared_ptr<Body> b, std::unique_ptr<DenseEncoder> i)
      : body(std::move(b)), inner(std::move(i)) {}
  int Dim() const override { return inner->Dim(); }
  std::string Name() const override { return inner->Name(); }
  Result<perception::FeatureGrid> EncodeImage(const Observation& obs) override {
    return inner->EncodeImage(obs);
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    return inner->EncodeText(text);
  }
  std::shared_ptr<Body> body;
  std::unique_ptr<DenseEncoder> inner;
};

/// Reads the pictures that the simulator has taken so far.
struct TruePictures : perception::PictureReader {
  explicit TruePictures(std::shared_ptr<Body> b) : body(std::move(b)) {}
  Result<perception::PictureReading> Read(const perception::GoalPicture& picture) override {
    auto reader = sim::MakeGroundTruthPictureReader(body->simulator, body->config.ground_truth,
                                                    body->pictures);
    if (!reader) return tl::unexpected(reader.error());
    return (*reader)->Read(picture);
  }
  std::shared_ptr<Body> body;
};

/// A new Python object of the interface's type.
template <class Interface, class Part>
nb::object Own(const std::shared_ptr<Body>& body, std::unique_ptr<Interface> inner) {
  Interface* part = new Part(body, std::move(inner));
  return nb::cast(part, nb::rv_policy::take_ownership);
}

PerceptionHandle GroundTruth(const SimulatorHandle& self) {
  auto suite =
      Unwrap(sim::GroundTruthPerception(self.body->simulator, self.body->config.ground_truth));
  return {Own<perception::Detector, TrueDetector>(self.body, std::move(suite.detector)),
          Own<perception::Segmenter, TrueSegmenter>(self.body, std::move(suite.segmenter)),
          Own<perception::StairSegmenter, TrueStairs>(self.body, std::move(suite.stairs)),
          Own<perception::DenseEncoder, TrueEncoder>(self.body, std::move(suite.encoder)),
          std::make_shared<TruePictures>(self.body)};
}

/// A picture of an instance, as episodes have them as goals.
RgbOut TakePicture(const SimulatorHandle& self, int instance_id, std::uint64_t seed) {
  Body& body = *self.body;
  const InUse guard(body.in_use), scene(*body.scene.in_use);
  const evaluation::SceneContext& context = *body.scene.context;
  const sim::SceneInstance* instance = context.scene().FindInstance(instance_id);
  if (instance == nullptr)
    Raise(ErrorCode::kInvalid, "is no instance of the scene", std::to_string(instance_id));
  Rng rng(seed);
  auto taken = evaluation::PictureTaker(context).TakeOf(*instance, rng);
  if (!taken)
    Raise(ErrorCode::kInvalid, "has no place to stand with a good view of it",
          std::to_string(instance_id));
  body.pictures[perception::NameOfPicture(taken->picture)] = evaluation::ViewOf(*taken);
  RgbImage& rgb = taken->picture.rgb;
  std::vector<std::uint8_t> bytes;
  for (const Rgb8& p : rgb.data) bytes.insert(bytes.end(), {p.r, p.g, p.b});
  return ToArray<RgbOut>(std::move(bytes), {static_cast<std::size_t>(rgb.height),
                                            static_cast<std::size_t>(rgb.width), std::size_t{3}});
}

// --- Moving and looking -------------------------------------------------------------------------

void Reset(SimulatorHandle& self, const AgentPose& start) {
  const InUse guard(self.body->in_use), scene(*self.body->scene.in_use);
  Unwrap(self.body->simulator.Reset(start));
  self.body->is_placed = true;
}

double Step(SimulatorHandle& self, Action action) {
  Body& body = Placed(self);
  const InUse guard(body.in_use), scene(*body.scene.in_use);
  const Vector3d before = body.simulator.agent().p_world;
  body.simulator.Step(action);
  return (body.simulator.agent().p_world - before).norm();
}

Observation Observe(SimulatorHandle& self, bool with_colour) {
  Body& body = Placed(self);
  const InUse guard(body.in_use);
  const nb::gil_scoped_release others_run;
  body.simulator.ShowColour(with_colour);
  return body.simulator.Observe();
}

Array<std::int32_t, nb::ndim<2>> Instances(const SimulatorHandle& self) {
  InstanceImage image = Placed(self).simulator.last_frame().instance;
  return ToArray<Array<std::int32_t, nb::ndim<2>>>(
      std::move(image.data),
      {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width)});
}

// --- Judging ------------------------------------------------------------------------------------

// Callers hold the scene: its navmesh and its table of targets are for one thread at a time.
const std::vector<evaluation::Target>& TargetsOf(const SceneHandle& scene,
                                                 const std::string& goal) {
  const nb::gil_scoped_release others_run;
  return scene.context->TargetsOf(goal);
}

bool IsReached(const SimulatorHandle& self, const std::string& goal) {
  const Body& body = Placed(self);
  const InUse scene(*body.scene.in_use);
  return evaluation::IsGoalReached(*body.scene.context, TargetsOf(body.scene, goal),
                                   body.simulator.agent().p_world, body.config.eval);
}

bool IsClaimNear(const SimulatorHandle& self, const std::string& goal, const Point& p_claimed) {
  const Body& body = Placed(self);
  const Vector3d p = ToPoint(p_claimed, "p_claimed_world");
  const InUse scene(*body.scene.in_use);
  const int floor = body.scene.context->FloorUnder(p);
  const auto& targets = TargetsOf(body.scene, goal);
  return std::any_of(targets.begin(), targets.end(), [&](const evaluation::Target& target) {
    return evaluation::IsWithinBoxRadius(target, p, floor, body.config.eval);
  });
}

std::optional<double> DistanceTo(const SceneHandle& scene, const Vector3d& p_world,
                                 const std::string& goal) {
  const InUse guard(*scene.in_use);
  TargetsOf(scene, goal);  // the slow part
  return scene.context->DistanceToGoal(p_world, goal);
}

// --- Scenes -------------------------------------------------------------------------------------

SceneHandle LoadScene(const PathIn& scenes_dir, const std::optional<std::string>& scene_id,
                      const Settings& settings) {
  SceneHandle scene;
  scene.config = ConfigOf(settings);
  const nb::gil_scoped_release others_run;
  scene.id = scene_id ? *scene_id : Unwrap(evaluation::ListScenes(scenes_dir.path)).front();
  scene.context = Unwrap(evaluation::SceneContext::Load(scenes_dir.path, scene.id, scene.config));
  return scene;
}

nb::list Floors(const SceneHandle& self) {
  nb::list floors;
  for (const sim::Floor& floor : self.context->navmesh().Floors()) {
    nb::dict entry;
    entry["id"] = floor.id;
    entry["height_m"] = floor.height_m;
    entry["area_m2"] = floor.area_m2;
    floors.append(entry);
  }
  return floors;
}

nb::list Objects(const SceneHandle& self) {
  nb::list objects;
  for (const sim::SceneInstance& instance : self.context->scene().instances) {
    nb::dict entry;
    entry["id"] = instance.id;
    entry["name"] = instance.name;
    entry["category"] = instance.category;
    entry["box_min"] = ToArray(instance.box.min);
    entry["box_max"] = ToArray(instance.box.max);
    objects.append(entry);
  }
  return objects;
}

PointOut RandomPoint(const SceneHandle& self, std::uint64_t seed) {
  const InUse guard(*self.in_use);
  Rng rng(seed);
  const auto p = self.context->navmesh().RandomPoint(rng);
  if (!p) Raise(ErrorCode::kInvalid, "has no walkable ground", self.id);
  return ToArray(*p);
}

void BindScene(nb::module_& m) {
  nb::class_<SceneHandle>(m, "Scene", "A scene with its navmesh and true objects.")
      .def(
          "__init__",
          [](SceneHandle* self, const PathIn& scenes_dir,
             const std::optional<std::string>& scene_id, const Settings& config) {
            new (self) SceneHandle(LoadScene(scenes_dir, scene_id, config));
          },
          "scenes_dir"_a, "scene_id"_a = nb::none(), "config"_a = nb::none(),
          "Reads a scene below `scenes_dir` (the first one where no id is given).")
      .def_ro("id", &SceneHandle::id)
      .def_ro("config", &SceneHandle::config)
      .def_prop_ro("floors", &Floors, nb::sig("def floors(self) -> list[dict[str, typing.Any]]"),
                   "id, height_m and area_m2 of each, lowest first.")
      .def_prop_ro("objects", &Objects, nb::sig("def objects(self) -> list[dict[str, typing.Any]]"),
                   "True instances: id, name, category, box_min, box_max (3,) [m].")
      .def("random_point", &RandomPoint, "seed"_a, "(3,) [m], a point one can stand on.")
      .def(
          "floor_of",
          [](const SceneHandle& self, const Point& p) {
            return self.context->navmesh().FloorOf(ToPoint(p, "p_world"));
          },
          "p_world"_a, "Id of the floor whose height is nearest.")
      .def(
          "distance_to_goal",
          [](const SceneHandle& self, const Point& p, const std::string& goal) {
            return DistanceTo(self, ToPoint(p, "p_world"), goal);
          },
          "p_world"_a, "goal"_a, "Shortest path to a viewpoint of the goal [m], or None.");
}

}  // namespace

void BindSimulator(nb::module_& m) {
  BindScene(m);
  nb::class_<SimulatorHandle>(m, "Simulator", "The robot in a scene: six actions and a camera.")
      .def(
          "__init__",
          [](SimulatorHandle* self, const SceneHandle& scene, const Settings& config) {
            new (self) SimulatorHandle{std::make_shared<Body>(
                scene, config.value.is_none() ? scene.config : ConfigOf(config))};
          },
          "scene"_a, "config"_a = nb::none(), "The scene's own settings where none are given.")
      .def("reset", &Reset, "start"_a, "Places the robot; the point is snapped to the navmesh.")
      .def("step", &Step, "action"_a, "Executes one action. Returns the 3D distance moved [m].")
      .def("observe", &Observe, "with_colour"_a = true,
           "The current view; without colour it is black and comes sooner.")
      .def_prop_ro("pose",
                   [](const SimulatorHandle& self) { return Placed(self).simulator.agent(); })
      .def_prop_ro("instances", &Instances, kOwnArray,
                   "H x W int32: true instance ids of the last view.")
      .def("ground_truth", &GroundTruth,
           "Perception answered from the last view. For tests, and for runs that say so.")
      .def("take_picture", &TakePicture, "instance"_a, "seed"_a = 0, kOwnArray,
           "A picture (H, W, 3) of an instance from a place nearby, for Agent.set_goal. The "
           "simulator's ground truth reads the pictures that it has taken.")
      .def("is_reached", &IsReached, "goal"_a, "Would a STOP here be a success?")
      .def("is_claim_near", &IsClaimNear, "goal"_a, "p_claimed_world"_a,
           "Does the point lie within the success radius of a true instance?")
      .def(
          "distance_to_goal",
          [](const SimulatorHandle& self, const std::string& goal) {
            const Body& body = Placed(self);
            return DistanceTo(body.scene, body.simulator.agent().p_world, goal);
          },
          "goal"_a, "Shortest path from here to a viewpoint of the goal [m], or None.")
      .def_prop_ro("scene", [](const SimulatorHandle& self) { return self.body->scene; })
      .def_prop_ro("config", [](const SimulatorHandle& self) { return self.body->config; });
}

}  // namespace crossnav::python
