// SPDX-License-Identifier: MIT
// Which networks answer for perception from pixels: the names of their cards (docs/networks.md).
#pragma once

#include <string>

namespace crossnav::inference {

struct NetworksConfig {
  std::string dir;  ///< folder of cards and files; empty = the one that comes with crossnav
  // One network of our own answers all; chosen: it is in the repository.
  std::string detector = "crossnav_small";   ///< or several: the first that has the goal
  std::string segmenter = "crossnav_small";  ///< or depth: the depth cluster in the box, no file
  std::string stairs = "crossnav_small";
  std::string encoder = "crossnav_small";
  std::string backend = "auto";  ///< auto | openvino | onnxruntime
  std::string provider = "cpu";  ///< cpu | cuda | tensorrt: of onnxruntime
  int threads = 1;               ///< of inference; more may change the last bits
};

template <class V>
void Visit(V& visit, NetworksConfig& c) {
  visit("dir", c.dir);
  visit("detector", c.detector);
  visit("segmenter", c.segmenter);
  visit("stairs", c.stairs);
  visit("encoder", c.encoder);
  visit("backend", c.backend, {"auto", "openvino", "onnxruntime"});
  visit("provider", c.provider, {"cpu", "cuda", "tensorrt"});
  visit("threads", c.threads, 1, 64);
}

}  // namespace crossnav::inference
