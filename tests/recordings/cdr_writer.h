// SPDX-License-Identifier: MIT
// ROS 2 messages in CDR, written independently of the reader, and bags of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crossnav/trace/mcap_writer.h"

namespace crossnav::recordings::testing {

/// Little-endian, or big-endian.
class CdrWriter {
 public:
  explicit CdrWriter(bool is_big = false) : is_big_(is_big) {
    bytes_ = is_big ? std::string("\0\0\0\0", 4) : std::string("\0\1\0\0", 4);
  }
  template <class T>
  CdrWriter& Number(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\xAA';  // padding has any value
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    if (is_big_) std::reverse(raw, raw + sizeof(T));
    bytes_.append(raw, sizeof(T));
    return *this;
  }
  CdrWriter& Text(const std::string& text) {
    Number(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }
  CdrWriter& Bytes(const std::string& bytes) {
    Number(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
    return *this;
  }
  CdrWriter& Numbers(const std::vector<double>& numbers) {
    for (const double n : numbers) Number(n);
    return *this;
  }
  CdrWriter& Header(std::int64_t time_ns, const std::string& frame) {
    Number(static_cast<std::int32_t>(time_ns / 1'000'000'000));
    return Number(static_cast<std::uint32_t>(time_ns % 1'000'000'000)).Text(frame);
  }
  std::string Take() const { return bytes_; }

 private:
  bool is_big_;
  std::string bytes_;
};

struct ImageToWrite {
  std::int64_t time_ns = 0;
  std::string frame, encoding;
  std::uint32_t width = 0, height = 0, row_bytes = 0;
  std::string data;
  bool is_big = false;
};

inline std::string ImageMessage(const ImageToWrite& image) {
  CdrWriter out(image.is_big);
  out.Header(image.time_ns, image.frame).Number(image.height).Number(image.width);
  out.Text(image.encoding).Number(static_cast<std::uint8_t>(image.is_big));
  return out.Number(image.row_bytes).Bytes(image.data).Take();
}

inline std::string CompressedMessage(std::int64_t time_ns, const std::string& frame,
                                     const std::string& format, const std::string& data) {
  return CdrWriter().Header(time_ns, frame).Text(format).Bytes(data).Take();
}

struct CameraToWrite {
  std::string frame, lens = "plumb_bob";
  std::uint32_t width = 0, height = 0, binning = 0;
  std::vector<double> distortion;
  double focal = 0;
};

inline std::string CameraMessage(const CameraToWrite& c) {
  CdrWriter out;
  out.Header(0, c.frame).Number(c.height).Number(c.width).Text(c.lens);
  out.Number(static_cast<std::uint32_t>(c.distortion.size())).Numbers(c.distortion);
  const double cx = 0.5 * (c.width - 1), cy = 0.5 * (c.height - 1);
  out.Numbers({c.focal, 0, cx, 0, c.focal, cy, 0, 0, 1}).Numbers({1, 0, 0, 0, 1, 0, 0, 0, 1});
  out.Numbers({c.focal, 0, cx, 0, 0, c.focal, cy, 0, 0, 0, 1, 0});
  for (int i = 0; i < 2; ++i) out.Number(c.binning);
  for (int i = 0; i < 4; ++i) out.Number(std::uint32_t{0});
  return out.Number(std::uint8_t{0}).Take();
}

/// Translation x, y, z and quaternion x, y, z, w.
using SevenNumbers = std::array<double, 7>;

inline std::string OdometryMessage(std::int64_t time_ns, const std::string& frame,
                                   const std::string& child, const SevenNumbers& pose) {
  CdrWriter out;
  out.Header(time_ns, frame).Text(child).Numbers({pose.begin(), pose.end()});
  return out.Numbers(std::vector<double>(36 + 6 + 36)).Take();
}

inline std::string TransformMessage(std::int64_t time_ns, const std::string& parent,
                                    const std::string& child, const SevenNumbers& pose) {
  CdrWriter out;
  out.Number(std::uint32_t{1}).Header(time_ns, parent).Text(child);
  return out.Numbers({pose.begin(), pose.end()}).Take();
}

/// A bag of one file, written when it is asked for.
class BagMaker {
 public:
  void Add(const std::string& topic, const std::string& type, std::int64_t time_ns,
           const std::string& message) {
    messages_.push_back({topic, type, time_ns, message});
  }
  void Write(const std::filesystem::path& path, const std::string& encoding = "cdr") const {
    auto writer = trace::McapWriter::Open(path, {});
    std::map<std::string, std::uint16_t> channels;
    for (const auto& m : messages_) {
      if (channels.count(m.topic) == 0)
        channels[m.topic] =
            writer->AddChannel(m.topic, writer->AddSchema(m.type, "ros2msg", ""), encoding);
      writer->Write(channels[m.topic], static_cast<std::uint64_t>(m.time_ns), m.message);
    }
    (void)writer->Close();
  }

 private:
  struct Message {
    std::string topic, type;
    std::int64_t time_ns;
    std::string message;
  };
  std::vector<Message> messages_;
};

}  // namespace crossnav::recordings::testing
