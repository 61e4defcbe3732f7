// SPDX-License-Identifier: MIT
#include "crossnav/inference/model_card.h"
#include "fuzz/harness.h"

FUZZ(card, input) {
  (void)crossnav::inference::ReadModelCard(crossnav::fuzz::FileWith("network.toml", input));
}
