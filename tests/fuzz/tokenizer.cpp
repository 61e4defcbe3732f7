// SPDX-License-Identifier: MIT
#include "crossnav/inference/tokenizer.h"
#include "fuzz/harness.h"

FUZZ(tokenizer, input) {
  using namespace crossnav;
  const auto file = fuzz::FileWith("vocabulary.txt", input);
  const std::string text = fuzz::Text(input.subspan(0, std::min<std::size_t>(input.size(), 200)));
  if (const auto clip = inference::ReadClipTokenizer(file)) (void)(*clip)->Encode(text, 77);
  if (const auto words = inference::ReadWordPieceTokenizer(file)) (void)(*words)->Encode(text, 77);
}
