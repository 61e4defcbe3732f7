// SPDX-License-Identifier: MIT
// `networks calibrate`: retrieval thresholds of an encoder, found on development houses and written
// into its card.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/trials/retrieval_trials.h"
#include "crossnav/inference/suite.h"
#include "perception_source.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double kNoise = 0.02;  // chosen: of an F1; other houses turn such a difference round

/// Everything that the houses answered.
struct Measured {
  std::vector<std::string> houses;
  std::vector<evaluation::RetrievalChoice> choices = evaluation::RetrievalChoices();
  evaluation::RetrievalTrial all;
};

/// The card's encoder alone, opened once and kept for all houses.
evaluation::MakeEncoder MakerOf(const fs::path& card, const evaluation::RunConfig& config) {
  return [card, config](const sim::Simulator&) -> Result<evaluation::HeldEncoder> {
    struct Held {
      inference::NetworkSet set;
      perception::PerceptionSuite suite;
    };
    inference::NetworksConfig settings = config.networks;
    settings.detector = settings.segmenter = settings.stairs = "";
    settings.encoder = card.string();
    auto set = inference::NetworkSet::Read(settings, card.parent_path());
    if (!set) return tl::unexpected(set.error());
    const auto held = std::make_shared<Held>(Held{std::move(*set), {}});
    auto suite = held->set.MakeSuite(config.agent.sensor.camera_height_m);
    if (!suite) return tl::unexpected(suite.error());
    held->suite = std::move(*suite);
    return evaluation::HeldEncoder{held->suite.encoder.get(), held};
  };
}

Result<sim::Scene> LoadById(const std::string& scenes, const std::string& id) {
  const auto folder = sim::FindScene(scenes, id);
  if (!folder) return tl::unexpected(folder.error());
  return sim::LoadScene(*folder);
}

Result<Measured> Measure(const NetworksOptions& options, const fs::path& card,
                         const evaluation::RunConfig& config, Console& console) {
  const auto ids = evaluation::ListScenes(options.scenes);
  if (!ids) return tl::unexpected(ids.error());
  Measured measured;
  std::set<std::string> words = evaluation::WordsOfNoHouse();
  for (const std::string& id : *ids) {
    const auto scene = LoadById(options.scenes, id);
    if (!scene) return tl::unexpected(scene.error());
    words.merge(evaluation::WordsOf(*scene));
  }
  measured.all.counts.resize(measured.choices.size());
  for (const std::string& id : *ids) {
    console.Progress(
        fmt::format("house {} of {}: {}", measured.houses.size() + 1, ids->size(), id));
    const auto scene = LoadById(options.scenes, id);
    if (!scene) return tl::unexpected(scene.error());
    auto trial =
        evaluation::TryRetrieval(*scene, words, measured.choices, MakerOf(card, config), config);
    if (!trial) return tl::unexpected(trial.error());
    measured.houses.push_back(id);
    for (auto& query : trial->queries) measured.all.queries.push_back(std::move(query));
    for (std::size_t i = 0; i < measured.choices.size(); ++i)
      measured.all.counts[i] += trial->counts[i];
  }
  return measured;
}

/// Index of the card's settings; nothing where they are none of the choices.
std::optional<std::size_t> ChoiceOf(const inference::ModelCard& card, const Measured& measured) {
  const auto& of = card.retrieval;
  for (std::size_t i = 0; i < measured.choices.size(); ++i) {
    const auto& choice = measured.choices[i];
    if (of.min_similarity == choice.min_similarity && of.min_z_score == choice.min_z_score &&
        of.min_peak_share == choice.min_peak_share)
      return i;
  }
  return {};
}

/// Verdicts by the card's thresholds; nothing where it has none.
std::optional<evaluation::PresenceVerdicts> VerdictsOf(const inference::ModelCard& card,
                                                       const Measured& measured,
                                                       std::size_t choice) {
  const auto& of = card.retrieval;
  if (!of.present_from) return {};
  return evaluation::CountVerdicts(measured.all.queries, choice,
                                   {of.absent_below.value_or(*of.present_from), *of.present_from});
}

/// Lines of the card; its margin is kept.
std::string SectionOf(const Measured& measured, std::size_t taken,
                      const std::optional<evaluation::PresenceVerdicts>& presence,
                      const inference::ModelCard& card) {
  const auto& choice = measured.choices[taken];
  std::string text = fmt::format(
      "[retrieval]  # by `crossnav networks calibrate` on {} houses, {} questions\n"
      "min_similarity = {}\nmin_z_score = {}\nmin_peak_share = {}\n",
      measured.houses.size(), measured.all.queries.size(), choice.min_similarity,
      choice.min_z_score, choice.min_peak_share);
  if (presence)
    text += fmt::format("absent_below = {}\npresent_from = {}\n", presence->thresholds.absent_below,
                        presence->thresholds.present_from);
  if (card.retrieval.margin) text += fmt::format("margin = {}\n", *card.retrieval.margin);
  return text;
}

std::string CountText(const char* name, const evaluation::RetrievalChoice& choice,
                      const evaluation::RetrievalCount& count) {
  return fmt::format(
      "{:<8} min_similarity {:.2f}, min_z_score {:.1f}, min_peak_share {:.1f}: {} of {} names "
      "found, "
      "{} places right, {} wrong, F1 {:.3f}\n",
      name, choice.min_similarity, choice.min_z_score, choice.min_peak_share, count.found,
      count.asked, count.right, count.wrong, count.F1());
}

std::string VerdictsText(const char* name, const evaluation::PresenceVerdicts& v) {
  const auto line = [](const char* said, double right, int rightly, int asked, int wrongly,
                       int wrongly_asked) {
    return fmt::format("  {}: right in {:.0f} %; said of {} of {} rightly, of {} of {} wrongly\n",
                       said, 100 * right, rightly, asked, wrongly, wrongly_asked);
  };
  return fmt::format("{:<8} absent_below {:.3f}, present_from {:.3f}\n", name,
                     v.thresholds.absent_below, v.thresholds.present_from) +
         line("present", v.PresentIsRight(), v.there.present, v.there.asked, v.not_there.present,
              v.not_there.asked) +
         line("absent", v.AbsentIsRight(), v.not_there.absent, v.not_there.asked, v.there.absent,
              v.there.asked);
}

Json VerdictJson(const evaluation::VerdictCount& count) {
  return {{"asked", count.asked}, {"present", count.present}, {"absent", count.absent}};
}

Json VerdictsJson(const std::optional<evaluation::PresenceVerdicts>& v) {
  if (!v) return {};
  return {{"absent_below", v->thresholds.absent_below},
          {"present_from", v->thresholds.present_from},
          {"present_is_right", v->PresentIsRight()},
          {"absent_is_right", v->AbsentIsRight()},
          {"there", VerdictJson(v->there)},
          {"not_there", VerdictJson(v->not_there)}};
}

Json CountJson(const evaluation::RetrievalChoice& choice, const evaluation::RetrievalCount& count) {
  return {{"min_similarity", choice.min_similarity},
          {"min_z_score", choice.min_z_score},
          {"min_peak_share", choice.min_peak_share},
          {"asked", count.asked},
          {"found", count.found},
          {"right", count.right},
          {"wrong", count.wrong},
          {"f1", count.F1()}};
}

}  // namespace

Result<void> NetworksCalibrate(const NetworksOptions& options, const CommonOptions& common,
                               Console& console) {
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const std::string name = options.cards.empty() ? config->networks.encoder : options.cards.front();
  const fs::path path = inference::CardPath(NetworksDir(*config), name);
  const auto card = inference::ReadModelCard(path);
  if (!card) return tl::unexpected(card.error());
  const fs::path out = options.out.empty() ? path : fs::path(options.out);
  if (auto ok = evaluation::CheckOutputFile(out.string(), "--out"); !ok) return ok;
  const auto measured = Measure(options, path, *config, console);
  if (!measured) return tl::unexpected(measured.error());
  if (measured->all.queries.empty())
    return Fail(ErrorCode::kInvalid, "has no vector for any name in these houses", path.string());
  const auto& counts = measured->all.counts;
  const std::size_t best = evaluation::BestChoice(counts);
  const std::size_t own = ChoiceOf(*card, *measured).value_or(0);
  const std::size_t taken = counts[best].F1() - counts[own].F1() < kNoise ? own : best;
  const auto presence = evaluation::ChoosePresence(measured->all.queries, taken);
  const auto before = VerdictsOf(*card, *measured, own);
  const auto text = ReadFile(path, kMostToml);
  if (!text) return tl::unexpected(text.error());
  const std::string section = SectionOf(*measured, taken, presence, *card);
  if (auto ok = WriteFileAtomically(out, inference::WithRetrieval(*text, section)); !ok) return ok;
  console.Print(
      CountText("defaults", measured->choices[0], counts[0]) +
      CountText("best", measured->choices[best], counts[best]) +
      CountText("taken", measured->choices[taken], counts[taken]) +
      (before ? VerdictsText("before", *before) : "") +
      (presence ? VerdictsText("now", *presence)
                : "no match tells what is there from what is not: present_from is left out\n") +
      out.string() + "\n");
  Json queries = Json::array();
  for (const auto& q : measured->all.queries)
    queries.push_back({{"house", q.house},
                       {"word", q.word},
                       {"is_there", q.is_there},
                       {"match", q.match[taken]}});
  console.Document(Json({{"card", out.string()},
                         {"houses", measured->houses},
                         {"defaults", CountJson(measured->choices[0], counts[0])},
                         {"best", CountJson(measured->choices[best], counts[best])},
                         {"taken", CountJson(measured->choices[taken], counts[taken])},
                         {"verdicts_before", VerdictsJson(before)},
                         {"verdicts", VerdictsJson(presence)},
                         {"queries", std::move(queries)}}));
  return {};
}

}  // namespace crossnav::app
