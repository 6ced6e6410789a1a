# SPDX-License-Identifier: Apache-2.0
# cmake -DROOT=... -DFILES=a;b -DOUTPUT=... -P embed.cmake: a C++ table of names and bytes.
set(text "// Made by kernels/embed.cmake.\n#include \"device/embedded.h\"\nnamespace sunstone {\n")
set(table "")
set(number 0)
foreach(file ${FILES})
  file(READ ${ROOT}/${file} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
  string(APPEND text "static const unsigned char file_${number}[] = {${bytes}0};\n")
  string(APPEND table "  {\"${file}\", std::string_view(reinterpret_cast<const char *>(file_${number}), sizeof file_${number} - 1)},\n")
  math(EXPR number "${number} + 1")
endforeach()
string(APPEND text "static const EmbeddedFile table[] = {\n${table}};\nstd::span<const EmbeddedFile> embedded_files() { return table; }\n}\n")
file(WRITE ${OUTPUT} "${text}")
