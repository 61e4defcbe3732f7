// SPDX-License-Identifier: MIT
#include "crossnav/inference/network.h"

#include <algorithm>
#include <cmath>

#include "inference/model_files.h"

namespace crossnav::inference::test {
namespace {

using crossnav::test::TempFolder;
using crossnav::test::WriteText;

const Signature kArithmetic{{{"a", {1, 3}}, {"b", {1, 3}}}, {{"sum", {1, 3}}, {"log", {-1, 3}}}};

std::string ErrorOf(const Result<Network>& network) {
  return network ? "no error" : network.error().Message();
}

class NetworkFile : public EachBackend {
 protected:
  static Result<Network> Open(const std::filesystem::path& path, const Signature& signature) {
    return Network::Open(path, signature, Options());
  }
};
CROSSNAV_FOR_EACH_BACKEND(NetworkFile);

TEST_P(NetworkFile, RunsWithNamedTensorsInTheOrderOfTheSignature) {
  auto network = Open(DataFile("arithmetic.onnx"), kArithmetic);
  ASSERT_TRUE(network) << network.error().Message();
  const Tensor inputs[] = {{"a", {1, 3}, {1, 2, 4}}, {"b", {1, 3}, {10, 20, 30}}};
  const auto out = network->Run(inputs);
  ASSERT_TRUE(out) << out.error().Message();
  ASSERT_EQ(out->size(), 2U);
  EXPECT_EQ((*out)[0].data, (std::vector<float>{21, 42, 64}));
  EXPECT_NEAR((*out)[1].data[2], std::log(4.0), 1e-6);

  const Signature turned{{kArithmetic.inputs[1], kArithmetic.inputs[0]}, {{"sum", {1, 3}}}};
  auto other = Open(DataFile("arithmetic.onnx"), turned);
  ASSERT_TRUE(other) << other.error().Message();
  const Tensor reversed[] = {inputs[1], inputs[0]};
  EXPECT_EQ((*other->Run(reversed))[0].data, (*out)[0].data);
}

TEST_P(NetworkFile, AnOutputThatIsNotFiniteIsAnErrorThatNamesTheNetwork) {
  auto network = Open(DataFile("arithmetic.onnx"), kArithmetic);
  ASSERT_TRUE(network);
  const Tensor inputs[] = {{"a", {1, 3}, {1, -2, 4}}, {"b", {1, 3}, {0, 0, 0}}};
  const auto out = network->Run(inputs);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().Message().find("arithmetic.onnx"), std::string::npos);
  EXPECT_NE(out.error().Message().find("\"log\" holds a number that is not finite"),
            std::string::npos);
}

TEST_P(NetworkFile, OtherPortsThanTheAdapterAsksForAreNamed) {
  const auto path = DataFile("arithmetic.onnx");
  Signature other = kArithmetic;
  other.outputs[0].name = "product";
  EXPECT_NE(ErrorOf(Open(path, other)).find("has no output \"product\"; it has sum 1x3"),
            std::string::npos);
  other = kArithmetic;
  other.inputs[0].shape = {1, 4};
  EXPECT_NE(ErrorOf(Open(path, other)).find("input \"a\" is 1x3, and its card asks for 1x4"),
            std::string::npos);
  other = kArithmetic;
  other.inputs.pop_back();
  EXPECT_NE(ErrorOf(Open(path, other)).find("has an input \"b\""), std::string::npos);
}

TEST_P(NetworkFile, AnotherKindOfFileIsOneLineThatNamesIt) {
  const TempFolder folder;
  const std::string whole = *ReadFile(DataFile("crossnav.onnx"));
  const auto check = [&](const std::string& content, const char* name) {
    const auto path = folder.path() / name;
    WriteText(path, content);
    const std::string error = ErrorOf(Open(path, kArithmetic));
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
  EXPECT_NE(ErrorOf(Open(folder.path() / "none.onnx", kArithmetic)).find("cannot be opened"),
            std::string::npos);
}

/// Of opening and running; both are one line.
std::string ErrorOfRun(Result<Network> network) {
  if (!network) return network.error().Message();
  const Tensor inputs[] = {{"a", {1, 3}, {1, 2, 4}}, {"b", {1, 3}, {10, 20, 30}}};
  const auto out = network->Run(inputs);
  return out ? "no error" : out.error().Message();
}

TEST_P(NetworkFile, AFileBeyondMemoryIsOneLineThatNamesIt) {
  const Signature any{kArithmetic.inputs, {{"sum", {-1, -1}}, {"log", {1, 3}}}};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "operator new of a sanitizer ends the process where others throw";
#endif
  for (const char* name : {"huge.onnx", "declared.onnx"}) {
    const std::string error = ErrorOfRun(Open(DataFile(name), any));
    EXPECT_EQ(error.rfind(DataFile(name).string() + ": ", 0), 0U) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  const TempFolder folder;
  const auto path = folder.path() / "large.onnx";
  WriteText(path, "x");
  std::filesystem::resize_file(path, std::uintmax_t{3} << 30);  // no bytes on the disk
  const std::string error = ErrorOf(Open(path, any));
  EXPECT_EQ(error.rfind(path.string() + ": ", 0), 0U) << error;
}

TEST_P(NetworkFile, AMissingProviderNamesTheSettingAndTheRemedy) {
  for (const Backend& backend : Backends())
    for (const char* provider : {"cpu", "cuda", "tensorrt"}) {
      if (backend.name != GetParam()) continue;
      const auto& all = backend.providers;
      const bool has_it = std::find(all.begin(), all.end(), provider) != all.end();
      SessionOptions options = Options();
      options.provider = provider;
      const auto network = Network::Open(DataFile("arithmetic.onnx"), kArithmetic, options);
      EXPECT_TRUE(has_it || !network) << provider;
      if (network) continue;  // the libraries of a provider may be missing
      const std::string error = ErrorOf(network);
      EXPECT_NE(options.provider, "cpu") << error;
      EXPECT_EQ(error.rfind("networks.provider: \"" + options.provider + "\"", 0), 0U) << error;
      EXPECT_NE(error.find("set networks.provider = cpu"), std::string::npos) << error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
}

TEST(Backend, AnUnknownBackendIsNamed) {
  SessionOptions options;
  options.backend = "abacus";
  const auto session = OpenSession("", options, "x.onnx");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().Message().find("no backend \"abacus\""), std::string::npos);
}

TEST(Backend, AMissingBackendNamesTheRemedy) {
  for (const Backend& backend : Backends()) {
    if (backend.is_available) {
      EXPECT_FALSE(backend.version.empty());
      EXPECT_EQ(backend.providers.empty() ? "" : backend.providers.front(), "cpu");
      continue;
    }
    SessionOptions options;
    options.backend = backend.name;
    const auto session = OpenSession("", options, "x.onnx");
    ASSERT_FALSE(session);
    EXPECT_EQ(session.error().Message(),
              "x.onnx: " + options.backend + " is not available; " + backend.get);
  }
}

TEST(Backend, WithoutALibraryTheErrorNamesTheRemedy) {
  if (HasBackend()) GTEST_SKIP() << "a library is available";
  const auto session = OpenSession("", {}, "x.onnx");
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().Message().find("scripts/setup.sh"), std::string::npos);
}

}  // namespace
}  // namespace crossnav::inference::test
