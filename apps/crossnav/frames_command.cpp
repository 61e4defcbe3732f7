// SPDX-License-Identifier: MIT
// `scene frames`: many frames with their ground truth as arrays (docs/formats/frames.md).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/sim/sensing/frame_places.h"
#include "open_scene.h"

namespace crossnav::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kOversample = 2;  // chosen: colours are means of 2 x 2 rays, as in a camera

/// A file in NumPy's format 1, written row by row.
class NpyFile {
 public:
  NpyFile(const fs::path& file, const char* type, const std::string& shape)
      : out_(file, std::ios::binary) {
    std::string header =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');
    header += '\n';
    const auto size = static_cast<std::uint16_t>(header.size());
    out_.write("\x93NUMPY\x01\x00", 8);
    out_.write(reinterpret_cast<const char*>(&size), 2);
    out_ << header;
  }

  template <class T>
  void Add(const std::vector<T>& values) {
    out_.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(T)));
  }

  bool IsGood() { return out_.flush().good(); }

 private:
  std::ofstream out_;
};

struct Arrays {
  std::vector<std::uint8_t> rgb;           // size x size x 3
  std::vector<std::uint16_t> depth_mm;     // size x size, 0 = none
  std::vector<std::uint16_t> instance_id;  // size x size, 0 = none
};

/// Averages colours; depth and instance come from the ray nearest to the pixel's middle.
Arrays Reduce(const sim::Frame& frame, int size) {
  Arrays arrays;
  for (int v = 0; v < size; ++v) {
    for (int u = 0; u < size; ++u) {
      int r = 0, g = 0, b = 0;
      for (int i = 0; i < kOversample * kOversample; ++i) {
        const Rgb8 c =
            frame.rgb.At(u * kOversample + i % kOversample, v * kOversample + i / kOversample);
        r += c.r;
        g += c.g;
        b += c.b;
      }
      constexpr int n = kOversample * kOversample;
      for (const int sum : {r, g, b}) {
        arrays.rgb.push_back(static_cast<std::uint8_t>((sum + n / 2) / n));
      }
      const double mm = 1e3 * frame.depth_m.At(u * kOversample, v * kOversample);
      arrays.depth_mm.push_back(static_cast<std::uint16_t>(std::clamp(mm, 0.0, 65535.0)));
      arrays.instance_id.push_back(
          static_cast<std::uint16_t>(frame.instance.At(u * kOversample, v * kOversample)));
    }
  }
  return arrays;
}

Json PlaceJson(const sim::FramePlace& place) {
  const Vector3d& p = place.pose.p_world;
  return {{"position", {Rounded(p.x()), Rounded(p.y()), Rounded(p.z())}},
          {"yaw_deg", Rounded(RadToDeg(place.pose.yaw_rad))},
          {"pitch_deg", Rounded(RadToDeg(place.pose.pitch_rad))},
          {"camera_height_m", Rounded(place.camera_height_m)}};
}

Json HeaderJson(const OpenScene& open, const FramesOptions& options, double hfov_deg) {
  Json instances = Json::array();
  for (const sim::SceneInstance& instance : open.scene->instances) {
    instances.push_back(
        {{"id", instance.id}, {"name", instance.name}, {"category", instance.category}});
  }
  return {{"format", 1},
          {"scene", open.scene->id},
          {"mesh_hash", evaluation::HexHash(open.scene->mesh_hash)},
          {"size_px", options.size_px},
          {"hfov_deg", hfov_deg},
          {"seed", options.seed},
          {"instances", std::move(instances)}};
}

}  // namespace

Result<void> SceneFrames(const FramesOptions& options, const CommonOptions& common,
                         Console& console) {
  const auto job = OpenSceneJob(options.scene, options.out, common, console);
  if (!job) return tl::unexpected(job.error());
  const OpenScene& open = job->open;
  const fs::path out = options.out;
  SensorConfig sensor = job->config.agent.sensor;
  sensor.width_px = sensor.height_px = options.size_px * kOversample;
  sim::FrameRules rules;
  rules.count = options.count;
  rules.seed = options.seed;
  rules.camera_height_m = sensor.camera_height_m;
  const auto places = sim::FramePlaces(*open.scene, *open.navmesh, *open.caster, rules);
  const std::string shape =
      fmt::format("{}, {}, {}", places.size(), options.size_px, options.size_px);
  NpyFile rgb(out / "rgb.npy", "|u1", shape + ", 3");
  NpyFile depth(out / "depth_mm.npy", "<u2", shape), ids(out / "instance.npy", "<u2", shape);
  Json document = HeaderJson(open, options, sensor.hfov_deg), frames = Json::array();
  for (const sim::FramePlace& place : places) {
    const Arrays arrays = Reduce(
        open.caster->Render(sensor.Intrinsics(), CameraPose(place.pose, place.camera_height_m)),
        options.size_px);
    rgb.Add(arrays.rgb);
    depth.Add(arrays.depth_mm);
    ids.Add(arrays.instance_id);
    frames.push_back(PlaceJson(place));
    console.Progress(fmt::format("frame {} of {}", frames.size(), places.size()));
  }
  if (!rgb.IsGood() || !depth.IsGood() || !ids.IsGood()) {
    return Fail(ErrorCode::kIo, "cannot write the arrays", options.out);
  }
  document["frames"] = std::move(frames);
  const std::string text = document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (auto ok = WriteFileAtomically(out / "frames.json", text); !ok) return ok;
  console.EndProgress();
  console.Print(fmt::format("{}: {} frames\n", options.out, places.size()));
  console.Document(text);
  return {};
}

}  // namespace crossnav::app
