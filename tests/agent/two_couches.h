// SPDX-License-Identifier: MIT
// A long room with a grey and a red couch: what a goal says beyond "sofa" decides between them.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "agent/two_rooms.h"

namespace crossnav::agent::testing {

inline const Box3 kGrey = BoxOf(2.6, 1.6, 0, 3.4, 2.4, 0.7);
inline const Box3 kRed = BoxOf(6.4, 2.2, 0, 7.4, 3.0, 0.7);

inline BoxWalker LongRoom() {
  BoxWalker walker;
  walker.sensor = SmallConfig().sensor;
  walker.rooms.shell = BoxOf(0, 0, 0, 9, 4, 2.6);
  walker.rooms.solids = {kGrey, kRed};
  walker.pose.p_world = Vector3d(0.8, 2.0, 0);
  return walker;
}

template <class F>
void ForEachPixel(const Observation& obs, F&& f) {
  for (int v = 0; v < obs.rgb.height; ++v)
    for (int u = 0; u < obs.rgb.width; ++u)
      f(u, v,
        Vector3d(obs.T_world_camera * BackProjectPixel(obs.camera, u, v, obs.depth_m.At(u, v))));
}

/// Both couches are detected whenever a sofa is asked for.
inline FakeSight TwoSofas() {
  FakeSight grey, red, sight;
  test::SeeBox(kGrey, "sofa", &grey);
  test::SeeBox(kRed, "sofa", &red);
  sight.detect = [=](const Observation& obs, std::string_view goal) {
    auto found = red.detect(obs, goal);
    for (auto other : grey.detect(obs, goal)) {
      other.confidence = 0.85F;
      found.push_back(other);
    }
    return found;
  };
  sight.segment = [=](const Observation& obs, perception::Detection& detection) {
    (detection.confidence == 0.85F ? grey : red).segment(obs, detection);
  };
  sight.text = [](std::string_view text) {
    return text == "sofa" ? std::vector<float>{1, 0, 0, 0} : std::vector<float>{0, 0, 0, 1};
  };
  sight.features = [](const Observation& obs) {
    perception::FeatureGrid grid{obs.rgb.height, obs.rgb.width, 4, {}};
    ForEachPixel(obs, [&](int, int, const Vector3d& p) {
      const bool is_sofa = IsOn(kGrey, p) || IsOn(kRed, p);
      const auto cell =
          is_sofa ? std::array{1.0F, 0.0F, 0.0F, 0.0F} : std::array{0.0F, 0.8F, 0.6F, 0.0F};
      grid.data.insert(grid.data.end(), cell.begin(), cell.end());
    });
    return grid;
  };
  return sight;
}

inline Observation InColour(const BoxWalker& walker) {
  Observation obs = walker.Look();
  ForEachPixel(obs, [&](int u, int v, const Vector3d& p) {
    obs.rgb.At(u, v) = IsOn(kRed, p)    ? Rgb8{190, 40, 40}
                       : IsOn(kGrey, p) ? Rgb8{120, 120, 122}
                                        : Rgb8{230, 230, 225};
  });
  return obs;
}

/// Claim of the agent in the long room; nullopt where it does not claim.
inline std::optional<Vector3d> ClaimIn600Steps(Agent& agent) {
  BoxWalker walker = LongRoom();
  for (int i = 0; i < 600; ++i) {
    const auto result = agent.Step(InColour(walker));
    if (!result || result->all_explored) return std::nullopt;
    if (result->action == Action::kStop) return result->p_claimed_world;
    walker.Do(result->action);
  }
  return std::nullopt;
}

inline bool IsClaimAt(const std::optional<Vector3d>& claim, const Box3& box) {
  return claim && box.HorizontalDistance(*claim) < 0.3;
}

}  // namespace crossnav::agent::testing
