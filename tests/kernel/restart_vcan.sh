#!/bin/bash
# What a write is worth after a restart, on vcan0 of a real kernel: uml.sh restart_vcan.sh BLACTL.
# The simulator counts ROM writes, candump is the witness of what is on the wire.

# shellcheck disable=SC2119 # witness_start takes an interface, which is vcan0 here
set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: uml.sh restart_vcan.sh BLACTL}
simulator=''

# sim SERVO...: simulated servos on vcan0, until sim_end; each is an object of a scenario file.
sim() {
  local IFS=,
  echo "{\"schema\":\"blactl-scenario/1\",\"servos\":[$*]}" >"$TMPDIR/scenario.json"
  "$blactl" sim -i vcan0 --json "$TMPDIR/scenario.json" >"$TMPDIR/sim.out" 2>"$TMPDIR/sim.err" &
  simulator=$!
  wait_for 20 grep -q '"ready"' "$TMPDIR/sim.out"
}

sim_end() {
  kill "$simulator"
  wait "$simulator"
  [ $? -eq 143 ] || fail "the simulator did not end by the signal"
}

# expect_events N KIND: so many of these have happened in the simulated servos.
expect_events() {
  local count
  count=$(grep -c "\"event\":\"$2\"" "$TMPDIR/sim.out")
  [ "$count" -eq "$1" ] || fail "expected $1 $2, the simulator tells $count"
}

# expect_value VALUE NODE PARAMETER: as raw number.
expect_value() {
  run "$blactl" get -n "$2" "$3" -j
  expect_status 0
  case $out in *"\"raw\": $1,"*) ;; *) fail "expected raw $1 of $3" ;; esac
}

# is_held ID: a process uses this node ID on vcan0. To try the lock would be to hold it.
is_held() {
  grep -q ":$(stat -c %i "/run/lock/blactl/vcan0@$(stat -Lc %i /proc/self/ns/net).$1") " /proc/locks
}

# at ID [MORE KEYS]: a servo of a scenario.
at() {
  echo "{\"model\":\"BLA21-12U-AB\",\"node_id\":$1${2:+,$2}}"
}

note "a servo with a static ID: set, save, back, read again"
sim "$(at 11)" "$(at 12 '"servo_id":1')"
run "$blactl" set -n 11 angle_limit_cw=90deg --save -y
expect_status 0
expect_events 1 rom_write
expect_value 900 11 angle_limit_cw
run "$blactl" set -n 12 angle_limit_cw=80deg
expect_status 0
run "$blactl" restart -n all -y
expect_status 0
expect_value 900 11 angle_limit_cw
expect_value 1799 12 angle_limit_cw # was not saved
expect_events 1 rom_write

sim_end

note "a servo with a dynamic ID: set, save, back under the same ID, read again"
sim "$(at 0)"
run "$blactl" alloc --once --range 11-11
expect_status 0
expect_events 1 allocated
run "$blactl" set -n 11 angle_limit_cw=70deg --save -y
expect_status 0
expect_events 2 allocated
expect_events 1 rom_write
run "$blactl" restart -n 11 -y
expect_status 0
expect_events 3 allocated
expect_value 700 11 angle_limit_cw
expect_value 0 11 static_node_id
sim_end

note "a lost answer to SAVE: no second ROM write, and no second SAVE on the wire"
sim "$(at 11 '"faults":{"lose_opcode_answers":1}')"
witness_start
run "$blactl" save -n 11 -y
witness_stop
expect_status 0
expect_events 1 rom_write
expect_frames 1 '1E0A8B(FF|FE)'
sim_end

note "three processes at once: one writes, a second one that wants to is told who, others read"
sim "$(at 11 '"faults":{"return_delay":"12s"}')" "$(at 12 '"servo_id":1')"
"$blactl" save -n 11 -y --wait 30 >"$TMPDIR/save.out" 2>&1 &
writer=$!
wait_for 20 grep -q '"event":"rom_write"' "$TMPDIR/sim.out"
run "$blactl" set -n 12 smoothing=off
expect_status 9
expect_err '[busy]'
expect_err "$writer"
run "$blactl" save -n 12 -y
expect_status 9
"$blactl" wait -n 44 --wait 10 >"$TMPDIR/wait.out" 2>&1 & # for what never comes
reader=$!
wait_for 20 is_held 126
run "$blactl" get -n 12 smoothing # the two default IDs are taken
expect_status 9
expect_err '[no_local_node_id]'
run "$blactl" get -n 12 smoothing --local-node-id 101
expect_status 0
wait "$reader"
[ $? -eq 4 ] || fail "the second process did not end with 4: $(cat "$TMPDIR/wait.out")"
wait "$writer" || fail "the save failed: $(cat "$TMPDIR/save.out")"
expect_events 1 rom_write
sim_end

note "kill -9 of the writer, and of a reader: the others work, the next writer begins at once"
sim "$(at 11 '"faults":{"return_delay":"20s"}')" "$(at 12 '"servo_id":1')"
"$blactl" save -n 11 -y --wait 40 >"$TMPDIR/save.out" 2>&1 &
writer=$!
"$blactl" scan --listen 60 >/dev/null 2>&1 &
reader=$!
"$blactl" trace --count 40 >"$TMPDIR/trace.out" 2>&1 &
third=$!
wait_for 20 grep -q '"event":"rom_write"' "$TMPDIR/sim.out"
kill -9 "$writer" "$reader"
wait "$writer" "$reader" 2>/dev/null
run "$blactl" set -n 12 smoothing=off --save -y
expect_status 0
wait "$third" || fail "the trace failed: $(cat "$TMPDIR/trace.out")"
for _ in 1 2 3; do # the local IDs of the killed are free again
  run "$blactl" get -n 12 smoothing
  expect_status 0
done
sim_end
