# blactl_embed(OUT files…): one generated source that holds the files as text, so that the binary
# needs nothing beside it. A cmake -P script does the work: it also runs in cross builds.

function(blactl_embed out)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_profiles.cpp)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} "-DFILES=${ARGN}"
            -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed_files.cmake
    DEPENDS ${ARGN} ${CMAKE_CURRENT_SOURCE_DIR}/cmake/embed_files.cmake
    COMMENT "Embedding the profiles"
    VERBATIM)
  set(${out} ${source} PARENT_SCOPE)
endfunction()
