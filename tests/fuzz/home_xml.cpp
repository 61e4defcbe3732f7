// SPDX-License-Identifier: MIT
#include "crossnav/homes/home_xml.h"
#include "crossnav/homes/contents.h"
#include "crossnav/homes/home_builder.h"
#include "fuzz/harness.h"

FUZZ(home_xml, input) {
  using namespace crossnav;
  auto plan = homes::ParseHomeXml(fuzz::Text(input), "Home.xml");
  if (!plan) return;
  const std::string nothing("PK\5\6\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(nothing.data());
  const auto contents = homes::Contents::Open(fuzz::FileWith("none.sh3d", {bytes, 22}));
  homes::ModelStore models(*contents);
  (void)homes::BuildHome(*plan, models, {}, plan->notes);
}
