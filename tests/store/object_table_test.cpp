// SPDX-License-Identifier: MIT
// Records of objects in the map file: there and back, cut short, damaged.
#include "crossnav/store/object_table.h"

#include <gtest/gtest.h>

#include "crossnav/objects/object_book.h"
#include "crossnav/store/map_file.h"
#include "store/change_file.h"
#include "store/small_world.h"

namespace crossnav::store {
namespace {

using objects::ObjectRecord;
using testing::Change;
using testing::SmallWorld;
using testing::TempFile;

ObjectRecord Plant() {
  ObjectRecord record;
  record.id = 4;
  record.category = "potted plant";
  record.voxels = {{-3, 0, 4}, {-3, 1, 4}, {7, 2, 5}};
  Measure(record, 0.1);
  record.floor = 1;
  record.room = 6;
  record.views = 12;
  record.first_seen_step = 3;
  record.last_seen_step = 99;
  record.first_seen_day = 0;
  record.last_seen_day = 2;
  record.confidence = 0.875;
  record.colour = {20, 130, 40};
  record.picture_png = {1, 2, 3, 4, 5};
  return record;
}

ObjectRecord Bare() {
  ObjectRecord record;
  record.id = 9;
  record.category = "bed";
  record.voxels = {{0, 0, 0}};
  Measure(record, 0.1);
  return record;
}

TEST(ObjectTable, RecordsAreLoadedAsTheyWereSaved) {
  const TempFile file("objects.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info;
  info.objects = {Plant(), Bare()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_EQ(loaded->objects, info.objects);
}

TEST(ObjectTable, TheNextSaveReplacesThem) {
  const TempFile file("objects2.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info;
  info.objects = {Plant(), Bare()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  info.objects = {Bare()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  EXPECT_EQ(LoadMemory(file.path())->objects, info.objects);
  info.objects.clear();
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  EXPECT_TRUE(LoadMemory(file.path())->objects.empty());
}

TEST(ObjectTable, FilesOfBeforeHaveNone) {
  const TempFile file("old.map");
  SmallWorld world;
  world.AddFrame(0);
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, {}));
  Change(file.path(), "DROP TABLE IF EXISTS object");
  const auto loaded = LoadMemory(file.path());
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_TRUE(loaded->objects.empty());
  EXPECT_TRUE(loaded->damaged.empty());
}

TEST(ObjectTable, ADamagedRecordIsNamedAndTheOthersLoadOnRequest) {
  const TempFile file("damaged.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info;
  info.objects = {Plant(), Bare()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  Change(file.path(), "UPDATE object SET data = x'00010203' WHERE id = 0");
  const auto refused = LoadMemory(file.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("object 0"), std::string::npos) << refused.error().what;
  LoadOptions options;
  options.skip_damaged = true;
  const auto loaded = LoadMemory(file.path(), options);
  ASSERT_TRUE(loaded) << loaded.error().Message();
  EXPECT_EQ(loaded->objects, std::vector<ObjectRecord>{Bare()});
}

TEST(ObjectTable, ARecordInAnotherRowIsDamage) {
  const TempFile file("swapped.map");
  SmallWorld world;
  world.AddFrame(0);
  SaveInfo info;
  info.objects = {Plant(), Bare()};
  ASSERT_TRUE(SaveMemory(file.path(), world.map, world.memory, info));
  Change(file.path(), "UPDATE object SET id = 5 WHERE id = 1");
  EXPECT_FALSE(LoadMemory(file.path()));
}

TEST(ObjectTable, BytesThatAreCutShortAreNoRecord) {
  const Bytes bytes = EncodeObject(Plant());
  EXPECT_EQ(DecodeObject(bytes), Plant());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(DecodeObject(ByteView(bytes).first(size))) << size;
}

TEST(ObjectTable, AnyFlippedByteIsARecordOrNone) {
  const Bytes bytes = EncodeObject(Plant());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    Bytes other = bytes;
    other[i] ^= 0xff;
    if (const auto record = DecodeObject(other)) {
      EXPECT_GE(record->confidence, 0);
      EXPECT_LE(record->confidence, 1);
      EXPECT_FALSE(record->category.empty());
    }
  }
}

TEST(ObjectTable, NumbersThatAreNoneAreRefused) {
  ObjectRecord record = Plant();
  record.confidence = 1.5;
  EXPECT_FALSE(DecodeObject(EncodeObject(record)));
  record = Plant();
  record.centre_world_m.x() = std::nan("");
  EXPECT_FALSE(DecodeObject(EncodeObject(record)));
  record = Plant();
  std::swap(record.voxels[0], record.voxels[2]);
  EXPECT_FALSE(DecodeObject(EncodeObject(record)));
  record = Plant();
  record.category.clear();
  EXPECT_FALSE(DecodeObject(EncodeObject(record)));
}

}  // namespace
}  // namespace crossnav::store
