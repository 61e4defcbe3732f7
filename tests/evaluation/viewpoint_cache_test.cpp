// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/viewpoint_cache.h"

#include "evaluation/embedded_house_fixture.h"
#include "support/text_file.h"

namespace crossnav::evaluation {
namespace {

namespace fs = std::filesystem;

class ViewpointCache : public test::EmbeddedHouseTest {
 protected:
  std::vector<Target> Beds(const RunConfig& config = test::SmallConfig()) const {
    const auto context = SceneContext::Load(folder_->path(), scene_id_, config);
    EXPECT_TRUE(context) << context.error().Message();
    return context ? (*context)->TargetsOf("bed") : std::vector<Target>{};
  }
  static std::vector<fs::path> Files() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_->path())) {
      if (entry.path().extension() == ".viewpoints") files.push_back(entry.path());
    }
    return files;
  }
  void SetUp() override {
    for (const fs::path& file : Files()) fs::remove(file);
  }
  static void ExpectSame(const std::vector<Target>& a, const std::vector<Target>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_FALSE(a[i].viewpoints_world.empty());
      EXPECT_EQ(a[i].viewpoints_world, b[i].viewpoints_world);  // to the last bit
      EXPECT_EQ(a[i].floors, b[i].floors);
    }
  }
};

TEST_F(ViewpointCache, CachedViewpointsEqualComputedViewpoints) {
  const auto found = Beds();
  ASSERT_EQ(Files().size(), 1u);
  const auto written = fs::last_write_time(Files()[0]);
  ExpectSame(Beds(), found);
  EXPECT_EQ(fs::last_write_time(Files()[0]), written);
}

TEST_F(ViewpointCache, AnotherCameraHasViewpointsOfItsOwn) {
  Beds();
  RunConfig config = test::SmallConfig();
  config.agent.sensor.camera_height_m = 1.4;
  Beds(config);
  EXPECT_EQ(Files().size(), 2u);
}

TEST_F(ViewpointCache, DamagedFilesAreFoundAnew) {
  const auto found = Beds();
  const fs::path file = Files().at(0);
  const std::string good = crossnav::test::ReadText(file);
  std::string other_key = good;
  other_key.replace(other_key.find("\"key\":\"") + 7, 4, "zzzz");
  for (const std::string& bad : {std::string(), good.substr(0, good.size() / 2), std::string("[]"),
                                 other_key, std::string(R"({"key": 1})")}) {
    crossnav::test::WriteText(file, bad);
    ExpectSame(Beds(), found);
    EXPECT_EQ(crossnav::test::ReadText(file), good);
  }
}

}  // namespace
}  // namespace crossnav::evaluation
