// SPDX-License-Identifier: MIT
#include "crossnav/bench/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <vector>

namespace crossnav::bench {
namespace {

class WorkerPool : public testing::TestWithParam<int> {};

TEST_P(WorkerPool, DeliversInOrderWhateverTheNumberOfWorkers) {
  std::vector<std::string> delivered;
  PoolTask task;
  task.count = 20;
  task.jobs = GetParam();
  task.work = [](int item) -> Result<std::string> {
    if (item % 3 == 0) ::usleep(3000);  // later items are done before earlier ones
    return std::string(static_cast<std::size_t>(item) * 5000, 'x') + std::to_string(item);
  };
  task.deliver = [&](int item, const std::string& text) -> Result<void> {
    EXPECT_EQ(text.size(), static_cast<std::size_t>(item) * 5000 + std::to_string(item).size());
    delivered.push_back(std::to_string(item));
    return {};
  };
  ASSERT_TRUE(RunPool(task));
  ASSERT_EQ(delivered.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(delivered[static_cast<std::size_t>(i)], std::to_string(i));
}

TEST_P(WorkerPool, FailureOfOneItemDoesNotStopTheOthers) {
  int delivered = 0;
  PoolTask task;
  task.count = 6;
  task.jobs = GetParam();
  task.work = [](int item) -> Result<std::string> {
    if (item == 2) return Fail(ErrorCode::kMalformed, "what", "where");
    return std::string("fine");
  };
  task.deliver = [&](int, const std::string&) -> Result<void> {
    ++delivered;
    return {};
  };
  const auto ok = RunPool(task);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().code, ErrorCode::kMalformed);
  EXPECT_EQ(ok.error().Message(), "where: what");
  EXPECT_EQ(delivered, 5);
}

INSTANTIATE_TEST_SUITE_P(Jobs, WorkerPool, testing::Values(1, 2, 5, 40));

TEST(WorkerPoolProcesses, CrashTakesOnlyItsOwnItem) {
  int delivered = 0;
  PoolTask task;
  task.count = 8;
  task.jobs = 2;
  task.work = [](int item) -> Result<std::string> {
    if (item == 3) ::_exit(9);
    return std::string("fine");
  };
  task.deliver = [&](int, const std::string&) -> Result<void> {
    ++delivered;
    return {};
  };
  const auto ok = RunPool(task);
  ASSERT_FALSE(ok);
  EXPECT_NE(ok.error().what.find("worker process ended"), std::string::npos);
  EXPECT_EQ(delivered, 7);
}

TEST(WorkerPoolProcesses, NothingToDoIsFine) {
  PoolTask task;
  task.jobs = 4;
  EXPECT_TRUE(RunPool(task));
}

}  // namespace
}  // namespace crossnav::bench
