#!/bin/bash
# blactl doctor on vcan0 of a real kernel: uml.sh doctor_vcan.sh BLACTL. What controllers report is
# told apart, and an interface that is down is raised.

set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: uml.sh doctor_vcan.sh BLACTL}
export BLACTL_INTERFACE=vcan0

# while_reported ERROR-FRAME COMMAND...: as run, while a controller reports this over and over.
while_reported() {
  (while sleep 0.2; do cansend vcan0 "$1"; done) &
  local reporter=$!
  run "${@:2}"
  kill "$reporter"
  wait "$reporter" 2>/dev/null
}

# at_terminal KEYS COMMAND: answers the question that the command asks; sets $status and $out.
at_terminal() {
  local terminal
  rm -f "$TMPDIR/keys" "$TMPDIR/terminal"
  mkfifo "$TMPDIR/keys"
  script -qfec "$2" "$TMPDIR/terminal" <"$TMPDIR/keys" >/dev/null 2>&1 &
  terminal=$!
  exec 9>"$TMPDIR/keys"
  wait_for 20 grep -q 'Go on' "$TMPDIR/terminal"
  printf '%s' "$1" >&9
  command_line=$2
  wait "$terminal"
  status=$?
  out=$(cat "$TMPDIR/terminal")
  exec 9>&-
}

note "down: it says so, with the command; Ctrl-C and no leave it down"
ip link set vcan0 down
run "$blactl" doctor -j
expect_status 3
expect_codes findings interface_down
expect_out 'sudo ip link set vcan0 up'
at_terminal $'\003' "$blactl doctor --fix"
expect_status 130
expect_out 'vcan0 is down'
expect_out 'as does: sudo ip link set vcan0 up'
at_terminal $'n\n' "$blactl doctor --fix"
expect_status 3
expect_out '[not_confirmed]'

note "yes raises it; nobody is on the bus but ourselves, and that is told"
at_terminal $'y\n' "$blactl doctor --fix -j"
expect_status 8
expect_codes fixed interface_down
expect_codes findings silent

note "with a servo nothing is wrong, and there is nothing to mend"
echo '{"schema":"blactl-scenario/1","servos":[{"model":"BLA21-12U-AB","node_id":11,"servo_id":1}]}' \
  >"$TMPDIR/scenario.json"
"$blactl" sim -i vcan0 --json "$TMPDIR/scenario.json" >"$TMPDIR/sim.out" 2>&1 &
wait_for 20 grep -q '"ready"' "$TMPDIR/sim.out"
run "$blactl" doctor --fix -j
expect_status 0
expect_codes fixed
expect_codes findings

# linux/can/error.h: CAN_ERR_FLAG with ACK; with CRTL, TX_PASSIVE in the second byte; with BUSOFF.
note "missing acknowledgement, error-passive and bus-off are told apart"
while_reported 20000020#0000000000000000 "$blactl" doctor -j
expect_status 8
expect_codes findings no_acknowledge
while_reported 20000004#0020000000000000 "$blactl" doctor -j
expect_status 8
expect_codes findings error_passive
while_reported 20000040#0000000000000000 "$blactl" doctor -j
expect_status 8
expect_codes findings bus_off
