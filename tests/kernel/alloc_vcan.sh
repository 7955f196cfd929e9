#!/bin/bash
# 20 servos out of the box get node IDs on vcan0 of a real kernel: uml.sh alloc_vcan.sh BLACTL. What
# is on the wire, another allocator too, comes in real time and from other processes.

set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: uml.sh alloc_vcan.sh BLACTL}

# servos FIRST LAST: as a list of a scenario file; none of them has a node ID. This machine is slow:
# actuator.Status, which nobody needs here, would be most of its load.
servos() {
  local each='"model":"BLA21-12U-AB","node_id":0,"faults":{"no_actuator_status":true}'
  seq "$1" "$2" | sed "s/.*/{$each,\"serial_number\":&,\"servo_id\":&}/" | paste -sd,
}

# sim NAME KEYS: a simulator of its own on vcan0, until the machine ends.
sim() {
  echo "{\"schema\":\"blactl-scenario/1\",$2}" >"$TMPDIR/$1.json"
  "$blactl" sim -i vcan0 --json "$TMPDIR/$1.json" >"$TMPDIR/$1.out" 2>"$TMPDIR/$1.err" &
  wait_for 20 grep -q '"ready"' "$TMPDIR/$1.out"
}

# has_allocated N NAME: so many servos of that simulator have got a node ID.
has_allocated() {
  [ "$(grep -c '"event":"allocated"' "$TMPDIR/$2.out")" -eq "$1" ]
}

# units: the unique IDs, of 32 digits, and the node IDs right behind them, of a document on stdin.
units() {
  awk '/"node_id":/ { id = $2 } /"unique_id":/ { unit = $2 } /"unique_id":|"node_id":/ {
    if (id && unit) { print unit id; id = unit = "" } }' | tr -d '",' | sort
}

# same A B: two such lists, as texts.
same() {
  [ "$1" = "$2" ] || fail "expected these units and IDs: $1"$'\n'"got: $2"
}

# expect_own_ids N LIST: so many units, each with an ID that no other one has.
expect_own_ids() {
  [ "$(echo "$2" | cut -c 1-32 | sort -u | wc -l)" -eq "$1" ] || fail "expected $1 units: $2"
  [ "$(echo "$2" | cut -c 33- | sort -u | wc -l)" -eq "$1" ] || fail "expected $1 IDs: $2"
}

note "20 servos ask at once: each gets an ID of its own"
sim first "\"servos\":[$(servos 1 20)]"
run "$blactl" -i vcan0 alloc --once -j
expect_status 0
expect_out '"counts":{"nodes":20,"failed":0,"assigned":20,"kept":0}'
run "$blactl" scan --expect 20 -j
expect_status 0
before=$(echo "$out" | units)
expect_own_ids 20 "$before"
run "$blactl" alloc --list -j
same "$before" "$(echo "$out" | units)"

note "after a restart of all of them each has the same ID again"
run "$blactl" restart -n 106-125 -y # -n all looks for actuator.Status
expect_status 0
run "$blactl" scan --expect 20 -j
expect_status 0
same "$before" "$(echo "$out" | units)"
[ "$(grep -c '"event":"restart"' "$TMPDIR/first.out")" -eq 20 ] || fail "expected 20 restarts"

note "another allocator comes, and then two servos that ask: we are silent, and end with 9"
"$blactl" alloc -j >"$TMPDIR/alloc.out" 2>"$TMPDIR/alloc.err" &
allocator=$!
wait_for 20 grep -q 'free: ' "$TMPDIR/alloc.err"
sim other '"servos":[],"foreign":[{"kind":"autopilot","node_id":100,"allocates":true}]'
sleep 3 # to it only those that it has heard have an ID
sim second "\"servos\":[$(servos 21 22)]"
wait "$allocator"
[ $? -eq 9 ] || fail "alloc did not end with 9: $(cat "$TMPDIR/alloc.out" "$TMPDIR/alloc.err")"
grep -q '\[other_allocator\].*node 100' "$TMPDIR/alloc.err" || fail "it does not name the other"
! grep -qE '"event":"(assigned|kept)"' "$TMPDIR/alloc.out" ||
  fail "it has given an ID beside the other: $(cat "$TMPDIR/alloc.out")"
wait_for 60 has_allocated 2 second
run "$blactl" scan --expect 22 -j
after=$(echo "$out" | units | grep -v '100$') # the other allocator itself
expect_own_ids 22 "$after"
same "$before" "$(echo "$after" | grep -F "$before")"
