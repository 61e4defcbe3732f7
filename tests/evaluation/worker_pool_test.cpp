// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "crossnav/evaluation/running/item_queue.h"
#include "evaluation/processes.h"

namespace crossnav::evaluation {
namespace {

/// A task whose answers end in `answers`.
PoolTask Collect(int count, int jobs, std::map<int, ItemAnswer>& answers) {
  PoolTask task;
  task.count = count;
  task.jobs = jobs;
  task.deliver = [&](int item, ItemAnswer answer) -> Result<void> {
    EXPECT_TRUE(answers.emplace(item, std::move(answer)).second) << item;
    return {};
  };
  return task;
}

class WorkerPool : public testing::TestWithParam<int> {};

TEST_P(WorkerPool, DeliversEveryItemOnceWithItsOwnText) {
  std::map<int, ItemAnswer> answers;
  PoolTask task = Collect(20, GetParam(), answers);
  task.work = [](int item) -> Result<std::string> {
    return std::string(static_cast<std::size_t>(item) * 5000, 'x') + std::to_string(item);
  };
  ASSERT_TRUE(RunPool(task));
  ASSERT_EQ(answers.size(), 20u);
  for (const auto& [item, answer] : answers) {
    EXPECT_EQ(answer.end, ItemEnd::kDone);
    EXPECT_EQ(answer.text.size(), static_cast<std::size_t>(item) * 5000 + (item < 10 ? 1 : 2));
  }
}

TEST_P(WorkerPool, ErrorsAndExceptionsAreAnswersAndStopNothing) {
  std::map<int, ItemAnswer> answers;
  PoolTask task = Collect(6, GetParam(), answers);
  task.work = [](int item) -> Result<std::string> {
    if (item == 2) return Fail(ErrorCode::kMalformed, "what", "where");
    if (item == 4) throw std::runtime_error("thrown");
    return std::string("fine");
  };
  ASSERT_TRUE(RunPool(task));
  ASSERT_EQ(answers.size(), 6u);
  EXPECT_EQ(answers[2].end, ItemEnd::kError);
  EXPECT_EQ(answers[2].error.code, ErrorCode::kMalformed);
  EXPECT_EQ(answers[2].error.Message(), "where: what");
  EXPECT_EQ(answers[4].end, ItemEnd::kError);
  EXPECT_NE(answers[4].error.what.find("thrown"), std::string::npos);
  EXPECT_EQ(answers[5].text, "fine");
}

TEST_P(WorkerPool, CrashTakesOnlyItsOwnItem) {
  std::map<int, ItemAnswer> answers;
  PoolTask task = Collect(8, GetParam(), answers);
  task.work = [](int item) -> Result<std::string> {
    if (item == 3) ::_exit(9);
    if (item == 5) ::raise(SIGKILL);  // as the kernel does where memory is short
    return std::string("fine");
  };
  ASSERT_TRUE(RunPool(task));
  ASSERT_EQ(answers.size(), 8u);
  for (const auto& [item, answer] : answers) {
    EXPECT_EQ(answer.end, item == 3 || item == 5 ? ItemEnd::kCrash : ItemEnd::kDone) << item;
  }
  EXPECT_NE(answers[3].error.what.find("exit status 9"), std::string::npos);
  EXPECT_NE(answers[5].error.what.find("signal 9"), std::string::npos);
}

TEST_P(WorkerPool, ABusyAndAWaitingItemAreKilledWhenTheirTimeIsOver) {
  std::map<int, ItemAnswer> answers;
  PoolTask task = Collect(6, GetParam(), answers);
  task.item_seconds = 0.3;
  task.work = [](int item) -> Result<std::string> {
    volatile int spin = 0;
    while (item == 1) spin = spin + 1;
    while (item == 4) ::pause();
    return std::string("fine");
  };
  ASSERT_TRUE(RunPool(task));
  ASSERT_EQ(answers.size(), 6u);
  for (const auto& [item, answer] : answers) {
    EXPECT_EQ(answer.end, item == 1 || item == 4 ? ItemEnd::kTime : ItemEnd::kDone) << item;
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, WorkerPool, testing::Values(1, 2, 5, 40));

TEST(WorkerPoolProcesses, SlowItemHoldsBackNoOther) {
  std::vector<int> order;
  PoolTask task;
  task.count = 4;
  task.jobs = 2;
  int go[2];
  ASSERT_EQ(::pipe(go), 0);
  task.work = [&](int item) -> Result<std::string> {
    char byte = 0;
    if (item == 0 && ::read(go[0], &byte, 1) != 1) return Fail(ErrorCode::kIo, "no byte");
    return std::string("fine");
  };
  task.deliver = [&](int item, const ItemAnswer& answer) -> Result<void> {
    EXPECT_EQ(answer.end, ItemEnd::kDone);
    order.push_back(item);
    if (order.size() == 3) {
      EXPECT_EQ(::write(go[1], "x", 1), 1);  // only now item 0 continues
    }
    return {};
  };
  ASSERT_TRUE(RunPool(task));
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3, 0}));
  ::close(go[0]);
  ::close(go[1]);
}

TEST(WorkerPoolProcesses, FailingDeliveryStopsAtOnceAndLeavesNoProcess) {
  test::PidFolder pids;
  PoolTask task;
  task.count = 100;
  task.jobs = 3;
  task.work = [&](int item) -> Result<std::string> {
    pids.Add();
    while (item > 0) ::pause();
    return std::string("fine");
  };
  int delivered = 0;
  task.deliver = [&](int, const ItemAnswer&) -> Result<void> {
    ++delivered;
    return Fail(ErrorCode::kIo, "disk full", "file");
  };
  const auto ok = RunPool(task);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().Message(), "file: disk full");
  EXPECT_EQ(delivered, 1);
  EXPECT_TRUE(pids.AreAllGone(1.0));
}

TEST(WorkerPoolProcesses, NothingToDoIsFine) {
  PoolTask task;
  task.jobs = 4;
  EXPECT_TRUE(RunPool(task));
}

TEST(ItemQueue, AWorkerKeepsItsGroupAndIdleWorkersJoinTheLargestGroup) {
  //                   0  1  2  3  4  5  6
  ItemQueue queue(7, {8, 8, 9, 8, 8, 9, 9});
  EXPECT_EQ(queue.Take(-1), 0);  // first worker: group 8
  EXPECT_EQ(queue.Take(-1), 2);  // second worker: the free group
  EXPECT_EQ(queue.Take(0), 1);
  EXPECT_EQ(queue.Take(2), 5);
  EXPECT_EQ(queue.Take(5), 6);
  EXPECT_EQ(queue.Take(6), 3);  // group 9 is done, group 8 is not
  EXPECT_EQ(queue.Take(1), 4);
  EXPECT_EQ(queue.Take(4), -1);
}

}  // namespace
}  // namespace crossnav::evaluation
