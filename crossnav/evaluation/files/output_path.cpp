// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/files/output_path.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "crossnav/core/write_file.h"

namespace crossnav::evaluation {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> Refuse(const fs::path& path, const std::string& option,
                             const std::string& reason) {
  return Fail(ErrorCode::kIo, option + ": cannot be written (" + reason + "); choose another path",
              path.string());
}

/// Creates the missing part of `folder`; `created` receives the new folders, deepest first.
std::error_code MakeFolder(const fs::path& folder, std::vector<fs::path>& created) {
  std::error_code error;
  fs::path at = fs::absolute(folder, error).lexically_normal();
  if (!at.has_filename()) at = at.parent_path();
  while (!error && !fs::exists(at, error) && at != at.parent_path()) {
    created.push_back(at);
    at = at.parent_path();
  }
  error.clear();
  fs::create_directories(folder, error);
  return error;
}

/// Creates and removes an empty file; returns the errno of a failure, or 0.
int TryFile(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) return errno;
  ::close(descriptor);
  ::unlink(file.c_str());
  return 0;
}

/// Empty if `name` can be created in `folder`. Removes only folders that it made and that are still
/// empty: another process may use them by now. Retries once if another process removed them.
std::string TryIn(const fs::path& folder, const std::string& name) {
  const std::string file = name + ".try" + std::to_string(::getpid());
  int failure = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    std::vector<fs::path> created;
    if (const auto error = MakeFolder(folder, created)) return error.message();
    failure = TryFile(folder / file);
    for (const fs::path& made : created) ::rmdir(made.c_str());
    if (failure != ENOENT) break;
  }
  return failure == 0 ? std::string() : std::strerror(failure);
}

}  // namespace

Result<void> CheckOutputFile(const fs::path& path, const std::string& option) {
  if (path.empty()) return {};
  if (!path.has_filename()) return Refuse(path, option, "it is a folder");
  const auto place = OutputPlace(path);
  if (!place) {
    return Fail(place.error().code, option + ": " + place.error().what + "; choose another path",
                place.error().where);
  }
  std::error_code ignored;
  const fs::path folder = place->has_parent_path() ? place->parent_path() : fs::path(".");
  std::string reason = TryIn(folder, place->filename().string());
  if (reason.empty() && fs::is_regular_file(*place, ignored) &&
      ::access(place->c_str(), W_OK) != 0) {
    reason = std::strerror(errno);
  }
  if (!reason.empty()) return Refuse(path, option, reason);
  return {};
}

Result<void> CheckOutputFolder(const fs::path& folder, const std::string& option) {
  if (folder.empty()) return {};
  const std::string reason = TryIn(folder, "crossnav");
  if (!reason.empty()) return Refuse(folder, option, reason);
  return {};
}

Result<void> CheckNotInput(const fs::path& path, const std::string& option, const fs::path& input) {
  std::error_code ignored;
  if (path.empty() || !fs::equivalent(path, input, ignored)) return {};
  return Fail(ErrorCode::kInvalid, option + ": is the input itself; choose another path",
              path.string());
}

Result<void> CheckNoneTwice(const std::vector<fs::path>& inputs) {
  std::error_code ignored;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!fs::equivalent(inputs[i], inputs[k], ignored)) continue;
      return Fail(ErrorCode::kInvalid,
                  "is given twice (also as " + inputs[k].string() + "); name it once",
                  inputs[i].string());
    }
  }
  return {};
}

}  // namespace crossnav::evaluation
