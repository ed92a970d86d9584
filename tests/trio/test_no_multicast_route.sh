#!/usr/bin/env bash
# On a machine without a multicast route, the command that adds one is printed, and the run uses a private network.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

cat >no_route.sh <<'SH'
ip link set lo up
exec "$1" --device 'synthetic://office?frames=30' --replay --resolution 0.02 --volume-size 3.2 --out fallback
SH
network=(unshare --net)
((EUID == 0)) || network=(unshare --map-root-user --net)
env -u LCM_DEFAULT_URL "${network[@]}" bash no_route.sh "$root/scripts/trio" >trio.txt 2>&1 || {
  cat trio.txt
  fail "no fall-back to a private network"
}
grep -q 'ip route add 224.0.0.0/4' trio.txt || fail "the cure is not named: $(cat trio.txt)"
expect_file fallback/segments.ply
