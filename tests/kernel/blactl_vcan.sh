#!/bin/bash
# The built blactl on vcan0 of a real kernel: uml.sh blactl_vcan.sh BLACTL, where BLACTL is the
# binary. candump is the witness of what is on the wire.

# shellcheck disable=SC2119 # witness_start takes an interface, which is vcan0 here
set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: uml.sh blactl_vcan.sh BLACTL}
simulator=''

# sim: simulated servos on vcan0, until sim_end.
sim() {
  "$blactl" sim -i vcan0 >"$TMPDIR/sim.out" 2>&1 &
  simulator=$!
  wait_for 20 grep -q '^ready$' "$TMPDIR/sim.out"
}

sim_end() {
  kill "$simulator"
  wait "$simulator"
  [ $? -eq 143 ] || fail "the simulator did not end by the signal"
}

# What this tool sends has the source 127 or 126; services bear bit 7.
from_us='[0-9A-F]{6}(7F|FF|7E|FE)'

# expect_silence: the witness saw no frame of ours.
expect_silence() {
  expect_frames 0 "$from_us"
}

# expect_writes N NODE: so many frames of multi-frame GetSet requests, which is what writes are (a
# read fits into one frame), went to the node. NODE is its ID with bit 7 set, in hexadecimal.
expect_writes() {
  local count
  count=$(grep -cE " 1E0B$2(FF|FE)#([0-9A-F]{2})*[^CD][0-9A-F]$" "$witness_log")
  [ "$count" -eq "$1" ] || fail "expected $1 frames of writes to $2, the witness saw $count"
}

note "an interface that is down, missing, or no CAN interface"
ip link set vcan0 down
run "$blactl" scan
expect_status 3
expect_err '[interface]'
expect_err 'sudo ip link set vcan0 up'
run "$blactl" -i vcan0 get
expect_status 3
expect_err 'sudo ip link set vcan0 up'
ip link set vcan0 up
run "$blactl" -i can7 scan
expect_status 3
expect_err 'vcan0'
run "$blactl" -i lo scan
expect_status 3

note "nobody on the bus"
run "$blactl" scan
expect_status 4
expect_err '[not_found]'

note "the main job, with the only interface found by itself"
sim
run "$blactl" scan --expect 3
expect_status 0
expect_out 'BLA21-12U-AB'
expect_out 'BLA15-06U-A0'
expect_out 'BLA34-28U-AB'
run "$blactl" get --all -n 11
expect_status 0
expect_out '1799  (179.9 deg)'
run "$blactl" get -j --all
expect_status 0
expect_out '"interface": "vcan0"'

note "a validated write crosses the wire once, as three frames"
witness_start
run "$blactl" set -n 11 angle_limit_cw=90deg
witness_stop
expect_status 0
expect_out 'written'
expect_writes 3 8B
grep -q '1E0B8BFF#[0-9A-F]\{4\}0001840300' "$witness_log" ||
  fail "the first frame of the write does not carry 900 (0x0384)"
run "$blactl" get -n 11 angle_limit_cw
expect_out '900  (90.0 deg)'

note "an equal value is not written again"
witness_start
run "$blactl" set -n 11 angle_limit_cw=900raw
witness_stop
expect_status 0
expect_out 'unchanged'
expect_writes 0 8B

note "what every model refuses sends not one frame"
witness_start
for refused in angle_limit_cw=90.05deg temperature_limit_high=81degC model_number=61 0x28=0 \
  static_node_id=127; do
  run "$blactl" set -n 11 "$refused"
  expect_status 2
done
run "$blactl" set -n 11 soft_start=on 0x21=0
expect_status 2
witness_stop
expect_silence

note "what this servo refuses is read first, and then nothing is written"
witness_start
run "$blactl" set -n 11 voltage_limit_high=40V
expect_status 2
expect_err '24.0V'
run "$blactl" set -n 12 pwm_neutral=1500us
expect_status 2
expect_err '[unsupported]'
run "$blactl" set -n 11,12 smoothing=off pwm_mode=speed
expect_status 2
witness_stop
expect_writes 0 8B
expect_writes 0 8C

note "a question without a terminal is a no"
witness_start
run "$blactl" set -n 11 torque_output=off
expect_status 7
witness_stop
expect_writes 0 8B
sim_end

note "34 gets in a row, beyond the lap of transfer IDs, against servos that drop repeated ones: not one retry"
sim
sleep 4 # the uptime of a younger servo proves no restart, and all is read twice
witness_start
for _ in $(seq 34); do
  "$blactl" get -n 11 soft_start >/dev/null || fail "get failed"
done
witness_stop
# a servo does not answer a repeated one; a machine that is busy lets the simulator pause, after which
# blactl asks again who it is, and reads again
expect_answered 68 1E018BFF 1E017F8B  # who is it, and was it the same one to the end
expect_answered 204 1E0B8BFF 1E0B7F8B # 0x50-0x53, 0x45 and the parameter

# frames_of LOG [FILTER]: the frames of a log without their times and interfaces; marks left out.
frames_of() {
  awk '$3 !~ /^7FF#/ { print $3 }' "$1"
}

note "a recording holds what candump saw, and canplayer plays it to the same frames"
record=$TMPDIR/record.log
witness_start
run "$blactl" get -j --all --record "$record"
expect_status 0
witness_stop
expected=$out
frames_of "$record" >"$TMPDIR/recorded"
frames_of "$witness_log" >"$TMPDIR/witnessed"
[ "$(wc -l <"$TMPDIR/recorded")" -gt 500 ] || fail "the recording has too few frames"
# The witness was there before and after: the recording is a piece of what it saw.
first=$(head -n 1 "$record" | cut -d ' ' -f 1)
last=$(tail -n 1 "$record" | cut -d ' ' -f 1)
awk -v first="$first" -v last="$last" '$1 >= first && $1 <= last' "$witness_log" |
  diff "$record" - >"$TMPDIR/diff" || fail "recorded, not as witnessed: $(head "$TMPDIR/diff")"
sim_end
witness_start
canplayer -I "$record" -g 1 || fail "canplayer does not take the recording"
witness_stop
frames_of "$witness_log" | diff "$TMPDIR/recorded" - >"$TMPDIR/diff" ||
  fail "played, not as recorded: $(head "$TMPDIR/diff")"

note "the recording, and candump's own, answer as the servos did"
for log in "$record" "$witness_log"; do
  run "$blactl" -i "replay:$log" get -j --all
  expect_status 0
  [ "${out/replay:$log/vcan0}" = "$expected" ] || fail "$log answers otherwise"
done
sim

note "garbage, foreign frames and floods on the bus disturb nobody"
cangen vcan0 -g 2 -e -I 1003F363 -L r -D r -n 3000 & # as if node 99 sent garbage
flood=$!
cangen vcan0 -g 2 -e -I 1E0BFF8D -L r -D r -n 3000 & # and node 13 answered what nobody asked
answers=$!
run "$blactl" get -n 11,12 angle_limit_cw
expect_status 0
expect_out '1799'
kill "$flood" "$answers" 2>/dev/null
wait "$flood" "$answers" 2>/dev/null
run "$blactl" get -j -n 13 angle_limit_cw
expect_status 0
cangen vcan0 -g 1 -e -I r -L r -D r -n 500 # anything, our own ID among it
sleep 3
cansend vcan0 123#1122334455
cansend vcan0 00000000#
cansend vcan0 1E0B7F8B#8055
run "$blactl" scan --expect 3
expect_out 'BLA34-28U-AB'

note "an error frame that says bus-off ends a command with 3"
"$blactl" scan --listen 20 >"$TMPDIR/scan.out" 2>&1 &
scan=$!
sleep 1
cansend vcan0 20000040#0000000000000000
wait "$scan"
[ $? -eq 3 ] || fail "bus-off did not end the scan with 3"
grep -q '\[bus_off\]' "$TMPDIR/scan.out" || fail "the scan does not say bus_off"

note "the interface goes down in the middle"
"$blactl" scan --listen 20 >"$TMPDIR/scan.out" 2>&1 &
scan=$!
sleep 1
ip link set vcan0 down
wait "$scan"
[ $? -eq 3 ] || fail "the scan did not end with 3"
grep -q '\[interface\]' "$TMPDIR/scan.out" || fail "the scan does not say interface"
wait "$simulator"
[ $? -eq 3 ] || fail "the simulator did not end with 3"
ip link set vcan0 up

note "an interface that goes down, or away, is waited for by those who watch"
sim
"$blactl" -i vcan0 monitor --json --rate 5 >"$TMPDIR/monitor.out" 2>"$TMPDIR/monitor.err" &
monitor=$!
for absence in down away; do
  : >"$TMPDIR/monitor.err"
  wait_for 20 grep -q '"voltage_v":12.0' "$TMPDIR/monitor.out"
  if [ $absence = down ]; then
    ip link set vcan0 down
  else
    ip link del vcan0
  fi
  wait "$simulator"
  wait_for 10 grep -q 'waiting for it' "$TMPDIR/monitor.err"
  wait_for 10 grep -q '"stale":true' "$TMPDIR/monitor.out"
  if [ $absence = away ]; then
    ip link add vcan0 type vcan
  fi
  ip link set vcan0 up
  wait_for 10 grep -q 'vcan0 is back' "$TMPDIR/monitor.err"
  : >"$TMPDIR/monitor.out"
  sim
done
wait_for 20 grep -q '"voltage_v":12.0' "$TMPDIR/monitor.out"
kill -INT "$monitor"
wait "$monitor"
[ $? -eq 130 ] || fail "the monitor did not end with 130"
sim_end

note "frames that nobody acknowledges"
tc qdisc add dev vcan0 root netem delay 5000ms limit 10
run "$blactl" get -n 11
expect_status 3
expect_err '[no_acknowledge]'
