// SPDX-License-Identifier: MIT
#include "crossnav/world/mesh/coplanar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "crossnav/core/check.h"
#include "crossnav/world/mesh/rect.h"

namespace crossnav::world {
namespace {

constexpr double kSamePlane_m = 1e-3;
constexpr double kAligned_m = 1e-5;  // chosen: above the rounding of coordinates to float
constexpr std::uint32_t kNotCopied = 0xFFFFFFFF;
constexpr double kSliver_m = 1e-4;  // chosen: as the thinnest solid of MeshBuilder

/// A rectangle of two consecutive triangles (a, b, c) and (a, c, d). `u` and `v` are the axes of
/// its plane; the edge a-b runs along one of them.
struct Face {
  std::size_t triangle = 0;  ///< the first of the two
  std::array<std::uint32_t, 4> corners{};
  int axis = 0;  ///< of the normal
  bool is_positive = false;
  double plane_m = 0;
  Rect rect_uv;

  int u() const { return (axis + 1) % 3; }
  int v() const { return (axis + 2) % 3; }
};

bool IsQuad(const sim::TriangleMesh& mesh, std::size_t t) {
  if (t + 1 >= mesh.triangles.size()) return false;
  const auto &first = mesh.triangles[t], &second = mesh.triangles[t + 1];
  return first[0] == second[0] && first[2] == second[1] &&
         mesh.triangle_material[t] == mesh.triangle_material[t + 1] &&
         mesh.triangle_instance[t] == mesh.triangle_instance[t + 1];
}

/// The axis along which an edge runs; -1 if it is not axis-aligned.
int AxisOf(const Vector3f& edge) {
  int axis = 0;
  const float length = edge.cwiseAbs().maxCoeff(&axis);
  const double across = (edge.cwiseAbs().sum() - length);
  return length > kAligned_m && across < kAligned_m ? axis : -1;
}

std::optional<Face> FaceAt(const sim::TriangleMesh& mesh, std::size_t t) {
  if (!IsQuad(mesh, t)) return std::nullopt;
  Face face;
  face.triangle = t;
  const auto &first = mesh.triangles[t], &second = mesh.triangles[t + 1];
  face.corners = {first[0], first[1], first[2], second[2]};
  const auto p = [&](std::size_t i) -> const Vector3f& { return mesh.vertices[face.corners[i]]; };
  const Vector3f ab = p(1) - p(0), ad = p(3) - p(0);
  const int along = AxisOf(ab), across = AxisOf(ad);
  if (along < 0 || across < 0 || along == across) return std::nullopt;
  if ((p(2) - p(1) - ad).cwiseAbs().maxCoeff() > kAligned_m) return std::nullopt;
  face.axis = 3 - along - across;
  face.is_positive = ab.cross(ad)[face.axis] > 0;
  face.plane_m = p(0)[face.axis];
  const Vector3f low = p(0).cwiseMin(p(2)), high = p(0).cwiseMax(p(2));
  face.rect_uv = {low[face.u()], low[face.v()], high[face.u()], high[face.v()]};
  return face;
}

std::vector<Face> FacesOf(const sim::TriangleMesh& mesh) {
  std::vector<Face> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (const auto face = FaceAt(mesh, t)) {
      faces.push_back(*face);
      ++t;
    }
  }
  return faces;
}

/// What remains of the faces that lose area, by their first triangle.
using Remains = std::map<std::size_t, std::pair<Face, std::vector<Rect>>>;

/// Faces of one plane: the larger keeps what two share.
void CutGroup(std::vector<Face> group, Remains& remains) {
  std::stable_sort(group.begin(), group.end(), [](const Face& a, const Face& b) {
    return a.rect_uv.Area() > b.rect_uv.Area();
  });
  for (std::size_t i = 1; i < group.size(); ++i) {
    std::vector<Rect> larger;
    for (std::size_t j = 0; j < i; ++j) {
      if (group[i].rect_uv.Overlaps(group[j].rect_uv, kSliver_m)) {
        larger.push_back(group[j].rect_uv);
      }
    }
    if (larger.empty()) continue;
    std::vector<Rect> pieces = Subtract(group[i].rect_uv, larger);
    std::erase_if(pieces, [](const Rect& r) { return std::min(r.Width(), r.Depth()) < kSliver_m; });
    remains[group[i].triangle] = {group[i], std::move(pieces)};
  }
}

Remains CutAll(std::vector<Face> faces) {
  const auto side = [](const Face& f) { return 2 * f.axis + (f.is_positive ? 1 : 0); };
  std::stable_sort(faces.begin(), faces.end(), [&](const Face& a, const Face& b) {
    return side(a) != side(b) ? side(a) < side(b) : a.plane_m < b.plane_m;
  });
  Remains remains;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && side(faces[end]) == side(faces[i]) &&
           faces[end].plane_m - faces[i].plane_m < kSamePlane_m) {
      ++end;
    }
    const auto at = [&](std::size_t k) { return faces.begin() + static_cast<std::ptrdiff_t>(k); };
    CutGroup({at(i), at(end)}, remains);
    i = end;
  }
  return remains;
}

/// Adds the part `piece_uv` of the face of `from`, with its texture, to `to`.
void AddPiece(const sim::TriangleMesh& from, const Face& face, const Rect& piece_uv,
              sim::TriangleMesh& to) {
  const auto p = [&](std::size_t i) -> const Vector3f& { return from.vertices[face.corners[i]]; };
  const bool is_u_first = AxisOf(p(1) - p(0)) == face.u();
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (std::size_t i = 0; i < 4; ++i) {
    const bool is_low_u = p(i)[face.u()] < static_cast<float>(face.rect_uv.Center().x());
    const bool is_low_v = p(i)[face.v()] < static_cast<float>(face.rect_uv.Center().y());
    Vector3f corner = p(0);
    corner[face.u()] = static_cast<float>(is_low_u ? piece_uv.x0 : piece_uv.x1);
    corner[face.v()] = static_cast<float>(is_low_v ? piece_uv.y0 : piece_uv.y1);
    to.vertices.push_back(corner);
    if (from.uvs.empty()) continue;
    const auto share = [&](int axis, std::size_t end) {
      return (corner[axis] - p(0)[axis]) / (p(end)[axis] - p(0)[axis]);
    };
    const float s = share(is_u_first ? face.u() : face.v(), 1);
    const float t = share(is_u_first ? face.v() : face.u(), 3);
    std::array<float, 2> uv{};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = [&](std::size_t c) { return from.uvs[face.corners[c]][k]; };
      uv[k] = at(0) + s * (at(1) - at(0)) + t * (at(3) - at(0));
    }
    to.uvs.push_back(uv);
  }
  for (const auto& k : {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}}) {
    to.triangles.push_back({first + k[0], first + k[1], first + k[2]});
    to.triangle_material.push_back(from.triangle_material[face.triangle]);
    to.triangle_instance.push_back(from.triangle_instance[face.triangle]);
  }
}

/// Adds triangle `t` with its vertices; `new_of`: where vertices of `from` stand in `to`.
void CopyTriangle(const sim::TriangleMesh& from, std::size_t t, std::vector<std::uint32_t>& new_of,
                  sim::TriangleMesh& to) {
  std::array<std::uint32_t, 3> copied{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = from.triangles[t][i];
    if (new_of[vertex] == kNotCopied) {
      new_of[vertex] = static_cast<std::uint32_t>(to.vertices.size());
      to.vertices.push_back(from.vertices[vertex]);
      if (!from.uvs.empty()) to.uvs.push_back(from.uvs[vertex]);
    }
    copied[i] = new_of[vertex];
  }
  to.triangles.push_back(copied);
  to.triangle_material.push_back(from.triangle_material[t]);
  to.triangle_instance.push_back(from.triangle_instance[t]);
}

}  // namespace

sim::TriangleMesh WithoutOverlaps(sim::TriangleMesh mesh) {
  CROSSNAV_CHECK(mesh.vertex_colours.empty(), "colours of vertices would be lost");
  const Remains remains = CutAll(FacesOf(mesh));
  if (remains.empty()) return mesh;
  sim::TriangleMesh cut;
  std::vector<std::uint32_t> new_of(mesh.vertices.size(), kNotCopied);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto remaining = remains.find(t);
    if (remaining == remains.end()) {
      CopyTriangle(mesh, t, new_of, cut);
      continue;
    }
    const auto& [face, pieces] = remaining->second;
    for (const Rect& piece : pieces) AddPiece(mesh, face, piece, cut);
    ++t;  // both triangles of the face
  }
  return cut;
}

}  // namespace crossnav::world
