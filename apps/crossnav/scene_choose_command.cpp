// SPDX-License-Identifier: MIT
// `crossnav scene choose`, and its lists of scenes.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/lines.h"
#include "crossnav/core/write_file.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/files/gzip_file.h"
#include "crossnav/evaluation/files/output_path.h"
#include "crossnav/evaluation/scoring/scene_context.h"
#include "scene_list.h"

namespace crossnav::app {
namespace {

using Json = nlohmann::ordered_json;

std::string_view Trimmed(std::string_view text) {
  text = text.substr(0, text.find('#'));
  while (!text.empty() && text.front() <= ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() <= ' ') text.remove_suffix(1);
  return text;
}

/// All names by which a list may refer to a scene.
std::map<std::string, std::string, std::less<>> IdsByName(const std::vector<std::string>& ids) {
  std::map<std::string, std::string, std::less<>> by_name;
  for (const std::string& id : ids) {
    const std::string folder = evaluation::SceneName(id);
    by_name.emplace(id, id);
    by_name.emplace(folder, id);
    by_name.emplace(folder.substr(folder.find('-') + 1), id);
  }
  return by_name;
}

struct SceneFacts {
  std::string name;
  std::size_t floors = 0;
  std::vector<std::string> categories;  ///< observable categories
};

SceneFacts FactsOf(const std::string& id, const evaluation::SceneContext& context) {
  SceneFacts facts{evaluation::SceneName(id), context.navmesh().Floors().size(), {}};
  for (const std::string_view name : kCategories) {
    const std::string category(name);
    if (!context.FloorsOf(category).empty()) facts.categories.push_back(category);
  }
  return facts;
}

bool Fits(const SceneFacts& facts, const ChooseOptions& options) {
  return static_cast<int>(facts.floors) >= options.floors &&
         std::ranges::all_of(options.categories, [&](const std::string& category) {
           return std::ranges::find(facts.categories, category) != facts.categories.end();
         });
}

Result<void> CheckCategories(const std::vector<std::string>& categories) {
  for (const std::string& category : categories) {
    if (std::ranges::find(kCategories, category) == kCategories.end()) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("\"{}\" is no category; there are {}", category,
                              fmt::join(kCategories, ", ")),
                  "--categories");
    }
  }
  return {};
}

}  // namespace

Result<std::vector<std::string>> ReadSceneList(const std::string& file,
                                               const std::string& scenes_dir) {
  const auto ids = evaluation::ListScenes(scenes_dir);
  if (!ids) return ids;
  const auto text = evaluation::ReadTextFile(file);
  if (!text) return tl::unexpected(text.error());
  const auto by_name = IdsByName(*ids);
  std::vector<std::string> listed;
  std::string_view rest = *text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view name = Trimmed(TakeLine(rest));
    if (name.empty()) continue;
    const std::string where = fmt::format("{}, line {}", file, number);
    const auto found = by_name.find(name);
    if (found == by_name.end()) {
      return Fail(ErrorCode::kNotFound,
                  "\"" + std::string(name) + "\" is no scene of " + scenes_dir, where);
    }
    if (std::ranges::find(listed, found->second) != listed.end())
      return Fail(ErrorCode::kInvalid, "\"" + std::string(name) + "\" is listed twice", where);
    listed.push_back(found->second);
  }
  if (listed.empty()) return Fail(ErrorCode::kInvalid, "lists no scene", file);
  return listed;
}

Result<void> SceneChoose(const ChooseOptions& options, const CommonOptions& common,
                         Console& console) {
  if (auto ok = CheckCategories(options.categories); !ok) return ok;
  if (!options.out.empty()) {
    if (auto ok = evaluation::CheckOutputFile(options.out, "--out"); !ok) return ok;
  }
  const auto config = LoadConfig(common);
  if (!config) return tl::unexpected(config.error());
  const auto ids = evaluation::ListScenes(options.scenes);
  if (!ids) return tl::unexpected(ids.error());
  std::string list;
  Json rows = Json::array();
  for (const std::string& id : *ids) {
    console.Progress(fmt::format("scene {} of {}: {}", rows.size() + 1, ids->size(), id));
    const auto context = evaluation::SceneContext::Load(options.scenes, id, *config);
    if (!context) return tl::unexpected(context.error());
    for (const std::string& note : (*context)->scene().notes) console.Log(id + ": " + note);
    const SceneFacts facts = FactsOf(id, **context);
    const bool is_chosen = Fits(facts, options);
    if (is_chosen) list += facts.name + "\n";
    rows.push_back({{"scene", facts.name},
                    {"floors", facts.floors},
                    {"categories", facts.categories},
                    {"chosen", is_chosen}});
    console.Print(fmt::format("{} {:<24} {} floors  {}\n", is_chosen ? "+" : "-", facts.name,
                              facts.floors, fmt::join(facts.categories, " ")));
  }
  console.EndProgress();
  const auto chosen = std::count(list.begin(), list.end(), '\n');
  console.Print(fmt::format("{} of {} scenes chosen\n", chosen, ids->size()));
  console.Document(Json({{"scenes", rows}, {"chosen", chosen}}));
  return options.out.empty() ? Result<void>{} : WriteFileAtomically(options.out, list);
}

}  // namespace crossnav::app
