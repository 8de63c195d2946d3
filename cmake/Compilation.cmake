# How the library is compiled.

# Headers that nearly every source file includes are read once. The preset "fuzz" does without, so no file can come to rely on it.
set(RICOCHET_COMMON_HEADERS <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore> <fmt/format.h> <algorithm> <functional> <map> <memory>
  <string> <vector>)

# GCC collects its garbage whenever its heap has grown by a third, which takes a tenth of the time of a compilation; 2 GB are enough
# for the largest one.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options("SHELL:--param ggc-min-heapsize=2000000")
endif()

# Folders without a loop over numbers in the time loop: the optimizer would take a third of their compilation for nothing.
set(RICOCHET_COLD_FOLDERS base hdf5 fclib contact/construction contact/multipliers simulation/impact simulation/statics case io model run
  study report)
# Sources in these folders that have such loops.
set(RICOCHET_HOT_SOURCES base/dense_decompositions.cpp base/parallel.cpp base/expression.cpp)
# Code that is not worth the optimizer's time links this. (With less inlining GCC 12 takes vectors of Eigen for uninitialized, or for
# used after they were freed.)
add_library(ricochet_cold_code INTERFACE)
target_compile_options(ricochet_cold_code INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:Release>:-finline-small-functions>
  $<$<CONFIG:Release>:-Wno-maybe-uninitialized> $<$<CONFIG:Release>:-Wno-use-after-free>)

# ricochet_add_sources(LIBRARY SOURCES…): adds the sources to a library, those of cold folders as objects with their own options.
# Each part has its own precompiled header, as a function keeps the level of optimization that its header was compiled with.
function(ricochet_add_sources library)
  set(cold ${ARGN})
  list(JOIN RICOCHET_COLD_FOLDERS "|" folders)
  list(FILTER cold INCLUDE REGEX "/src/ricochet/(${folders})/")
  list(TRANSFORM RICOCHET_HOT_SOURCES PREPEND ${CMAKE_SOURCE_DIR}/src/ricochet/ OUTPUT_VARIABLE hot_ones)
  list(REMOVE_ITEM cold ${hot_ones})
  set(hot ${ARGN})
  list(REMOVE_ITEM hot ${cold})
  add_library(${library}_hot OBJECT ${hot})
  add_library(${library}_cold OBJECT ${cold})
  target_link_libraries(${library}_cold PRIVATE ricochet_cold_code)
  foreach(part hot cold)
    set_target_properties(${library}_${part} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_include_directories(${library}_${part} PRIVATE ${CMAKE_SOURCE_DIR}/src ${CMAKE_BINARY_DIR}/generated)
    target_link_libraries(${library}_${part} PRIVATE Eigen3::Eigen ricochet_dependencies ricochet_warnings Threads::Threads)
    ricochet_unity_groups(${library}_${part})
    if(library STREQUAL ricochet_contact)
      target_precompile_headers(${library}_${part} PRIVATE ${RICOCHET_COMMON_HEADERS})
    else()
      target_precompile_headers(${library}_${part} REUSE_FROM ricochet_contact_${part})
    endif()
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:${library}_${part}>)
  endforeach()
endfunction()
