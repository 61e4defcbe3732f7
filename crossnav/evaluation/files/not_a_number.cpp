// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/files/not_a_number.h"

namespace crossnav::evaluation {

std::string DescribeNotANumber(const std::string& text) {
  std::string last_string, key;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      const std::size_t begin = ++i;
      while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
      last_string = text.substr(begin, i - begin);
    } else if (text[i] == ':') {
      key = last_string;
    } else if (text.compare(i, 3, "NaN") == 0 || text.compare(i, 8, "Infinity") == 0) {
      return "key \"" + key + "\" holds " + (text[i] == 'N' ? "NaN" : "Infinity") + " (byte " +
             std::to_string(i) + "), which is no number";
    }
  }
  return "";
}

}  // namespace crossnav::evaluation
