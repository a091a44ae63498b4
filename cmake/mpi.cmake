# lacquer-mpi, the same program for mpirun, where there is an MPI; without one it is left out (docs/cluster.md).
find_package(MPI QUIET COMPONENTS C)
if(MPI_C_FOUND)
  add_executable(lacquer-mpi program/main.c program/crew_mpi.c $<TARGET_OBJECTS:lacquer-verbs>)
  lacquer_warnings(lacquer-mpi)
  target_compile_definitions(lacquer-mpi PRIVATE ${system_interfaces})
  target_link_libraries(lacquer-mpi PRIVATE lacquer-inside MPI::MPI_C PkgConfig::JANSSON OpenMP::OpenMP_C m)
  install(TARGETS lacquer-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
