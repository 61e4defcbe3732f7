// SPDX-License-Identifier: MIT
#include "crossnav/inference/suite.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include "crossnav/core/read_file.h"
#include "crossnav/inference/batcher.h"
#include "crossnav/inference/depth_mask.h"
#include "crossnav/inference/detector_by_goal.h"
#include "crossnav/inference/second_opinion.h"
#include "crossnav/inference/sha256.h"

namespace crossnav::inference {
namespace {

struct Role {
  const char* part;
  std::string name;  ///< of the card
};

/// "yolov7, yolo_world_open" -> both names; an empty text is one empty name.
std::vector<std::string> NamesOf(const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    std::string name = list.substr(from, comma - from);
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    names.push_back(std::move(name));
    from = comma + 1;
  }
  return names;
}

std::vector<Role> RolesOf(const NetworksConfig& config) {
  std::vector<Role> roles;
  for (std::string& name : NamesOf(config.detector)) roles.push_back({"detector", std::move(name)});
  if (!config.second_detector.empty()) roles.push_back({"second_detector", config.second_detector});
  roles.push_back({"segmenter", config.segmenter});
  roles.push_back({"stairs", config.stairs});
  roles.push_back({"encoder", config.encoder});
  return roles;
}

bool HasPart(const Family& family, std::string_view part) {
  const std::string parts = std::string(" ") + family.parts + " ";
  return parts.find(" " + std::string(part) + " ") != std::string::npos;
}

/// Inference libraries crash on some damaged files that still parse; therefore only files with the
/// hash of their card run.
Result<void> HasHash(const ModelCard& card, const char* key, const std::string& hash,
                     const std::string& bytes) {
  if (!hash.empty()) return {};
  return Fail(ErrorCode::kInvalid,
              "key \"" + std::string(key) + "\" is missing; of the file as it is, it is \"" +
                  Sha256(bytes) + "\"",
              card.path.string());
}

SessionOptions SessionOptionsOf(const NetworksConfig& config) {
  SessionOptions options;
  options.backend = config.backend;
  options.provider = config.provider;
  options.threads = config.threads;
  return options;
}

}  // namespace

std::filesystem::path CardPath(const std::filesystem::path& dir, const std::string& name) {
  const std::filesystem::path path = name;
  return path.extension() == ".toml" ? path : dir / (name + ".toml");
}

std::vector<std::filesystem::path> FileDirs() {
  std::vector<std::filesystem::path> dirs;
  const auto value_of = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  const std::string named = value_of("CROSSNAV_NETWORKS"), data = value_of("XDG_DATA_HOME");
  if (!named.empty()) dirs.emplace_back(named);
  if (!data.empty()) dirs.push_back(std::filesystem::path(data) / "crossnav/networks");
  if (data.empty() && !value_of("HOME").empty())
    dirs.push_back(std::filesystem::path(value_of("HOME")) / ".local/share/crossnav/networks");
  return dirs;
}

void FindFile(ModelCard& card, const std::vector<std::filesystem::path>& dirs) {
  std::error_code error;
  if (std::filesystem::exists(card.file, error)) return;
  std::vector<std::filesystem::path> all = dirs;
  for (auto& dir : FileDirs()) all.push_back(std::move(dir));
  for (const auto& dir : all) {
    const auto file = dir / card.file.filename();
    if (!std::filesystem::exists(file, error)) continue;
    card.file = file;
    return;
  }
}

Result<std::vector<std::filesystem::path>> ListCards(const std::filesystem::path& dir) {
  std::vector<std::filesystem::path> cards;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(dir, error))
    if (entry.path().extension() == ".toml") cards.push_back(entry.path());
  if (error)
    return Fail(ErrorCode::kNotFound, "no such folder of networks; networks.dir names it",
                dir.string());
  std::sort(cards.begin(), cards.end());
  return cards;
}

Result<NetworkSet> NetworkSet::Read(const NetworksConfig& config, const std::filesystem::path& dir,
                                    const std::vector<std::filesystem::path>& file_dirs) {
  NetworkSet set;
  set.config_ = config;
  const auto roles = RolesOf(config);
  for (const auto& [part, name] : roles) {
    if (name.empty() && part == std::string_view("detector") && !config.detector.empty())
      return Fail(ErrorCode::kInvalid, "holds an empty name between commas", "networks.detector");
    if (name.empty() || (part == std::string_view("segmenter") && name == kDepthSegmenter))
      continue;
    const auto path = CardPath(dir, name);
    auto card = ReadModelCard(path);
    if (!card) {
      card.error().what += " (needed by networks." + std::string(part) + ")";
      return tl::unexpected(card.error());
    }
    FindFile(*card, file_dirs);
    const auto family = FamilyOf(*card);
    if (!family) return tl::unexpected(family.error());
    if (!HasPart(**family, part))
      return Fail(ErrorCode::kMismatch,
                  "family \"" + card->family + "\" has no " + part + "; networks." + part +
                      " must name a card that does",
                  path.string());
    if (set.cards_.count(name) == 0)
      if (auto ok = set.HashFiles(*card); !ok) return tl::unexpected(ok.error());
    if (part == std::string_view("second_detector") && !card->opinion.weight)
      return Fail(ErrorCode::kMismatch,
                  "key \"opinion.weight\" is missing; networks.second_detector needs it",
                  path.string());
    if (part == std::string_view("encoder")) set.encoder_name_ = EncoderNameOf(*card);
    set.cards_.emplace(name, std::move(*card));
  }
  return set;
}

Result<void> NetworkSet::HashFiles(const ModelCard& card) {
  const auto own = ReadNetworkFile(card);
  if (!own) return tl::unexpected(own.error());
  if (auto ok = HasHash(card, "sha256", card.sha256, *own); !ok) return ok;
  hashes_[card.name()] = card.sha256;
  const auto add = [&](const char* what, const char* key, const std::filesystem::path& file,
                       const std::string& hash) -> Result<void> {
    if (file.empty()) return {};
    const auto bytes = ReadFile(file);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto ok = HasHash(card, key, hash, *bytes); !ok) return ok;
    hashes_[card.name() + "." + what] = hash;
    return {};
  };
  if (auto ok = add("decoder", "decoder_sha256", card.decoder.file, card.decoder.sha256); !ok)
    return ok;
  return add("text", "text.sha256", card.text.encoder, card.text.sha256);
  return {};
}

Result<Model*> NetworkSet::ModelOf(const std::string& name, const ModelOptions& options) {
  auto& model = models_[name];
  if (model) return model.get();
  auto opened = Open(cards_.at(name), options);
  if (!opened) return tl::unexpected(opened.error());
  model = std::move(*opened);
  return model.get();
}

Result<perception::PerceptionSuite> NetworkSet::MakeSuite(double camera_height_m) {
  ModelOptions options;
  options.session = SessionOptionsOf(config_);
  if (config_.batch > 1) {
    if (!shared_) shared_ = std::make_shared<SharedNetworks>(BatchOptions{config_.batch});
    options.session.shared = shared_;
    models_.clear();  // the caches of a model are one agent's
  }
  options.camera_height_m = camera_height_m;
  std::map<std::string_view, Model*> models;
  std::vector<std::unique_ptr<perception::Detector>> detectors;
  for (const auto& [part, name] : RolesOf(config_)) {
    if (cards_.count(name) == 0) continue;
    auto model = ModelOf(name, options);
    if (!model) return tl::unexpected(model.error());
    models[part] = *model;
    if (part == std::string_view("detector")) detectors.push_back((*model)->MakeDetector());
  }
  perception::PerceptionSuite suite;
  suite.detector = MakeDetectorByGoal(std::move(detectors));
  if (models.count("segmenter") > 0) suite.segmenter = models["segmenter"]->MakeSegmenter();
  if (config_.segmenter == kDepthSegmenter) suite.segmenter = MakeDepthSegmenter();
  if (models.count("second_detector") > 0 && suite.detector && suite.segmenter) {
    DetectorPair pair = MakeDetectorPair(std::move(suite.detector), std::move(suite.segmenter),
                                         models_[config_.second_detector],
                                         cards_.at(config_.second_detector), config_.second_every);
    suite.detector = std::move(pair.detector);
    suite.segmenter = std::move(pair.segmenter);
  }
  if (models.count("stairs") > 0) suite.stairs = models["stairs"]->MakeStairs();
  if (models.count("encoder") > 0) suite.encoder = models["encoder"]->MakeEncoder();
  return suite;
}

Result<void> NetworkSet::IsComplete() const {
  for (const auto& [part, name] : RolesOf(config_))
    if (name.empty())
      return Fail(ErrorCode::kInvalid, "names no network, and the agent needs one",
                  std::string("networks.") + part);
  return CheckBackend(SessionOptionsOf(config_), "networks.backend");
}

}  // namespace crossnav::inference
