// SPDX-License-Identifier: MIT
// Parts of perception that an opened network provides. Each adapter (one file each, listed in
// families.cpp) makes the parts of its kind of network; the others stay empty.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "crossnav/inference/boxes.h"
#include "crossnav/inference/model_card.h"
#include "crossnav/inference/network.h"
#include "crossnav/perception/perception.h"

namespace crossnav::inference {

/// An opened network, shared by all its parts. Not thread-safe.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::unique_ptr<perception::Detector> MakeDetector() { return nullptr; }
  virtual std::unique_ptr<perception::Segmenter> MakeSegmenter() { return nullptr; }
  virtual std::unique_ptr<perception::StairSegmenter> MakeStairs() { return nullptr; }
  virtual std::unique_ptr<perception::DenseEncoder> MakeEncoder() { return nullptr; }
  /// Of a second detector (second_opinion.h): the boxes of all its classes [px of the frame], after
  /// suppression, with scores from `least` on. kUnsupported from other families.
  virtual Result<std::vector<FoundBox>> DetectAll(const Observation& obs, double least);
};

/// Name of a dense encoder in saved memories: the network's name and the beginning of its hash.
std::string EncoderNameOf(const ModelCard& card);

/// The parts of a model `M` that has the method of the same name, and shares it.
template <typename M>
class DetectorOf : public perception::Detector {
 public:
  explicit DetectorOf(std::shared_ptr<M> model) : model_(std::move(model)) {}
  Result<std::vector<perception::Detection>> Detect(const Observation& obs,
                                                    std::string_view goal) override {
    return model_->Detect(obs, goal);
  }

 private:
  std::shared_ptr<M> model_;
};

template <typename M>
class SegmenterOf : public perception::Segmenter {
 public:
  explicit SegmenterOf(std::shared_ptr<M> model) : model_(std::move(model)) {}
  Result<void> Segment(const Observation& obs, perception::Detection& detection) override {
    return model_->Segment(obs, detection);
  }

 private:
  std::shared_ptr<M> model_;
};

template <typename M>
class StairsOf : public perception::StairSegmenter {
 public:
  explicit StairsOf(std::shared_ptr<M> model) : model_(std::move(model)) {}
  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    return model_->SegmentStairs(obs);
  }

 private:
  std::shared_ptr<M> model_;
};

template <typename M>
class EncoderOf : public perception::DenseEncoder {
 public:
  explicit EncoderOf(std::shared_ptr<M> model) : model_(std::move(model)) {}
  int Dim() const override { return model_->Dim(); }
  std::string Name() const override { return EncoderNameOf(model_->card()); }
  Result<perception::FeatureGrid> EncodeImage(const Observation& obs) override {
    return model_->EncodeImage(obs);
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    return model_->EncodeText(text);
  }

 private:
  std::shared_ptr<M> model_;
};

struct ModelOptions {
  SessionOptions session;
  double camera_height_m = 0.88;  ///< above the robot's foot
};

using OpenModel = Result<std::shared_ptr<Model>> (*)(const ModelCard& card,
                                                     const ModelOptions& options);

struct Family {
  const char* name;   ///< as in cards
  const char* what;   ///< description for users
  const char* parts;  ///< provided parts: some of "detector second_detector segmenter
                      ///< stairs encoder"
  OpenModel open;
};

/// All adapters.
std::span<const Family> Families();

/// The adapter of a card; else an error that lists all adapters.
Result<const Family*> FamilyOf(const ModelCard& card);

/// Opens the card's file with its adapter.
Result<std::shared_ptr<Model>> Open(const ModelCard& card, const ModelOptions& options);

/// Reads and checks the card's file and opens it with `signature`: common start of all adapters.
Result<Network> OpenNetwork(const ModelCard& card, const Signature& signature,
                            const ModelOptions& options);

/// Likewise for the card's second file.
Result<Network> OpenDecoder(ModelCard card, const Signature& signature,
                            const ModelOptions& options);

Result<std::shared_ptr<Model>> OpenCrossnavNetwork(const ModelCard& card,
                                                   const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenDetrDetector(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYolo8(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYolo8Segment(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYoloWorld(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYolo7(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYolo7EndToEnd(const ModelCard& card,
                                                 const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenYoloX(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenSegFormer(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenMobileSam(const ModelCard& card, const ModelOptions& options);
Result<std::shared_ptr<Model>> OpenDense(const ModelCard& card, const ModelOptions& options);

}  // namespace crossnav::inference
