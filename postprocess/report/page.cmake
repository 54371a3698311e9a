# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The report's page: page/*.js bundled by esbuild (which also refuses what does not parse), put into page/report.html
# with the style and the libraries, and compiled in as bytes. Nothing is fetched; see cmake/dependencies.cmake.
set(_page ${CMAKE_CURRENT_SOURCE_DIR}/report/page)
set(_made ${CMAKE_CURRENT_BINARY_DIR}/report)
file(GLOB _scripts CONFIGURE_DEPENDS ${_page}/*.js)
add_custom_command(OUTPUT ${_made}/page.js
  COMMAND ${ESBUILD} ${_page}/main.js --bundle --format=iife --charset=utf8 --log-level=warning
    --outfile=${_made}/page.js
  DEPENDS ${_scripts} VERBATIM)
# three.js comes as modules: what the page takes of it becomes one script.
add_custom_command(OUTPUT ${_made}/three.js
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${THREE_FOLDER} ${ESBUILD} ${CMAKE_CURRENT_SOURCE_DIR}/report/three.js
    --bundle --minify --format=iife --global-name=THREE --charset=utf8 --log-level=warning --outfile=${_made}/three.js
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/report/three.js ${THREE_SCRIPT} ${THREE_CONTROLS} VERBATIM)
add_custom_command(OUTPUT ${_made}/page.cpp
  COMMAND ${CMAKE_COMMAND} -DHTML=${_page}/report.html -DSTYLE=${_page}/report.css -DSCRIPT=${_made}/page.js
    -DLEAFLET_STYLE=${LEAFLET_STYLE} -DLEAFLET=${LEAFLET_SCRIPT} -DCHART=${CHART_SCRIPT}
    -DTHREE=${_made}/three.js
    -DLICENCES=${_page}/licences.txt -DOUTPUT=${_made}/page.cpp -P ${CMAKE_CURRENT_SOURCE_DIR}/report/build_page.cmake
  DEPENDS ${_made}/page.js ${_made}/three.js ${_page}/report.html ${_page}/report.css ${_page}/licences.txt
    ${CMAKE_CURRENT_SOURCE_DIR}/report/build_page.cmake ${LEAFLET_STYLE} ${LEAFLET_SCRIPT} ${CHART_SCRIPT}
  VERBATIM)
