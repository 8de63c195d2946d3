# Packages for Debian (`./dev package`), one for each component of cmake/Install.cmake. They are made only if the prefix
# is /usr and RICOCHET_PACKAGE is set: the preset "package".
if(NOT RICOCHET_PACKAGE)
  return()
endif()
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  message(FATAL_ERROR "Packages are for /usr: configure with `cmake --preset package`")
endif()
set(RICOCHET_MAINTAINER "The Ricochet authors <ricochet@localhost>" CACHE STRING
  "Name and address of the one who distributes the packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ricochet)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_VENDOR "The Ricochet authors")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${RICOCHET_MAINTAINER})
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
# The library's interface is C++ that changes with every version: programs need the version with which they were built.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(ricochet_same_library "libricochet0 (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# --- files of every package: licence and changes ---------------------------------------------------------------------
file(READ LICENSE licence)
string(REGEX REPLACE "^[^\n]*\n\n[^\n]*\n\n" "" licence "${licence}")  # title and copyright, which the heading contains
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n([^\n])" "\n \\1" RICOCHET_LICENCE "\n${licence}")
string(STRIP "${RICOCHET_LICENCE}" RICOCHET_LICENCE)
configure_file(packaging/debian/copyright.in packages/copyright @ONLY)
# Files of the packages themselves; reproducible if SOURCE_DATE_EPOCH is set.
string(TIMESTAMP RICOCHET_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(packaging/debian/changelog.in packages/changelog.Debian @ONLY)
configure_file(CHANGELOG.md packages/changelog COPYONLY)
foreach(name changelog changelog.Debian)
  execute_process(COMMAND gzip -9nf ${CMAKE_BINARY_DIR}/packages/${name} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/packages/triggers "activate-noawait ldconfig\n")

# ricochet_package(COMPONENT NAME SECTION SUMMARY TEXT [DEPENDS …] [RECOMMENDS …] [SUGGESTS …] [ALL])
function(ricochet_package component name section summary text)
  cmake_parse_arguments(PARSE_ARGV 5 with "ALL" "" "DEPENDS;RECOMMENDS;SUGGESTS")
  foreach(file copyright changelog.gz changelog.Debian.gz)
    install(FILES ${CMAKE_BINARY_DIR}/packages/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  endforeach()
  string(TOUPPER ${component} upper)
  foreach(relation DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN with_${relation} ", " joined)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${relation} "${joined}" PARENT_SCOPE)
  endforeach()
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  if(with_ALL)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all PARENT_SCOPE)
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS OFF PARENT_SCOPE)
  endif()
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
endfunction()

set(about "Ricochet simulates elastic bodies that strike, rest on, slide along and leave\neach other and rigid obstacles: \
elastodynamics with unilateral contact and\nCoulomb friction by finite elements, in two and three dimensions.\n\n")
set(CPACK_COMPONENTS_ALL "")
# The program and the library start gmsh, meshio and matplotlib as separate programs.
ricochet_package(program ricochet science "elastodynamics with contact and friction (program)"
  "${about}This package has the command-line program with its manual page, cases and\npublished benchmarks."
  DEPENDS ${ricochet_same_library} RECOMMENDS gmsh python3-meshio python3-matplotlib
  SUGGESTS ricochet-doc paraview python3-h5py python3-netcdf4)
ricochet_package(library libricochet0 libs "elastodynamics with contact and friction (library)"
  "${about}This package has the shared libraries." SUGGESTS gmsh python3-meshio)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/packages/triggers)
ricochet_package(development libricochet-dev libdevel "elastodynamics with contact and friction (development)"
  "${about}This package has the headers of the C++ library and what CMake needs to find\nit."
  DEPENDS ${ricochet_same_library} "libeigen3-dev (>= 3.4)" SUGGESTS cmake ricochet-doc)
ricochet_package(documentation ricochet-doc doc "elastodynamics with contact and friction (documentation)"
  "${about}This package has the documentation." ALL)
# The folder python/ installs its files with COMPONENT python, into lib/python3/dist-packages/ricochet.
if(RICOCHET_BUILD_PYTHON)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  ricochet_package(python python3-ricochet python "elastodynamics with contact and friction (Python 3)"
    "${about}This package has the module for Python 3."
    DEPENDS ${ricochet_same_library} "ricochet (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})" "python3 (>= 3.${Python3_VERSION_MINOR})" "python3 (<< 3.${next_minor})" python3-numpy
    RECOMMENDS python3-scipy python3-matplotlib python3-meshio SUGGESTS ricochet-doc python3-pandas python3-gmsh)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/debian/python/postinst
    ${CMAKE_SOURCE_DIR}/packaging/debian/python/prerm)
endif()
include(CPack)
