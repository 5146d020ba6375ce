# SPDX-License-Identifier: Apache-2.0
# cmake -D OUT=file.cpp -D FOLDER=view/page -D HEADER=view/page_files.h -D FUNCTION=page_files -P EmbedPage.cmake
# Writes a source file with the bytes of all files of a folder, for pelage::FUNCTION(), which HEADER declares.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT files)
set(arrays)
set(table)
set(index 0)
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} hex HEX)
  string(LENGTH "${hex}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  string(REGEX REPLACE "('[^']*',('[^']*',)?('[^']*',)?('[^']*',)?('[^']*',)?('[^']*',)?('[^']*',)?('[^']*',)?)" "\\1\n" bytes "${bytes}")
  string(APPEND arrays "constexpr char kFile${index}[] = {${bytes}'\\0'};\n")
  string(APPEND table "    {\"${name}\", {kFile${index}, ${size}}},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(WRITE ${OUT} "// Made by cmake/EmbedPage.cmake.
#include \"${HEADER}\"

namespace pelage {
namespace {

${arrays}
constexpr PageFile kFiles[] = {
${table}};

}  // namespace

std::span<const PageFile> ${FUNCTION}() { return kFiles; }

}  // namespace pelage
")
