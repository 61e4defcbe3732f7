// SPDX-License-Identifier: MIT
#include "crossnav/perception/named_vectors.h"

#include <sstream>
#include <utility>

#include "crossnav/core/category_table.h"
#include "crossnav/core/npy_file.h"
#include "crossnav/core/read_file.h"

namespace crossnav::perception {

Result<std::vector<std::string>> ReadNames(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  std::istringstream lines(*text);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);)
    if (!SpacedName(line).empty()) names.push_back(line);
  return names;
}

Result<NamedVectors> ReadNamedVectors(const std::vector<std::string>& names,
                                      const std::filesystem::path& rows) {
  auto vectors = ReadNpyRows(rows, names.size());
  if (!vectors) return tl::unexpected(vectors.error());
  NamedVectors out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out.emplace(SpacedName(names[i]), std::move((*vectors)[i]));
  return out;
}

Result<NamedVectors> ReadNamedVectors(const std::filesystem::path& names,
                                      const std::filesystem::path& rows) {
  const auto listed = ReadNames(names);
  if (!listed) return tl::unexpected(listed.error());
  return ReadNamedVectors(*listed, rows);
}

}  // namespace crossnav::perception
