# Debian packages, which ./dev package makes in a build folder of its own whose prefix is /usr: the components of
# Install.cmake, each with the papers that Debian's policy asks for.
set(maintainer "Pellucid Developers <pellucid@packages.invalid>")
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git log -1 --format=%ct WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE epoch
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  set(ENV{SOURCE_DATE_EPOCH} "${epoch}")
endif()
string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC)

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # samples go into no package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pellucid)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_OUTPUT_FILE_PREFIX ${CMAKE_BINARY_DIR}/packages)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${maintainer}")
set(CPACK_COMPONENTS_ALL)

# package(COMPONENT NAME SECTION SUMMARY DESCRIPTION [DEPENDS ...]): one package, and its papers.
function(package component name section summary description)
  cmake_parse_arguments(given "SHLIBDEPS" "" "DEPENDS" ${ARGN})
  string(TOUPPER ${component} key)
  string(JOIN ", " depends ${given_DEPENDS})
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${summary}\n${description}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DESCRIPTION "${summary}\n${description}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SHLIBDEPS ${given_SHLIBDEPS} PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(papers ${CMAKE_BINARY_DIR}/papers/${name})
  file(CONFIGURE OUTPUT ${papers}/changelog.Debian CONTENT "pellucid (@PROJECT_VERSION@-1) bookworm; urgency=medium

  * What changed is in changelog.gz.

 -- @maintainer@  @package_date@
" @ONLY)
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
  string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
  string(REGEX REPLACE "\n" "\n " license " ${license}")
  string(STRIP "${license}" license)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/copyright.in ${papers}/copyright @ONLY)
  execute_process(COMMAND gzip -9nkf ${papers}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${papers}/changelog.gz
    COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${papers}/copyright ${papers}/changelog.gz ${papers}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endfunction()

# libepoxy and libglvnd open these when a context is made; no linker knows of them.
set(gl libegl1 libgl1-mesa-dri libopengl0)
set(same "(= ${PROJECT_VERSION}-1)")
package(program pellucid graphics "composite transparency onto finished renders"
  "Glass, smoke, fog, particles and foliage from glTF or deep EXR files are\ncomposited exactly onto opaque pictures of any renderer, and written back\ninto the same EXR."
  SHLIBDEPS DEPENDS ${gl})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS xdg-utils)  # which `pellucid view` opens files with
package(c libpellucid-c${PROJECT_VERSION_MAJOR} libs "order-independent transparency behind an engine"
  "A C library that draws transparent things in any order in the frame of an\nengine that renders with OpenGL." SHLIBDEPS)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/papers/shlibs
  CONTENT "libpellucid_c @PROJECT_VERSION_MAJOR@ libpellucid-c@PROJECT_VERSION_MAJOR@ (>= @PROJECT_VERSION@)\n" @ONLY)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/papers/triggers CONTENT "activate-noawait ldconfig\n" @ONLY)
set(CPACK_DEBIAN_C_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/papers/shlibs ${CMAKE_BINARY_DIR}/papers/triggers)
package(dev libpellucid-c-dev libdevel "order-independent transparency behind an engine (development)"
  "The header, pkg-config and CMake files of the C library." DEPENDS "libpellucid-c${PROJECT_VERSION_MAJOR} ${same}")
package(rooms libpellucid-rooms-dev libdevel "compositor of Pellucid as C++ libraries"
  "Static libraries, headers, pkg-config and CMake files of the whole\ncompositor and its parts."
  DEPENDS "libpellucid-c-dev ${same}" "pellucid ${same}" libdeflate-dev libdraco-dev libegl-dev libembree-dev libepoxy-dev libfmt-dev
    libglm-dev libimath-dev libmeshoptimizer-dev libopencolorio-dev libopenexr-dev libopenimageio-dev libopenvdb-dev
    libtbb-dev nlohmann-json3-dev pkg-config zlib1g-dev)
if(TARGET pellucid_python)
  package(python python3-pellucid python "composite transparency onto NumPy arrays and EXR files"
    "The compositor of Pellucid as a Python module: functions of files and of\nNumPy arrays, with every flag of the program as a keyword."
    SHLIBDEPS DEPENDS "pellucid ${same}" python3 "python3 (>= 3.11~)" "python3 (<< 3.12)" python3-numpy ${gl})
endif()
# Debian has its man pages compressed.
install(CODE [[
  file(GLOB pages "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/man/man1/*.1")
  execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
]] COMPONENT program)
include(CPack)
