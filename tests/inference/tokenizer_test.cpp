// SPDX-License-Identifier: MIT
// Tokenizers against transformers' tokenizers, on 1,000 texts of all scripts (make_tokens.py).
#include "crossnav/inference/tokenizer.h"

#include <zlib.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "crossnav/inference/unicode.h"
#include "inference/model_files.h"
#include "support/places.h"

namespace crossnav::inference::test {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kAll = 4096;  // long enough for every text

struct Row {
  std::string text;
  std::array<std::vector<std::int32_t>, 4> numbers;
};

std::string Unescaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      out += text[i];
      continue;
    }
    const char c = text[++i];
    out += c == 't' ? '\t' : c == 'n' ? '\n' : c == 'r' ? '\r' : c;
  }
  return out;
}

std::vector<Row> Rows() {
  std::vector<Row> rows;
  std::ifstream file(DataFile("tokens/tokens.tsv"));
  for (std::string line; std::getline(file, line);) {
    std::istringstream columns(line);
    Row row;
    std::string column;
    std::getline(columns, column, '\t');
    row.text = Unescaped(column);
    for (auto& numbers : row.numbers) {
      std::getline(columns, column, '\t');
      std::istringstream words(column);
      for (std::int32_t id = 0; words >> id;) numbers.push_back(id);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void ExpectEqual(const Tokenizer& tokenizer, std::size_t column) {
  const auto rows = Rows();
  ASSERT_EQ(rows.size(), 1000U);
  int wrong = 0;
  for (const Row& row : rows) {
    if (tokenizer.Encode(row.text, kAll) == row.numbers[column]) continue;
    if (++wrong <= 5) ADD_FAILURE() << row.text;
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Tokenizers, BytePairsEqualTransformers) {
  const auto tokenizer = ReadClipTokenizer(DataFile("tokens/merges.txt"));
  ASSERT_TRUE(tokenizer) << tokenizer.error().Message();
  ExpectEqual(**tokenizer, 0);
}

TEST(Tokenizers, ClipsOwnVocabularyToo) {
  const fs::path packed = crossnav::test::SharedPath("data/clip/bpe_simple_vocab_16e6.txt.gz");
  if (!fs::exists(packed)) GTEST_SKIP() << packed << " is not here";
  const crossnav::test::TempFolder folder;
  const fs::path merges = folder.path() / "merges.txt";
  std::string text(1 << 23, '\0');
  gzFile in = gzopen(packed.c_str(), "rb");
  text.resize(static_cast<std::size_t>(gzread(in, text.data(), 1 << 23)));
  gzclose(in);
  crossnav::test::WriteText(merges, text);
  const auto tokenizer = ReadClipTokenizer(merges);
  ASSERT_TRUE(tokenizer) << tokenizer.error().Message();
  ExpectEqual(**tokenizer, 1);
  const std::vector<std::int32_t> chair = {49406, 320, 1125, 539, 320, 4269, 49407};
  EXPECT_EQ((*tokenizer)->Encode("a photo of a chair", 77), chair);
}

TEST(Tokenizers, WordPiecesEqualTransformers) {
  const auto tokenizer = ReadWordPieceTokenizer(DataFile("tokens/vocab.txt"));
  ASSERT_TRUE(tokenizer) << tokenizer.error().Message();
  ExpectEqual(**tokenizer, 2);
}

TEST(Tokenizers, BertsOwnVocabularyToo) {
  const char* vocabulary = std::getenv("CROSSNAV_BERT_VOCABULARY");
  if (vocabulary == nullptr) GTEST_SKIP() << "CROSSNAV_BERT_VOCABULARY names no vocab.txt";
  const auto tokenizer = ReadWordPieceTokenizer(vocabulary);
  ASSERT_TRUE(tokenizer) << tokenizer.error().Message();
  ExpectEqual(**tokenizer, 3);
}

TEST(Tokenizers, TruncateLongTextsAndKeepTheEnd) {
  const auto tokenizer = ReadClipTokenizer(DataFile("tokens/merges.txt"));
  ASSERT_TRUE(tokenizer);
  const auto whole = (*tokenizer)->Encode("a b c d e f", kAll);
  const auto cut = (*tokenizer)->Encode("a b c d e f", 4);
  ASSERT_EQ(cut.size(), 4U);
  EXPECT_EQ(cut[2], whole[2]);
  EXPECT_EQ(cut.back(), whole.back());
}

TEST(Tokenizers, AnotherKindOfFileIsOneClearMessage) {
  const crossnav::test::TempFolder folder;
  const fs::path path = folder.path() / "words.txt";
  EXPECT_FALSE(ReadClipTokenizer(path));
  crossnav::test::WriteText(path, "chair\nbed\n");
  const auto clip = ReadClipTokenizer(path);
  ASSERT_FALSE(clip);
  EXPECT_NE(clip.error().Message().find("words.txt"), std::string::npos);
  EXPECT_NE(ReadWordPieceTokenizer(path).error().Message().find("[CLS]"), std::string::npos);
  crossnav::test::WriteText(path, "#version\na b\nlonely\n");
  EXPECT_NE(ReadClipTokenizer(path).error().Message().find("line 3"), std::string::npos);
}

TEST(Unicode, BrokenUtf8BecomesReplacements) {
  EXPECT_EQ(FromUtf8("a\xff\xc3"), U"a\xFFFD\xFFFD");
  EXPECT_EQ(FromUtf8("\xed\xa0\x80").size(), 3U);  // a surrogate is none
  EXPECT_EQ(ToUtf8(FromUtf8("ä€🪑")), "ä€🪑");
}

}  // namespace
}  // namespace crossnav::inference::test
