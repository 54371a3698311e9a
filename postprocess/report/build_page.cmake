# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Puts a page together and writes it as C++: cmake -DFRAME=page.html -DBODY=report.html -DKIND=report -DSTYLE=...
# -DSCRIPT=... -DLEAFLET_STYLE=... -DLEAFLET=... -DCHART=... [-DTHREE=...] -DLICENCES=... -DFUNCTION=page_template
# -DOUTPUT=page.cpp -P build_page.cmake. FUNCTION is the one of page.hpp that gives the page. Arguments are quoted
# throughout: scripts are full of semicolons, which CMake would take for lists.

# What would be loaded from beside the page is taken out: pictures of controls that are not used, maps for debuggers.
function(read_part file out)
  file(READ "${file}" text)
  string(REGEX REPLACE "url\\(\"?images/[^)]*\\)" "none" text "${text}")
  string(REGEX REPLACE "(//[#@]|/\\*#) sourceMappingURL=[^\n]*" "" text "${text}")
  if(text MATCHES "</[sS][cC][rR][iI][pP][tT]")
    message(FATAL_ERROR "${file} holds the end of a script block and cannot stand inside one")
  endif()
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

file(READ "${FRAME}" page)
set(at "@")   # CMake would put a variable in the place of @KIND@ in a text
if(NOT DEFINED THREE)
  string(REPLACE "<script>${at}THREE${at}</script>\n" "" page "${page}")
endif()
string(REPLACE "${at}KIND${at}" "${KIND}" page "${page}")
foreach(part BODY STYLE SCRIPT LEAFLET_STYLE LEAFLET CHART THREE LICENCES)
  string(FIND "${page}" "@${part}@" place)
  if(NOT DEFINED ${part})
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${FRAME} has a @${part}@, but -D${part}=... is not given")
    endif()
    continue()
  endif()
  if(place EQUAL -1)
    message(FATAL_ERROR "${FRAME} has no @${part}@")
  endif()
  read_part("${${part}}" text)
  string(REPLACE "@${part}@" "${text}" page "${page}")
endforeach()

get_filename_component(folder "${OUTPUT}" DIRECTORY)
get_filename_component(name "${OUTPUT}" NAME_WE)
file(WRITE "${folder}/${name}.html" "${page}")   # for looking at; the program holds the bytes below
file(READ "${folder}/${name}.html" bytes HEX)
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"postprocess/report/page.hpp\"

namespace talus::postprocess {
namespace {
const unsigned char bytes_of_${FUNCTION}[] = {
${bytes}
};
}  // namespace

std::string_view ${FUNCTION}() {
  return {reinterpret_cast<const char*>(bytes_of_${FUNCTION}), sizeof bytes_of_${FUNCTION}};
}

}  // namespace talus::postprocess
")
