// SPDX-License-Identifier: MIT
#include "crossnav/policy/whereabouts.h"

#include <string>

#include "crossnav/core/category_table.h"

namespace crossnav::policy {

double UpperStoreyBits(std::string_view goal) {
  constexpr double kThrice = 1.6;  // chosen: three to one
  const std::string name = CanonicalName(goal);
  for (const std::string_view above : {"bed", "bedroom", "wardrobe", "crib", "dresser"})
    if (name == above) return kThrice;
  for (const std::string_view below : {"sofa", "living room", "kitchen", "stove", "oven",
                                       "refrigerator", "dishwasher", "dining table", "fireplace"})
    if (name == below) return -kThrice;
  return 0;
}

}  // namespace crossnav::policy
