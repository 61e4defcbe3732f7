// SPDX-License-Identifier: MIT
// `scene views`: pictures of the goal objects and views.json (docs/formats/views.md).
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/sim/sensing/object_views.h"
#include "crossnav/sim/sensing/picture.h"
#include "open_scene.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMinObject_px = 50;  // chosen: smaller objects are unrecognisable

Json BoxJson(const perception::PixelBox& box) {
  return Json::array({box.u0, box.v0, box.u1, box.v1});
}

Json ObjectsJson(const sim::Scene& scene, const InstanceImage& image) {
  Json objects = Json::array();
  for (const sim::VisibleObject& seen : sim::VisibleObjects(image, kMinObject_px)) {
    const sim::SceneInstance* instance = scene.FindInstance(seen.instance);
    if (instance == nullptr) continue;
    objects.push_back({{"instance", seen.instance},
                       {"name", instance->name},
                       {"category", instance->category},
                       {"box", BoxJson(seen.box)},
                       {"visible_px", seen.visible_px}});
  }
  return objects;
}

Json ViewJson(const sim::SceneInstance& instance, const sim::ObjectView& view,
              const std::string& file) {
  const AgentPose& pose = view.pose;
  const Vector3d& p = pose.p_world;
  return {{"file", file},
          {"category", instance.category},
          {"name", instance.name},
          {"instance", instance.id},
          {"pose",
           {{"position", {Rounded(p.x()), Rounded(p.y()), Rounded(p.z())}},
            {"yaw_deg", Rounded(RadToDeg(pose.yaw_rad))},
            {"pitch_deg", Rounded(RadToDeg(pose.pitch_rad))}}},
          {"distance_m", Rounded(view.distance_m)},
          {"box", BoxJson(view.box)},
          {"visible_px", view.visible_px},
          {"visible_fraction", Rounded(view.visible_fraction)}};
}

Json HeaderJson(const OpenScene& open, const sim::ViewRules& rules) {
  const SensorConfig& sensor = rules.sensor;
  return {{"format", 1},
          {"scene", open.scene->id},
          {"mesh_hash", evaluation::HexHash(open.scene->mesh_hash)},
          {"sensor",
           {{"width_px", sensor.width_px},
            {"height_px", sensor.height_px},
            {"hfov_deg", sensor.hfov_deg},
            {"camera_height_m", sensor.camera_height_m}}},
          {"rules",
           {{"near_m", rules.near_m},
            {"far_m", rules.far_m},
            {"min_visible", rules.min_visible},
            {"min_box_fraction", rules.min_box_fraction},
            {"per_object", rules.per_object}}}};
}

/// Writes the pictures of one instance and adds them to `views`.
Result<void> WriteViews(const OpenScene& open, const sim::SceneInstance& instance,
                        const sim::ViewRules& rules, const std::filesystem::path& out,
                        Json& views) {
  const auto good = sim::GoodViews(*open.scene, *open.navmesh, *open.caster, instance, rules);
  for (std::size_t i = 0; i < good.size(); ++i) {
    const auto frame = open.caster->Render(rules.sensor.Intrinsics(),
                                           CameraPose(good[i].pose, rules.sensor.camera_height_m));
    const std::string file = fmt::format("{}_{:04}_{}.png", instance.category, instance.id, i);
    if (auto ok = sim::WritePng(frame.rgb, out / file); !ok) return ok;
    Json view = ViewJson(instance, good[i], file);
    view["objects"] = ObjectsJson(*open.scene, frame.instance);
    views.push_back(std::move(view));
  }
  return {};
}

std::string Summary(const Json& document, const std::string& out) {
  std::map<std::string, int> count;
  for (const Json& view : document["views"]) ++count[view["category"]];
  std::string text = fmt::format("{}: {} views", out, document["views"].size());
  for (const auto& [category, n] : count) text += fmt::format(", {} {}", n, category);
  return text + fmt::format("; {} objects have no good view\n", document["unseen"].size());
}

}  // namespace

Result<void> SceneViews(const ViewsOptions& options, const CommonOptions& common,
                        Console& console) {
  const auto job = OpenSceneJob(options.scene, options.out, common, console);
  if (!job) return tl::unexpected(job.error());
  const OpenScene& open = job->open;
  sim::ViewRules rules;
  rules.sensor = job->config.agent.sensor;
  rules.per_object = options.per_object;
  Json document = HeaderJson(open, rules), views = Json::array(), unseen = Json::array();
  for (const sim::SceneInstance& instance : open.scene->instances) {
    if (instance.category.empty()) continue;
    console.Progress(fmt::format("instance {} of {}", instance.id, open.scene->instances.size()));
    const std::size_t before = views.size();
    if (auto ok = WriteViews(open, instance, rules, options.out, views); !ok) return ok;
    if (views.size() > before) continue;
    unseen.push_back({{"instance", instance.id}, {"category", instance.category}});
  }
  document["views"] = std::move(views);
  document["unseen"] = std::move(unseen);
  const std::string text = document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  const auto file = std::filesystem::path(options.out) / "views.json";
  if (auto ok = WriteFileAtomically(file, text); !ok) return ok;
  console.EndProgress();
  console.Print(Summary(document, options.out));
  console.Document(text);
  return {};
}

}  // namespace crossnav::app
