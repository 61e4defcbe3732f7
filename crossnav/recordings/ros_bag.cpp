// SPDX-License-Identifier: MIT
#include "crossnav/recordings/ros_bag.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/read_file.h"
#include "crossnav/recordings/bag_contents.h"
#include "crossnav/recordings/image_pairs.h"
#include "crossnav/recordings/ros_images.h"
#include "crossnav/recordings/text_rows.h"

namespace crossnav::recordings {
namespace {

namespace fs = std::filesystem;

/// A value of YAML without its quotes.
std::string Unquoted(std::string_view word) {
  const bool is_quoted = word.size() > 1 && (word.front() == '"' || word.front() == '\'') &&
                         word.back() == word.front();
  return std::string(is_quoted ? word.substr(1, word.size() - 2) : word);
}

/// Storage and files from metadata.yaml; ROS writes it in a single form, one value a line.
struct BagMetadata {
  std::string storage, compression;
  std::vector<std::string> files;
};

BagMetadata MetadataOf(std::string_view yaml) {
  BagMetadata metadata;
  bool is_in_files = false;
  for (const TextRow& row : RowsOf(yaml)) {
    if (row.words[0] == "-" && is_in_files && row.words.size() == 2) {
      metadata.files.push_back(Unquoted(row.words[1]));
      continue;
    }
    is_in_files = row.words[0] == "relative_file_paths:";
    if (row.words.size() != 2) continue;
    if (row.words[0] == "storage_identifier:") metadata.storage = Unquoted(row.words[1]);
    if (row.words[0] == "compression_mode:") metadata.compression = Unquoted(row.words[1]);
  }
  return metadata;
}

/// Files of the folder, for bags without metadata.yaml.
std::vector<fs::path> McapFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".mcap") files.push_back(at->path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Second pass through the files: pixels.
class BagReader {
 public:
  BagReader(const BagPlan& plan, const RecordingOptions& options, const FrameVisitor& visit)
      : plan_(plan),
        options_(options),
        visit_(visit),
        rig_(plan.rig),
        pairs_(std::llround(options.match_s * 1e9)) {}

  Result<Recording> Run(const std::vector<fs::path>& files, const BagContents& bag) {
    const auto T_world_bag = WorldOf(options_.up.empty() ? "z" : options_.up);
    if (!T_world_bag) return tl::unexpected(T_world_bag.error());
    T_world_bag_ = *T_world_bag;
    recording_ = {"ROS 2 bag", !plan_.colour_topic.empty(), {}};
    recording_.counts.is_torn = bag.is_torn;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto take = [&](const auto& so_far, const auto& channel, const auto& message) {
        const double share = static_cast<double>(so_far.good_bytes) /
                             static_cast<double>(std::max<std::uint64_t>(so_far.total_bytes, 1));
        share_done_ = (static_cast<double>(i) + share) / static_cast<double>(files.size());
        return Take(files[i].string(), channel, message);
      };
      const auto contents = trace::ReadMcap(files[i], take);
      if (!contents) return tl::unexpected(contents.error());
    }
    if (auto ok = MapPairs(true); !ok) return tl::unexpected(ok.error());
    if (auto ok = CheckFrames(recording_.counts, bag.name); !ok) return tl::unexpected(ok.error());
    return std::move(recording_);
  }

 private:
  Result<void> Take(const std::string& file, const trace::McapChannel& channel,
                    const trace::McapMessage& message) {
    const bool is_depth = channel.topic == plan_.depth_topic;
    if (!is_depth && channel.topic != plan_.colour_topic) return {};
    const auto header = ReadRosHeader(message.data);
    const std::string where =
        WhereOf(file, channel, static_cast<std::int64_t>(message.log_time_ns));
    if (is_depth) ++recording_.counts.depth_images;
    if (!header) {
      auto bad = Fail(ErrorCode::kMalformed, "the message is no image in CDR", where);
      if (!options_.skip_damaged) return bad;
      if (is_depth) ++recording_.counts.damaged;
      return {};
    }
    HeldImage image{header->time_ns, std::string(message.data), where};
    is_depth ? pairs_.AddDepth(std::move(image)) : pairs_.AddColour(std::move(image));
    return MapPairs(!recording_.has_colour);
  }

  Result<void> MapPairs(bool is_end) {
    while (const auto pair = pairs_.Take(is_end))
      if (auto ok = MapPair(*pair); !ok) return ok;
    return {};
  }

  Result<void> MapPair(const ImagePair& pair) {
    RecordingCounts& counts = recording_.counts;
    if (recording_.has_colour && !pair.colour) {
      ++counts.without_colour;
      return {};
    }
    const PoseAt pose = plan_.poses.At(pair.depth.time_ns, options_.poses);
    if (!IsUsable(pose, counts)) return {};
    auto images = ImagesOf(pair);
    if (!images) {
      if (!options_.skip_damaged) return tl::unexpected(images.error());
      ++counts.damaged;
      return {};
    }
    UseSizes(*images);
    auto obs =
        MakeObservation(rig_, std::move(*images), T_world_bag_ * pose.pose, pair.depth.where);
    if (!obs) return tl::unexpected(obs.error());
    obs->time_ns = pair.depth.time_ns;
    ++counts.frames;
    return visit_(recording_, {std::move(*obs), share_done_});
  }

  Result<RosImage> ParsedOf(const std::string& topic, const HeldImage& held) const {
    const bool is_compressed = plan_.poses.bag->images.at(topic).is_compressed;
    auto image = is_compressed ? ReadRosCompressedImage(held.message) : ReadRosImage(held.message);
    if (image) return std::move(*image);
    return Fail(ErrorCode::kMalformed, "the message is no image in CDR", held.where);
  }

  Result<Images> ImagesOf(const ImagePair& pair) const {
    const auto depth = ParsedOf(plan_.depth_topic, pair.depth);
    if (!depth) return tl::unexpected(depth.error());
    const double unit_m = options_.depth_unit_m > 0 ? options_.depth_unit_m : 0.001;  // REP 118
    auto depth_m = DepthOf(*depth, unit_m, pair.depth.where);
    if (!depth_m) return tl::unexpected(depth_m.error());
    Images images{{}, std::move(*depth_m)};
    if (!pair.colour) return images;
    const auto colour = ParsedOf(plan_.colour_topic, *pair.colour);
    if (!colour) return tl::unexpected(colour.error());
    auto rgb = ColourOf(*colour, pair.colour->where);
    if (!rgb) return tl::unexpected(rgb.error());
    images.rgb = std::move(*rgb);
    return images;
  }

  /// Intrinsics from the user get the size of the images.
  void UseSizes(const Images& images) {
    if (rig_.depth.K.width_px == 0) {
      rig_.depth.K.width_px = images.depth_m.width;
      rig_.depth.K.height_px = images.depth_m.height;
    }
    if (rig_.colour.K.width_px == 0) {
      rig_.colour.K.width_px = images.rgb.width;
      rig_.colour.K.height_px = images.rgb.height;
    }
  }

  const BagPlan& plan_;
  const RecordingOptions& options_;
  const FrameVisitor& visit_;
  Rig rig_;
  ImagePairs pairs_;
  Pose T_world_bag_ = Pose::Identity();
  Recording recording_;
  double share_done_ = 0;
};

}  // namespace

Result<std::vector<fs::path>> BagFilesOf(const fs::path& folder) {
  const fs::path yaml = folder / "metadata.yaml";
  std::error_code error;
  std::vector<fs::path> files;
  if (!fs::exists(yaml, error)) {
    files = McapFilesIn(folder);
  } else {
    const auto text = ReadFile(yaml, std::uintmax_t{64} << 20);
    if (!text) return tl::unexpected(text.error());
    const BagMetadata metadata = MetadataOf(*text);
    if (metadata.storage != "mcap")
      return Fail(ErrorCode::kUnsupported,
                  "storage_identifier is \"" + metadata.storage +
                      "\", and only mcap is read; ros2 bag convert makes one",
                  yaml.string());
    if (!metadata.compression.empty() && metadata.compression != "NONE" &&
        metadata.compression != "none")
      return Fail(ErrorCode::kUnsupported,
                  "compression_mode is \"" + metadata.compression +
                      "\", and only MCAP's own compression is read; ros2 bag convert makes one",
                  yaml.string());
    for (const std::string& name : metadata.files) files.push_back(folder / name);
  }
  if (files.empty()) return Fail(ErrorCode::kMalformed, "names no .mcap files", yaml.string());
  return files;
}

Result<Recording> ReadRosBag(const std::vector<fs::path>& files, const RecordingOptions& options,
                             const FrameVisitor& visit) {
  const auto bag = ReadBagContents(files, options.skip_damaged);
  if (!bag) return tl::unexpected(bag.error());
  const auto plan = PlanOf(*bag, options);
  if (!plan) return tl::unexpected(plan.error());
  return BagReader(*plan, options, visit).Run(files, *bag);
}

}  // namespace crossnav::recordings
