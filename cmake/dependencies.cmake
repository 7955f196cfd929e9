# The libraries that blactl is built on, by their Debian 12 packages. A missing one is named with
# the command that installs it.

set(BLACTL_PACKAGES "")

macro(blactl_require found package)
  if(NOT ${found})
    list(APPEND BLACTL_PACKAGES ${package})
  endif()
endmacro()

find_package(fmt 9 QUIET)
blactl_require(fmt_FOUND libfmt-dev)
find_package(CLI11 2.1 QUIET)
blactl_require(CLI11_FOUND libcli11-dev)
find_package(nlohmann_json 3.11 QUIET)
blactl_require(nlohmann_json_FOUND nlohmann-json3-dev)
find_package(ZLIB QUIET) # logs that gzip has packed
blactl_require(ZLIB_FOUND zlib1g-dev)
find_package(PkgConfig QUIET)
blactl_require(PkgConfig_FOUND pkg-config)
if(PkgConfig_FOUND)
  # Link state, bit timing and queue length of CAN interfaces.
  pkg_check_modules(NL_ROUTE IMPORTED_TARGET QUIET libnl-route-3.0)
  blactl_require(NL_ROUTE_FOUND libnl-route-3-dev)
  # What must survive a power cut, and several processes at once. 3.37 is the first with STRICT.
  pkg_check_modules(SQLITE3 IMPORTED_TARGET QUIET sqlite3>=3.37)
  blactl_require(SQLITE3_FOUND libsqlite3-dev)
  # Digests: what dpkg uses, small, and on every Debian.
  pkg_check_modules(MD IMPORTED_TARGET QUIET libmd)
  blactl_require(MD_FOUND libmd-dev)
  # The screen of monitor: every terminal, wide characters among its cells.
  pkg_check_modules(NCURSES IMPORTED_TARGET QUIET ncursesw>=6.1)
  blactl_require(NCURSES_FOUND libncurses-dev)
endif()
if(BUILD_TESTING)
  find_package(Catch2 QUIET) # 2 in Debian 12, 3 elsewhere
  blactl_require(Catch2_FOUND catch2)
endif()

if(BLACTL_PACKAGES)
  list(JOIN BLACTL_PACKAGES " " BLACTL_PACKAGES)
  message(FATAL_ERROR "blactl: missing libraries. On Debian install them with\n"
                      "  sudo apt-get install ${BLACTL_PACKAGES}\n")
endif()
