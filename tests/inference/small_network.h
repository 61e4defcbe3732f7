// SPDX-License-Identifier: MIT
// A network of the family `crossnav` that sees goals as colours (make_models.py), with its card.
#pragma once

#include <string>
#include <vector>

#include "crossnav/inference/networks_config.h"
#include "crossnav/inference/sha256.h"
#include "inference/model_files.h"

namespace crossnav::inference::test {

inline constexpr const char* kCardWithoutHash = R"(family = "crossnav"
labels = ["chair", "bed", "potted plant", "toilet", "tv", "couch"]
[input]
size = 32
antialias = false
[output]
rows = 4
cols = 4
dim = 4
[thresholds]
score = 0.5
[text]
names_file = "names.txt"
table = "names.npy"
)";

/// With the hash of its file.
inline std::string SmallCard(const std::string& file = "crossnav.onnx") {
  return "sha256 = \"" + Sha256(*ReadFile(DataFile(file))) + "\"\n" + kCardWithoutHash;
}

/// Rows of float32, as NumPy writes them.
inline std::string Npy(const std::vector<std::vector<float>>& rows) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows.size()) + ", " + std::to_string(rows[0].size()) + "), }";
  header.resize(118 - 10 + 10 - 1, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size());
  out += '\0';
  out += header;
  for (const auto& row : rows)
    out.append(reinterpret_cast<const char*>(row.data()), sizeof(float) * row.size());
  return out;
}

/// Leaves card, file and text table in `folder`; settings that name it for everything.
/// crossnav_frames.onnx is the same network with an open number of frames.
inline NetworksConfig WriteSmallNetwork(const std::filesystem::path& folder,
                                        const std::string& file = "crossnav.onnx") {
  using crossnav::test::WriteText;
  WriteText(folder / "small.toml", SmallCard(file));
  WriteText(folder / "small.onnx", *ReadFile(DataFile(file)));
  WriteText(folder / "names.txt", "chair\nbed\nplant\nWall\ntoilet\ntv\ncouch\n");
  WriteText(folder / "names.npy", Npy({{1, 0, 0, 0},
                                       {0, 2, 0, 0},
                                       {0, 0, 1, 0},
                                       {0, 0, 0, 1},
                                       {1, 1, 0, 0},
                                       {0, 1, 1, 0},
                                       {1, 0, 1, 0}}));
  NetworksConfig config;
  config.dir = folder.string();
  config.detector = config.segmenter = config.stairs = config.encoder = "small";
  return config;
}

}  // namespace crossnav::inference::test
