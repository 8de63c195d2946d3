# All dependencies are found by name, as in Debian 12. Each search is strict, so that a missing package is reported here
# and not by the linker.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Basix REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(muparser REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(ZLIB REQUIRED)

set(BLA_VENDOR OpenBLAS)
find_package(BLAS REQUIRED)

find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(UMFPACK_LIBRARY umfpack REQUIRED)
find_package(PkgConfig REQUIRED)
# Debian installs it beside the parallel one; others call it hdf5.
pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial hdf5)

# Used by the library's own sources only: no public header includes any of these except Eigen.
add_library(ricochet_dependencies INTERFACE)
target_include_directories(ricochet_dependencies SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR} ${HDF5_INCLUDE_DIRS})
target_link_libraries(ricochet_dependencies INTERFACE
  Basix::basix fmt::fmt spdlog::spdlog tomlplusplus::tomlplusplus muparser::muparser nlohmann_json::nlohmann_json ZLIB::ZLIB
  ${CHOLMOD_LIBRARY} ${UMFPACK_LIBRARY} PkgConfig::HDF5 BLAS::BLAS)

add_library(ricochet_program_dependencies INTERFACE)
target_link_libraries(ricochet_program_dependencies INTERFACE CLI11::CLI11 fmt::fmt)
