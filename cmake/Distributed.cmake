# The library and the program for several processes. Debian's PETSc has no CMake package, but a pkg-config file.
find_package(MPI REQUIRED COMPONENTS CXX)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET petsc)
# PETSc divides meshes by PT-Scotch, but cannot reset its random numbers.
find_path(PTSCOTCH_INCLUDE_DIR ptscotch.h PATH_SUFFIXES scotch REQUIRED)
find_library(PTSCOTCH_LIBRARY ptscotch REQUIRED)
# They add Debian's compiler options; with other options the common headers would have to be precompiled again.
set_target_properties(MPI::MPI_CXX PkgConfig::PETSC PROPERTIES INTERFACE_COMPILE_OPTIONS "")

add_library(ricochet_distributed SHARED ${RICOCHET_DISTRIBUTED_SOURCES})
set_target_properties(ricochet_distributed PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION 0 DEFINE_SYMBOL "" INSTALL_RPATH "$ORIGIN")
# Open MPI's C++ interface is not used; its headers would take most of the compile time.
target_compile_definitions(ricochet_distributed PUBLIC OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
target_link_libraries(ricochet_distributed PUBLIC ricochet::ricochet MPI::MPI_CXX
  PRIVATE PkgConfig::PETSC ${PTSCOTCH_LIBRARY} ricochet_dependencies ricochet_warnings Threads::Threads)
target_include_directories(ricochet_distributed SYSTEM PRIVATE ${PTSCOTCH_INCLUDE_DIR})
target_precompile_headers(ricochet_distributed REUSE_FROM ricochet_contact_hot)
ricochet_unity_groups(ricochet_distributed)

add_executable(ricochet_mpi ${CMAKE_SOURCE_DIR}/apps/ricochet-mpi/main.cpp)
set_target_properties(ricochet_mpi PROPERTIES OUTPUT_NAME ricochet-mpi INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
target_link_libraries(ricochet_mpi PRIVATE ricochet_commands ricochet_distributed)
install(TARGETS ricochet_distributed LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT mpi NAMELINK_SKIP)
install(TARGETS ricochet_mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mpi)
