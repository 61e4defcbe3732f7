// SPDX-License-Identifier: MIT
#include "crossnav/store/block_codec.h"
#include "crossnav/store/object_table.h"
#include "fuzz/harness.h"

// Behind the checksums of a map file, which random bytes do not pass.
FUZZ(map_block, input) {
  using namespace crossnav;
  if (const auto block = store::DecodeMapBlock({1, -2, 0}, input))
    (void)geometry::ImportBlocks({*block}, {});
  (void)store::DecodeFeatureBlock({1, -2, 0}, 4, input);
  if (const auto record = store::DecodeObject(input)) (void)store::EncodeObject(*record);
  (void)store::Decompress(input, store::kMaxMapBlockBytes);
}
