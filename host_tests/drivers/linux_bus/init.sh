#!/bin/busybox sh
# First process of the emulated machine: modules, the host's tree, one command, power off.
busybox=/bin/busybox
$busybox mount -t proc proc /proc
$busybox mount -t devtmpfs dev /dev
while read -r module; do
    parameters=
    [ "$module" = i2c_stub ] && parameters="chip_addr=0x68"
    $busybox insmod "/$module.ko" $parameters || echo "cannot load $module"
done </modules.order
$busybox mount -t 9p -o ro,trans=virtio,version=9p2000.L,cache=loose,msize=262144 host /host || echo "no host tree"
$busybox mount -t proc proc /host/proc
$busybox mount -t devtmpfs dev /host/dev
$busybox mkdir -p /host/dev/shm
$busybox mount -t tmpfs tmpfs /host/dev/shm
$busybox mount -t sysfs sys /host/sys
$busybox cp /command /host/dev/shm/command
echo "guest: begins"
PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/dev/shm TMPDIR=/dev/shm $busybox chroot /host /bin/sh /dev/shm/command
echo "guest: exit code $?"
$busybox poweroff -f
