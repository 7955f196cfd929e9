#!/bin/bash
# One job of eight servos on vcan0 of a real kernel and on the simulated bus ends the same way:
# uml.sh apply_vcan.sh BLACTL DATA. Two exchange their node IDs, three rotate theirs, one moves.

set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: uml.sh apply_vcan.sh BLACTL DATA}
data=${2:?usage: uml.sh apply_vcan.sh BLACTL DATA}

# job NAME INTERFACE ARGUMENT...: the simulator with these arguments, and apply, export and diff on
# its bus. Leaves NAME.status, NAME.nodes and NAME.rom: how it ended, and what ROM holds.
job() {
  local name=$1 interface=$2
  shift 2
  mkfifo "$TMPDIR/$name.orders"
  "$blactl" --json sim "$@" "$data/scenarios/eight.json" <"$TMPDIR/$name.orders" \
    >"$TMPDIR/$name.out" 2>"$TMPDIR/$name.err" &
  local simulator=$!
  exec 3>"$TMPDIR/$name.orders"
  wait_for 20 grep -q '"ready"' "$TMPDIR/$name.out"
  run "$blactl" -i "$interface" --json --yes apply "$data/fleets/eight.json"
  echo "$status" >"$TMPDIR/$name.status"
  echo "$out" | grep -E '"(name|status|saved|verified_after_restart|node_id_after)":' \
    >"$TMPDIR/$name.nodes"
  echo dump >&3
  wait_for 20 grep -q '"dumped"' "$TMPDIR/$name.out"
  grep '"event":"state"' "$TMPDIR/$name.out" |
    sed 's/.*"serial_number":\([0-9]*\).*"rom":/\1 /' | sort >"$TMPDIR/$name.rom"
  run "$blactl" -i "$interface" diff "$data/fleets/eight.json"
  expect_status 0
  exec 3>&-
  kill "$simulator"
  wait "$simulator"
}

note "on the simulated bus"
export XDG_RUNTIME_DIR=$TMPDIR
job simulated sim: --clock virtual
note "on vcan0"
job vcan vcan0 -i vcan0
[ "$(cat "$TMPDIR/vcan.status")" -eq 0 ] || fail "apply on vcan0 ended with $(cat "$TMPDIR/vcan.status")"
[ "$(wc -l <"$TMPDIR/vcan.rom")" -eq 8 ] || fail "expected eight memories"
[ "$(grep -c '"status": "changed"' "$TMPDIR/vcan.nodes")" -ge 8 ] || fail "not all are changed"
for what in status nodes rom; do
  cmp "$TMPDIR/simulated.$what" "$TMPDIR/vcan.$what" ||
    fail "another $what on vcan0: $(diff "$TMPDIR/simulated.$what" "$TMPDIR/vcan.$what")"
done
