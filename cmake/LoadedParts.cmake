# Parts of the program that are loaded when first needed (gbuffer/loaded_part.h). They lie in one folder, which is in the
# run path of every program that is built here, of the installed program, and of what links the installed libraries.
set(PELLUCID_PARTS_FOLDER ${CMAKE_BINARY_DIR}/lib/pellucid)

# Symbols stay visible: libraries made of templates, as OpenVDB, keep tables in statics that a part and the library must
# share.
#
# pellucid_part(NAME SOURCES... LIBRARIES...): a part and what it is linked to.
function(pellucid_part name)
  cmake_parse_arguments(PART "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${PART_SOURCES})
  target_link_libraries(${name} PRIVATE ${PART_LIBRARIES})
  set_target_properties(${name} PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY ${PELLUCID_PARTS_FOLDER})
endfunction()
