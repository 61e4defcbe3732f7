# SPDX-License-Identifier: MIT
# cmake -DOUT=replay.html -P pack.cmake
# Joins the page's sources into one HTML file. The scripts are ES modules; joined into one script
# they need no imports, so those lines and the word "export" are taken out. Names of top-level
# declarations must therefore be unique across the files (test/pack.test.mjs checks it).
get_filename_component(here "${CMAKE_CURRENT_LIST_DIR}" ABSOLUTE)
include("${here}/files.cmake")

set(script "")
foreach(file IN LISTS VIEWER_SCRIPTS)
  file(READ "${here}/${file}" text)
  string(REGEX REPLACE "\nimport [^;]*;" "" text "${text}")
  string(REGEX REPLACE "\nexport " "\n" text "${text}")
  string(APPEND script "${text}")
endforeach()

file(READ "${here}/src/index.html" page)
file(READ "${here}/src/style.css" style)
string(REPLACE "/*STYLE*/" "${style}" page "${page}")
string(REPLACE "/*SCRIPT*/" "${script}" page "${page}")
file(WRITE "${OUT}" "${page}")
