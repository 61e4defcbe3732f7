// SPDX-License-Identifier: MIT
#include "map_texts.h"

#include <fmt/format.h>

#include "crossnav/agent/pictured_goal.h"
#include "crossnav/core/read_file.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/perception/goal_picture.h"
#include "crossnav/scenegraph/find_objects.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"
#include "perception_source.h"
#include "session.h"

namespace crossnav::app {
namespace {

/// As ground truth would encode texts for features of `dim` numbers.
Result<std::unique_ptr<perception::DenseEncoder>> TruthFor(const std::string& file, int dim,
                                                           const evaluation::RunConfig& config) {
  sim::GroundTruthConfig texts = config.ground_truth;
  texts.feature_dim = dim;  // the map knows
  auto encoder = sim::MakeGroundTruthTexts(texts);
  if (!encoder) return encoder;
  if ((*encoder)->Dim() != dim) {
    return Fail(ErrorCode::kMismatch,
                fmt::format("its features have {} numbers, the vectors of ground_truth.clip_dir {}",
                            dim, (*encoder)->Dim()),
                file);
  }
  return encoder;
}

/// The text in the space of `encoder`, and its background for comparison.
Result<TextVectors> EncodeWith(perception::DenseEncoder& encoder, const std::string& text,
                               const evaluation::RunConfig& config) {
  auto vector = encoder.EncodeText(text);
  if (!vector) return tl::unexpected(vector.error());
  if (config.agent.query.relevancy != "contrastive") return TextVectors{std::move(*vector), {}};
  auto background = perception::EncodeTexts(encoder, memory::kBackgroundPrompts);
  if (!background) return tl::unexpected(background.error());
  return TextVectors{std::move(*vector), std::move(*background)};
}

}  // namespace

Result<PictureQuery> EncodePicture(const std::string& file, const std::string& picture,
                                   const std::vector<int>& box, const store::MapHeader& header,
                                   const evaluation::RunConfig& config) {
  const auto source = PerceptionSource::Read(config);
  if (!source) return tl::unexpected(source.error());
  if (auto ok = CheckEncoder(header, source->EncoderName(), file); !ok)
    return tl::unexpected(ok.error());
  auto suite = source->MakeSuite();
  if (!suite)
    return Fail(ErrorCode::kUnsupported,
                "pictures are read by networks; add --set eval.perception=networks", picture);
  if (!*suite) return tl::unexpected(suite->error());
  const auto bytes = ReadFile(picture);
  if (!bytes) return tl::unexpected(bytes.error());
  std::optional<perception::PixelBox> about;
  if (box.size() == 4) about = perception::PixelBox{box[0], box[1], box[2], box[3]};
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
  const auto goal = perception::DecodeGoalPicture({data, bytes->size()}, about, picture);
  if (!goal) return tl::unexpected(goal.error());
  auto pictured = agent::PicturedGoalOf(*goal, **suite);
  if (!pictured) return tl::unexpected(pictured.error());
  auto vectors = EncodeWith(*(*suite)->encoder, pictured->category, config);
  if (!vectors) return tl::unexpected(vectors.error());
  vectors->text = std::move(pictured->object);
  return PictureQuery{std::move(*vectors), std::move(pictured->category)};
}

std::optional<memory::MatchThresholds> ThresholdsOf(const std::string& encoder,
                                                    const evaluation::RunConfig& config) {
  if (const auto thresholds = memory::ThresholdsOf(encoder)) return thresholds;
  const auto card = RetrievalOf(config);
  if (!card.present_from) return std::nullopt;
  return memory::MatchThresholds{card.absent_below.value_or(*card.present_from),
                                 *card.present_from};
}

Result<store::LoadedMemory> LoadMap(const std::string& file, bool skip_damaged,
                                    const evaluation::RunConfig& config, Console& console) {
  const auto header = store::ReadMapHeader(file);
  if (!header) return tl::unexpected(header.error());
  store::LoadOptions load;
  load.map = config.agent.map;
  load.map->voxel_m = header->voxel_m;
  load.map->clearing = header->clearing;
  load.fusion = config.agent.fusion;
  load.skip_damaged = skip_damaged;
  auto loaded = store::LoadMemory(file, load);
  if (loaded) {
    for (const std::string& damage : loaded->damaged) console.Log(file + ": " + damage);
  }
  return loaded;
}

Result<std::unique_ptr<perception::DenseEncoder>> EncoderFor(const std::string& file,
                                                             const store::MapHeader& header,
                                                             const evaluation::RunConfig& config) {
  if (header.feature_dim == 0)
    return Fail(ErrorCode::kInvalid, "this map holds no features to query", file);
  const auto source = PerceptionSource::Read(config);
  if (!source) return tl::unexpected(source.error());
  if (auto ok = CheckEncoder(header, source->EncoderName(), file); !ok)
    return tl::unexpected(ok.error());
  auto suite = source->MakeSuite();
  if (!suite) return TruthFor(file, header.feature_dim, config);
  if (!*suite) return tl::unexpected(suite->error());
  return std::move((*suite)->encoder);
}

Result<TextVectors> EncodeText(const std::string& file, const std::string& text,
                               const store::MapHeader& header,
                               const evaluation::RunConfig& config) {
  const auto encoder = EncoderFor(file, header, config);
  if (!encoder) return tl::unexpected(encoder.error());
  return EncodeWith(**encoder, text, config);
}

Result<void> FindObjects(const std::string& file, const std::vector<std::string>& categories,
                         const store::LoadedMemory& loaded, const evaluation::RunConfig& config,
                         scenegraph::SceneGraph& graph) {
  if (categories.empty()) return {};
  const auto encoder = EncoderFor(file, loaded.header, config);
  if (!encoder) return tl::unexpected(encoder.error());
  for (const std::string& category : categories) {
    const auto vectors = EncodeWith(**encoder, category, config);
    if (!vectors) return tl::unexpected(vectors.error());
    scenegraph::FindObjects(graph, loaded.memory, {category, vectors->text, vectors->background},
                            config.agent.query, ThresholdsOf(loaded.header.encoder_name, config));
  }
  return {};
}

}  // namespace crossnav::app
