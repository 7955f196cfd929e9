# shellcheck shell=bash
# What scripts share that run a program in a machine of its own: `. "$(dirname "$0")/machine.sh"`.
# $scratch is a folder that is gone in the end.

script=${0##*/}
machine=''

# die STATUS TEXT
die() {
  echo "$script: $2" >&2
  exit "$1"
}

scratch=$(mktemp -d) || die 125 "no scratch folder"
# shellcheck disable=SC2317 # called by the trap
cleanup() {
  [ -z "$machine" ] || kill "$machine" 2>/dev/null
  rm -rf -- "$scratch"
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# finish MACHINE SECONDS PROGRAM FOLDER LOGS...: waits for the process of the machine, prints what the
# program printed (FOLDER/log), and exits with its status (FOLDER/status). LOGS tell why there is none.
finish() {
  local name=$1 seconds=$2 program=$3 folder=$4 ended
  shift 4
  wait "$machine"
  ended=$?
  machine=''
  [ ! -f "$folder/log" ] || cat "$folder/log"
  if [ -s "$folder/status" ]; then
    exit "$(cat "$folder/status")"
  fi
  if [ $ended -eq 124 ] || [ $ended -eq 137 ]; then
    die 124 "ended after $seconds s: $program"
  fi
  cat "$@" >&2 2>/dev/null
  die 125 "$name did not run $program (see above; status $ended)"
}
