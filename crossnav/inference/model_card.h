// SPDX-License-Identifier: MIT
// Description of a network file, in a TOML file beside it (docs/networks.md): the adapter, the
// inputs, the meaning of the outputs, and the hash of the bytes.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/core/result.h"

namespace crossnav::inference {

struct ModelCard {
  std::filesystem::path path;  ///< of the card; its stem is the network's name
  std::filesystem::path file;  ///< the ONNX file
  std::string family;          ///< name of an adapter, see Families()
  std::string sha256;          ///< of the file, 64 hexadecimal digits
  std::string licence, source;

  struct Input {
    int width = 0, height = 0;                 ///< [px]
    std::string resize = "plain";              ///< plain | letterbox | corner
    bool antialias = true;                     ///< average over the pixels that merge
    std::string colour = "rgb";                ///< rgb | bgr
    double scale = 1.0 / 255;                  ///< of a byte, before mean and deviation
    std::array<double, 3> mean{0, 0, 0};       ///< subtracted, by channel of `colour`
    std::array<double, 3> deviation{1, 1, 1};  ///< then divided by
    std::string layout = "chw";                ///< chw | hwc
    std::optional<double> focal_px;            ///< to which depth is scaled; none = metres
  } input;

  struct Output {
    int classes = 0;                 ///< known to the network; 0 = as many as labels
    int rows = 0, cols = 0;          ///< of dense features
    int dim = 0;                     ///< of dense features, or number of mask prototypes
    std::string layout = "hwc";      ///< of dense features: hwc | chw
    int top = 0;                     ///< number of boxes of a detector; 0 = any
    std::vector<int> stair_classes;  ///< from 0
  } output;

  std::vector<std::string> labels;  ///< of the classes, in order
  /// Names of the file's inputs and outputs that differ from those of the family `crossnav`.
  std::map<std::string, std::string> ports;

  std::string PortName(const std::string& port) const {
    const auto own = ports.find(port);
    return own == ports.end() ? port : own->second;
  }

  struct Thresholds {
    double score = 0.3;  ///< minimum score of a detection
    /// Score of each label that maps to the policy's confidence 0.60, and to 0.70; empty = the
    /// score is used unchanged.
    std::vector<double> weak, accept;
    double nms_iou = 0.6;  ///< overlap above which two boxes of a class are one object
    double mask = 0.5;     ///< minimum probability of a mask's pixel
    double stairs = 0.25;  ///< probability that maps to the policy's 0.25
  } thresholds;

  struct Text {
    std::filesystem::path table;               ///< .npy, a row for each name; empty = none
    std::vector<std::string> names;            ///< names, or
    std::filesystem::path names_file;          ///< a file of names, one a line
    std::filesystem::path encoder;             ///< ONNX file for texts that the table lacks
    std::string sha256;                        ///< of that file
    std::string tokenizer;                     ///< clip | wordpiece
    std::filesystem::path vocabulary;          ///< of the tokenizer
    int length = 77;                           ///< length of the encoder's input
    std::string padding = "end";               ///< end (the tokenizer's own) | zero
    std::vector<std::string> templates{"{}"};  ///< "{}" stands for the text
  } text;

  /// Of an encoder, as `crossnav networks calibrate` measured it; nullopt = never measured.
  struct Retrieval {
    std::optional<double> min_similarity, min_z_score, min_peak_share;  ///< as in QueryConfig
    std::optional<double> absent_below, present_from;  ///< matches (memory/query_match.h)
    std::optional<double> margin;  ///< as VerifyConfig's refute_margin and strong_margin
  } retrieval;

  /// Of a detector, as benchmarks/detector_calibration measured it (EvidenceConfig); nullopt =
  /// never.
  struct Evidence {
    std::optional<double> offset, slope, missed, found, too_short;
    bool IsMeasured() const { return offset && slope && missed && found && too_short; }
  } evidence;

  /// Of a second detector (second_opinion.h), as benchmarks/detector_pair measured it beside our
  /// network: log-odds.
  struct Opinion {
    std::optional<double> weight;   ///< of its log-odds for the goal less those of its best rival
    double neutral = 0;             ///< added, so that the mean confidence stays
    double unseen = 0;              ///< of a box that the first detector does not have
    std::vector<double> unseen_of;  ///< likewise, by label
  } opinion;

  /// The second file of a network that has two.
  struct Second {
    std::filesystem::path file;
    std::string sha256;
  } decoder;

  std::string name() const { return path.stem().string(); }
};

/// Errors name the card and the key: unknown, missing, of the wrong type or out of range.
Result<ModelCard> ReadModelCard(const std::filesystem::path& path);

/// The text of a card with `section`, lines of TOML that begin with "[retrieval]", in place of its
/// own section of that name, or behind everything else. All other bytes stay.
std::string WithRetrieval(std::string_view card, std::string_view section);

/// Content of the card's file; an error if it does not match the card's SHA-256.
Result<std::string> ReadNetworkFile(const ModelCard& card);

/// Policy confidence of a detector's score for a label: piecewise linear through (0, 0), (weak,
/// 0.60), (accept, 0.70) and (1, 1), or the score itself.
double ConfidenceOf(const ModelCard::Thresholds& thresholds, int label, double score);

/// Maps probabilities of stairs: piecewise linear through (0, 0), (thresholds.stairs, 0.25), (1,
/// 1).
void ScaleStairs(const ModelCard::Thresholds& thresholds, std::vector<float>& probability);

}  // namespace crossnav::inference
