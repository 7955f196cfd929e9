#!/bin/bash
# blactl doctor on a controller with a real driver: qemu.sh doctor_qemu.sh BLACTL. What it says of
# the bit timing, and what --fix makes of it, iproute2 must say too.

set -u
# shellcheck source=tests/kernel/lib.sh
. "$(dirname "$0")/lib.sh"

blactl=${1:?usage: qemu.sh doctor_qemu.sh BLACTL}
export BLACTL_INTERFACE=can0
right='1000000 bit/s, sample point 87.5 %'

# kernel_says TEXT: of can0.
kernel_says() {
  ip -d link show can0 | grep -qF "$1" || fail "the kernel does not say of can0: $1"
}

note "a servo at can1, at the other end of the bus"
ip link set can1 up type can bitrate 1000000 sample-point 0.875
# The machine is slow: actuator.Status, which nobody needs here, would be most of its load.
echo '{"schema":"blactl-scenario/1","servos":[{"model":"BLA21-12U-AB","node_id":11,"servo_id":1,
  "faults":{"no_actuator_status":true}}]}' >"$TMPDIR/scenario.json"
"$blactl" sim -i can1 --json "$TMPDIR/scenario.json" >"$TMPDIR/sim.out" 2>"$TMPDIR/sim.err" &
wait_for 30 grep -q '"ready"' "$TMPDIR/sim.out"

note "down: it says so, and with which command it comes up"
run "$blactl" doctor -j
expect_status 3
expect_codes findings interface_down
expect_out 'sudo ip link set can0 up type can bitrate 1000000 sample-point 0.875'

note "a wrong bit rate and sample point are found; nobody can be asked, so nothing is changed"
ip link set can0 up type can bitrate 500000 sample-point 0.625
run "$blactl" doctor --fix -j
expect_status 7
expect_codes findings bit_rate sample_point no_restart
expect_codes fixed
expect_err '[not_confirmed]'
kernel_says 'bitrate 500000 sample-point 0.625'

note "who may not is told the command, also with --yes, and nothing is changed"
run setpriv --reuid 65534 --regid 65534 --clear-groups env BLACTL_STATE_DIR= \
  "$blactl" doctor --fix -y
expect_status 3
expect_err '[permission]'
expect_err 'sudo ip link set can0 down; sudo ip link set can0 up type can bitrate 1000000 sample-point 0.875 restart-ms 100'
kernel_says 'bitrate 500000 sample-point 0.625'

note "--fix --yes mends it, and nothing is left"
run "$blactl" doctor --fix -y -j
expect_status 0
expect_codes findings
expect_codes fixed bit_rate sample_point no_restart
kernel_says 'bitrate 1000000 sample-point 0.875'
kernel_says 'restart-ms 100'

note "the controller goes down while it listens, and comes back"
"$blactl" doctor -j >"$TMPDIR/doctor.out" 2>"$TMPDIR/doctor.err" &
doctor=$!
wait_for 20 grep -q can0 /proc/net/can/rcvlist_all
sleep 1
ip link set can0 down
wait "$doctor"
[ $? -eq 3 ] || fail "doctor did not end with 3: $(cat "$TMPDIR/doctor.out" "$TMPDIR/doctor.err")"
grep -q interface_down "$TMPDIR/doctor.out" || fail "no finding: $(cat "$TMPDIR/doctor.out")"

note "--fix raises it with the bit timing that it has"
run "$blactl" doctor --fix -y
expect_status 0
expect_out "can0 up, $right, restart-ms 100"
expect_out 'fixed  can0 is down'
expect_out 'servos: 1, other nodes: 0'
expect_out 'nothing is wrong'
