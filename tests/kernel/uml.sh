#!/bin/bash
# Runs a program as root in a kernel of its own (User-Mode Linux) that has CAN and an interface
# vcan0 that is up; wherever it runs, no privilege is needed. Prints what the program printed and
# exits with its status.
#
#   tests/kernel/uml.sh PROGRAM [ARGUMENTS]
#
# The host's files are the root file system: the program is found under the same path, with the
# same environment and working directory. What it writes to $TMPDIR, $HOME or /run is gone after.
# BLACTL_KERNEL_OF_ITS_OWN tells it that it may do with this kernel what it likes.
#
# The modules slcan and sch_netem are loaded. vcan echoes like a controller: when a frame has left
# the queue, so that "tc qdisc ... netem delay" delays the echo too.
#
#   BLACTL_UML_TIMEOUT   seconds for everything, boot included (default 120)
#   BLACTL_UML_MEMORY    memory of the machine (default 512M)
#   BLACTL_UML_PRELOAD   auto: preload BLACTL_UML_XSTATE into linux.uml where the processor has AMX
#                        (default); always; never. Nothing in the machine has it preloaded.
#   BLACTL_UML_XSTATE    the library that is built from uml_xstate.c
#
# Exit status: that of the program; 77 when User-Mode Linux or insmod is not installed; 124 when
# it took too long; 125 when it did not come as far as running the program.

set -u
PATH=$PATH:/usr/sbin:/sbin

# shellcheck source=tests/kernel/machine.sh
. "$(dirname "$0")/machine.sh"

[ $# -ge 1 ] || die 125 "usage: uml.sh PROGRAM [ARGUMENTS]"
program=$(command -v -- "$1") || die 125 "there is no program $1"
shift
for needed in linux.uml insmod ip; do
  command -v $needed >/dev/null ||
    die 77 "$needed is missing; sudo apt-get install user-mode-linux kmod iproute2"
done
modules=$(echo /usr/lib/uml/modules/*/kernel)
[ -d "$modules" ] || die 125 "expected one folder /usr/lib/uml/modules/*/kernel, got: $modules"

# has_amx: whether linux.uml would panic at its first program (uml_xstate.c)
has_amx() {
  grep -qw amx_tile /proc/cpuinfo
}

wants_preload() {
  case ${BLACTL_UML_PRELOAD:-auto} in
    always) ;;
    auto) has_amx ;;
    never) false ;;
    *) die 125 "BLACTL_UML_PRELOAD=$BLACTL_UML_PRELOAD: not one of auto, always, never" ;;
  esac
}

linux=(linux.uml)
if wants_preload; then
  # A library that is missing would be passed over by the loader.
  [ -r "${BLACTL_UML_XSTATE:-}" ] ||
    die 125 "BLACTL_UML_XSTATE does not name the library to preload: '${BLACTL_UML_XSTATE:-}'"
  linux=(env LD_PRELOAD="$(realpath -- "$BLACTL_UML_XSTATE")${LD_PRELOAD:+:$LD_PRELOAD}" linux.uml)
fi

export -p >"$scratch/environment"
power_off='echo o >/proc/sysrq-trigger; sleep 60' # takes a moment, and init must not end before
cat >"$scratch/init" <<EOF
#!/bin/bash
. $(printf %q "$scratch/environment")
exec >$(printf %q "$scratch/boot.log") 2>&1
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
mkdir -p /dev/pts /dev/shm
mount -t devpts devpts /dev/pts
mount -t tmpfs tmpfs /dev/shm
mount -t tmpfs tmpfs /run
mkdir -m 1777 /run/lock /run/tmp
mkdir /run/home
for module in net/can/can net/can/can-raw drivers/net/can/dev/can-dev \\
    "drivers/net/can/vcan echo=1" drivers/net/can/vxcan drivers/net/can/slcan/slcan \\
    net/sched/sch_netem; do
  # shellcheck disable=SC2086
  set -- \$module
  insmod $(printf %q "$modules")/\$1.ko \$2
done
ip link set lo up
ip link add dev vcan0 type vcan && ip link set vcan0 up ||
  { $power_off; }

export TMPDIR=/run/tmp HOME=/run/home BLACTL_KERNEL_OF_ITS_OWN=yes
unset XDG_RUNTIME_DIR XDG_STATE_HOME XDG_CONFIG_HOME XDG_CACHE_HOME XDG_DATA_HOME
cd $(printf %q "$PWD") || cd /
$(printf '%q ' "$program" "$@") </dev/null >$(printf %q "$scratch/log") 2>&1
echo \$? >$(printf %q "$scratch/status")
$power_off
EOF
chmod +x "$scratch/init"

# uml_dir: else it leaves files in ~/.uml. timeout(1) makes a process group of its own and ends
# all of it, the host processes that stand for those of the machine included.
timeout -k 5 "${BLACTL_UML_TIMEOUT:-120}" "${linux[@]}" mem="${BLACTL_UML_MEMORY:-512M}" \
  uml_dir="$scratch/" rootfstype=hostfs rootflags=/ rw init="$scratch/init" \
  con=null con0=fd:0,fd:1 quiet </dev/null >"$scratch/console.log" 2>&1 &
machine=$!
finish "User-Mode Linux" "${BLACTL_UML_TIMEOUT:-120}" "$program" "$scratch" \
  "$scratch/console.log" "$scratch/boot.log"
