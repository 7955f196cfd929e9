# blactl_unity(target): the sources of a target in a few units, in builds that are made to be run
# once (BLACTL_UNITY). A header is then read once for several files, which is most of the work.
#
# Files of one folder come together only with each other, so names that are local to a file must be
# unique in its folder: scripts/tidy tells which are not.

# More files a unit cost fewer headers, but leave a processor without work at the end.
set(BLACTL_UNITY_BYTES 50000 CACHE STRING "Source in a unit, about")

function(blactl_unity target)
  if(NOT BLACTL_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(SORT sources)
  set(last "")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${path})
    cmake_path(GET name PARENT_PATH folder)
    if(NOT name MATCHES "^(src|tests)/")
      continue() # what is generated is by itself too
    endif()
    file(SIZE ${path} length)
    if(NOT folder STREQUAL last OR have GREATER BLACTL_UNITY_BYTES)
      set(last ${folder})
      set(have 0)
      string(MAKE_C_IDENTIFIER "${name}" group)
    endif()
    math(EXPR have "${have} + ${length}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
