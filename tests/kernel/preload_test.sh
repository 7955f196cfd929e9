#!/bin/bash
# When uml.sh preloads uml_xstate.c, into what, and that the machine works with it.
#
#   BLACTL_UML_XSTATE=LIBRARY tests/kernel/preload_test.sh
#
# Exit status 77: User-Mode Linux is not installed; the test did not run.

set -u
: "${BLACTL_UML_XSTATE:?is to name the library}"
uml=$(dirname "$0")/uml.sh

# fail TEXT
fail() {
  echo "preload_test.sh: failed: $1" >&2
  exit 1
}

# has_library PID: whether the process has the library of the test in its memory
has_library() {
  grep -qF "$(realpath "$BLACTL_UML_XSTATE")" "/proc/$1/maps" 2>/dev/null
}

# kernel_of PID: the process of linux.uml among the descendants of PID
kernel_of() {
  local child children=()
  read -ra children 2>/dev/null <"/proc/$1/task/$1/children"
  for child in "${children[@]}"; do
    if [ "$(basename "$(readlink "/proc/$child/exe")")" = linux.uml ]; then
      echo "$child"
    else
      kernel_of "$child"
    fi
  done
}

# runs_with MODE yes|no: a machine runs a program that sees no library; linux.uml has it, or not
runs_with() {
  local begun found=no kernel
  begun=$(mktemp)
  # shellcheck disable=SC2016 # what expands, expands in the machine
  BLACTL_UML_PRELOAD=$1 "$uml" bash -c '
    echo begun >"$1"
    while [ -s "$1" ]; do sleep 0.1; done
    [ -z "${LD_PRELOAD:-}" ] && ! grep -F "$2" /proc/self/maps' \
    bash "$begun" "$(basename "$BLACTL_UML_XSTATE")" &
  local machine=$!
  for _ in {1..300}; do
    if [ -s "$begun" ] || ! kill -0 "$machine" 2>/dev/null; then
      break
    fi
    sleep 0.1
  done
  kernel=$(kernel_of "$machine" | head -n 1)
  ! has_library "${kernel:-none}" || found=yes
  : >"$begun"
  wait "$machine" || fail "$1: the program in the machine ended with $?"
  rm -f "$begun"
  [ -n "$kernel" ] || fail "$1: no process of linux.uml was found"
  [ "$found" = "$2" ] || fail "$1: the library is in linux.uml: $found, expected $2"
}

# refuses TEXT VARIABLE=VALUE…: uml.sh ends with 125, says TEXT and starts nothing
refuses() {
  local text=$1 said status=0
  shift
  said=$(env "$@" "$uml" true 2>&1) || status=$?
  [ $status -eq 125 ] || fail "$*: exit status $status, expected 125"
  [[ $said == *"$text"* ]] || fail "$*: it said: $said"
}

command -v linux.uml insmod >/dev/null || exit 77
needed=no
if grep -qw amx_tile /proc/cpuinfo; then
  needed=yes
fi
runs_with always yes
runs_with auto $needed
[ $needed = yes ] || runs_with never no
refuses "not one of auto, always, never" BLACTL_UML_PRELOAD=yes
refuses "not one of auto, always, never" BLACTL_UML_PRELOAD=Always
refuses "does not name the library" BLACTL_UML_PRELOAD=always BLACTL_UML_XSTATE=
refuses "does not name the library" BLACTL_UML_PRELOAD=always BLACTL_UML_XSTATE=/no/such.so
echo "linux.uml runs with the library and, unless there is AMX, without it"
