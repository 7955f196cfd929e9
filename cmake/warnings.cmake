# Compiler warnings and sanitizers, for every target of this project.

add_library(blactl-warnings INTERFACE)
target_compile_options(blactl-warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast -Wformat=2 -Wimplicit-fallthrough)
if(BLACTL_WERROR)
  target_compile_options(blactl-warnings INTERFACE -Werror)
endif()
# They watch what users run; tests are only linked with them, which are a third less to compile so.
add_library(blactl-sanitizers INTERFACE)
if(BLACTL_SANITIZE)
  target_compile_options(blactl-sanitizers INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    # These take a fifth of the compile time. The address sanitizer sees what is accessed through a
    # null pointer or beyond an object; no base class is cast to a derived one.
    -fno-sanitize=null,object-size,vptr)
  target_link_options(blactl-sanitizers INTERFACE -fsanitize=address,undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 sees uninitialised memory in std::regex and std::variant that is not, once it
    # instruments them.
    target_compile_options(blactl-sanitizers INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
if(BLACTL_FUZZ)
  target_compile_options(blactl-sanitizers INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(BLACTL_COVERAGE)
  # Simulator and client are threads of one process in some tests.
  target_compile_options(blactl-sanitizers INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(blactl-sanitizers INTERFACE --coverage)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # std::stable_sort() of GCC 12 calls a function that it has deprecated.
  target_compile_options(blactl-warnings INTERFACE -Wno-deprecated-declarations)
endif()
# Where several files are one unit, a local name may hide one of another file, and a type of a file's
# own may stand in a unit with another main file: there neither is a mistake.
set(in_unity $<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>)
target_compile_options(blactl-warnings INTERFACE $<${in_unity}:-Wno-shadow>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(blactl-warnings INTERFACE
    "$<${in_unity}:-Wshadow=local;-Wno-subobject-linkage>")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 warns of `"text" + std::string()` itself (its bug 105651).
  target_compile_options(blactl-warnings INTERFACE -Wno-restrict)
endif()
