# What goes to an install prefix, by components: `c` the C library, `dev` what hosts of it are built with, `docs`, and,
# unless PELLUCID_ROOMS is off, `program` and `rooms`, the C++ libraries, and `python`, the module.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(rooms pellucid_options pellucid_shaders pellucid_gbuffer pellucid_scene pellucid_gl pellucid_embree
  pellucid_composite pellucid_pipeline)
set(rooms_include ${CMAKE_INSTALL_INCLUDEDIR}/pellucid-rooms)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)

install(TARGETS pellucid_c EXPORT pellucid-c
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT c NAMELINK_COMPONENT dev)
install(DIRECTORY engine_bridge/include/pellucid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(EXPORT pellucid-c NAMESPACE pellucid:: DESTINATION ${config_folder} COMPONENT dev)
install(FILES LICENSE engine_bridge/INTEGRATION.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT docs)
install(FILES tests/bridge/outside/outside.c DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT docs)

configure_package_config_file(cmake/pellucidConfig.cmake.in ${CMAKE_BINARY_DIR}/pellucidConfig.cmake INSTALL_DESTINATION ${config_folder})
# While the major version is 0, a minor one may ask a host for another line.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/pellucidConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/pellucidConfig.cmake ${CMAKE_BINARY_DIR}/pellucidConfigVersion.cmake
  DESTINATION ${config_folder} COMPONENT dev)
set(pkgconfig_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
configure_file(cmake/pellucid.pc.in ${CMAKE_BINARY_DIR}/pellucid.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/pellucid.pc DESTINATION ${pkgconfig_folder} COMPONENT dev)

if(NOT PELLUCID_ROOMS)
  return()
endif()
install(TARGETS pellucid RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS pellucid_images pellucid_grids pellucid_plots
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/pellucid COMPONENT program)
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program OPTIONAL)
install(DIRECTORY ${CMAKE_BINARY_DIR}/share/bash-completion ${CMAKE_BINARY_DIR}/share/zsh
  DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT program OPTIONAL)
if(TARGET pellucid_python)
  set(python_folder lib/python3/dist-packages)
  install(TARGETS pellucid_python LIBRARY DESTINATION ${python_folder}/pellucid COMPONENT python)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/python/pellucid DESTINATION ${python_folder} COMPONENT python
    PATTERN __pycache__ EXCLUDE PATTERN "*.so" EXCLUDE)
endif()
install(TARGETS ${rooms} EXPORT pellucid-rooms ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT rooms)
install(DIRECTORY shaders gbuffer engine_bridge composite DESTINATION ${rooms_include} COMPONENT rooms
  FILES_MATCHING PATTERN "*.h" PATTERN "*.glsl" PATTERN "engine_bridge/c" EXCLUDE PATTERN "engine_bridge/include" EXCLUDE
  PATTERN "composite/cli" EXCLUDE)
install(EXPORT pellucid-rooms NAMESPACE pellucid:: DESTINATION ${config_folder} COMPONENT rooms)
configure_file(cmake/pellucid-rooms.pc.in ${CMAKE_BINARY_DIR}/pellucid-rooms.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/pellucid-rooms.pc DESTINATION ${pkgconfig_folder} COMPONENT rooms)
if(PELLUCID_PACKAGES)
  include(cmake/Package.cmake)
endif()
