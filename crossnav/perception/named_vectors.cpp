// SPDX-License-Identifier: MIT
#include "crossnav/perception/named_vectors.h"

#include <sstream>
#include <utility>

#include "crossnav/core/category_table.h"
#include "crossnav/core/npy_file.h"
#include "crossnav/core/read_file.h"

namespace crossnav::perception {

Result<NamedVectors> ReadNamedVectors(const std::filesystem::path& names,
                                      const std::filesystem::path& rows) {
  const auto text = ReadFile(names);
  if (!text) return tl::unexpected(text.error());
  std::istringstream lines(*text);
  std::vector<std::string> spaced;
  for (std::string line; std::getline(lines, line);)
    if (!SpacedName(line).empty()) spaced.push_back(SpacedName(line));
  auto vectors = ReadNpyRows(rows, spaced.size());
  if (!vectors) return tl::unexpected(vectors.error());
  NamedVectors out;
  for (std::size_t i = 0; i < spaced.size(); ++i) out.emplace(spaced[i], std::move((*vectors)[i]));
  return out;
}

}  // namespace crossnav::perception
