// SPDX-License-Identifier: MIT
#include "crossnav/inference/batcher.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "crossnav/core/camera.h"
#include "crossnav/inference/suite.h"
#include "inference/small_network.h"

namespace crossnav::inference::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kNever = 1h;  // a test that waits for it fails by its time

/// Doubles two numbers a frame; notes the size of each batch. Frames with a negative number fail.
class Doubling : public Session {
 public:
  explicit Doubling(std::vector<std::size_t>* batches) : batches_(batches) {}
  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }
  Result<std::vector<Tensor>> Run(std::span<const Tensor> inputs) override {
    EXPECT_FALSE(is_running_.exchange(true)) << "two threads in one session";
    Tensor out = inputs[0];
    out.name = "twice";
    batches_->push_back(out.data.size() / 2);
    for (float& x : out.data) x *= 2;
    is_running_ = false;
    if (std::any_of(out.data.begin(), out.data.end(), [](float x) { return x < 0; }))
      return Fail(ErrorCode::kInvalid, "the network failed", "x.onnx");
    if (loses_frames_) out.shape.front() = 1;
    return std::vector<Tensor>{out};
  }
  void LoseFrames() { loses_frames_ = true; }

 private:
  std::vector<Port> inputs_ = {{"x", {-1, 2}}}, outputs_ = {{"twice", {-1, 2}}};
  std::vector<std::size_t>* batches_;
  std::atomic<bool> is_running_ = false;
  bool loses_frames_ = false;
};

/// A batcher over the doubling network, and its agents.
struct Group {
  Group(int agents, const BatchOptions& options) {
    auto session = std::make_unique<Doubling>(&batches);
    doubling = session.get();
    batcher = std::make_shared<Batcher>(std::move(session), options, "x.onnx");
    for (int i = 0; i < agents; ++i) sessions.push_back(Batcher::Join(batcher));
  }
  /// Runs `work` with each agent's number in a thread of its own.
  void InThreads(const std::function<void(int agent)>& work) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < sessions.size(); ++i)
      threads.emplace_back([&work, i] { work(static_cast<int>(i)); });
    for (std::thread& thread : threads) thread.join();
  }
  Result<std::vector<Tensor>> Run(int agent, float x) {
    const Tensor input{"x", {1, 2}, {x, x + 1}};
    return sessions[static_cast<std::size_t>(agent)]->Run({&input, 1});
  }

  std::vector<std::size_t> batches;
  Doubling* doubling = nullptr;
  std::shared_ptr<Batcher> batcher;
  std::vector<std::unique_ptr<Session>> sessions;
};

TEST(Batcher, ALoneAgentDoesNotWait) {
  Group group(1, {8, kNever});
  EXPECT_EQ(group.sessions[0]->inputs()[0].shape, (Shape{1, 2}));
  EXPECT_EQ(group.sessions[0]->outputs()[0].shape, (Shape{1, 2}));
  const auto out = group.Run(0, 3);
  ASSERT_TRUE(out) << out.error().Message();
  EXPECT_EQ(out->at(0).name, "twice");
  EXPECT_EQ(out->at(0).shape, (Shape{1, 2}));
  EXPECT_EQ(out->at(0).data, (std::vector<float>{6, 8}));
}

TEST(Batcher, FramesOfAllAgentsRunTogetherAndEachAgentGetsItsOwn) {
  constexpr int kAgents = 5, kFrames = 40;
  Group group(kAgents, {8, kNever});
  group.InThreads([&](int agent) {
    for (int frame = 0; frame < kFrames; ++frame) {
      const auto x = static_cast<float>(100 * frame + agent);
      const auto out = group.Run(agent, x);
      ASSERT_TRUE(out);
      EXPECT_EQ(out->at(0).data, (std::vector<float>{2 * x, 2 * x + 2}));
    }
  });
  EXPECT_EQ(group.batches, std::vector<std::size_t>(kFrames, kAgents));
}

TEST(Batcher, ABatchHasAtMostTheSettingsFrames) {
  constexpr int kAgents = 6, kFrames = 30;
  Group group(kAgents, {2, kNever});
  group.InThreads([&](int agent) {
    for (int frame = 0; frame < kFrames; ++frame) {
      const auto x = static_cast<float>(frame + 1000 * agent);
      EXPECT_EQ(group.Run(agent, x)->at(0).data[0], 2 * x);
    }
    group.sessions[static_cast<std::size_t>(agent)].reset();  // the slowest may end alone
  });
  std::size_t frames = 0;
  for (const std::size_t batch : group.batches) {
    EXPECT_LE(batch, 2U);
    frames += batch;
  }
  EXPECT_EQ(frames, static_cast<std::size_t>(kAgents) * kFrames);
  EXPECT_GE(std::count(group.batches.begin(), group.batches.end(), 2U), kFrames);
}

TEST(Batcher, AFrameWaitsNoLongerThanTheLimit) {
  Group group(2, {8, 1ms});  // the other agent never runs
  const auto start = std::chrono::steady_clock::now();
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(group.Run(0, 1));
  const auto time = std::chrono::steady_clock::now() - start;
  EXPECT_GE(time, 20ms);
  EXPECT_LT(time, 10s);
  EXPECT_EQ(group.batches, std::vector<std::size_t>(20, 1));
}

TEST(Batcher, AnAgentThatEndsIsNotWaitedFor) {
  Group group(3, {8, kNever});
  group.InThreads([&](int agent) {
    for (int frame = 0; frame < 10 * (agent + 1); ++frame) ASSERT_TRUE(group.Run(agent, 1));
    group.sessions[static_cast<std::size_t>(agent)].reset();
  });
  EXPECT_EQ(group.batches.size(), 30U);
  EXPECT_EQ(std::count(group.batches.begin(), group.batches.end(), 3U), 10);
  EXPECT_EQ(std::count(group.batches.begin(), group.batches.end(), 1U), 10);
}

TEST(Batcher, AnErrorReachesEveryFrameOfItsBatchAndTheNextBatchRuns) {
  constexpr int kAgents = 4;
  Group group(kAgents, {8, kNever});
  group.InThreads([&](int agent) {
    const auto bad = group.Run(agent, agent == 2 ? -5.0F : 5.0F);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().Message(), "x.onnx: the network failed");
    EXPECT_TRUE(group.Run(agent, 5));
  });
}

TEST(Batcher, AnotherNumberOfFramesIsAnErrorThatNamesTheOutput) {
  Group group(2, {8, kNever});
  group.doubling->LoseFrames();
  group.InThreads([&](int agent) {
    const auto out = group.Run(agent, 1);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().Message(), "x.onnx: output \"twice\" came as 1x2 for 2 frames");
  });
}

class SharedNetwork : public EachBackend {};
CROSSNAV_FOR_EACH_BACKEND(SharedNetwork);

TEST_P(SharedNetwork, AFileWithAFixedNumberOfFramesIsOpenedForEachAgent) {
  SharedNetworks shared({4, kNever});
  const std::string onnx = *ReadFile(DataFile("arithmetic.onnx"));
  SessionOptions options = Options();
  options.shapes = {{"a", {1, 3}}, {"b", {1, 3}}};
  std::vector<std::unique_ptr<Session>> sessions;
  for (int i = 0; i < 2; ++i) {
    auto session = shared.Open(onnx, options, "arithmetic.onnx");
    ASSERT_TRUE(session) << session.error().Message();
    sessions.push_back(std::move(*session));
  }
  std::vector<Tensor> inputs;  // one agent alone: a batch would wait for the other
  for (const Port& port : sessions[0]->inputs()) inputs.push_back({port.name, {1, 3}, {1, 2, 4}});
  EXPECT_TRUE(sessions[0]->Run(inputs));
}

TEST_P(SharedNetwork, AnErrorAtOpeningIsAsWithoutBatches) {
  SharedNetworks shared({4, kNever});
  for (int i = 0; i < 2; ++i) {
    const auto session = shared.Open("no network", Options(), "x.onnx");
    ASSERT_FALSE(session);
    EXPECT_EQ(session.error().Message(),
              OpenSession("no network", Options(), "x.onnx").error().Message());
  }
}

/// Another picture for each agent and frame: a red and a blue cell among grey ones.
Observation PictureOf(int agent, int frame) {
  Observation obs;
  obs.camera = IntrinsicsFromHfov(64, 64, DegToRad(90));
  obs.depth_m = DepthImage(64, 64, 1.0F + 0.1F * static_cast<float>(frame));
  obs.T_world_camera = CameraPose({}, 0.88);
  obs.rgb = RgbImage(64, 64, Rgb8{40, static_cast<std::uint8_t>(30 + agent), 50});
  for (int v = 0; v < 8; ++v)
    for (int u = 0; u < 8; ++u) {
      obs.rgb.At(8 * agent + u, v) = {255, 0, 0};
      obs.rgb.At(8 * frame + u, 32 + v) = {0, 0, 255};
    }
  return obs;
}

TEST_P(SharedNetwork, SuitesInThreadsSeeTheSameAsOneSuiteAlone) {
  constexpr int kAgents = 4, kFrames = 6;
  const crossnav::test::TempFolder folder;
  NetworksConfig config = WriteSmallNetwork(folder.path(), "crossnav_frames.onnx");
  config.backend = GetParam();
  auto single = NetworkSet::Read(config, folder.path());
  ASSERT_TRUE(single) << single.error().Message();
  auto alone = single->MakeSuite(0.88);
  ASSERT_TRUE(alone) << alone.error().Message();
  config.batch = kAgents;
  auto set = NetworkSet::Read(config, folder.path());
  std::vector<perception::PerceptionSuite> suites;
  for (int i = 0; i < kAgents; ++i) suites.push_back(std::move(set->MakeSuite(0.88).value()));
  std::vector<std::vector<perception::Percept>> seen(kAgents);
  std::vector<std::thread> threads;
  for (int agent = 0; agent < kAgents; ++agent)
    threads.emplace_back([&, agent] {
      const auto at = static_cast<std::size_t>(agent);
      for (int frame = 0; frame < kFrames; ++frame)
        seen[at].push_back(suites[at].Look(PictureOf(agent, frame), "chair").value());
    });
  for (std::thread& thread : threads) thread.join();
  for (int agent = 0; agent < kAgents; ++agent)
    for (int frame = 0; frame < kFrames; ++frame) {
      const auto wanted = alone->Look(PictureOf(agent, frame), "chair").value();
      const auto& is = seen[static_cast<std::size_t>(agent)][static_cast<std::size_t>(frame)];
      ASSERT_EQ(is.detections.size(), 1U);
      ASSERT_EQ(wanted.detections.size(), 1U);
      EXPECT_EQ(is.detections[0].box.u0, wanted.detections[0].box.u0);
      EXPECT_EQ(is.detections[0].mask.data, wanted.detections[0].mask.data);
      ASSERT_EQ(is.features.data.size(), wanted.features.data.size());
      for (std::size_t i = 0; i < wanted.features.data.size(); ++i)
        EXPECT_NEAR(is.features.data[i], wanted.features.data[i], 1e-6);
    }
}

}  // namespace
}  // namespace crossnav::inference::test
