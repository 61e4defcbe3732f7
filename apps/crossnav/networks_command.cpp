// SPDX-License-Identifier: MIT
// `networks list | check | calibrate | look`: lists, checks and calibrates networks, and shows
// their output.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <span>

#include "batch_check.h"
#include "commands.h"
#include "crossnav/core/categories.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/inference/boxes.h"
#include "crossnav/inference/presets.h"
#include "crossnav/inference/suite.h"
#include "crossnav/sim/sensing/picture.h"
#include "frame_file.h"
#include "look_panel.h"
#include "perception_source.h"
#include "verbs.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The requested cards, as names in the folder or as paths; all cards by default.
Result<std::vector<fs::path>> CardsOf(const NetworksOptions& options,
                                      const evaluation::RunConfig& config) {
  const fs::path dir = NetworksDir(config);
  if (options.cards.empty()) return inference::ListCards(dir);
  std::vector<fs::path> cards;
  for (const std::string& name : options.cards) {
    const fs::path path = name;
    cards.push_back(path.extension() == ".toml" ? path : dir / (name + ".toml"));
  }
  return cards;
}

/// A card and the result of its check.
struct Entry {
  std::string name, family, parts, licence, error;
  bool is_there = false;  ///< the file exists and matches the card
};

Entry EntryOf(const fs::path& path) {
  Entry entry;
  entry.name = path.stem().string();
  auto card = inference::ReadModelCard(path);
  if (!card) {
    entry.error = card.error().Message();
    return entry;
  }
  entry.family = card->family;
  entry.licence = card->licence;
  const auto family = inference::FamilyOf(*card);
  if (!family) {
    entry.error = family.error().Message();
    return entry;
  }
  entry.parts = (*family)->parts;
  inference::FindFile(*card);
  const auto bytes = inference::ReadNetworkFile(*card);
  entry.is_there = bytes.has_value();
  if (!bytes) entry.error = bytes.error().Message();
  return entry;
}

Json BackendsJson() {
  Json json = Json::array();
  for (const inference::Backend& backend : inference::Backends())
    json.push_back({{"name", backend.name},
                    {"found", backend.is_available},
                    {"version", backend.version},
                    {"providers", backend.providers},
                    {"get", backend.is_available ? std::string() : backend.get}});
  return json;
}

/// Grey and 2 m away everywhere, of the sensor's size.
Observation PlainFrame(const SensorConfig& sensor) {
  Observation obs;
  obs.camera = sensor.Intrinsics();
  obs.rgb = RgbImage(sensor.width_px, sensor.height_px, Rgb8{128, 128, 128});
  obs.depth_m = DepthImage(sensor.width_px, sensor.height_px, 2.0F);
  obs.T_world_camera = CameraPose({}, sensor.camera_height_m);
  return obs;
}

/// Settings with this network for every part that it has, and no network for the other parts.
inference::NetworksConfig Alone(const inference::NetworksConfig& base, const std::string& name,
                                const std::string& parts) {
  inference::NetworksConfig config = base;
  const auto has = [&](const char* part) {
    return (" " + parts + " ").find(std::string(" ") + part + " ") != std::string::npos;
  };
  config.detector = has("detector") ? name : "";
  config.segmenter = has("segmenter") ? name : has("detector") ? "depth" : "";
  config.stairs = has("stairs") ? name : "";
  config.encoder = has("encoder") ? name : "";
  return config;
}

/// Runs each part of the suite once, the detector for each goal; a goal outside its classes is no
/// error.
Result<Look> LookAt(const perception::PerceptionSuite& suite, const Observation& obs,
                    std::span<const std::string_view> goals, const std::string& text) {
  Look look;
  look.text = text;
  for (const std::string_view goal : goals) {
    if (!suite.detector) break;
    auto found = suite.detector->Detect(obs, goal);
    if (!found && found.error().code == ErrorCode::kUnsupported) continue;
    if (!found) return tl::unexpected(found.error());
    for (perception::Detection& detection : *found) {
      if (suite.segmenter)
        if (auto ok = suite.segmenter->Segment(obs, detection); !ok)
          return tl::unexpected(ok.error());
      look.found.push_back({std::string(goal), std::move(detection)});
    }
  }
  if (suite.stairs) {
    auto stairs = suite.stairs->SegmentStairs(obs);
    if (!stairs) return tl::unexpected(stairs.error());
    look.stairs = std::move(*stairs);
  }
  if (!suite.encoder || text.empty()) return look;
  const auto vector = suite.encoder->EncodeText(text);
  if (!vector) return tl::unexpected(vector.error());
  const auto grid = suite.encoder->EncodeImage(obs);
  if (!grid) return tl::unexpected(grid.error());
  look.similarity = Image<float>(grid->cols, grid->rows);
  for (std::size_t i = 0; i < look.similarity.data.size(); ++i) {
    const auto first = grid->data.begin() + static_cast<std::ptrdiff_t>(i * vector->size());
    look.similarity.data[i] = std::inner_product(vector->begin(), vector->end(), first, 0.0F);
  }
  return look;
}

/// Milliseconds of the second of two looks: the first look allocates.
Result<double> TimeOf(const fs::path& path, const Entry& entry,
                      const evaluation::RunConfig& config) {
  const auto settings = Alone(config.networks, path.string(), entry.parts);
  auto set = inference::NetworkSet::Read(settings, path.parent_path());
  if (!set) return tl::unexpected(set.error());
  const auto suite = set->MakeSuite(config.agent.sensor.camera_height_m);
  if (!suite) return tl::unexpected(suite.error());
  Observation obs = PlainFrame(config.agent.sensor);
  const std::span<const std::string_view> goal(kCategories.data(), 1);  // as an agent does
  double ms = 0;
  for (int i = 0; i < 2; ++i) {
    obs.rgb.data[0].r = static_cast<std::uint8_t>(i);  // another frame
    const auto start = std::chrono::steady_clock::now();
    const auto look = LookAt(*suite, obs, goal, suite->encoder ? "chair" : "");
    if (!look) return tl::unexpected(look.error());
    ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  return ms;
}

/// Batches of networks.batch frames, with an agent's look at a plain picture.
Result<BatchCheck> CheckBatchesOf(const fs::path& path, const Entry& entry,
                                  const evaluation::RunConfig& config) {
  auto card = inference::ReadModelCard(path);
  if (!card) return tl::unexpected(card.error());
  inference::FindFile(*card);
  const auto work = [&](const perception::PerceptionSuite& suite, int agent,
                        int frame) -> Result<void> {
    Observation obs = PlainFrame(config.agent.sensor);
    obs.rgb.data[0] = {static_cast<std::uint8_t>(frame), static_cast<std::uint8_t>(agent), 0};
    const std::span<const std::string_view> goal(kCategories.data(), 1);
    const auto look = LookAt(suite, obs, goal, suite.encoder ? "chair" : "");
    if (!look) return tl::unexpected(look.error());
    return {};
  };
  return CheckBatches(*card, Alone(config.networks, path.string(), entry.parts),
                      config.agent.sensor.camera_height_m, work);
}

Json LookJson(const Look& look, const std::string& panel) {
  Json found = Json::array();
  for (const auto& [goal, detection] : look.found) {
    const auto& box = detection.box;
    found.push_back(
        {{"goal", goal},
         {"confidence", detection.confidence},
         {"box", {box.u0, box.v0, box.u1, box.v1}},
         {"mask_px", std::count(detection.mask.data.begin(), detection.mask.data.end(), 1)},
         {"mask_quality", detection.mask_quality}});
  }
  Json json = {{"found", std::move(found)}, {"panel", panel}};
  if (!look.stairs.empty()) {
    const auto& p = look.stairs.data;
    json["stairs"] = {{"px", std::count_if(p.begin(), p.end(), [](float x) { return x >= 0.5F; })},
                      {"most", *std::max_element(p.begin(), p.end())}};
  }
  if (!look.similarity.empty()) {
    json["similarity"] = {{"text", look.text},
                          {"rows", look.similarity.height},
                          {"cols", look.similarity.width},
                          {"cells", look.similarity.data}};
  }
  return json;
}

}  // namespace

Result<void> NetworksList(const NetworksOptions& options, const CommonOptions& common,
                          Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto cards = CardsOf(options, *config);
  if (!cards) return tl::unexpected(cards.error());
  Json list = Json::array();
  std::string text = fmt::format("{}\n", NetworksDir(*config).string());
  for (const fs::path& path : *cards) {
    const Entry e = EntryOf(path);
    list.push_back({{"name", e.name},
                    {"family", e.family},
                    {"parts", e.parts},
                    {"licence", e.licence},
                    {"found", e.is_there},
                    {"error", e.error}});
    text += fmt::format("  {:<24} {:<10} {:<36} {}\n", e.name, e.family, e.parts,
                        e.error.empty() ? "found" : e.error);
  }
  Json presets = Json::array();
  for (const inference::Preset& preset : inference::Presets()) {
    const auto missing = inference::MissingFile(preset, NetworksDir(*config));
    presets.push_back({{"name", preset.name}, {"what", preset.what}, {"found", !missing}});
    text += fmt::format("  --networks {:<13} {}{}\n", preset.name, preset.what,
                        missing ? "; " + missing->string() + " is not there" : "");
  }
  for (const inference::Backend& backend : inference::Backends())
    text += backend.is_available
                ? fmt::format("{}: {} ({})\n", backend.name, backend.version,
                              fmt::join(backend.providers, ", "))
                : fmt::format("{}: not available; {}\n", backend.name, backend.get);
  console.Print(text);
  console.Document(Json({{"dir", NetworksDir(*config).string()},
                         {"networks", std::move(list)},
                         {"presets", std::move(presets)},
                         {"backends", BackendsJson()}}));
  return {};
}

Result<void> NetworksCheck(const NetworksOptions& options, const CommonOptions& common,
                           Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto cards = CardsOf(options, *config);
  if (!cards) return tl::unexpected(cards.error());
  std::string first_error, text;
  Json list = Json::array();
  for (const fs::path& path : *cards) {
    Entry entry = EntryOf(path);
    double ms = 0;
    // A card without its downloaded file is no error, unless it was requested.
    const bool is_absent = !entry.is_there && !entry.family.empty() && options.cards.empty() &&
                           entry.error.find("is not there") != std::string::npos;
    if (entry.is_there) {
      const auto time = TimeOf(path, entry, *config);
      if (time) ms = *time;
      if (!time) entry.error = time.error().Message();
    }
    std::optional<BatchCheck> batches;
    if (entry.error.empty() && config->networks.batch > 1) {
      auto checked = CheckBatchesOf(path, entry, *config);
      if (!checked) entry.error = checked.error().Message();
      if (checked) batches = std::move(*checked);
    }
    if (!entry.error.empty() && !is_absent && first_error.empty()) first_error = entry.error;
    text += fmt::format(
        "{:<24} {}\n", entry.name,
        entry.error.empty() ? fmt::format("fits its card, {:.1f} ms a frame", ms) : entry.error);
    list.push_back({{"name", entry.name}, {"ms", ms}, {"error", entry.error}});
    if (!batches) continue;
    text += BatchText(*batches);
    list.back()["batches"] = BatchJson(*batches);
  }
  console.Print(text);
  console.Document(Json({{"networks", std::move(list)}}));
  if (first_error.empty()) return {};
  return Fail(ErrorCode::kInvalid, first_error);
}

Result<void> NetworksLook(const NetworksOptions& options, const CommonOptions& common,
                          Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  if (auto ok = evaluation::CheckNotInput(options.out, "--out", options.image); !ok) return ok;
  const auto obs = ReadFrame(options.image, options.depth, config->agent.sensor);
  if (!obs) return tl::unexpected(obs.error());
  inference::NetworksConfig settings = config->networks;
  if (!options.network.empty()) {
    NetworksOptions one;
    one.cards = {options.network};
    const auto path = CardsOf(one, *config);
    const Entry entry = EntryOf(path->front());
    if (!entry.error.empty()) return Fail(ErrorCode::kInvalid, entry.error);
    settings = Alone(settings, path->front().string(), entry.parts);
  }
  auto set = inference::NetworkSet::Read(settings, NetworksDir(*config));
  if (!set) return tl::unexpected(set.error());
  const auto suite = set->MakeSuite(config->agent.sensor.camera_height_m);
  if (!suite) return tl::unexpected(suite.error());
  const auto look = LookAt(*suite, *obs, kCategories, options.text);
  if (!look) return tl::unexpected(look.error());
  if (auto ok = sim::WritePng(LookPanel(*obs, *look), options.out); !ok) return ok;
  std::string text;
  for (const auto& [goal, detection] : look->found) {
    const auto& box = detection.box;
    text += fmt::format("{:<12} {:.2f}  {}..{} x {}..{}  mask {:.2f}\n", goal, detection.confidence,
                        box.u0, box.u1, box.v0, box.v1, detection.mask_quality);
  }
  console.Print(text + options.out + "\n");
  console.Document(LookJson(*look, options.out));
  return {};
}

void AddNetworks(CLI::App& app, Options& o) {
  CLI::App* networks = app.add_subcommand("networks", "Networks for perception from pixels");
  networks->require_subcommand(1);
  AddVerb(*networks, o, "list", "Which networks there are", "crossnav networks list",
          [&o](Console& c) { return NetworksList(o.networks, o.common, c); });
  CLI::App* check = AddVerb(*networks, o, "check", "Whether files fit their cards, and how fast",
                            "crossnav networks check crossnav_small",
                            [&o](Console& c) { return NetworksCheck(o.networks, o.common, c); });
  check->add_option("CARD", o.networks.cards, "Names or paths of cards; default: all");
  CLI::App* calibrate =
      AddVerb(*networks, o, "calibrate",
              "Retrieval thresholds of an encoder, measured and put into its card",
              "crossnav networks calibrate sed --scenes houses",
              [&o](Console& c) { return NetworksCalibrate(o.networks, o.common, c); });
  calibrate->add_option("CARD", o.networks.cards, "Name or path; default: networks.encoder")
      ->expected(0, 1);
  calibrate->add_option("--scenes", o.networks.scenes, "Folder of development houses")->required();
  calibrate->add_option("--out", o.networks.out, "Card to write; default: the card itself");
  CLI::App* look = AddVerb(*networks, o, "look", "What the networks see in a picture",
                           "crossnav networks look room.png --text sofa --out panel.png",
                           [&o](Console& c) { return NetworksLook(o.networks, o.common, c); });
  look->add_option("IMAGE", o.networks.image, "Picture (PNG or JPEG)")->required();
  look->add_option("--depth", o.networks.depth, "Its depth: PGM of 16 bits [mm], or .npy [m]");
  look->add_option("--text", o.networks.text, "Show how much each place is like this");
  look->add_option("--network", o.networks.network, "Card that answers alone; default: settings");
  look->add_option("--out", o.networks.out, "Picture to write (PNG)")->required();
}

}  // namespace crossnav::app
