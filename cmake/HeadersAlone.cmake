# Every header compiles alone, and twice: one generated file for each, which the test headers.CompileAlone has the compiler
# parse and no more. Nothing of it is part of the build itself; a header that did not change is not parsed again. The
# samples inside other engines are left out, whose headers need those engines.
set(folder ${CMAKE_BINARY_DIR}/headers)
# Carries the flags; its one file is never compiled.
file(CONFIGURE OUTPUT ${folder}/flags.cpp CONTENT "" @ONLY)
add_library(pellucid_header_flags OBJECT EXCLUDE_FROM_ALL ${folder}/flags.cpp)
target_link_libraries(pellucid_header_flags PRIVATE
  pellucid_cli pellucid_c pellucid_test_support OpenEXR::OpenEXR OpenImageIO::OpenImageIO PkgConfig::EPOXY PkgConfig::EGL)
if(TARGET embree)
  target_link_libraries(pellucid_header_flags PRIVATE embree)
endif()
set(own "^(${PROJECT_SOURCE_DIR}(/shaders)?|/usr/include)$")  # ours, and what the compiler searches anyhow
set(others "$<FILTER:$<TARGET_PROPERTY:pellucid_header_flags,INCLUDE_DIRECTORIES>,EXCLUDE,${own}>")
set(definitions "$<TARGET_PROPERTY:pellucid_header_flags,COMPILE_DEFINITIONS>")
set(options "$<TARGET_PROPERTY:pellucid_header_flags,COMPILE_OPTIONS>")
set(parse ${CMAKE_CXX_COMPILER} -std=c++${CMAKE_CXX_STANDARD} -I${PROJECT_SOURCE_DIR} -I${PROJECT_SOURCE_DIR}/shaders
  -fsyntax-only)

set(stamps)
foreach(room shaders gbuffer engine_bridge composite samples tests)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${room}/*.h)
  list(FILTER headers EXCLUDE REGEX "^samples/(osg|vtk|vulkan)/")
  foreach(header IN LISTS headers)
    string(REPLACE "/" "_" name ${header})
    set(stem ${folder}/${name})
    file(CONFIGURE OUTPUT ${stem}.cpp CONTENT "#include \"${header}\"\n#include \"${header}\"\n" @ONLY)
    add_custom_command(OUTPUT ${stem}.parsed
      COMMAND ${parse} "${options}" "$<$<BOOL:${definitions}>:-D$<JOIN:${definitions},;-D>>"
              "$<$<BOOL:${others}>:-isystem$<JOIN:${others},;-isystem>>" -MMD -MT ${stem}.parsed -MF ${stem}.d ${stem}.cpp
      COMMAND ${CMAKE_COMMAND} -E touch ${stem}.parsed
      DEPENDS ${stem}.cpp DEPFILE ${stem}.d COMMENT "Parsing ${header} alone" COMMAND_EXPAND_LISTS VERBATIM)
    list(APPEND stamps ${stem}.parsed)
  endforeach()
endforeach()
add_custom_target(pellucid_headers DEPENDS ${stamps})
add_test(NAME headers.CompileAlone COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target pellucid_headers)
set_tests_properties(headers.CompileAlone PROPERTIES TIMEOUT 1200)

# The check itself is checked: a header that lacks an include must not compile so.
if(NOT DEFINED PELLUCID_PLANTED_HEADER_COMPILES)
  file(WRITE ${folder}/planted/planted.h "#pragma once\ninline std::string planted() { return {}; }\n")
  file(WRITE ${folder}/planted/planted.cpp "#include \"planted.h\"\n#include \"planted.h\"\n")
  file(WRITE ${folder}/planted/whole.cpp "#include <string>\n#include \"planted.h\"\nint main() {}\n")
  try_compile(PELLUCID_PLANTED_HEADER_COMPILES ${folder}/planted/a ${folder}/planted/planted.cpp)
  try_compile(PELLUCID_WHOLE_HEADER_COMPILES ${folder}/planted/b ${folder}/planted/whole.cpp)
endif()
if(PELLUCID_PLANTED_HEADER_COMPILES OR NOT PELLUCID_WHOLE_HEADER_COMPILES)
  message(FATAL_ERROR "HeadersAlone: the planted header was not told from a whole one")
endif()
