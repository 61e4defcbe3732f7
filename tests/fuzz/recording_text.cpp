// SPDX-License-Identifier: MIT
#include "crossnav/recordings/folder.h"
#include "fuzz/harness.h"

// The list files of the folders; the images that they name are not there.
FUZZ(recording_text, input) {
  using namespace crossnav::recordings;
  const RecordingOptions options;
  const auto visit = [](const auto&, const auto&) -> crossnav::Result<void> { return {}; };
  for (const char* name : {"tum/rgb.txt", "tum/depth.txt"})
    crossnav::fuzz::FileWith(name, input.subspan(0, input.size() / 2));
  const auto tum = crossnav::fuzz::FileWith("tum/groundtruth.txt", input.subspan(input.size() / 2));
  if (auto folder = OpenTum(tum.parent_path(), options)) (void)ReadFolder(*folder, options, visit);
  const auto numbered = crossnav::fuzz::FileWith("numbered/pose.txt", input);
  if (auto folder = OpenNumbered(numbered.parent_path(), options))
    (void)ReadFolder(*folder, options, visit);
  const auto scenes = crossnav::fuzz::FileWith("scenes/frame-000000.pose.txt", input);
  (void)OpenSevenScenes(scenes.parent_path(), options);
}
