# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` lays where. Two components: `runtime` (what runs, with recipes, samples, styles, man pages and
# completions) and `docs`. A third, `dev` (libtalus, its headers and the Python module), is installed by its name alone
# (make install-library). Packages and bundles are made of the same rules (cmake/package.cmake, tools/make-bundle.sh).
set(TALUS_SHARE ${CMAKE_INSTALL_DATADIR}/talus)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)   # the tests need not be built for it: make build, then cmake --install

set_target_properties(${TALUS_PROGRAMS} PROPERTIES
  INSTALL_RPATH "$ORIGIN/../lib;$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/talus")
install(TARGETS ${TALUS_PROGRAMS} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS talus_openturns LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/talus COMPONENT runtime)

# Recipes with the Makefile that chains the stages, and the samples that they name by ../../data_samples. Results of
# installed pipelines go to where the user stands, since the folder is seldom the user's own.
file(GLOB _recipes CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/pipelines/*/recipe.toml)
foreach(_recipe IN LISTS _recipes)
  get_filename_component(_folder ${_recipe} DIRECTORY)
  install(DIRECTORY ${_folder}/ DESTINATION ${TALUS_SHARE}/${_folder} COMPONENT runtime FILES_MATCHING
    PATTERN out EXCLUDE PATTERN "*.toml" PATTERN "*.md" PATTERN "*.csv" PATTERN "*.geojson" PATTERN "*.tif")
endforeach()
install(FILES pipelines/Makefile DESTINATION ${TALUS_SHARE}/pipelines COMPONENT runtime)
install(PROGRAMS pipelines/ensemble.sbatch pipelines/ensemble.py DESTINATION ${TALUS_SHARE}/pipelines COMPONENT runtime)
file(RELATIVE_PATH _bin ${CMAKE_INSTALL_FULL_DATADIR}/talus/pipelines ${CMAKE_INSTALL_FULL_BINDIR})
file(WRITE ${CMAKE_BINARY_DIR}/installed.mk "# Installed: the programs, and where the user stands.
BIN  ?= $(CURDIR)/${_bin}
OUT  ?= talus-out
DATA ?= data
")
install(FILES ${CMAKE_BINARY_DIR}/installed.mk DESTINATION ${TALUS_SHARE}/pipelines COMPONENT runtime)
install(DIRECTORY data_samples/ DESTINATION ${TALUS_SHARE}/data_samples COMPONENT runtime FILES_MATCHING
  PATTERN "*.tif" PATTERN "*.geojson" PATTERN "*.csv" PATTERN README.md)

# For Python: PYTHONPATH=PREFIX/share/talus/python (docs/how-to/python.md).
install(DIRECTORY python/talus python/examples DESTINATION ${TALUS_SHARE}/python COMPONENT runtime FILES_MATCHING
  PATTERN "*.py" PATTERN __pycache__ EXCLUDE)

# libtalus: find_package(Talus) (docs/reference/library.md).
set(_dev COMPONENT dev EXCLUDE_FROM_ALL)
install(TARGETS talus_library EXPORT TalusTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${_dev})
install(TARGETS talus_openturns LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/talus ${_dev})
install(EXPORT TalusTargets NAMESPACE Talus:: FILE TalusConfig.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Talus ${_dev})
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/TalusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/TalusConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Talus ${_dev})
install(FILES library/talus.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/talus ${_dev})
foreach(_header IN LISTS TALUS_HEADERS)
  get_filename_component(_folder ${_header} DIRECTORY)
  install(FILES ${_header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/talus/${_folder} ${_dev})
endforeach()
if(TARGET talus_python)
  install(TARGETS talus_python LIBRARY DESTINATION ${TALUS_SHARE}/python/talus ${_dev})
endif()

# For QGIS: the plugin, to be installed from its zip file (docs/how-to/qgis.md).
if(TALUS_QGIS_PLUGIN)
  install(FILES ${TALUS_QGIS_PLUGIN} DESTINATION ${TALUS_SHARE}/qgis COMPONENT runtime)
endif()

install(DIRECTORY ${TALUS_STYLES}/ DESTINATION ${TALUS_SHARE}/styles COMPONENT runtime)
foreach(_name IN LISTS TALUS_MANUAL_PAGES)
  install(FILES ${TALUS_MANUALS}/man/${_name}.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
  install(FILES ${TALUS_MANUALS}/bash/${_name}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)
  install(FILES ${TALUS_MANUALS}/zsh/_${_name}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT zsh)
  install(FILES ${TALUS_MANUALS}/zsh/_${_name}   # where Debian's packages have theirs
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT zsh_vendor EXCLUDE_FROM_ALL)
endforeach()
if(TALUS_WITH_MANUALS)
  install(FILES ${TALUS_MANUALS}/man/talus-recipe.5.gz
    DESTINATION ${CMAKE_INSTALL_MANDIR}/man5 COMPONENT runtime)
endif()

include(package_names)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/changelog.gz
  COMMAND sh -c "gzip -9nc \"$1\" >\"$2\"" gzip ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_BINARY_DIR}/changelog.gz
  DEPENDS ${CMAKE_SOURCE_DIR}/CHANGELOG.md VERBATIM)
add_custom_target(talus-changelog DEPENDS ${CMAKE_BINARY_DIR}/changelog.gz)
add_dependencies(talus-manuals talus-changelog)
# The licences of headers and scripts that the programs hold.
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/notices/README.md
  COMMAND ${CMAKE_SOURCE_DIR}/tools/collect-notices.sh ${CMAKE_BINARY_DIR}/notices
  DEPENDS ${CMAKE_SOURCE_DIR}/tools/collect-notices.sh VERBATIM)
add_custom_target(talus-notices DEPENDS ${CMAKE_BINARY_DIR}/notices/README.md)
add_dependencies(talus-manuals talus-notices)
install(DIRECTORY ${CMAKE_BINARY_DIR}/notices
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${TALUS_PACKAGE} COMPONENT runtime)
install(FILES packaging/copyright CITATION.cff ${CMAKE_BINARY_DIR}/changelog.gz
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${TALUS_PACKAGE} COMPONENT runtime)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/talus COMPONENT docs)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/talus/docs COMPONENT docs FILES_MATCHING
  PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
# The site, where `make docs` has made it before; `make package` does.
install(DIRECTORY ${CMAKE_BINARY_DIR}/site/html DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/talus COMPONENT docs OPTIONAL)
