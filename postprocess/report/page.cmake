# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The pages of the report and of an ensemble: FOLDER/*.js bundled by esbuild (which also refuses what does not parse),
# put into an HTML file with a style and the libraries, and compiled in as bytes. All have the frame page.html, which
# says what a browser may load and run. Nothing is fetched; see cmake/dependencies.cmake.
set(_made ${CMAKE_CURRENT_BINARY_DIR}/report)
set(_shared ${CMAKE_CURRENT_SOURCE_DIR}/report/page)
file(GLOB _shared_scripts CONFIGURE_DEPENDS ${_shared}/*.js)

# three.js comes as modules: what a page takes of it becomes one script.
add_custom_command(OUTPUT ${_made}/three.js
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${THREE_FOLDER} ${ESBUILD} ${CMAKE_CURRENT_SOURCE_DIR}/report/three.js
    --bundle --minify --format=iife --global-name=THREE --charset=utf8 --log-level=warning --outfile=${_made}/three.js
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/report/three.js ${THREE_SCRIPT} ${THREE_CONTROLS} VERBATIM)

# talus_page(NAME FUNCTION FOLDER KIND [THREE] STYLE...): ${_made}/NAME.cpp, whose FUNCTION gives the page;
# FOLDER/KIND.html is what the frame holds, FOLDER/main.js begins its script, and the styles follow one another. THREE:
# the page holds three.js.
function(talus_page name function folder kind)
  cmake_parse_arguments(_asked "THREE" "" "" ${ARGN})
  set(_styles ${_asked_UNPARSED_ARGUMENTS})
  if(_asked_THREE)
    set(_three ${_made}/three.js)
    set(_with_three -DTHREE=${_three})
  endif()
  file(GLOB _scripts CONFIGURE_DEPENDS ${folder}/*.js)
  add_custom_command(OUTPUT ${_made}/${name}.js
    COMMAND ${ESBUILD} ${folder}/main.js --bundle --format=iife --charset=utf8 --log-level=warning
      --outfile=${_made}/${name}.js
    DEPENDS ${_scripts} ${_shared_scripts} VERBATIM)
  add_custom_command(OUTPUT ${_made}/${name}.css
    COMMAND ${CMAKE_COMMAND} -E cat ${_styles} > ${_made}/${name}.css DEPENDS ${_styles} VERBATIM)
  add_custom_command(OUTPUT ${_made}/${name}.cpp
    COMMAND ${CMAKE_COMMAND} -DFRAME=${_shared}/page.html -DBODY=${folder}/${kind}.html -DKIND=${kind}
      -DSTYLE=${_made}/${name}.css -DSCRIPT=${_made}/${name}.js
      -DLEAFLET_STYLE=${LEAFLET_STYLE} -DLEAFLET=${LEAFLET_SCRIPT} -DCHART=${CHART_SCRIPT} -DFUNCTION=${function}
      ${_with_three} -DLICENCES=${_shared}/licences.txt -DOUTPUT=${_made}/${name}.cpp
      -P ${CMAKE_CURRENT_SOURCE_DIR}/report/build_page.cmake
    DEPENDS ${_made}/${name}.js ${_made}/${name}.css ${_three} ${_shared}/page.html ${folder}/${kind}.html
      ${_shared}/licences.txt
      ${CMAKE_CURRENT_SOURCE_DIR}/report/build_page.cmake ${LEAFLET_STYLE} ${LEAFLET_SCRIPT} ${CHART_SCRIPT}
    VERBATIM)
endfunction()

talus_page(report_page page_template ${_shared} report THREE ${_shared}/report.css)
set(_ensemble ${CMAKE_CURRENT_SOURCE_DIR}/ensemble/page)
talus_page(ensemble_page ensemble_template ${_ensemble} ensemble ${_shared}/report.css ${_ensemble}/ensemble.css)
