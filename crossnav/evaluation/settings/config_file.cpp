// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/settings/config_file.h"

#include <toml++/toml.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "crossnav/core/config_visitor.h"
#include "crossnav/core/nearest.h"
#include "crossnav/core/read_file.h"
#include "crossnav/core/rng.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/settings/renamed_settings.h"

namespace crossnav::evaluation {
namespace {

std::string_view LastPart(std::string_view key) {
  return key.substr(key.rfind('.') + 1);
}

std::vector<std::string> KeysOf(const std::vector<ConfigField>& fields) {
  std::vector<std::string> keys;
  for (const ConfigField& field : fields) keys.push_back(field.key);
  return keys;
}

/// Shortest text that reads back as the same number.
std::string FormatNumber(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string FormatNumber(std::uint64_t value) {
  return std::to_string(value);
}
std::string FormatNumber(int value) {
  return std::to_string(value);
}

std::string Quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted.push_back('\\');
    quoted.push_back(c);
  }
  return quoted + "\"";
}

/// JSON and TOML text of a value; a whole double needs its ".0" in TOML only.
std::string FormatValue(const ConfigField& field) {
  return std::visit(
      [](const auto* value) -> std::string {
        using T = std::decay_t<decltype(*value)>;
        if constexpr (std::is_same_v<T, bool>) return *value ? "true" : "false";
        if constexpr (std::is_same_v<T, std::string>) return Quote(*value);
        if constexpr (std::is_same_v<T, double>) {
          std::string text = FormatNumber(*value);
          if (text.find_first_of(".en") == std::string::npos) text += ".0";
          return text;
        }
        if constexpr (std::is_same_v<T, int> || std::is_same_v<T, std::uint64_t>) {
          return FormatNumber(*value);
        }
        return "";
      },
      field.value);
}

std::string Join(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

/// A scalar from a file or an override, before conversion to a field's type.
using Scalar = std::variant<bool, std::int64_t, double, std::string>;

std::string RangeText(const ConfigField& field) {
  return "must be in [" + FormatNumber(field.lo) + ", " + FormatNumber(field.hi) + "]";
}

struct ScalarSetter {
  const ConfigField& field;

  std::string operator()(bool* target, bool value) const {
    *target = value;
    return {};
  }
  std::string operator()(std::string* target, const std::string& value) const {
    const auto& choices = field.choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), value) == choices.end()) {
      return "must be one of " + Join(choices, ", ") + ", not \"" + value + "\"" +
             DidYouMean(value, choices);
    }
    *target = value;
    return {};
  }
  template <class T>
  requires(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) std::string operator()(
      T* target, std::int64_t value) const {
    if (static_cast<double>(value) < field.lo || static_cast<double>(value) > field.hi) {
      return RangeText(field);
    }
    *target = static_cast<T>(value);
    return {};
  }
  std::string operator()(double* target, double value) const {
    if (!(value >= field.lo && value <= field.hi)) return RangeText(field);
    *target = value;
    return {};
  }
  template <class T, class S>
  std::string operator()(T*, const S&) const {
    if (std::is_same_v<T, bool>) return "must be true or false";
    if (std::is_same_v<T, std::string>) return "must be a string";
    if (std::is_same_v<T, double>) return "must be a number";
    return "must be a whole number";
  }
};

/// Sets fields from one source: a file, or all overrides together.
struct SettingsReader {
  SettingsReader(RunConfig& config, const std::string& from)
      : fields(FieldsOf(config)), source(from), renamed(from) {}

  void Set(const std::string& key, const Scalar& value) {
    const std::string present = renamed.PresentKey(key);
    const auto field = std::find_if(fields.begin(), fields.end(),
                                    [&](const ConfigField& f) { return f.key == present; });
    if (field == fields.end()) {
      problems.push_back("unknown key \"" + key + "\"" + DidYouMean(key, KeysOf(fields)));
      return;
    }
    const std::string problem = std::visit(ScalarSetter{*field}, field->value, value);
    if (!problem.empty()) problems.push_back("key \"" + key + "\" " + problem);
  }

  /// All problems as one error. Without problems, appends the warnings to `warnings`.
  Result<void> Finish(std::vector<std::string>* warnings) {
    problems.insert(problems.end(), renamed.problems().begin(), renamed.problems().end());
    if (!problems.empty()) return Fail(ErrorCode::kInvalid, Join(problems, "\n  "), source);
    if (warnings != nullptr)
      warnings->insert(warnings->end(), renamed.warnings().begin(), renamed.warnings().end());
    return {};
  }

  std::vector<ConfigField> fields;
  std::string source;
  RenamedSettings renamed;
  std::vector<std::string> problems;
};

void ApplyTable(const toml::table& table, const std::string& prefix, SettingsReader& reader) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    if (const auto* inner = node.as_table()) {
      ApplyTable(*inner, key + ".", reader);
    } else if (const auto* flag = node.as_boolean()) {
      reader.Set(key, flag->get());
    } else if (const auto* whole = node.as_integer()) {
      reader.Set(key, whole->get());
    } else if (const auto* number = node.as_floating_point()) {
      reader.Set(key, number->get());
    } else if (const auto* text = node.as_string()) {
      reader.Set(key, text->get());
    } else {
      reader.problems.push_back("key \"" + key + "\" must be a single value");
    }
  }
}

/// The text after `--set key=` is a TOML value, or else a string.
Scalar ParseOverride(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  const char* end = text.data() + text.size();
  std::int64_t whole = 0;
  if (const auto r = std::from_chars(text.data(), end, whole);
      r.ec == std::errc() && r.ptr == end) {
    return whole;
  }
  double number = 0;
  if (const auto r = std::from_chars(text.data(), end, number);
      r.ec == std::errc() && r.ptr == end) {
    return number;
  }
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return text.substr(1, text.size() - 2);
  }
  return text;
}

/// Cast for readers only: fields never change through a const config.
std::vector<ConfigField> ReadOnlyFields(const RunConfig& config) {
  return FieldsOf(const_cast<RunConfig&>(config));
}

std::string SectionOf(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

std::vector<std::string> Split(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

struct Variant {
  std::string_view name;
  void (*apply)(RunConfig&);
};

constexpr Variant kVariants[] = {
    {"full", [](RunConfig&) {}},
    {"no-history-poi", [](RunConfig& c) { c.agent.policy.poi.use_history = false; }},
    {"no-history-poi-pure",
     [](RunConfig& c) {
       c.agent.policy.poi.use_history = false;
       c.agent.policy.poi.keep_coverage = true;
     }},
    {"planar", [](RunConfig& c) { c.agent.policy.planar = true; }},
    {"onemap",
     [](RunConfig& c) {
       c.agent.policy.profile = "onemap";
       c.agent.policy.planar = true;
       c.agent.policy.poi.use_history = false;  // OneMap has its own points of interest
     }},
    {"paper", [](RunConfig& c) { c.agent.policy.profile = "paper"; }},
    {"paper-no-history-poi",
     [](RunConfig& c) {
       c.agent.policy.profile = "paper";
       c.agent.policy.poi.use_history = false;
     }},
    {"known-map", [](RunConfig&) {}},  // the memory provides the knowledge (survey.h)
    // Every instance, not the paper's four.
    {"known-objects", [](RunConfig& c) { c.agent.query.top_k = 1000; }},
};

}  // namespace

Result<void> ApplyConfigText(std::string_view text, const std::string& name, RunConfig& config,
                             std::vector<std::string>* warnings) {
  if (auto ok = CheckTomlShape(text, name); !ok) return ok;
  toml::table table;
  try {
    table = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    return Fail(ErrorCode::kMalformed, std::string(error.description()),
                name + ": line " + std::to_string(error.source().begin.line));
  }
  RunConfig changed = config;
  SettingsReader reader(changed, name);
  ApplyTable(table, "", reader);
  if (auto ok = reader.Finish(warnings); !ok) return ok;
  config = std::move(changed);
  return {};
}

Result<void> ApplyConfigFile(const std::filesystem::path& path, RunConfig& config,
                             std::vector<std::string>* warnings) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ApplyConfigText(*text, path.string(), config, warnings);
}

Result<void> ApplyOverrides(const std::vector<std::string>& overrides, RunConfig& config,
                            std::vector<std::string>* warnings) {
  RunConfig changed = config;
  SettingsReader reader(changed, "--set");
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      reader.problems.push_back("\"" + text + "\" is not key=value");
      continue;
    }
    reader.Set(text.substr(0, equals), ParseOverride(text.substr(equals + 1)));
  }
  if (auto ok = reader.Finish(warnings); !ok) return ok;
  config = std::move(changed);
  return {};
}

Result<void> ApplyVariant(std::string_view name, RunConfig& config) {
  std::vector<std::string> names;
  for (const Variant& variant : kVariants) {
    if (variant.name == name) return variant.apply(config), Result<void>();
    names.emplace_back(variant.name);
  }
  return Fail(ErrorCode::kInvalid,
              "unknown variant \"" + std::string(name) + "\"; there are " + Join(names, ", ") +
                  DidYouMean(name, names),
              "--variant");
}

RunConfig DefaultsOfProfile(const std::string& profile) {
  RunConfig config;
  config.noise = sim::NoiseOfProfile(profile);
  // A map that never clears would keep stray readings.
  if (profile != "none") config.agent.map.clearing = "evidence";
  return config;
}

Result<RunConfig> ReadConfig(const ConfigSources& sources, std::vector<std::string>* warnings) {
  const auto apply = [&](RunConfig config, std::vector<std::string>* said) -> Result<RunConfig> {
    if (!sources.file.empty()) {
      if (auto ok = ApplyConfigFile(sources.file, config, said); !ok)
        return tl::unexpected(ok.error());
    }
    if (auto ok = ApplyVariant(sources.variant, config); !ok) return tl::unexpected(ok.error());
    if (auto ok = ApplyOverrides(sources.overrides, config, said); !ok)
      return tl::unexpected(ok.error());
    return config;
  };
  auto config = apply({}, warnings);
  if (!config || config->noise.profile == "none") return config;
  return apply(DefaultsOfProfile(config->noise.profile), nullptr);
}

std::string DumpToml(const RunConfig& config) {
  std::string text, section;
  for (const ConfigField& field : ReadOnlyFields(config)) {
    if (SectionOf(field.key) != section) {
      section = SectionOf(field.key);
      text += (text.empty() ? "[" : "\n[") + section + "]\n";
    }
    text += std::string(LastPart(field.key)) + " = " + FormatValue(field) + "\n";
  }
  return text;
}

std::string DumpJson(const RunConfig& config) {
  std::string text = "{";
  std::vector<std::string> open;  // sections that are open
  bool is_first = true;
  for (const ConfigField& field : ReadOnlyFields(config)) {
    std::vector<std::string> parts = Split(field.key);
    const std::string name = parts.back();
    parts.pop_back();
    std::size_t common = 0;
    while (common < open.size() && common < parts.size() && open[common] == parts[common]) ++common;
    for (; open.size() > common; open.pop_back()) text += "}";
    if (!is_first) text += ",";
    for (; open.size() < parts.size(); open.push_back(parts[open.size()])) {
      text += "\"" + parts[open.size()] + "\":{";
    }
    text += "\"" + name + "\":" + FormatValue(field);
    is_first = false;
  }
  return text + std::string(open.size() + 1, '}');
}

std::string ConfigHash(const RunConfig& config) {
  std::string text;
  for (const ConfigField& field : ReadOnlyFields(config)) {
    text += field.key + "=" + FormatValue(field) + "\n";
  }
  return HexHash(HashString(text));
}

}  // namespace crossnav::evaluation
