// SPDX-License-Identifier: MIT
#include "crossnav/sim/sensing/ground_truth_pictures.h"

#include <algorithm>
#include <utility>

#include "crossnav/perception/goal_picture.h"
#include "crossnav/sim/sensing/ground_truth_encoder.h"

namespace crossnav::sim {
namespace {

class GroundTruthPictureReader : public perception::PictureReader {
 public:
  GroundTruthPictureReader(const Simulator& simulator, std::unique_ptr<InstanceEncoder> encoder,
                           KnownPictures known)
      : simulator_(simulator), encoder_(std::move(encoder)), known_(std::move(known)) {}

  Result<perception::PictureReading> Read(const perception::GoalPicture& picture) override {
    const auto found = known_.find(perception::NameOfPicture(picture));
    if (found == known_.end())
      return Fail(ErrorCode::kUnsupported,
                  "ground truth reads no picture but those that the simulator took for it",
                  "goal's picture");
    const PictureView& view = found->second;
    const SceneInstance* instance = simulator_.scene().FindInstance(view.instance);
    const CameraIntrinsics camera =
        IntrinsicsFromHfov(picture.rgb.width, picture.rgb.height, DegToRad(view.hfov_deg));
    const Frame frame =
        simulator_.caster().Render(camera, view.T_world_camera, Channels::kWithoutColour);
    perception::PictureReading reading;
    reading.mask = MaskImage(picture.rgb.width, picture.rgb.height);
    for (std::size_t i = 0; i < reading.mask.data.size(); ++i)
      reading.mask.data[i] = frame.instance.data[i] == view.instance ? 1 : 0;
    const auto& mask = reading.mask.data;
    if (instance == nullptr || std::count(mask.begin(), mask.end(), 1) == 0)
      return Fail(ErrorCode::kMismatch, "the picture's object is not in this scene",
                  "goal's picture");
    reading.category = instance->category.empty() ? instance->name : instance->category;
    reading.features = encoder_->EncodeInstances(frame.instance, view.T_world_camera);
    return reading;
  }

 private:
  const Simulator& simulator_;
  std::unique_ptr<InstanceEncoder> encoder_;
  KnownPictures known_;
};

}  // namespace

Result<std::unique_ptr<perception::PictureReader>> MakeGroundTruthPictureReader(
    const Simulator& simulator, const GroundTruthConfig& config, KnownPictures known) {
  std::unique_ptr<InstanceEncoder> encoder;  // not needed to refuse every picture
  if (!known.empty()) {
    auto made = MakeGroundTruthEncoder(simulator, config);
    if (!made) return tl::unexpected(made.error());
    encoder = std::move(*made);
  }
  return std::make_unique<GroundTruthPictureReader>(simulator, std::move(encoder),
                                                    std::move(known));
}

}  // namespace crossnav::sim
