# What goes to an install prefix: the program, the C library with its header, and the rooms as C++ libraries.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(rooms pellucid_options pellucid_shaders pellucid_gbuffer pellucid_scene pellucid_gl pellucid_embree
  pellucid_composite pellucid_pipeline)
set(rooms_include ${CMAKE_INSTALL_INCLUDEDIR}/pellucid-rooms)

install(TARGETS pellucid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS pellucid_c EXPORT pellucid-c LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY engine_bridge/include/pellucid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS ${rooms} EXPORT pellucid-rooms ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY shaders gbuffer engine_bridge composite DESTINATION ${rooms_include}
  FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl" PATTERN "engine_bridge/c" EXCLUDE PATTERN "engine_bridge/include" EXCLUDE
  PATTERN "composite/cli" EXCLUDE)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)
install(EXPORT pellucid-c NAMESPACE pellucid:: DESTINATION ${config_folder})
install(EXPORT pellucid-rooms NAMESPACE pellucid:: DESTINATION ${config_folder})
configure_package_config_file(cmake/pellucidConfig.cmake.in ${CMAKE_BINARY_DIR}/pellucidConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pellucidConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_BINARY_DIR}/pellucidConfig.cmake ${CMAKE_BINARY_DIR}/pellucidConfigVersion.cmake DESTINATION ${config_folder})
foreach(package pellucid pellucid-rooms)
  configure_file(cmake/${package}.pc.in ${CMAKE_BINARY_DIR}/${package}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${package}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
