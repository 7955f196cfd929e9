# blactl_unity(target): the sources of a target in a few units, in builds that are made to be run
# once (BLACTL_UNITY). A header is then read once for several files, which is most of the work.
#
# Sources of one floor come together only with each other, those of src/cli by folder, so names that
# are local to a file must be unique there: scripts/tidy tells which are not.
#
# blactl_unity(target OWN_NAMESPACES): for tests. Each file is in a namespace of its own, so its names
# are its own too; what it includes is included before, outside of it. Other files than tests are
# compiled by themselves.

# More files a unit cost fewer headers, but leave a processor without work at the end.
set(BLACTL_UNITY_BYTES 150000 CACHE STRING "Source in a unit, about")

# The sources that come together with this one: a floor, or a folder.
function(blactl_unity_room name result)
  cmake_path(GET name PARENT_PATH room)
  if(name MATCHES "^src/" AND NOT name MATCHES "^src/cli/")
    string(REGEX MATCH "^src/[^/]+" room "${name}")
  endif()
  set(${result} "${room}" PARENT_SCOPE)
endfunction()

# A header that includes whatever the sources include.
function(blactl_include_before target sources)
  set(lines "")
  foreach(source IN LISTS sources)
    file(STRINGS ${source} includes REGEX "^#include ")
    list(APPEND lines ${includes})
    cmake_path(GET source PARENT_PATH folder)
    target_include_directories(${target} PRIVATE ${folder})
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
  list(REMOVE_DUPLICATES lines)
  list(JOIN lines "\n" text)
  set(header ${CMAKE_CURRENT_BINARY_DIR}/${target}_includes.hpp)
  file(CONFIGURE OUTPUT ${header} CONTENT "#pragma once\n${text}\n" @ONLY)
  target_compile_options(${target} PRIVATE "SHELL:-include ${header}")
endfunction()

function(blactl_unity target)
  if(NOT BLACTL_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(SORT sources)
  if("OWN_NAMESPACES" IN_LIST ARGN)
    list(TRANSFORM sources REPLACE "^([^/])" "${CMAKE_CURRENT_SOURCE_DIR}/\\1")
    blactl_include_before(${target} "${sources}")
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD_UNIQUE_ID BLACTL_UNITY_FILE
      UNITY_BUILD_CODE_BEFORE_INCLUDE "namespace BLACTL_UNITY_FILE {"
      UNITY_BUILD_CODE_AFTER_INCLUDE "}")
  endif()
  set(last "")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${path})
    blactl_unity_room(${name} room)
    if(NOT name MATCHES "^(src|tests)/")
      continue() # what is generated is by itself too
    endif()
    if("OWN_NAMESPACES" IN_LIST ARGN AND NOT name MATCHES "_(test|bench)\\.cpp$")
      continue() # defines what tests share
    endif()
    file(SIZE ${path} length)
    if(NOT room STREQUAL last OR have GREATER BLACTL_UNITY_BYTES)
      set(last ${room})
      set(have 0)
      string(MAKE_C_IDENTIFIER "${name}" group)
    endif()
    math(EXPR have "${have} + ${length}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
