// SPDX-License-Identifier: MIT
// Networks of perception from pixels: the names of their cards (docs/networks.md).
#pragma once

#include <string>

#include "crossnav/core/setting.h"

namespace crossnav::inference {

struct NetworksConfig {
  std::string dir;  ///< folder of cards and files; empty = the folder shipped with crossnav
  // Our own network in all roles; chosen: it is in the repository.
  /// or several: the first with a label for the goal answers
  std::string detector = "crossnav_small";
  /// that raises or lowers the detector's confidence where both have a box; empty = none
  std::string second_detector;
  /// the second detector also looks in one of so many frames in which the first has no box
  int second_every = 4;  // chosen: it costs as much as the first
  /// or depth: the depth cluster in the box, without a file
  std::string segmenter = "crossnav_small";
  std::string stairs = "crossnav_small";
  std::string encoder = "crossnav_small";
  std::string backend = "auto";  ///< auto | openvino | onnxruntime
  std::string provider = "cpu";  ///< cpu | cuda | tensorrt: of onnxruntime
  int threads = 1;               ///< of inference; more may change the last bits
  /// most frames of several agents of one process in one run; 1 = each agent has its own network
  int batch = 1;
};

template <class V>
void Visit(V& visit, NetworksConfig& c) {
  visit(CROSSNAV_SETTING(c, dir));
  visit(CROSSNAV_SETTING(c, detector));
  visit(CROSSNAV_SETTING(c, second_detector));
  visit(CROSSNAV_SETTING(c, second_every), 1, 1000);
  visit(CROSSNAV_SETTING(c, segmenter));
  visit(CROSSNAV_SETTING(c, stairs));
  visit(CROSSNAV_SETTING(c, encoder));
  visit(CROSSNAV_SETTING(c, backend), {"auto", "openvino", "onnxruntime"});
  visit(CROSSNAV_SETTING(c, provider), {"cpu", "cuda", "tensorrt"});
  visit(CROSSNAV_SETTING(c, threads), 1, 64);
  visit(CROSSNAV_SETTING(c, batch), 1, 64);
}

}  // namespace crossnav::inference
