// SPDX-License-Identifier: MIT
// Records of all objects over frames and days. Sightings of one category at one place share a
// record; contradictions lower its confidence. A sighting multiplies the odds of presence, a good
// view of the place without the object divides them. World frame, metres.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/objects/appearance.h"
#include "crossnav/objects/frame_view.h"
#include "crossnav/objects/object_record.h"
#include "crossnav/objects/portrait.h"

namespace crossnav::objects {

/// Limits of records; some are settings of `memory.*`.
struct BookConfig {
  double range_m = 5.0;    // chosen: as policy.explore.inspect_range_m
  double good_view = 0.5;  // chosen: least share of the place in view for a contradiction
  double gone = 0.3;       // chosen: an object below this belief counts as gone
  int least_views = 2;     // chosen: least frames of a saved record, as policy.object.stable_frames
  double same_place_m = 0.25;  // chosen: between the centres; chairs at a table stand farther apart
};

/// Sighting of an object in one frame.
struct SeenObject {
  std::string category;
  std::vector<geometry::VoxelKey> voxels;  ///< sorted, not empty
  double confidence = 0;                   ///< of the detector [0, 1]
  const MaskImage* mask = nullptr;         ///< null = no pixels to look at
  PictureBox box;
};

/// When a frame was taken.
struct Moment {
  int day = 0;
  std::int64_t step = 0;
};

class ObjectBook {
 public:
  explicit ObjectBook(double voxel_m = 0.1, const BookConfig& config = {})
      : voxel_m_(voxel_m), config_(config) {}

  /// Notes the sightings of one frame; two sightings are two objects. Returns the index of each in
  /// records().
  std::vector<int> Note(std::span<const SeenObject> seen, const Observation& obs,
                        const Moment& when);

  /// Doubts objects whose place this frame shows well and from near, without the object. `asked`
  /// are the categories that the detector looked for: for others only free space at the place
  /// counts. Skips records of this frame's Note. Returns indices of records that fell below `gone`.
  std::vector<int> Doubt(std::span<const std::string> asked, const Observation& obs,
                         const Moment& when);

  /// A claim about the object was refuted: `voxels` show something else.
  void Refute(const std::string& category, std::span<const geometry::VoxelKey> voxels);

  /// Notes a fruitless look from near: `voxels` are no place of the category. Without a record
  /// there, a new record with 0 views stands for the disproved place.
  void Disprove(const std::string& category, std::vector<geometry::VoxelKey> voxels,
                const Moment& when);

  /// Colours of the object of records()[index], from all its sightings, or from its saved picture
  /// until there is one.
  const ColourHistogram& ColoursOf(int index) const { return watches_[index].colours; }
  /// Unordered; includes records of a single frame.
  const std::vector<ObjectRecord>& records() const { return records_; }
  /// Records to save, by id: objects confirmed by enough frames, and disproved places.
  std::vector<ObjectRecord> Confirmed() const;
  bool IsGone(const ObjectRecord& record) const { return record.confidence < config_.gone; }

  /// Continues with saved records. The reader must have checked their ids.
  void Load(std::vector<ObjectRecord> records);
  /// Sets floor and room of every record by `place(record, &floor, &room)`.
  template <class Place>
  void Locate(const Place& place) {
    for (ObjectRecord& record : records_) place(record, &record.floor, &record.room);
  }
  double voxel_m() const { return voxel_m_; }

 private:
  /// Fields of a record that are not saved.
  struct Watch {
    std::int64_t noted_step = -1;                        ///< of the last Note in this run
    double picture_px = 0;                               ///< pixels behind the picture
    Vector3d p_doubted_world = Vector3d::Constant(1e9);  ///< camera of the last contradiction
    Vector3d doubted_along = Vector3d::Zero();           ///< and its direction
    int frames = 0;                                      ///< of this run that found it
    Vector3d to_camera_missed_m = Vector3d::Zero();      ///< from the object, at the last miss
    double least_shown_px = 0;  ///< of the views of this run that found the object; 0 = none
    std::int64_t colour_views = 0;
    ColourHistogram colours;
    bool has_old_colours = false;  ///< of the saved picture alone
  };

  int FindFor(const SeenObject& seen, const Vector3d& centre, std::int64_t step) const;
  void Merge(ObjectRecord& record, Watch& watch, const SeenObject& seen, const Observation& obs);
  bool IsMiss(const FrameView& view, const Watch& watch, const Vector3d& to_camera_m,
              double image_px) const;
  int MergeTwins(int index);  // id of the merged record, or -1

  double voxel_m_;
  BookConfig config_;
  std::vector<ObjectRecord> records_;
  std::vector<Watch> watches_;  // of each record
  int next_id_ = 0;
};

/// Centre and box of a record from its voxels.
void Measure(ObjectRecord& record, double voxel_m);

}  // namespace crossnav::objects
