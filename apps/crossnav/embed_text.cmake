# SPDX-License-Identifier: MIT
# cmake -DOUT=file.cpp -DFUNCTION=Name -DFILE=path -P embed_text.cmake
# Writes a .cpp that gives the bytes of a file through crossnav::app::<Function>().
file(READ "${FILE}" hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
file(WRITE "${OUT}"
  "// Made by embed_text.cmake; do not edit.\n#include \"ifc_import.h\"\n"
  "namespace crossnav::app {\nstatic const unsigned char kBytes[] = {\n${bytes}0};\n"
  "std::string_view ${FUNCTION}() {\n"
  "  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes) - 1};\n}\n"
  "}  // namespace crossnav::app\n")
