// SPDX-License-Identifier: MIT
// `bench graph`: rooms and floors of generated houses' maps against the plans of the houses.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/trials/graph_trials.h"
#include "graph_picture.h"
#include "perception_source.h"
#include "session.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

Json ScoreJson(const evaluation::GraphScore& score, const evaluation::ObjectScore& objects) {
  return {{"floors", score.floors},
          {"floors_found", score.floors_found},
          {"floors_wrong", score.floors_wrong},
          {"rooms", score.rooms},
          {"rooms_found", score.rooms_found},
          {"rooms_wrong", score.rooms_wrong},
          {"rooms_f1", score.RoomsF1()},
          {"objects", objects.objects},
          {"objects_found", objects.objects_found},
          {"objects_wrong", objects.objects_wrong},
          {"objects_f1", objects.ObjectsF1()},
          {"relations", objects.relations},
          {"relations_found", objects.relations_found},
          {"relations_wrong", objects.relations_wrong}};
}

constexpr const char* kHead =
    "| house | floors | rooms (IoU 0.5) | rooms F1 | objects | objects F1 | relations |\n"
    "|---|---|---|--:|---|--:|---|\n";

std::string Row(const std::string& name, const evaluation::GraphScore& score,
                const evaluation::ObjectScore& objects) {
  return fmt::format(
      "| {} | {} of {}, {} more | {} of {}, {} more | {:.3f} | {} of {}, {} more | "
      "{:.3f} | {} of {}, {} more |\n",
      name, score.floors_found, score.floors, score.floors_wrong, score.rooms_found, score.rooms,
      score.rooms_wrong, score.RoomsF1(), objects.objects_found, objects.objects,
      objects.objects_wrong, objects.ObjectsF1(), objects.relations_found, objects.relations,
      objects.relations_wrong);
}

}  // namespace

Result<void> BenchGraph(const GraphBenchOptions& options, const CommonOptions& common,
                        Console& console) {
  Protocol protocol;
  protocol.perception = options.perception;
  const auto config = LoadRunConfig(common, protocol);
  if (!config) return tl::unexpected(config.error());
  const auto source = PerceptionSource::Read(*config);
  if (!source) return tl::unexpected(source.error());
  std::optional<perception::PerceptionSuite> suite;  // empty = ground truth
  if (auto made = source->MakeSuite()) {
    if (!*made) return tl::unexpected(made->error());
    suite = std::move(**made);
  }
  if (auto ok = evaluation::CheckOutputFolder(options.pictures, "--pictures"); !ok) return ok;
  evaluation::GraphScore all;
  evaluation::ObjectScore objects;
  std::string table = kHead;
  Json houses = Json::array();
  for (int i = 0; i < options.count; ++i) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    console.Progress(fmt::format("house {} of {}", i + 1, options.count));
    const auto trial =
        evaluation::TryGraph(seed, options.edition, *config, suite ? &*suite : nullptr);
    if (!trial) return tl::unexpected(trial.error());
    all += trial->score;
    objects += trial->objects;
    table += Row(trial->house, trial->score, trial->objects);
    Json house = ScoreJson(trial->score, trial->objects);
    house["house"] = trial->house;
    house["seconds"] = trial->seconds;
    house["record_ms"] = trial->record_ms;
    house["relate_ms"] = trial->relate_ms;
    house["failures"] = trial->objects.failures;
    houses.push_back(std::move(house));
    console.Log(fmt::format("{}: graph in {:.2f} s; records {:.2f} ms a view, relations {:.2f} ms",
                            trial->house, trial->seconds, trial->record_ms, trial->relate_ms));
    if (options.pictures.empty()) continue;
    const auto folder = std::filesystem::path(options.pictures) / trial->house;
    if (auto ok = WriteFloorPictures(trial->graph, folder); !ok) return ok;
  }
  console.Print(table + Row("all", all, objects));
  console.Document(Json({{"seed", options.seed},
                         {"count", options.count},
                         {"edition", options.edition},
                         {"all", ScoreJson(all, objects)},
                         {"houses", std::move(houses)}}));
  return {};
}

}  // namespace crossnav::app
