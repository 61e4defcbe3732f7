// SPDX-License-Identifier: MIT
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/graph_note.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/sight.h"
#include "fuzz/harness.h"

FUZZ(trace_json, input) {
  const std::string text = crossnav::fuzz::Text(input);
  if (const auto step = crossnav::trace::StepTraceFromJson(text))
    (void)crossnav::trace::ToJson(*step);
  (void)crossnav::trace::ReplayInfoFromJson(text);
  (void)crossnav::trace::StageResultFromJson(text);
  (void)crossnav::trace::SightNoteFromJson(text);
  if (const auto graph = crossnav::trace::GraphNoteFromJson(text))
    (void)crossnav::trace::ToJson(*graph);
}
