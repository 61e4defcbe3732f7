// SPDX-License-Identifier: MIT
#include "crossnav/inference/model_card.h"

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "crossnav/core/read_file.h"
#include "crossnav/core/text_shape.h"
#include "crossnav/inference/sha256.h"

namespace crossnav::inference {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{2} << 30;  // of a network, protobuf's limit
constexpr int kMostSide = 4096;                                 // chosen: of an input [px]
constexpr int kMostClasses = 100000;                            // chosen: LVIS has 1203
constexpr int kStride = 4;  // of the maps of the family `crossnav`

/// A table of the card: typed access that keeps the first problem and the known keys.
class Section {
 public:
  Section(const toml::table* table, std::string name, std::string where)
      : table_(table), name_(std::move(name)), where_(std::move(where)) {}

  void Text(const char* key, std::string& target,
            std::initializer_list<std::string_view> choices = {}) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const auto value = node->value_exact<std::string>();
    if (!value) return Complain(key, "must be a text");
    if (choices.size() != 0 && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
      std::string all;
      for (const auto choice : choices) all += (all.empty() ? "" : ", ") + std::string(choice);
      return Complain(key, "must be one of " + all + ", not \"" + *value + "\"");
    }
    target = *value;
  }
  void Flag(const char* key, bool& target) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const auto value = node->value_exact<bool>();
    if (!value) return Complain(key, "must be true or false");
    target = *value;
  }
  void Number(const char* key, double& target, double lo, double hi) {
    const toml::node* node = Find(key);
    if (node != nullptr) Take(*node, key, target, lo, hi);
  }
  void Number(const char* key, std::optional<double>& target, double lo, double hi) {
    if (double value = 0; Find(key) != nullptr) {
      Number(key, value, lo, hi);
      target = value;
    }
  }
  /// A number for each of `count`, or one for all of them.
  void Numbers(const char* key, std::vector<double>& target, double lo, double hi,
               std::size_t count) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list != nullptr && list->size() != count)
      return Complain(key, "must have as many numbers as there are labels");
    target.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      Take(list == nullptr ? *node : *list->get(i), key, target[i], lo, hi);
  }
  void Whole(const char* key, int& target, int lo, int hi) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < lo || *value > hi)
      return Complain(
          key, "must be a whole number from " + std::to_string(lo) + " to " + std::to_string(hi));
    target = static_cast<int>(*value);
  }
  void Wholes(const char* key, std::vector<int>& target, int lo, int hi) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) return Complain(key, "must be a list of whole numbers");
    for (const toml::node& entry : *list) {
      const auto value = entry.value_exact<std::int64_t>();
      if (!value || *value < lo || *value > hi)
        return Complain(key, "must be a list of whole numbers from " + std::to_string(lo) + " to " +
                                 std::to_string(hi));
      target.push_back(static_cast<int>(*value));
    }
  }
  /// One side [px] or [width, height].
  void Size(const char* key, int& width, int& height) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list != nullptr && list->size() != 2)
      return Complain(key, "must be one side or [width, height]");
    int* const sides[] = {&width, &height};
    for (std::size_t i = 0; i < 2; ++i) {
      const toml::node& side = list == nullptr ? *node : *list->get(i);
      const auto value = side.value_exact<std::int64_t>();
      if (!value || *value < 1 || *value > kMostSide)
        return Complain(key, "must be from 1 to " + std::to_string(kMostSide) + " px");
      *sides[i] = static_cast<int>(*value);
    }
  }
  void Ports(std::initializer_list<const char*> keys, std::map<std::string, std::string>& target) {
    for (const char* key : keys) {
      std::string name = key;
      Text(key, name);
      target[key] = name;
    }
  }
  void Three(const char* key, std::array<double, 3>& target, double lo, double hi) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr || list->size() != 3) return Complain(key, "must be three numbers");
    for (std::size_t i = 0; i < 3; ++i) Take(*list->get(i), key, target[i], lo, hi);
  }
  void Texts(const char* key, std::vector<std::string>& target) {
    const toml::node* node = Find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) return Complain(key, "must be a list of texts");
    for (const toml::node& entry : *list) {
      const auto value = entry.value_exact<std::string>();
      if (!value) return Complain(key, "must be a list of texts");
      target.push_back(*value);
    }
  }
  /// The table of this name; empty if absent.
  Section Inner(const char* key) {
    const toml::node* node = Find(key);
    if (node != nullptr && !node->is_table()) Complain(key, "must be a table");
    return {node == nullptr ? nullptr : node->as_table(), key, where_};
  }
  void Skip(const char* key) { known_.insert(key); }

  /// The first problem, or an unknown key.
  Result<void> Finish() {
    if (error_.empty() && table_ != nullptr)
      for (const auto& [key, value] : *table_)
        if (known_.count(std::string(key.str())) == 0) Complain(key.str(), "is no key of a card");
    if (error_.empty()) return {};
    return Fail(ErrorCode::kInvalid, error_, where_);
  }
  void Complain(std::string_view key, const std::string& what) {
    if (!error_.empty()) return;
    error_ = "key \"" + (name_.empty() ? "" : name_ + ".") + std::string(key) + "\" " + what;
  }

 private:
  const toml::node* Find(const char* key) {
    known_.insert(key);
    return table_ == nullptr ? nullptr : table_->get(key);
  }
  void Take(const toml::node& node, const char* key, double& target, double lo, double hi) {
    const auto value = node.value<double>();
    if (!node.is_number() || !value || !(*value >= lo && *value <= hi))
      return Complain(key,
                      "must be a number from " + std::to_string(lo) + " to " + std::to_string(hi));
    target = *value;
  }

  const toml::table* table_;
  std::string name_, where_, error_;
  std::set<std::string> known_;
};

bool IsHash(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

using Ports = std::map<std::string, std::string>;

Result<void> ReadInput(Section section, ModelCard::Input& input, Ports& ports) {
  section.Size("size", input.width, input.height);
  section.Text("resize", input.resize, {"plain", "letterbox", "corner"});
  section.Flag("antialias", input.antialias);
  section.Number("focal_px", input.focal_px, 1, 10 * kMostSide);
  section.Text("colour", input.colour, {"rgb", "bgr"});
  section.Number("scale", input.scale, 0, 1e6);
  section.Three("mean", input.mean, -1e6, 1e6);
  section.Three("deviation", input.deviation, 1e-6, 1e6);
  section.Text("layout", input.layout, {"chw", "hwc"});
  section.Ports({"image", "depth", "height"}, ports);
  if (input.width == 0) section.Complain("size", "is missing");
  return section.Finish();
}

Result<void> ReadOutput(Section section, ModelCard::Output& output, Ports& ports) {
  section.Whole("classes", output.classes, 1, kMostClasses);
  section.Whole("rows", output.rows, 1, kMostSide);
  section.Whole("cols", output.cols, 1, kMostSide);
  section.Whole("dim", output.dim, 1, kMostSide);
  section.Text("layout", output.layout, {"hwc", "chw"});
  section.Whole("top", output.top, 1, kMostClasses);
  section.Wholes("stair_classes", output.stair_classes, 0, kMostClasses);
  section.Ports({"heat", "box", "mask", "stairs", "dense"}, ports);
  int stride = kStride;
  section.Whole("stride", stride, kStride, kStride);
  return section.Finish();
}

// chosen: weak and minimum scores, as shares of a chosen score.
constexpr double kWeakShare = 0.75, kScoreShare = 0.5;

Result<void> ReadThresholds(Section section, std::size_t labels, ModelCard::Thresholds& t) {
  section.Numbers("heat", t.accept, 0, 1, labels);
  if (!t.accept.empty()) {  // of our networks: the chosen scores, and thresholds derived from them
    for (const double score : t.accept) t.weak.push_back(kWeakShare * score);
    t.score = kScoreShare * *std::min_element(t.accept.begin(), t.accept.end());
  }
  section.Number("score", t.score, 0, 1);
  section.Numbers("weak", t.weak, 0, 1, labels);
  section.Numbers("accept", t.accept, 0, 1, labels);
  section.Number("nms_iou", t.nms_iou, 0, 1);
  section.Number("mask", t.mask, 0, 1);
  section.Number("stairs", t.stairs, 0, 1);
  if (t.weak.empty() != t.accept.empty()) section.Complain("weak", "and accept come together");
  if (!(t.stairs > 0 && t.stairs < 1)) section.Complain("stairs", "must lie between 0 and 1");
  for (std::size_t i = 0; i < std::min(t.weak.size(), t.accept.size()); ++i)
    if (!(t.weak[i] > 0 && t.weak[i] < t.accept[i] && t.accept[i] < 1))
      section.Complain("accept", "must be greater than weak, and both between 0 and 1");
  return section.Finish();
}

Result<void> ReadText(Section section, const std::filesystem::path& folder, ModelCard::Text& text) {
  std::string table, names_file;
  section.Text("table", table);
  section.Text("names_file", names_file);
  section.Texts("names", text.names);
  std::string encoder, vocabulary;
  std::vector<std::string> templates;
  section.Text("encoder", encoder);
  section.Text("sha256", text.sha256);
  section.Text("tokenizer", text.tokenizer, {"clip", "wordpiece"});
  section.Text("vocabulary", vocabulary);
  section.Whole("length", text.length, 2, kMostSide);
  section.Text("padding", text.padding, {"end", "zero"});
  section.Texts("templates", templates);
  if (!templates.empty()) text.templates = std::move(templates);
  if (!encoder.empty()) text.encoder = folder / encoder;
  if (!vocabulary.empty()) text.vocabulary = folder / vocabulary;
  if (!text.sha256.empty() && !IsHash(text.sha256))
    section.Complain("sha256", "must be 64 hexadecimal digits in lower case");
  if (!table.empty()) text.table = folder / table;
  if (!names_file.empty()) text.names_file = folder / names_file;
  if (!table.empty() && text.names.empty() == names_file.empty())
    section.Complain("names", "or names_file must name the rows of the table");
  return section.Finish();
}

Result<void> ReadRetrieval(Section section, ModelCard::Retrieval& retrieval) {
  section.Number("min_similarity", retrieval.min_similarity, -1, 1);
  section.Number("min_z_score", retrieval.min_z_score, 0, 100);
  section.Number("min_peak_share", retrieval.min_peak_share, 0, 1);
  section.Number("absent_below", retrieval.absent_below, 0, 1);
  section.Number("present_from", retrieval.present_from, 0, 1);
  if (retrieval.absent_below && retrieval.absent_below > retrieval.present_from)
    section.Complain("absent_below", "must come with a present_from that is not smaller");
  section.Number("margin", retrieval.margin, 0, 2);
  return section.Finish();
}

Result<void> ReadEvidence(Section section, ModelCard::Evidence& evidence) {
  section.Number("offset", evidence.offset, -20, 20);
  section.Number("slope", evidence.slope, 0, 20);
  section.Number("missed", evidence.missed, -20, 0);
  section.Number("found", evidence.found, 0, 20);
  section.Number("too_short", evidence.too_short, -20, 0);
  return section.Finish();
}

Result<void> ReadOpinion(Section section, const std::vector<std::string>& labels,
                         ModelCard::Opinion& opinion) {
  section.Number("weight", opinion.weight, 0, 20);
  section.Number("neutral", opinion.neutral, -20, 20);
  section.Number("unseen", opinion.unseen, -20, 20);
  Section of = section.Inner("unseen_of");
  opinion.unseen_of.assign(labels.size(), opinion.unseen);
  for (std::size_t i = 0; i < labels.size(); ++i)
    of.Number(labels[i].c_str(), opinion.unseen_of[i], -20, 20);
  if (auto ok = of.Finish(); !ok) return ok;
  return section.Finish();
}

Result<ModelCard> ReadCard(const toml::table& table, const std::filesystem::path& path) {
  ModelCard card;
  card.path = path;
  Section top(&table, "", path.string());
  std::string file;
  top.Text("file", file);
  top.Text("family", card.family);
  top.Text("sha256", card.sha256);
  top.Text("licence", card.licence);
  top.Text("source", card.source);
  top.Texts("labels", card.labels);
  top.Texts("goals", card.labels);  // as labels, in cards of our networks
  for (const char* for_people : {"name", "limits", "data", "figures"}) top.Skip(for_people);
  std::string decoder;
  top.Text("decoder", decoder);
  top.Text("decoder_sha256", card.decoder.sha256);
  if (!card.decoder.sha256.empty() && !IsHash(card.decoder.sha256))
    top.Complain("decoder_sha256", "must be 64 hexadecimal digits in lower case");
  if (!decoder.empty()) card.decoder.file = path.parent_path() / decoder;
  if (card.family.empty()) top.Complain("family", "is missing");
  if (!card.sha256.empty() && !IsHash(card.sha256))
    top.Complain("sha256", "must be 64 hexadecimal digits in lower case");
  const auto folder = path.parent_path();
  card.file = folder / (file.empty() ? card.name() + ".onnx" : file);
  const Result<void> parts[] = {
      ReadInput(top.Inner("input"), card.input, card.ports),
      ReadOutput(top.Inner("output"), card.output, card.ports),
      ReadThresholds(top.Inner("thresholds"), card.labels.size(), card.thresholds),
      ReadText(top.Inner("text"), folder, card.text),
      ReadRetrieval(top.Inner("retrieval"), card.retrieval),
      ReadEvidence(top.Inner("evidence"), card.evidence),
      ReadOpinion(top.Inner("opinion"), card.labels, card.opinion)};
  if (auto ok = top.Finish(); !ok) return tl::unexpected(ok.error());
  for (const auto& part : parts)
    if (!part) return tl::unexpected(part.error());
  if (card.output.classes == 0) card.output.classes = static_cast<int>(card.labels.size());
  if (card.output.classes < static_cast<int>(card.labels.size()))
    return Fail(ErrorCode::kInvalid, "key \"labels\" has more entries than output.classes",
                path.string());
  return card;
}

}  // namespace

Result<ModelCard> ReadModelCard(const std::filesystem::path& path) {
  const auto text = ReadFile(path, kMostToml);
  if (!text) return tl::unexpected(text.error());
  if (auto ok = CheckTomlShape(*text, path.string()); !ok) return tl::unexpected(ok.error());
  try {
    return ReadCard(toml::parse(*text), path);
  } catch (const toml::parse_error& error) {
    return Fail(ErrorCode::kMalformed, std::string(error.description()),
                path.string() + ": line " + std::to_string(error.source().begin.line));
  }
}

std::string WithRetrieval(std::string_view card, std::string_view section) {
  constexpr std::string_view kHead = "[retrieval]";
  std::string before, after;
  bool is_own = false, is_behind = false;
  for (std::size_t at = 0; at < card.size();) {
    const std::size_t end = std::min(card.find('\n', at), card.size() - 1) + 1;
    const std::string_view line = card.substr(at, end - at);
    if (line.starts_with('[')) {
      is_behind = is_behind || is_own;
      is_own = line.starts_with(kHead);
    }
    if (!is_own) (is_behind ? after : before) += line;
    at = end;
  }
  while (before.ends_with("\n\n")) before.pop_back();
  if (!before.empty() && !before.ends_with('\n')) before += '\n';
  return before + "\n" + std::string(section) + (after.empty() ? "" : "\n") + after;
}

Result<std::string> ReadNetworkFile(const ModelCard& card) {
  auto bytes = ReadFile(card.file, kMostBytes);
  if (!bytes) {
    if (bytes.error().code == ErrorCode::kNotFound)
      bytes.error().what = "is not there, nor in the folder that CROSSNAV_NETWORKS names; " +
                           card.path.string() + " says where it comes from";
    return bytes;
  }
  if (card.sha256.empty() || Sha256(*bytes) == card.sha256) return bytes;
  return Fail(
      ErrorCode::kMismatch,
      "is not the file that " + card.path.string() + " describes: its SHA-256 is " + Sha256(*bytes),
      card.file.string());
}

double ConfidenceOf(const ModelCard::Thresholds& t, int label, double score) {
  constexpr double kWeak = 0.60, kAccept = 0.70;  // the policy's secondary and first confidence
  const auto i = static_cast<std::size_t>(label);
  if (i >= t.accept.size()) return score;
  const double weak = t.weak[i], accept = t.accept[i];
  if (score < weak) return kWeak * score / weak;
  if (score < accept) return kWeak + (kAccept - kWeak) * (score - weak) / (accept - weak);
  return kAccept + (1 - kAccept) * (score - accept) / (1 - accept);
}

void ScaleStairs(const ModelCard::Thresholds& t, std::vector<float>& probability) {
  constexpr float kPolicy = 0.25F;
  const auto own = static_cast<float>(t.stairs);
  if (own == kPolicy) return;
  for (float& p : probability)
    p = p < own ? kPolicy * p / own : kPolicy + (1 - kPolicy) * (p - own) / (1 - own);
}

}  // namespace crossnav::inference
