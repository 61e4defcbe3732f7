# SPDX-License-Identifier: MIT
# cmake -DOUT=file.cpp "-DENTRIES=Function=path,Function=path" -P embed.cmake
# Writes a .cpp that gives the bytes of each file through crossnav::trace::<Function>().
set(text "// Made by embed.cmake; do not edit.\n#include \"crossnav/trace/replay_schemas.h\"\n")
string(APPEND text "namespace crossnav::trace {\n")
string(REPLACE "," ";" entries "${ENTRIES}")
foreach(entry IN LISTS entries)
  string(REGEX MATCH "^([A-Za-z]+)=(.+)$" matched "${entry}")
  set(name "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
  string(APPEND text "static const unsigned char k${name}[] = {\n${bytes}0};\n")
  string(APPEND text "std::string_view ${name}() {\n  return {reinterpret_cast<const char*>(k${name}), "
                     "sizeof(k${name}) - 1};\n}\n")
endforeach()
string(APPEND text "}  // namespace crossnav::trace\n")
file(WRITE "${OUT}" "${text}")
