// SPDX-License-Identifier: MIT
#include "crossnav/networks/network.h"

#include <cmath>

#include "networks/model_files.h"

namespace crossnav::networks::test {
namespace {

using crossnav::test::TempFolder;
using crossnav::test::WriteText;

const Signature kArithmetic{{{"a", {1, 3}}, {"b", {1, 3}}}, {{"sum", {1, 3}}, {"log", {-1, 3}}}};

std::string ErrorOf(const Result<Network>& network) {
  return network ? "no error" : network.error().Message();
}

class NetworkFile : public WithBackend {};

TEST_F(NetworkFile, RunsWithNamedTensorsInTheOrderOfTheSignature) {
  auto network = Network::Open(DataFile("arithmetic.onnx"), kArithmetic);
  ASSERT_TRUE(network) << network.error().Message();
  const Tensor inputs[] = {{"a", {1, 3}, {1, 2, 4}}, {"b", {1, 3}, {10, 20, 30}}};
  const auto out = network->Run(inputs);
  ASSERT_TRUE(out) << out.error().Message();
  ASSERT_EQ(out->size(), 2U);
  EXPECT_EQ((*out)[0].data, (std::vector<float>{21, 42, 64}));
  EXPECT_NEAR((*out)[1].data[2], std::log(4.0), 1e-6);

  const Signature turned{{kArithmetic.inputs[1], kArithmetic.inputs[0]}, {{"sum", {1, 3}}}};
  auto other = Network::Open(DataFile("arithmetic.onnx"), turned);
  ASSERT_TRUE(other) << other.error().Message();
  const Tensor reversed[] = {inputs[1], inputs[0]};
  EXPECT_EQ((*other->Run(reversed))[0].data, (*out)[0].data);
}

TEST_F(NetworkFile, AnOutputThatIsNotFiniteIsAnErrorThatNamesTheNetwork) {
  auto network = Network::Open(DataFile("arithmetic.onnx"), kArithmetic);
  ASSERT_TRUE(network);
  const Tensor inputs[] = {{"a", {1, 3}, {1, -2, 4}}, {"b", {1, 3}, {0, 0, 0}}};
  const auto out = network->Run(inputs);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().Message().find("arithmetic.onnx"), std::string::npos);
  EXPECT_NE(out.error().Message().find("\"log\" holds a number that is not finite"),
            std::string::npos);
}

TEST_F(NetworkFile, OtherPortsThanTheAdapterAsksForAreNamed) {
  const auto path = DataFile("arithmetic.onnx");
  Signature other = kArithmetic;
  other.outputs[0].name = "product";
  EXPECT_NE(ErrorOf(Network::Open(path, other)).find("has no output \"product\"; it has sum 1x3"),
            std::string::npos);
  other = kArithmetic;
  other.inputs[0].shape = {1, 4};
  EXPECT_NE(
      ErrorOf(Network::Open(path, other)).find("input \"a\" is 1x3, and its card asks for 1x4"),
      std::string::npos);
  other = kArithmetic;
  other.inputs.pop_back();
  EXPECT_NE(ErrorOf(Network::Open(path, other)).find("has an input \"b\""), std::string::npos);
}

TEST_F(NetworkFile, WhatIsNoNetworkIsOneLineThatNamesTheFile) {
  const TempFolder folder;
  const std::string whole = *ReadFile(DataFile("crossnav.onnx"));
  const auto check = [&](const std::string& content, const char* name) {
    const auto path = folder.path() / name;
    WriteText(path, content);
    const std::string error = ErrorOf(Network::Open(path, kArithmetic));
    EXPECT_EQ(error.rfind(path.string() + ": ", 0), 0U) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  check("", "empty.onnx");
  check("this is no network", "text.onnx");
  check(std::string(5000, '\0'), "zeros.onnx");
  for (std::size_t size = 1; size < whole.size(); size += 97)
    check(whole.substr(0, size), "truncated.onnx");
  for (std::size_t at = 5; at < whole.size(); at += 131) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    check(damaged, "damaged.onnx");  // at best it has other ports
  }
  EXPECT_NE(
      ErrorOf(Network::Open(folder.path() / "none.onnx", kArithmetic)).find("cannot be opened"),
      std::string::npos);
}

TEST(Backend, AnUnknownOneIsNamed) {
  SessionOptions options;
  options.backend = "abacus";
  const auto session = OpenSession("", options, "x.onnx");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().Message().find("no backend \"abacus\""), std::string::npos);
}

TEST(Backend, WithoutALibraryTheErrorSaysHowToHaveOne) {
  if (HasBackend()) GTEST_SKIP() << "a library is built in";
  const auto session = OpenSession("", {}, "x.onnx");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().Message().find("scripts/setup.sh"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::networks::test
