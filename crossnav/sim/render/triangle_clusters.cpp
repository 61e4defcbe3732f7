// SPDX-License-Identifier: MIT
#include "crossnav/sim/render/triangle_clusters.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace crossnav::sim {
namespace {

constexpr std::size_t kClusterSize = 64;  // chosen: 32 and 128 take about as long

using Box3f = Eigen::AlignedBox3f;

class Divider {
 public:
  Divider(const TriangleMesh& mesh, TriangleClusters& out) : mesh_(mesh), out_(out) {
    boxes_.reserve(mesh.triangles.size());
    for (const auto& corner : mesh.triangles) {
      Box3f box(mesh.vertices[corner[0]]);
      box.extend(mesh.vertices[corner[1]]);
      box.extend(mesh.vertices[corner[2]]);
      boxes_.push_back(box);
    }
  }

  /// Halves along the widest axis until a cluster is left.
  void Divide(std::span<std::uint32_t> triangles, bool has_holes) {
    if (triangles.empty()) return;
    if (triangles.size() <= kClusterSize) return Add(triangles, has_holes);
    Box3f centres;
    for (const std::uint32_t t : triangles) centres.extend(boxes_[t].center());
    int axis = 0;
    centres.sizes().maxCoeff(&axis);
    // Whole clusters to the left, so that few are left half empty.
    const std::size_t clusters = (triangles.size() + kClusterSize - 1) / kClusterSize;
    const std::size_t left = clusters / 2 * kClusterSize;
    const auto at = [&](std::uint32_t t) { return boxes_[t].min()[axis] + boxes_[t].max()[axis]; };
    std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(left),
                     triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(at(a), a) < std::pair(at(b), b);
                     });
    Divide(triangles.first(left), has_holes);
    Divide(triangles.subspan(left), has_holes);
  }

 private:
  void Add(std::span<std::uint32_t> triangles, bool has_holes) {
    std::sort(triangles.begin(), triangles.end());
    Cluster cluster;
    cluster.first = static_cast<std::uint32_t>(out_.octets.size());
    cluster.has_holes = has_holes;
    Box3f box;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (i % 8 == 0) out_.octets.emplace_back();
      Octet& octet = out_.octets.back();
      const std::uint32_t t = triangles[i];
      octet.triangle[i % 8] = t;
      octet.instance[i % 8] = mesh_.triangle_instance[t];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vector3f& p = mesh_.vertices[mesh_.triangles[t][corner]];
        for (std::size_t axis = 0; axis < 3; ++axis)
          octet.corners[corner][axis][i % 8] = p[static_cast<int>(axis)];
      }
      box.extend(boxes_[t]);
    }
    cluster.count = static_cast<std::uint32_t>(out_.octets.size()) - cluster.first;
    cluster.centre = box.center();
    // A little more, as the centre is rounded.
    cluster.half = box.sizes() * 0.5F + Vector3f::Constant(1e-5F * (1 + cluster.centre.norm()));
    out_.clusters.push_back(cluster);
  }

  const TriangleMesh& mesh_;
  TriangleClusters& out_;
  std::vector<Box3f> boxes_;
};

// Whether a box may be in the picture: some corner on the inner side of each of its five planes.
class Frustum {
 public:
  explicit Frustum(const RasterView& view) : origin_(view.origin) {
    const Vector3f x = view.to_pixels.row(0), y = view.to_pixels.row(1), z = view.to_pixels.row(2);
    forms_ = {z, x, z * static_cast<float>(view.width - 1) - x, y,
              z * static_cast<float>(view.height - 1) - y};
    for (std::size_t i = 0; i < forms_.size(); ++i) sizes_[i] = forms_[i].cwiseAbs();
  }

  bool Holds(const Cluster& cluster, float& nearest_m) const {
    const Vector3f p = cluster.centre - origin_;
    const float z = forms_[0].dot(p), dz = sizes_[0].dot(cluster.half);
    nearest_m = z - dz;
    if (z + dz <= 0) return false;
    for (std::size_t i = 1; i < forms_.size(); ++i)
      if (forms_[i].dot(p) + sizes_[i].dot(cluster.half) < 0) return false;
    return true;
  }

 private:
  Vector3f origin_;
  // Linear forms of a point, and the half range of each over the box.
  std::array<Vector3f, 5> forms_, sizes_;
};

}  // namespace

std::vector<ClusterInView> ClustersInView(const TriangleClusters& triangles,
                                          const RasterView& view) {
  const Frustum frustum(view);
  std::vector<ClusterInView> seen;
  for (std::uint32_t i = 0; i < triangles.clusters.size(); ++i) {
    float nearest_m = 0;
    if (frustum.Holds(triangles.clusters[i], nearest_m)) seen.push_back({nearest_m, i});
  }
  std::sort(seen.begin(), seen.end(), [](const ClusterInView& a, const ClusterInView& b) {
    return a.nearest_m < b.nearest_m || (a.nearest_m == b.nearest_m && a.cluster < b.cluster);
  });
  return seen;
}

TriangleClusters ClusterTriangles(const TriangleMesh& mesh, const std::vector<bool>& has_holes) {
  TriangleClusters out;
  std::vector<std::uint32_t> triangles(mesh.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0U);
  const auto holed = std::partition(triangles.begin(), triangles.end(),
                                    [&](std::uint32_t t) { return !has_holes[t]; });
  const auto solid = static_cast<std::size_t>(holed - triangles.begin());
  Divider divider(mesh, out);
  divider.Divide(std::span(triangles).first(solid), false);
  divider.Divide(std::span(triangles).subspan(solid), true);
  return out;
}

}  // namespace crossnav::sim
