// SPDX-License-Identifier: MIT
#include "trace/sample_episode.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "crossnav/geometry/voxel_map.h"

namespace crossnav::trace {
namespace {

struct Block {
  Box3 box;
  Rgb8 colour;
};

Block MakeBlock(const Vector3d& lo, const Vector3d& hi, const Rgb8& colour) {
  Block block;
  block.box.min = lo;
  block.box.max = hi;
  block.colour = colour;
  return block;
}

constexpr double kStorey = 2.8;
constexpr int kSteps = 14;

std::vector<Block> MakeHouse() {
  const Rgb8 floor{186, 152, 112}, wall{226, 222, 210}, wood{140, 96, 60}, cloth{90, 120, 170};
  std::vector<Block> house = {
      MakeBlock({-0.1, -0.1, -0.2}, {8.1, 6.1, 0}, floor),
      MakeBlock({-0.1, -0.1, 2.6}, {8.1, 4.7, kStorey}, floor),  // open above the stairs
      MakeBlock({-0.1, 4.7, 2.6}, {2.5, 6.1, kStorey}, floor),
      MakeBlock({6.7, 4.7, 2.6}, {8.1, 6.1, kStorey}, floor),
      MakeBlock({-0.1, -0.1, 5.4}, {8.1, 6.1, 5.6}, wall)};
  for (const double z : {0.0, kStorey}) {
    const double top = z + 2.6;
    house.push_back(MakeBlock({-0.2, -0.2, z}, {8.2, 0, top}, wall));
    house.push_back(MakeBlock({-0.2, 6, z}, {8.2, 6.2, top}, wall));
    house.push_back(MakeBlock({-0.2, 0, z}, {0, 6, top}, wall));
    house.push_back(MakeBlock({8, 0, z}, {8.2, 6, top}, wall));
    house.push_back(MakeBlock({3.9, 0, z}, {4.1, 1.5, top}, wall));
    house.push_back(MakeBlock({3.9, 2.6, z}, {4.1, 4.6, top}, wall));
  }
  for (int i = 0; i < kSteps; ++i) {
    const double x = 2.5 + 0.3 * i;
    house.push_back(MakeBlock({x, 4.8, 0}, {x + 0.3, 5.9, 0.2 * (i + 1)}, wood));
  }
  house.push_back(MakeBlock({0.1, 0.1, 0}, {2.1, 1.0, 0.45}, cloth));  // sofa
  house.push_back(MakeBlock({0.1, 0.1, 0.45}, {2.1, 0.35, 0.9}, cloth));
  house.push_back(MakeBlock({5.6, 1.4, 0.7}, {7.0, 2.2, 0.76}, wood));  // table
  house.push_back(MakeBlock({6.2, 1.7, 0}, {6.4, 1.9, 0.7}, wood));
  house.push_back(MakeBlock({5.2, 0.1, kStorey}, {7.0, 2.1, kStorey + 0.5}, {200, 90, 90}));  // bed
  house.push_back(
      MakeBlock({0.2, 0.2, kStorey}, {0.7, 0.7, kStorey + 1.1}, {60, 140, 70}));  // plant
  return house;
}

/// Distance along `direction` at which the ray enters the box, if it does.
std::optional<double> Enter(const Box3& box, const Vector3d& origin, const Vector3d& direction) {
  double near = 1e-6, far = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1.0 / (direction[axis] == 0 ? 1e-12 : direction[axis]);
    const double a = (box.min[axis] - origin[axis]) * inverse;
    const double b = (box.max[axis] - origin[axis]) * inverse;
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far ? std::optional(near) : std::nullopt;
}

Rgb8 Shade(const Rgb8& colour, const Vector3d& p, const Box3& box) {
  double light = 0.75;
  if (std::abs(p.z() - box.max.z()) < 1e-6) light = 1.0;
  if (std::abs(p.x() - box.min.x()) < 1e-6 || std::abs(p.x() - box.max.x()) < 1e-6) light = 0.88;
  const auto scale = [light](std::uint8_t v) { return static_cast<std::uint8_t>(v * light); };
  return {scale(colour.r), scale(colour.g), scale(colour.b)};
}

Observation Look(const std::vector<Block>& house, const Pose& T_world_camera, int image_px) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(image_px, image_px, DegToRad(90));
  obs.rgb = RgbImage(image_px, image_px, {30, 30, 40});
  obs.depth_m = DepthImage(image_px, image_px);
  obs.T_world_camera = T_world_camera;
  for (int v = 0; v < image_px; ++v) {
    for (int u = 0; u < image_px; ++u) {
      // The direction has z = 1 in the camera, so the distance along it is planar depth.
      const Vector3d direction = T_world_camera.linear() * BackProjectPixel(obs.camera, u, v, 1.0);
      double best = 1e9;
      for (const Block& block : house) {
        const auto hit = Enter(block.box, T_world_camera.translation(), direction);
        if (!hit || *hit >= best) continue;
        best = *hit;
        obs.depth_m.At(u, v) = static_cast<float>(best);
        obs.rgb.At(u, v) =
            Shade(block.colour, T_world_camera.translation() + best * direction, block.box);
      }
    }
  }
  return obs;
}

/// Synthetic perception: masks of red and green surfaces, stairs on the flight.
Sight SightOf(const Observation& obs) {
  Sight sight;
  sight.width_px = obs.rgb.width;
  sight.height_px = obs.rgb.height;
  sight.masks = MaskImage(obs.rgb.width, obs.rgb.height, 0);
  sight.stair_probability = Image<float>(obs.rgb.width, obs.rgb.height, 0.0F);
  sight.similarity = Image<float>(24, 24, 0.2F);
  SightBox box{obs.rgb.width, obs.rgb.height, 0, 0, 0.86, 0.91};
  for (int v = 0; v < obs.rgb.height; ++v)
    for (int u = 0; u < obs.rgb.width; ++u) {
      const Rgb8& c = obs.rgb.At(u, v);
      const Vector3d p =
          obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v));
      const bool is_wood = c.r > c.b + 40 && c.r < 150;
      if (is_wood && p.y() > 4.7) sight.stair_probability.At(u, v) = 0.8F;
      if (c.r < 2 * c.g && c.g < 2 * c.r) continue;
      sight.masks.At(u, v) = 1;
      sight.similarity.At(24 * u / obs.rgb.width, 24 * v / obs.rgb.height) = 0.9F;
      box = {std::min(box.u0, u),
             std::min(box.v0, v),
             std::max(box.u1, u + 1),
             std::max(box.v1, v + 1),
             0.86,
             0.91};
    }
  if (box.u1 > 0) sight.boxes.push_back(box);
  return sight;
}

struct Waypoint {
  Vector3d p;
  int goal = 0;
  const char* mode = "";
  const char* reason = "";
};

std::vector<Waypoint> MakeRoute() {
  const char* explore = "basic_explore";
  const char* stair = "stair_explore";
  return {{{5.0, 3.5, 0}, 0, explore, "frontiers are left on this level"},
          {{4.0, 2.0, 0}, 0, explore, "frontiers are left on this level"},
          {{2.6, 2.2, 0}, 0, "poi_navigation", "a live POI is stable"},
          {{1.4, 1.6, 0}, 0, "target_approach", "the POI is within the approach range"},
          {{1.2, 5.2, 0}, 1, explore, "frontiers are left on this level"},
          {{2.3, 5.35, 0}, 1, stair, "no traversable frontier is left; an ascent is known"},
          {{6.7, 5.35, kStorey}, 1, stair, "the flight goes on"},
          {{7.3, 5.2, kStorey}, 1, stair, "a landing was reached"},
          {{7.2, 3.4, kStorey}, 1, explore, "the level is new"},
          {{6.2, 2.9, kStorey}, 1, "target_approach", "the POI is within the approach range"},
          {{4.6, 2.1, kStorey}, 2, "poi_navigation", "a history POI fits the goal"},
          {{1.6, 1.5, kStorey}, 2, "target_approach", "the POI is within the approach range"}};
}

/// Two rooms on two floors; a bed, and a plant beside it once both floors are known.
GraphNote GraphOf(bool has_upper_floor) {
  GraphNote note;
  const auto room = [](int id, double height_m) {
    return GraphNote::Room{id,
                           height_m,
                           24,
                           {4, 2, height_m},
                           {{0, 0, 8, 0}, {8, 0, 8, 4}, {8, 4, 0, 4}, {0, 4, 0, 0}}};
  };
  note.floors_m = {0};
  note.rooms = {room(0, 0)};
  Box3 bed;
  bed.min = {0.2, 0.2, 0};
  bed.max = {2.2, 1.8, 0.5};
  note.objects = {{0, "bed", 0, bed}};
  if (!has_upper_floor) return note;
  note.floors_m.push_back(kStorey);
  note.rooms.push_back(room(1, kStorey));
  Box3 plant;
  plant.min = {0.2, 0.2, kStorey};
  plant.max = {0.7, 0.7, kStorey + 1.1};
  note.objects.push_back({1, "plant", 1, plant});
  note.relations = {{"above", 1, 0}};
  return note;
}

class Recorder {
 public:
  explicit Recorder(int image_px) : house_(MakeHouse()), route_(MakeRoute()), image_px_(image_px) {
    agent_.p_world = route_.front().p;
  }

  SampleEpisode Run() {
    episode_.info = Info();
    for (int i = 0; i < 12; ++i) Turn(route_.front(), 1, 30);  // a look around
    for (std::size_t i = 1; i < route_.size(); ++i) GoTo(i);
    return std::move(episode_);
  }

 private:
  ReplayInfo Info() const {
    ReplayInfo info;
    info.scene_id = "sample-house";
    info.episode_id = "0";
    info.goals = {"sofa", "bed", "plant"};
    info.variant = "full";
    info.perception = "scripted";
    info.version = "0.1.0";
    info.config_hash = "0123abcd";
    info.seed = 7;
    const auto instance = [](const char* goal, const Vector3d& lo, const Vector3d& hi) {
      GoalInstance made;
      made.goal = goal;
      made.box.min = lo;
      made.box.max = hi;
      return made;
    };
    info.goal_instances = {instance("sofa", {0.1, 0.1, 0}, {2.1, 1.0, 0.9}),
                           instance("bed", {5.2, 0.1, kStorey}, {7.0, 2.1, kStorey + 0.5}),
                           instance("plant", {0.2, 0.2, kStorey}, {0.7, 0.7, kStorey + 1.1})};
    return info;
  }

  void Turn(const Waypoint& to, int sign, double deg) {
    Record(to, sign > 0 ? Action::kTurnLeft : Action::kTurnRight);
    agent_.yaw_rad = WrapAngle(agent_.yaw_rad + sign * DegToRad(deg));
  }

  void GoTo(std::size_t leg) {
    const Waypoint& to = route_[leg];
    const Vector3d from = agent_.p_world;
    const Vector3d move = to.p - from;
    const double heading = std::atan2(move.y(), move.x());
    for (int guard = 0; guard < 12; ++guard) {
      const double error = WrapAngle(heading - agent_.yaw_rad);
      if (std::abs(error) < 0.27) break;
      Turn(to, error > 0 ? 1 : -1, 30);
    }
    const int moves = static_cast<int>(std::ceil(move.head<2>().norm() / 0.25));
    for (int i = 1; i <= moves; ++i) {
      Record(to, Action::kMoveForward);
      agent_.p_world = from + move * (static_cast<double>(i) / moves);
    }
    if (std::string_view(to.mode) == "target_approach") Verify(leg);
  }

  void Verify(std::size_t leg) {
    const Waypoint& at = route_[leg];
    StepTrace* trace = nullptr;
    for (const bool passes : {false, true}) {
      trace = &Record(at, passes ? Action::kStop : Action::kTurnLeft);
      trace->verification = {
          true, passes, 0.86, 0.91, passes ? 0.74 : 0.31, 12.5, 1.12, passes ? "" : "visibility"};
      trace->events.push_back(passes ? "verification passed" : "verification failed: visibility");
      trace->detections = 1;
    }
    const bool success = at.goal != 2;
    const std::string goal = episode_.info.goals[static_cast<std::size_t>(at.goal)];
    episode_.stages.push_back({at.goal, goal, success ? "success" : "stop_out_of_range", success,
                               trace->step, 7.25 + at.goal, 6.5});
  }

  StepTrace& Record(const Waypoint& to, Action action) {
    SampleFrame frame;
    StepTrace& t = frame.trace;
    t.step = static_cast<int>(episode_.frames.size());
    t.goal_index = to.goal;
    t.goal = episode_.info.goals[static_cast<std::size_t>(to.goal)];
    t.agent = agent_;
    t.T_world_camera = CameraPose(agent_, 0.88);
    t.action = action;
    t.mode = to.mode;
    t.reason = to.reason;
    t.activity = t.mode == "target_approach" ? "approach" : "go_to";
    t.level_m = agent_.p_world.z() < 2.5 ? 0 : kStorey;
    if (episode_.frames.empty() || episode_.frames.back().trace.goal != t.goal) {
      t.events.push_back("goal activated: " + t.goal);
    }
    frame.observation = Look(house_, t.T_world_camera, image_px_);
    frame.sight = SightOf(frame.observation);
    if (t.step == 10 || t.step == 80) frame.graph = GraphOf(t.step == 80);
    UpdateMap(frame);
    AddCandidates(to, t);
    episode_.frames.push_back(std::move(frame));
    return episode_.frames.back().trace;
  }

  void UpdateMap(SampleFrame& frame) {
    const Observation& obs = frame.observation;
    const auto& ends = map_.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    std::vector<geometry::VoxelKey> stairs;
    for (const auto& end : ends) {
      const Vector3d p = geometry::CenterOf(end.key, 0.1);
      const bool is_on = p.x() > 2.5 && p.x() < 6.7 && p.y() > 4.8 && p.y() < 5.9 && p.z() > 0;
      if (is_on && p.z() < kStorey && frame.trace.mode == "stair_explore") {
        stairs.push_back(end.key);
      }
    }
    map_.ObserveBody(frame.trace.agent.p_world, 0.88);
    map_.MarkStair(stairs, geometry::StairMark::kStair);
    frame.trace.voxel_changes = map_.UpdateStates();
  }

  void AddCandidates(const Waypoint& to, StepTrace& t) const {
    t.path_world = {agent_.p_world, 0.5 * (agent_.p_world + to.p), to.p};
    const bool on_stairs = t.mode == "stair_explore", is_poi = t.mode != "basic_explore";
    CandidateTrace target;
    target.kind = on_stairs ? "stair_frontier" : is_poi ? "live_poi" : "traversable_frontier";
    target.p_nav_world = to.p;
    target.p_focus_world = to.p + Vector3d(0, -0.8, 0.4);
    target.score = 0.83;
    target.path_cost = 10 * (to.p - agent_.p_world).norm();
    target.size = 31;
    target.is_target = true;
    t.candidates.push_back(target);
    for (int i = 0; i < 5; ++i) {
      CandidateTrace other = target;
      other.kind = i == 3 ? "history_poi" : i == 4 ? "ascent_frontier" : "traversable_frontier";
      other.p_nav_world = Vector3d(1.0 + 1.5 * i, 0.8 + 0.9 * ((3 * i) % 5), t.level_m);
      other.p_focus_world = other.p_nav_world;
      other.score = 0.7 - 0.1 * i;
      other.path_cost = i == 2 ? -1 : 10 * (other.p_nav_world - agent_.p_world).norm();
      other.size = 20 - 3 * i;
      other.is_reachable = i != 2;
      other.is_target = false;
      t.candidates.push_back(other);
    }
  }

  std::vector<Block> house_;
  std::vector<Waypoint> route_;
  int image_px_;
  AgentPose agent_;
  geometry::VoxelMap map_;
  SampleEpisode episode_;
};

}  // namespace

SampleEpisode MakeSampleEpisode(int image_px) {
  return Recorder(image_px).Run();
}

}  // namespace crossnav::trace
