// SPDX-License-Identifier: MIT
#include "change_text.h"

#include <fmt/format.h>

namespace crossnav::app {
namespace {

std::string PlaceText(const world::ChangePlace& place) {
  std::string text = fmt::format("{:.2f}, {:.2f}, {:.2f}", place.p_world.x(), place.p_world.y(),
                                 place.p_world.z());
  if (place.room >= 0) text += fmt::format(" (room {}, floor {})", place.room, place.floor);
  return text;
}

}  // namespace

std::string ChangeText(const world::Change& change) {
  std::string text =
      fmt::format("  {:<15} {} {}", world::NameOf(change.kind), change.name, change.instance);
  if (change.from) text += "  from " + PlaceText(*change.from);
  if (change.to) text += (change.from ? "  to " : "  at ") + PlaceText(*change.to);
  return text + "\n";
}

}  // namespace crossnav::app
