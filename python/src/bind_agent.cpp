// SPDX-License-Identifier: MIT
// Agent: set_goal, step, restore, and the result of a step.
#include "crossnav/agent/agent.h"

#include "crossnav/perception/goal_picture.h"
#include "crossnav/trace/trace_json.h"
#include "hooks_handle.h"
#include "map_handle.h"
#include "perception_handle.h"

namespace crossnav::python {
namespace {

using agent::StepResult;
using StatesOut = Array<std::uint8_t, nb::ndim<1>>;

perception::GoalPicture ToPicture(const RgbIn& rgb) {
  static_assert(sizeof(Rgb8) == 3);
  constexpr std::size_t kMost = perception::kMostPictureSide_px;
  if (rgb.shape(0) > kMost || rgb.shape(1) > kMost)
    Raise(ErrorCode::kInvalid, "has a side of more than " + std::to_string(kMost) + " px",
          "picture");
  perception::GoalPicture picture;
  picture.rgb.height = static_cast<int>(rgb.shape(0));
  picture.rgb.width = static_cast<int>(rgb.shape(1));
  const auto* first = reinterpret_cast<const Rgb8*>(rgb.data());
  picture.rgb.data.assign(first, first + rgb.shape(0) * rgb.shape(1));
  return picture;
}

/// The agent with the Python objects that it calls; they are destroyed after it.
struct AgentHandle {
  AgentHandle(const evaluation::RunConfig& c, const PerceptionHandle& p, const nb::object& h)
      : perception(p),
        hooks(h),
        config(c),
        agent(c.agent, perception.Suite(), HooksOf(hooks, c.agent)) {}

  PerceptionHandle perception;
  nb::object hooks;
  evaluation::RunConfig config;
  agent::Agent agent;
  bool has_goal = false, has_stepped = false;
  std::atomic<bool> in_use{false};
};

void SetGoal(AgentHandle& self, const std::string& goal) {
  const InUse guard(self.in_use);
  {
    const nb::gil_scoped_release others_run;
    Unwrap(self.agent.SetGoal(goal));
  }
  self.has_goal = true;
}

void SetPicture(AgentHandle& self, const RgbIn& rgb, const std::optional<std::array<int, 4>>& box) {
  perception::GoalPicture picture = ToPicture(rgb);
  if (box) picture.box = {(*box)[0], (*box)[1], (*box)[2], (*box)[3]};
  const InUse guard(self.in_use);
  {
    const nb::gil_scoped_release others_run;
    Unwrap(self.agent.SetGoal(picture));
  }
  self.has_goal = true;
}

StepResult Step(AgentHandle& self, const Observation& obs) {
  if (!self.has_goal) Raise(ErrorCode::kInvalid, "has no goal yet: call set_goal first", "agent");
  const InUse guard(self.in_use);
  self.has_stepped = true;
  const nb::gil_scoped_release others_run;
  return Unwrap(self.agent.Step(obs));
}

void Restore(AgentHandle& self, const MapHandle& map, const MemoryHandle& memory) {
  if (self.has_goal || self.has_stepped)
    Raise(ErrorCode::kInvalid, "a saved memory is given before the first goal", "agent");
  if (map.map->config().voxel_m != memory.memory->VoxelSize())
    Raise(ErrorCode::kMismatch, "map and memory have different voxel sizes", "memory");
  const InUse guard(self.in_use);
  Unwrap(self.agent.Restore(CopyOf(*map.map), CopyOf(*memory.memory), map.Flights(),
                            map.SeenStairs()));
}

std::vector<memory::MemoryCluster> Query(AgentHandle& self, const std::string& text) {
  const InUse guard(self.in_use);
  const agent::Agent& agent = self.agent;
  auto& encoder = nb::cast<perception::DenseEncoder&>(self.perception.encoder);
  const nb::gil_scoped_release others_run;
  const std::vector<float> vector = Unwrap(encoder.EncodeText(text));
  if (agent.memory().Size() == 0) return {};
  CheckText(agent.memory(), vector);
  std::vector<std::vector<float>> background;
  if (agent.config().query.relevancy == "contrastive")
    background = Unwrap(perception::EncodeTexts(encoder, memory::kBackgroundPrompts));
  return memory::Query(agent.memory(), vector, agent.config().query, background);
}

nb::tuple VoxelChanges(const StepResult& self) {
  std::vector<geometry::VoxelKey> keys;
  std::vector<std::uint8_t> states;
  for (const geometry::StateChange& change : self.trace.voxel_changes) {
    keys.push_back(change.key);
    states.push_back(static_cast<std::uint8_t>(change.voxel.state));
  }
  const std::size_t count = keys.size();
  return nb::make_tuple(ToArray(std::span<const geometry::VoxelKey>(keys)),
                        ToArray<StatesOut>(std::move(states), {count}));
}

nb::dict Timing(const StepResult& self) {
  nb::dict times;
  for (const trace::StageTime& time : self.timing) times[nb::str(time.stage.c_str())] = time.ms;
  return times;
}

void BindResult(nb::module_& m) {
  nb::class_<StepResult>(m, "StepResult", "Decision of one step, and its reasons.")
      .def_ro("action", &StepResult::action)
      .def_ro("all_explored", &StepResult::all_explored,
              "No candidate is left; `action` means nothing then.")
      .def_prop_ro(
          "p_claimed_world",
          [](const StepResult& r) -> std::optional<PointOut> {
            if (!r.p_claimed_world) return std::nullopt;
            return ToArray(*r.p_claimed_world);
          },
          kOwnArray, "(3,) [m]: with STOP, where the agent believes the goal to be.")
      .def_prop_ro(
          "trace",
          [](const StepResult& r) {
            return FromJson(trace::ToJson(r.trace, trace::VoxelText::kOmit));
          },
          nb::sig("def trace(self) -> dict[str, typing.Any]"),
          "The step's record, as docs/formats/replay.md lists it.")
      .def_prop_ro(
          "trace_json",
          [](const StepResult& r) { return trace::ToJson(r.trace, trace::VoxelText::kOmit); },
          "The same as one line of canonical JSON.")
      .def_prop_ro("voxel_changes", &VoxelChanges,
                   nb::sig("def voxel_changes(self) -> tuple[numpy.typing.NDArray[numpy.int32], "
                           "numpy.typing.NDArray[numpy.uint8]]"),
                   "Voxels that changed: keys (N, 3), states (N,) as VoxelState.")
      .def_prop_ro("timing_ms", &Timing, nb::sig("def timing_ms(self) -> dict[str, float]"),
                   "CPU time per stage [ms].");
}

}  // namespace

void BindAgent(nb::module_& m) {
  BindResult(m);
  nb::class_<AgentHandle>(m, "Agent", "One observation in, one action out. One thread at a time.")
      .def(
          "__init__",
          [](AgentHandle* self, const PerceptionHandle& perception, const Settings& config,
             const nb::object& hooks) {
            new (self) AgentHandle(ConfigOf(config), perception, hooks);
          },
          "perception"_a, "config"_a = nb::none(), "hooks"_a = nb::none(),
          nb::sig("def __init__(self, perception: Perception, config: crossnav._config.Settings = "
                  "None, hooks: Hooks | None = None) -> None"))
      .def("set_goal", &SetGoal, "goal"_a,
           "Activates a goal, a name or a description; map, stairs and features stay as they are.")
      .def("set_goal", &SetPicture, "picture"_a, "box"_a = nb::none(),
           "Activates a goal that is a picture, (H, W, 3) uint8: the instance that it shows is "
           "wanted. `box` (u0, v0, u1, v1) is about it; without, it is in the middle.")
      .def("step", &Step, "observation"_a, "One step. Other threads run meanwhile.")
      .def("restore", &Restore, "map"_a, "memory"_a,
           "Starts from a copy of a saved map, its stairs and a memory; before the first goal.")
      .def("query", &Query, "text"_a,
           "Places in the memory that answer a text, best first, by the agent's own encoder.")
      .def_prop_ro(
          "map", [](AgentHandle& self) { return std::make_unique<MapHandle>(self.agent); },
          nb::keep_alive<0, 1>(), nb::sig("def map(self) -> VoxelMap"), "The agent's own, to read.")
      .def_prop_ro(
          "memory",
          [](AgentHandle& self) {
            return std::make_unique<MemoryHandle>(self.agent.memory(), self.agent.config().query);
          },
          nb::keep_alive<0, 1>(), nb::sig("def memory(self) -> SemanticMemory"),
          "The agent's own, to read.")
      .def_prop_ro("perception", [](const AgentHandle& self) { return self.perception; })
      .def_prop_ro("config", [](const AgentHandle& self) { return self.config; });
}

}  // namespace crossnav::python
