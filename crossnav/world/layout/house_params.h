// SPDX-License-Identifier: MIT
// Parameters of a generated house.
#pragma once

#include <cstdint>

namespace crossnav::world {

/// Raise it when the same parameters give another house. Named benchmarks refer to it.
inline constexpr int kGeneratorVersion = 1;

/// Offices are of edition 2.
enum class Building { kDrawn, kHome, kOffice };

struct HouseParams {
  std::uint64_t seed = 1;
  int edition = 1;  ///< of the generator (edition.h)
  Building building = Building::kDrawn;
  int floors = 0;      ///< 1 to 4; 0 = drawn from the seed (2 most often)
  double area_m2 = 0;  ///< of one floor, 60 to 400; 0 = drawn from the seed
  bool has_textures = true;
  bool has_lights = true;  ///< light of windows and lamps, baked into vertex colours
  bool is_scan = false;    ///< holes, noise and floating fragments, as in a real scan
  bool is_varied = false;  ///< furniture of uncommon sizes in uncommon places, to train networks
  int max_attempts = 0;    ///< plans tried; 0 = the edition's default
};

}  // namespace crossnav::world
