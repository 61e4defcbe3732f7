// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/rect.h"

namespace crossnav::world {

std::vector<Rect> Subtract(const Rect& whole, std::span<const Rect> holes) {
  std::vector<Rect> pieces = {whole};
  for (const Rect& hole : holes) {
    std::vector<Rect> next;
    for (const Rect& p : pieces) {
      if (!p.Overlaps(hole)) {
        next.push_back(p);
        continue;
      }
      const Rect s = p.Shared(hole);
      const Rect around[] = {{p.x0, p.y0, p.x1, s.y0},
                             {p.x0, s.y1, p.x1, p.y1},
                             {p.x0, s.y0, s.x0, s.y1},
                             {s.x1, s.y0, p.x1, s.y1}};
      for (const Rect& r : around) {
        if (r.Width() > 1e-6 && r.Depth() > 1e-6) next.push_back(r);
      }
    }
    pieces = std::move(next);
  }
  return pieces;
}

}  // namespace crossnav::world
