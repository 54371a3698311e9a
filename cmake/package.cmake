# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# Debian packages by CPack, from the rules of cmake/install.cmake: `make package`. What the programs need is read off
# them by dpkg-shlibdeps, so a package fits the distribution on which it was made.
set(TALUS_CONTACT "The Talus authors" CACHE STRING "Maintainer of the packages: Name <address>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME talus)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Talus authors")
set(CPACK_PACKAGE_CONTACT "${TALUS_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "landslides in three dimensions, from survey to map")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL runtime zsh_vendor docs docs_copyright)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_RUNTIME_GROUP runtime)
set(CPACK_COMPONENT_ZSH_VENDOR_GROUP runtime)
set(CPACK_COMPONENT_DOCS_GROUP docs)
set(CPACK_COMPONENT_DOCS_COPYRIGHT_GROUP docs)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${TALUS_PACKAGE})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core)   # the letters of map.png
# make chains the stages of a pipeline; without OpenBLAS the reference BLAS factorises, several times as slowly.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "make, libopenblas0-serial")
string(JOIN ", " CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS talus-doc ffmpeg qgis paraview python3-distributed python3-h5py
  python3-xarray "python3-rasterio${TALUS_PACKAGE_SUGGESTS_MORE}")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONFLICTS ${TALUS_PACKAGE_OTHER})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_REPLACES ${TALUS_PACKAGE_OTHER})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_PROVIDES "${TALUS_PACKAGE_PROVIDES}")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
"Talus computes where a landslide goes, in three dimensions, with the material
point method. It takes the elevation model from before the slide and the one
from after it, and writes thickness, speeds, pressures and arrival times as
GeoTIFF and NetCDF, with styles and a project for QGIS, a report, and a score
against what was surveyed.
.
${TALUS_PACKAGE_KERNELS}")

set(CPACK_DEBIAN_DOCS_PACKAGE_NAME talus-doc)
set(CPACK_DEBIAN_DOCS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCS_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCS_DESCRIPTION
"The documents: tutorials, how-to, reference and explanation, as a site for a
browser in /usr/share/doc/talus/html and as Markdown beside it.")

# Policy asks for a copyright file under each package's own name.
install(FILES packaging/copyright ${CMAKE_BINARY_DIR}/changelog.gz
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/talus-doc COMPONENT docs_copyright EXCLUDE_FROM_ALL)
include(CPack)
