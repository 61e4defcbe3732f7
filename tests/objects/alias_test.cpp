// SPDX-License-Identifier: MIT
// One object under two names.
#include "crossnav/objects/alias.h"

#include <gtest/gtest.h>

#include <vector>

namespace crossnav::objects {
namespace {

ObjectRecord RecordAt(const std::string& category, double x_m) {
  ObjectRecord record;
  record.category = category;
  record.views = 3;
  record.box_world_m = {Eigen::Vector3d(x_m, 0, 0), Eigen::Vector3d(x_m + 0.6, 0.6, 1)};
  return record;
}

TEST(Alias, AnArmchairThatIsAlsoOnRecordAsAChairIsOneObject) {
  const std::vector<ObjectRecord> records = {RecordAt("chair", 0), RecordAt("armchair", 0.1),
                                             RecordAt("armchair", 3), RecordAt("vase", 0)};
  EXPECT_FALSE(IsAlias(records[0], records)) << "the name of the category itself";
  EXPECT_TRUE(IsAlias(records[1], records));
  EXPECT_FALSE(IsAlias(records[2], records)) << "no chair is on record there";
  EXPECT_FALSE(IsAlias(records[3], records)) << "of no category";
}

TEST(Alias, ANameIsKnownByItsOwnRecordsBeforeThoseOfItsCategory) {
  const std::vector<ObjectRecord> chairs = {RecordAt("chair", 0)};
  EXPECT_EQ(KnownAs(chairs, "armchair"), "chair");
  const std::vector<ObjectRecord> both = {RecordAt("chair", 0), RecordAt("armchair", 0)};
  EXPECT_EQ(KnownAs(both, "armchair"), "armchair");
  EXPECT_EQ(KnownAs(both, "chair"), "chair");
  EXPECT_EQ(KnownAs(both, "tv_monitor"), "tv monitor");
}

}  // namespace
}  // namespace crossnav::objects
