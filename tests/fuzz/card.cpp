// SPDX-License-Identifier: MIT
#include "crossnav/networks/model_card.h"
#include "fuzz/harness.h"

FUZZ(card, input) {
  (void)crossnav::networks::ReadModelCard(crossnav::fuzz::FileWith("network.toml", input));
}
