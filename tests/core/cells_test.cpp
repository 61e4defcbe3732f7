// SPDX-License-Identifier: MIT
#include "crossnav/core/cells.h"

#include <gtest/gtest.h>

#include "crossnav/core/rng.h"

namespace crossnav {
namespace {

TEST(Cells, ThePapersLengthsDivideWithoutRoundingTraps) {
  EXPECT_EQ(CellsFloor(0.30, 0.05), 6);  // plain floor: 5
  EXPECT_EQ(CellsFloor(0.6, 0.1), 6);    // plain floor: 5
  EXPECT_EQ(CellsCeil(0.10, 0.03), 4);
  EXPECT_EQ(CellsFloor(0.10, 0.03), 3);
  EXPECT_EQ(CellsCeil(0.30, 0.05), 6);
  EXPECT_EQ(CellsCeil(1.50, 0.10), 15);
  EXPECT_EQ(CellsFloor(0.40, 0.10), 4);
  EXPECT_EQ(CellsNearest(0.25, 0.10), 3);
  EXPECT_EQ(CellsNearest(0.24, 0.10), 2);
}

TEST(Cells, FloatAndDoubleLengthsGiveTheSameCells) {
  EXPECT_EQ(CellsFloor(0.30F, 0.05F), CellsFloor(0.30, 0.05));
  EXPECT_EQ(CellsCeil(0.30F, 0.05F), CellsCeil(0.30, 0.05));
}

TEST(Cells, NegativeLengthsRoundTowardsTheNamedSide) {
  EXPECT_EQ(CellsFloor(-0.25, 0.1), -3);
  EXPECT_EQ(CellsCeil(-0.25, 0.1), -2);
  EXPECT_EQ(CellsFloor(-0.30, 0.1), -3);
  EXPECT_EQ(CellsCeil(-0.30, 0.1), -3);
}

TEST(Cells, WholeMultiplesComeBackExactlyForEveryCellSize) {
  Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const double cell = rng.Uniform(0.01, 0.5);
    const int n = rng.Int(-500, 500);
    // Summed up, so that the product carries rounding of its own.
    double length = 0;
    for (int k = 0; k < std::abs(n); ++k) length += n > 0 ? cell : -cell;
    ASSERT_EQ(CellsFloor(length, cell), n) << cell;
    ASSERT_EQ(CellsCeil(length, cell), n) << cell;
    ASSERT_EQ(CellsNearest(length, cell), n) << cell;
  }
}

}  // namespace
}  // namespace crossnav
