#!/usr/bin/env bash
# Installs the package PACKAGE into a bare Debian 12 root, in a folder of its own, and runs the demo from there.
# Usage: scripts/lib/package_test.sh PACKAGE      as root; takes some minutes and about 2 GB in the folder for temporary files
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
package="$(realpath "$1")"
work="$(mktemp -d)"
root="$work/root"
trap 'umount "$root/dev" "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT

# The mirror of this machine, in either of apt's two formats.
mirror="$(cat /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null |
  sed -nE 's/^(URIs: *|deb +(\[[^]]*\] +)?)(http[^ ]+).*/\3/p' | grep -v security | head -1 || true)"  # a file may not be there
debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}" >"$work/debootstrap.log" ||
  { tail -5 "$work/debootstrap.log" >&2; say "debootstrap failed"; exit 1; }
cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"
install -m 644 "$package" "$root/tmp/"
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM=dumb DEBIAN_FRONTEND=noninteractive "$@"; }

start="$(date +%s)"
inside apt-get update -qq
inside apt-get install -y -qq --no-install-recommends "/tmp/$(basename "$package")" >"$work/apt.log" 2>&1 ||
  { tail -20 "$work/apt.log" >&2; say "the package cannot be installed"; exit 1; }
say "installed after $(($(date +%s) - start)) s"

for program in mapper segmenter viewer status query export evaluate convert segment-cloud; do
  inside "kintsugi-$program" --version
done
inside bash -c 'cd /root && kintsugi-trio --private --device synthetic://office --replay --out demo --every 5 --max-frames 120' ||
  { say "the demo failed"; exit 1; }
[[ -s "$root/root/demo/final.png" && -s "$root/root/demo/segments.ply" ]] || { say "the demo wrote no map"; exit 1; }
say "first map and picture $(($(date +%s) - start)) s after 'apt install' began"
# A Python example, with what 'apt install' brought.
inside /usr/bin/python3 -c "
import numpy, kintsugi
x, y = numpy.meshgrid(numpy.arange(40) * 0.01, numpy.arange(40) * 0.01)
segmenter = kintsugi.Segmenter(resolution=0.01)
points = numpy.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
segmenter.add(points, normals=numpy.tile([0.0, 0.0, 1.0], (len(points), 1)))
assert segmenter.num_segments == 1, segmenter.segments()
print('python:', len(points), 'points,', segmenter.num_segments, 'segment')" || { say "the Python package does not work"; exit 1; }
# The units, as systemd itself reads them; their exposure is of 10.
inside apt-get install -y -qq --no-install-recommends systemd >/dev/null 2>&1
units=(kintsugi-mapper@hall kintsugi-segmenter kintsugi-viewer)
[[ -e "$root/usr/lib/systemd/system/kintsugi-objects.service" ]] && units+=(kintsugi-objects)
for unit in "${units[@]}"; do
  inside systemd-analyze verify --man=no "$unit.service" || { say "$unit.service is not right"; exit 1; }
  inside systemd-analyze security --offline=true "/usr/lib/systemd/system/${unit/@hall/@}.service" | tail -1
done
inside apt-get remove -y -qq kintsugi >/dev/null 2>&1
[[ ! -e "$root/usr/bin/kintsugi-mapper" ]] || { say "removing the package leaves its programs"; exit 1; }
say "the package works in a bare root"
