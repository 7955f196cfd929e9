#!/bin/bash
# Runs a program in a network namespace of its own, as root in it: nothing it sends leaves it, and
# no privilege is needed where users may make namespaces. Exits with the program's status.
#
#   tests/net/namespace.sh PROGRAM [ARGUMENTS]
#
# Only the interface lo is there, and up. /run is empty: lock files and the state folder are the
# program's own. Whatever it leaves running ends with it. BLACTL_NET_OF_ITS_OWN tells it that it may
# do with this network what it likes.
#
# Exit status 77: neither root nor other users can make namespaces here; the test did not run.

set -u
PATH=$PATH:/usr/sbin:/sbin

# die STATUS TEXT
die() {
  echo "namespace.sh: $2" >&2
  exit "$1"
}

[ $# -ge 1 ] || die 125 "usage: namespace.sh PROGRAM [ARGUMENTS]"
for needed in unshare ip; do
  command -v $needed >/dev/null || die 77 "SKIPPED: $needed is missing (util-linux, iproute2)"
done
own=(unshare --net --mount --pid --fork --kill-child)
if ! "${own[@]}" true 2>/dev/null; then
  own+=(--user --map-root-user)
  "${own[@]}" true || die 77 "SKIPPED: network namespaces are not permitted here"
fi

# shellcheck disable=SC2016 # what expands, expands inside
exec "${own[@]}" bash -c '
  mount -t tmpfs tmpfs /run && mkdir -m 1777 /run/lock && ip link set lo up || exit 125
  # LeakSanitizer reads /proc of its own PID namespace. A container may forbid to mount it.
  mount -t proc proc /proc 2>/dev/null || export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
  unset XDG_RUNTIME_DIR
  export BLACTL_NET_OF_ITS_OWN=yes BLACTL_STATE_DIR=/run/state
  "$@"' namespace.sh "$@"
