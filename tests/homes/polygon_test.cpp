// SPDX-License-Identifier: MIT
// Areas must add up: triangles of concave outlines, pieces and their cut-outs.
#include "crossnav/homes/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/homes/svg_path.h"

namespace crossnav::homes {
namespace {

double AreaOf(const std::vector<Polygon>& pieces) {
  double area = 0;
  for (const Polygon& piece : pieces) area += SignedArea(piece);
  return area;
}

Polygon Square(double x, double y, double side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(Polygon, TrianglesOfAConcaveOutlineCoverItsArea) {
  const Polygon l_shape = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_NEAR(AreaOf(Triangulate(l_shape)), 6, 1e-9);
  Polygon turned(l_shape.rbegin(), l_shape.rend());
  EXPECT_NEAR(AreaOf(Triangulate(turned)), 6, 1e-9);
  for (const Polygon& t : Triangulate(l_shape)) EXPECT_GT(SignedArea(t), 0);
}

TEST(Polygon, TrianglesOfAStarCoverItsAreaAndNothingElse) {
  Rng rng(7);
  for (int round = 0; round < 50; ++round) {
    Polygon star;
    for (int i = 0; i < 40; ++i) {
      const double a = 2 * 3.14159265358979 * i / 40, r = rng.Uniform(0.3, 5.0);
      star.emplace_back(r * std::cos(a), r * std::sin(a));
    }
    const auto triangles = Triangulate(star);
    EXPECT_NEAR(AreaOf(triangles), SignedArea(star), 1e-4);
    for (const Polygon& t : triangles) {
      EXPECT_TRUE(Contains(star, (t[0] + t[1] + t[2]) / 3));
    }
  }
}

TEST(Polygon, RepeatedAndStraightPointsDoNotMatter) {
  const Polygon rough = {{0, 0}, {0, 0}, {1, 0}, {2, 0}, {2, 2}, {2, 2.00001}, {0, 2}, {0, 1}};
  EXPECT_EQ(Cleaned(rough).size(), 4U);
  EXPECT_TRUE(Cleaned({{0, 0}, {1, 0}, {2, 0}}).empty());
  EXPECT_TRUE(Cleaned({}).empty());
}

TEST(Polygon, SubtractedAreaIsGoneAndTheRestStays) {
  const std::vector<Polygon> holes = {Square(1, 1, 1), Square(1.5, 1.5, 1)};
  const auto rest = Subtract(Triangulate(Square(0, 0, 4)), holes);
  EXPECT_NEAR(AreaOf(rest), 16 - 1.75, 1e-6);
  for (const Polygon& piece : rest) {
    EXPECT_FALSE(Contains(piece, {1.2, 1.2}));
    EXPECT_FALSE(Contains(piece, {2.2, 2.2}));
  }
  EXPECT_NEAR(AreaOf(Subtract({Square(0, 0, 1)}, std::vector<Polygon>{Square(5, 5, 1)})), 1, 1e-9);
  EXPECT_TRUE(Subtract({Square(0, 0, 1)}, std::vector<Polygon>{Square(-1, -1, 3)}).empty());
}

TEST(Polygon, TheHullLeavesOutInnerPoints) {
  EXPECT_NEAR(SignedArea(Hull({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {0.5, 0.7}, {0, 2}})), 4, 1e-9);
}

TEST(SvgPath, ReadsTheCutOutsOfTheCatalogue) {
  const auto square = ParseSvgPath("M0,0 v1 h1 v-1 z");
  ASSERT_TRUE(square && square->size() == 1);
  EXPECT_NEAR(std::abs(SignedArea(square->front())), 1, 1e-9);
  // Three quarters of a disc.
  const auto spiral =
      ParseSvgPath("M0.71077,0.94769 L0.5,0.5 h0.5 A0.5,0.5 0 1,0 0.71077,0.94769 z");
  ASSERT_TRUE(spiral && spiral->size() == 1);
  const double share = (2 * 3.14159265 - 1.1317) / (2 * 3.14159265);
  EXPECT_NEAR(std::abs(SignedArea(spiral->front())), share * 3.14159265 / 4, 0.02);
  const auto round = ParseSvgPath("M0,0.5 C0,0.2 0.2,0 0.5,0 Q1,0 1,0.5 L0.5 1Z");
  ASSERT_TRUE(round && round->size() == 1);
}

TEST(SvgPath, RefusesInvalidPaths) {
  for (const char* text :
       {"hello", "M0", "M0,0 X1,1", "M0,0 L nan,1", "M0,0 L1e99,1 1,1z", "M,,"}) {
    EXPECT_FALSE(ParseSvgPath(text)) << text;
  }
  EXPECT_TRUE(ParseSvgPath("")->empty());
}

}  // namespace
}  // namespace crossnav::homes
