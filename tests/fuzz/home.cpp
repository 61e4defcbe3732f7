// SPDX-License-Identifier: MIT
#include "crossnav/homes/contents.h"
#include "crossnav/homes/home_builder.h"
#include "crossnav/homes/home_xml.h"
#include "crossnav/homes/scene_import.h"
#include "fuzz/harness.h"

// A .sh3d from the archive to the triangles; its navmesh is not built.
FUZZ(home, input) {
  using namespace crossnav::homes;
  const auto contents = Contents::Open(crossnav::fuzz::FileWith("home.sh3d", input));
  if (!contents) return;
  const auto xml = contents->HomeXml("");
  if (!xml) return;
  auto plan = ParseHomeXml(xml->text, "home.sh3d");
  if (!plan) return;
  ModelStore models(*contents);
  (void)BuildHome(*plan, models, {}, plan->notes);
}
