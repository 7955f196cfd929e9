#!/bin/bash
# Runs a program as root in a machine of its own (QEMU) that has two CAN controllers on one bus:
# can0 and can1, with a real driver (kvaser_pci, SJA1000) and real bit timing, as yet not set up;
# wherever it runs, no privilege is needed. Prints what the program printed and exits with its
# status.
#
#   tests/kernel/qemu.sh PROGRAM [ARGUMENTS]
#
# The host's files are the root file system, read-only: the program is found under the same path,
# with the same environment and working directory. What it writes to $TMPDIR, $HOME or /run is gone
# after. BLACTL_KERNEL_OF_ITS_OWN tells it that it may do with this kernel what it likes. The machine
# is emulated, some ten times slower than the host, and its controllers know no errors.
#
#   BLACTL_QEMU_TIMEOUT  seconds for everything, boot included (default 120)
#   BLACTL_QEMU_KERNEL   the folder into which a kernel package of Debian was unpacked (dpkg -x)
#
# Exit status: that of the program; 77 when QEMU, busybox or the kernel is not there; 124 when it
# took too long; 125 when it did not come as far as running the program.

set -u
PATH=$PATH:/usr/sbin:/sbin

# shellcheck source=tests/kernel/machine.sh
. "$(dirname "$0")/machine.sh"

[ $# -ge 1 ] || die 125 "usage: qemu.sh PROGRAM [ARGUMENTS]"
program=$(command -v -- "$1") || die 125 "there is no program $1"
shift
for needed in qemu-system-x86_64 busybox modprobe ip; do
  command -v $needed >/dev/null ||
    die 77 "$needed is missing; sudo apt-get install qemu-system-x86 busybox-static kmod iproute2"
done
root=${BLACTL_QEMU_KERNEL:-}
kernel=$(echo "$root"/boot/vmlinuz-*)
[[ -n $root && -r $kernel ]] ||
  die 77 "BLACTL_QEMU_KERNEL: no kernel in '$root'; scripts/check --long unpacks one"
version=${kernel##*/vmlinuz-}

# A small root file system that loads the modules and mounts the host's files.
initrd=$scratch/initrd
mkdir -p "$initrd"/{bin,proc,sys,dev,host,scratch,modules} "$scratch/share"
cp "$(command -v busybox)" "$initrd/bin/busybox" || die 125 "busybox cannot be copied"
[ -r "$root/lib/modules/$version/modules.dep" ] || depmod -b "$root" "$version" ||
  die 125 "the modules of $version cannot be indexed"
for module in virtio_pci 9pnet_virtio 9p can_raw kvaser_pci; do
  modprobe -d "$root" -S "$version" --show-depends "$module" || die 125 "there is no $module"
done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }' >"$scratch/modules"
while read -r path; do
  cp "$path" "$initrd/modules/" && echo "${path##*/}"
done <"$scratch/modules" >"$initrd/modules/order"

export -p >"$scratch/share/environment"
cat >"$scratch/share/work" <<EOF
. /run/environment
export TMPDIR=/run/tmp HOME=/run/home BLACTL_KERNEL_OF_ITS_OWN=yes
unset XDG_RUNTIME_DIR XDG_STATE_HOME XDG_CONFIG_HOME XDG_CACHE_HOME XDG_DATA_HOME
cd $(printf %q "$PWD") || cd /
exec $(printf '%q ' "$program" "$@")
EOF
cat >"$initrd/init" <<'EOF'
#!/bin/busybox sh
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read -r module; do
  insmod "/modules/$module"
done </modules/order
share() {
  mount -t 9p -o "trans=virtio,version=9p2000.L,msize=262144,$3" "$1" "$2"
}
share host /host ro,cache=loose && share scratch /scratch rw || poweroff -f
for each in proc sys dev; do
  mount --move /$each /host/$each
done
mkdir -p /host/dev/pts /host/dev/shm
mount -t devpts devpts /host/dev/pts
mount -t tmpfs tmpfs /host/dev/shm
mount -t tmpfs tmpfs /host/run
mkdir -m 1777 /host/run/lock /host/run/tmp
mkdir /host/run/home
cp /scratch/environment /scratch/work /host/run
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
chroot /host ip link set lo up
chroot /host /bin/bash /run/work </host/dev/null >/scratch/log 2>&1
echo $? >/scratch/status
/bin/poweroff -f
EOF
chmod +x "$initrd/init"
(cd "$initrd" && find . | busybox cpio -o -H newc 2>/dev/null) | gzip -1 >"$scratch/initrd.gz"

# TCG: emulation works everywhere; nested KVM may hang.
timeout -k 5 "${BLACTL_QEMU_TIMEOUT:-120}" qemu-system-x86_64 -accel tcg -m 512 \
  -nographic -no-reboot -nodefaults -serial stdio -kernel "$kernel" -initrd "$scratch/initrd.gz" \
  -append "console=ttyS0 quiet panic=-1" \
  -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
  -virtfs local,path="$scratch/share",mount_tag=scratch,security_model=none \
  -object can-bus,id=cb0 -device kvaser_pci,canbus=cb0 -device kvaser_pci,canbus=cb0 \
  </dev/null >"$scratch/console.log" 2>&1 &
machine=$!
finish "QEMU" "${BLACTL_QEMU_TIMEOUT:-120}" "$program" "$scratch/share" \
  "$scratch/console.log"
