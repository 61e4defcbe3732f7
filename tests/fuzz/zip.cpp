// SPDX-License-Identifier: MIT
#include "crossnav/world/models/zip_reader.h"
#include "fuzz/harness.h"

FUZZ(zip, input) {
  const auto zip = crossnav::world::ZipReader::Parse(crossnav::fuzz::Text(input), "input.zip");
  if (!zip) return;
  for (const std::string& name : zip->Names()) (void)zip->Read(name);
}
