# What `cmake --install` puts in place: program, library, header, pkg-config file, CMake package.
install(TARGETS lacquer-library EXPORT lacquer-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        PUBLIC_HEADER DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS lacquer-program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY recipes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lacquer/recipes)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lacquer)
install(EXPORT lacquer-targets NAMESPACE lacquer:: DESTINATION ${package_dir})
configure_package_config_file(cmake/lacquer-config.cmake.in ${PROJECT_BINARY_DIR}/lacquer-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lacquer-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lacquer-config.cmake
              ${PROJECT_BINARY_DIR}/lacquer-config-version.cmake
        DESTINATION ${package_dir})

# A static library is the only one there is to link, so what it needs must show without --static.
set(pc_needs "-lOpenEXRCore ${OpenMP_C_FLAGS} -lm")
if(BUILD_SHARED_LIBS)
  set(pc_requires "Requires.private: jansson zlib libzstd lapacke openblas cairo")
  set(pc_libs "Libs: -L\${libdir} -llacquer\nLibs.private: ${pc_needs}")
else()
  set(pc_requires "Requires: jansson zlib libzstd lapacke openblas cairo")
  set(pc_libs "Libs: -L\${libdir} -llacquer ${pc_needs}")
endif()
file(RELATIVE_PATH pc_to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
configure_file(cmake/lacquer.pc.in ${PROJECT_BINARY_DIR}/lacquer.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lacquer.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
