# ricochet_unity_groups(TARGET SIZE): with CMAKE_UNITY_BUILD the sources of one folder and its parts are compiled together, at most SIZE of
# them, which takes less than half the time: what they all instantiate is instantiated once. A name in an anonymous namespace
# must then be the only one of its folder; the presets "debug" and "fuzz" compile each file alone, so that none relies on what
# its neighbour includes.
function(ricochet_unity_groups target size)
  get_target_property(sources ${target} SOURCES)
  list(SORT sources)
  set(last_folder "")
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
    # A folder's parts go with it: scheme/semi_explicit with scheme, but solver/contact is a library of its own.
    string(REGEX REPLACE "^(src/ricochet/[^/]*)/.*" "\\1" folder ${folder})
    if(NOT folder STREQUAL last_folder)
      set(last_folder ${folder})
      set(count 0)
      set(group 0)
    elseif(count EQUAL ${size})
      set(count 0)
      math(EXPR group "${group} + 1")
    endif()
    math(EXPR count "${count} + 1")
    string(MAKE_C_IDENTIFIER "${folder}_${group}" name)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()
