// SPDX-License-Identifier: MIT
#include "crossnav/homes/svg_path.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace crossnav::homes {
namespace {

constexpr int kCurveParts = 8;            // chosen: a floor's edge, not a drawing
constexpr std::size_t kMaxPoints = 2000;  // chosen: far above any real outline

struct PathReader {
  std::string_view text;
  std::size_t at = 0;
  std::vector<Polygon> outlines;
  Polygon current;
  Vector2d pen = Vector2d::Zero(), start = Vector2d::Zero();
  std::size_t points = 0;

  void SkipSpace() {
    while (at < text.size() && (text[at] == ' ' || text[at] == ',' || text[at] == '\t' ||
                                text[at] == '\n' || text[at] == '\r')) {
      ++at;
    }
  }

  bool HasNumber() {
    SkipSpace();
    return at < text.size() && (std::string_view("+-.0123456789").find(text[at]) != text.npos);
  }

  std::optional<double> Number() {
    SkipSpace();
    if (at < text.size() && text[at] == '+') ++at;
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + at, end, value);
    if (error != std::errc() || !std::isfinite(value) || std::abs(value) > 1e6) return std::nullopt;
    at = static_cast<std::size_t>(rest - text.data());
    return value;
  }

  std::optional<Vector2d> Point(bool is_relative) {
    const auto x = Number();
    const auto y = x ? Number() : std::nullopt;
    if (!y) return std::nullopt;
    return is_relative ? Vector2d(pen + Vector2d(*x, *y)) : Vector2d(*x, *y);
  }

  void LineTo(const Vector2d& p) {
    if (current.empty()) current.push_back(pen);
    current.push_back(p);
    pen = p;
    ++points;
  }

  void Close() {
    if (current.size() >= 3) outlines.push_back(std::move(current));
    current.clear();
    pen = start;
  }

  bool Curve(bool is_relative, int controls) {
    std::vector<Vector2d> p{pen};
    for (int i = 0; i <= controls; ++i) {
      const auto q = Point(is_relative);
      if (!q) return false;
      p.push_back(*q);
    }
    for (int i = 1; i <= kCurveParts; ++i) {
      const double t = static_cast<double>(i) / kCurveParts;
      std::vector<Vector2d> level = p;  // de Casteljau
      while (level.size() > 1) {
        for (std::size_t k = 0; k + 1 < level.size(); ++k) {
          level[k] += t * (level[k + 1] - level[k]);
        }
        level.pop_back();
      }
      LineTo(level[0]);
    }
    return true;
  }

  /// From the end points to the centre, as in the SVG standard's appendix on arcs.
  bool Arc(bool is_relative) {
    std::optional<double> v[5];
    for (auto& value : v) {
      value = Number();
      if (!value) return false;
    }
    const auto to = Point(is_relative);
    if (!to) return false;
    double rx = std::abs(*v[0]), ry = std::abs(*v[1]);
    if (rx < 1e-9 || ry < 1e-9 || (*to - pen).norm() < 1e-9) {
      LineTo(*to);
      return true;
    }
    const Eigen::Rotation2Dd turn(*v[2] * std::numbers::pi / 180);
    const Vector2d half = turn.inverse() * Vector2d(0.5 * (pen - *to));
    const double fit = std::pow(half.x() / rx, 2) + std::pow(half.y() / ry, 2);
    if (fit > 1) {
      rx *= std::sqrt(fit);
      ry *= std::sqrt(fit);
    }
    const double across = std::pow(rx * half.y(), 2) + std::pow(ry * half.x(), 2);
    double scale = std::sqrt(std::max(0.0, (rx * rx * ry * ry - across) / across));
    if ((*v[3] != 0) == (*v[4] != 0)) scale = -scale;
    const Vector2d c(scale * rx * half.y() / ry, -scale * ry * half.x() / rx);
    const Vector2d center = turn * c + 0.5 * (pen + *to);
    const auto angle = [&](const Vector2d& p) {
      return std::atan2((p.y() - c.y()) / ry, (p.x() - c.x()) / rx);
    };
    const double from = angle(half);
    double sweep = angle(-half) - from;
    if (*v[4] != 0 && sweep < 0) sweep += 2 * std::numbers::pi;
    if (*v[4] == 0 && sweep > 0) sweep -= 2 * std::numbers::pi;
    const int parts = 2 * kCurveParts;
    for (int i = 1; i < parts; ++i) {
      const double a = from + sweep * i / parts;
      LineTo(center + turn * Vector2d(rx * std::cos(a), ry * std::sin(a)));
    }
    LineTo(*to);
    return true;
  }

  bool Step(char command) {
    const bool is_relative = command >= 'a';
    switch (command) {
      case 'L':
      case 'l': {
        const auto p = Point(is_relative);
        if (p) LineTo(*p);
        return p.has_value();
      }
      case 'H':
      case 'h':
      case 'V':
      case 'v': {
        const auto n = Number();
        if (!n) return false;
        const std::size_t axis = command == 'H' || command == 'h' ? 0 : 1;
        Vector2d p = pen;
        p[static_cast<Eigen::Index>(axis)] =
            *n + (is_relative ? pen[static_cast<Eigen::Index>(axis)] : 0);
        LineTo(p);
        return true;
      }
      case 'C':
      case 'c':
        return Curve(is_relative, 2);
      case 'Q':
      case 'q':
        return Curve(is_relative, 1);
      case 'A':
      case 'a':
        return Arc(is_relative);
      default:
        return false;
    }
  }

  bool Read() {
    for (SkipSpace(); at < text.size(); SkipSpace()) {
      char command = text[at++];
      if (command == 'Z' || command == 'z') {
        Close();
        continue;
      }
      if (command == 'M' || command == 'm') {
        Close();
        const auto p = Point(command == 'm');
        if (!p) return false;
        pen = start = *p;
        command = command == 'm' ? 'l' : 'L';
        if (!HasNumber()) continue;
      }
      do {
        if (!Step(command) || points > kMaxPoints) return false;
      } while (HasNumber());
    }
    Close();
    return true;
  }
};

}  // namespace

std::optional<std::vector<Polygon>> ParseSvgPath(std::string_view text) {
  PathReader reader{text, 0, {}, {}, Vector2d::Zero(), Vector2d::Zero(), 0};
  if (!reader.Read()) return std::nullopt;
  return std::move(reader.outlines);
}

}  // namespace crossnav::homes
