// SPDX-License-Identifier: MIT
// make_seeds FOLDER
#include <cstdio>

#include "fuzz/seeds.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_seeds FOLDER\n", stderr);
    return 2;
  }
  crossnav::fuzz::WriteSeeds(argv[1]);
  return 0;
}
