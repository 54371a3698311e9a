# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Man pages and completions, from what the programs say of themselves (tools/make-manuals.py), and the styles for QGIS.
# They belong to `make build`, so that what is installed is never older than the programs.
add_custom_target(talus-manuals ALL)
set(TALUS_MANUALS ${CMAKE_BINARY_DIR}/manuals)
set(TALUS_MANUAL_PAGES "")   # section 1 pages by the programs' names
set(TALUS_WITH_MANUALS OFF)

find_package(Python3 3.9 COMPONENTS Interpreter QUIET)
if(NOT Python3_FOUND)
  message(STATUS "Talus: no man pages and no completions, since Python 3.9 was not found (apt-get install python3)")
elseif(NOT TALUS_SANITIZE AND NOT TALUS_FUZZ)
  set(TALUS_WITH_MANUALS ON)
endif()

# The programs that are installed; `talus`, one command over the stages, where it is part of the build.
set(TALUS_PROGRAMS talus-preprocess talus-solve talus-postprocess talus-make-terrain)
if(TARGET talus)
  list(PREPEND TALUS_PROGRAMS talus)
endif()

# talus_manual(PROGRAM): man page and completions of a program.
function(talus_manual name)
  if(NOT TALUS_WITH_MANUALS)
    return()
  endif()
  set(_page ${TALUS_MANUALS}/man/${name}.1)
  set(_script ${CMAKE_SOURCE_DIR}/tools/make-manuals.py)
  add_custom_command(OUTPUT ${_page} ${_page}.gz ${TALUS_MANUALS}/bash/${name} ${TALUS_MANUALS}/zsh/_${name}
    COMMAND ${Python3_EXECUTABLE} ${_script} $<TARGET_FILE:${name}> --to ${TALUS_MANUALS} --version ${PROJECT_VERSION}
      --pages ${TALUS_PROGRAMS}
    DEPENDS ${_script} ${name} VERBATIM)
  add_custom_target(talus-manual-of-${name} DEPENDS ${_page})
  add_dependencies(talus-manuals talus-manual-of-${name})
  set(TALUS_MANUAL_PAGES ${TALUS_MANUAL_PAGES} ${name} PARENT_SCOPE)
endfunction()

foreach(_program IN LISTS TALUS_PROGRAMS)
  talus_manual(${_program})
endforeach()

if(TALUS_WITH_MANUALS)
  set(_page ${TALUS_MANUALS}/man/talus-recipe.5)
  set(_stages talus-preprocess talus-solve talus-postprocess)
  add_custom_command(OUTPUT ${_page} ${_page}.gz
    COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tools/make-manuals.py --recipe
      "$<TARGET_FILE:talus-preprocess>" "$<TARGET_FILE:talus-solve>" "$<TARGET_FILE:talus-postprocess>"
      --to ${TALUS_MANUALS} --version ${PROJECT_VERSION} --pages ${TALUS_PROGRAMS}
    DEPENDS ${CMAKE_SOURCE_DIR}/tools/make-manuals.py ${_stages} VERBATIM)
  add_custom_target(talus-manual-of-recipe DEPENDS ${_page})
  add_dependencies(talus-manuals talus-manual-of-recipe)
endif()

# The plugin for QGIS as a zip file (tools/make-qgis-plugin.py; docs/how-to/qgis.md).
set(TALUS_QGIS_PLUGIN "")
if(Python3_FOUND)
  set(TALUS_QGIS_PLUGIN ${CMAKE_BINARY_DIR}/qgis/talus_provider.zip)
  set(_maker ${CMAKE_SOURCE_DIR}/tools/make-qgis-plugin.py)
  file(GLOB_RECURSE _plugin CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/qgis/*.py ${CMAKE_SOURCE_DIR}/qgis/*.txt
    ${CMAKE_SOURCE_DIR}/qgis/*.svg)
  add_custom_command(OUTPUT ${TALUS_QGIS_PLUGIN}
    COMMAND ${Python3_EXECUTABLE} ${_maker} --version ${PROJECT_VERSION} --to ${TALUS_QGIS_PLUGIN}
    DEPENDS ${_maker} ${_plugin} ${CMAKE_SOURCE_DIR}/LICENSE VERBATIM)
  add_custom_target(talus-qgis-plugin DEPENDS ${TALUS_QGIS_PLUGIN})
  add_dependencies(talus-manuals talus-qgis-plugin)
endif()

set(TALUS_STYLES ${CMAKE_BINARY_DIR}/styles)
add_custom_command(OUTPUT ${TALUS_STYLES}/thick/terrain.qml
  COMMAND talus-write-styles ${TALUS_STYLES} >${CMAKE_BINARY_DIR}/styles.txt
  DEPENDS talus-write-styles)
add_custom_target(talus-styles DEPENDS ${TALUS_STYLES}/thick/terrain.qml)
add_dependencies(talus-manuals talus-styles)
