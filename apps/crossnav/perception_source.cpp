// SPDX-License-Identifier: MIT
#include "perception_source.h"

#include <array>
#include <system_error>

#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::app {

namespace fs = std::filesystem;

fs::path NetworksDir(const evaluation::RunConfig& config) {
  if (!config.networks.dir.empty()) return config.networks.dir;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  // In a build tree (build/PRESET/apps/crossnav), in an installation (bin), or beside it.
  const std::array<fs::path, 3> places = {program / "../../../../networks",
                                          program / "../share/crossnav/networks", "networks"};
  for (const fs::path& place : places)
    if (fs::is_directory(place, error)) return fs::weakly_canonical(place, error);
  return places.back();
}

namespace {

/// The card of a network that perception uses; nullopt without one, or if it cannot be read.
std::optional<inference::ModelCard> CardOf(const evaluation::RunConfig& config,
                                           const std::string& network) {
  if (config.eval.perception != "networks" || network.empty()) return std::nullopt;
  auto card = inference::ReadModelCard(inference::CardPath(NetworksDir(config), network));
  return card ? std::optional(std::move(*card)) : std::nullopt;
}

/// `value` unless the user set another than the standard.
void Use(const std::optional<double>& value, double standard, double* setting) {
  if (value && *setting == standard) *setting = *value;
}

}  // namespace

inference::ModelCard::Retrieval RetrievalOf(const evaluation::RunConfig& config) {
  const auto card = CardOf(config, config.networks.encoder);
  return card ? card->retrieval : inference::ModelCard::Retrieval{};
}

void UseCards(evaluation::RunConfig& config) {
  const auto retrieval = RetrievalOf(config);
  const memory::QueryConfig base;
  memory::QueryConfig& query = config.agent.query;
  Use(retrieval.min_similarity, base.min_similarity, &query.min_similarity);
  Use(retrieval.min_z_score, base.min_z_score, &query.min_z_score);
  Use(retrieval.min_peak_share, base.min_peak_share, &query.min_peak_share);
  policy::VerifyConfig& verify = config.agent.verify;
  const policy::VerifyConfig standard;
  Use(retrieval.margin, standard.refute_margin, &verify.refute_margin);
  Use(retrieval.margin, standard.strong_margin, &verify.strong_margin);

  const auto detector = CardOf(config, config.networks.detector);
  if (!detector) return;
  const inference::ModelCard::Evidence& evidence = detector->evidence;
  if (verify.evidence == "auto" && evidence.IsMeasured()) verify.evidence = "views";
  Use(evidence.offset, standard.views.offset, &verify.views.offset);
  Use(evidence.slope, standard.views.slope, &verify.views.slope);
  Use(evidence.missed, standard.views.missed, &verify.views.missed);
  Use(evidence.found, standard.views.found, &verify.views.found);
  Use(evidence.too_short, standard.views.too_short, &verify.views.too_short);
}

Result<PerceptionSource> PerceptionSource::Read(const evaluation::RunConfig& config,
                                                const std::vector<fs::path>& file_dirs) {
  PerceptionSource source(config);
  if (config.eval.perception == "oracle") return source;
  auto set = inference::NetworkSet::Read(config.networks, NetworksDir(config), file_dirs);
  if (!set) return tl::unexpected(set.error());
  if (auto ok = set->IsComplete(); !ok) return tl::unexpected(ok.error());
  source.networks_ = std::make_shared<inference::NetworkSet>(std::move(*set));
  return source;
}

evaluation::MakePerception PerceptionSource::Maker() const {
  if (!networks_) return {};
  return [set = networks_, height_m = config_->agent.sensor.camera_height_m](
             const sim::Simulator&) { return set->MakeSuite(height_m); };
}

std::optional<Result<perception::PerceptionSuite>> PerceptionSource::MakeSuite() const {
  if (!networks_) return std::nullopt;
  return networks_->MakeSuite(config_->agent.sensor.camera_height_m);
}

std::map<std::string, std::string> PerceptionSource::Hashes() const {
  if (!networks_) return {};
  return networks_->hashes();
}

std::string PerceptionSource::EncoderName() const {
  return networks_ ? networks_->encoder_name() : sim::EncoderName(config_->ground_truth);
}

}  // namespace crossnav::app
