#!/usr/bin/env bash
# Two robots in one building: the map of the second becomes a part of that of the first, and one with it when a loop
# joins them. The second is killed afterwards, and the first finishes with what both have seen, each surface once. The
# second, whose --join names nobody, maps alone.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
if [[ -z "${KINTSUGI_TEST_JOIN:-}" ]]; then
  KINTSUGI_TEST_JOIN=1 "$root/scripts/private_bus" "$root/tests/trio/test_join.sh" && exit
  exit 1
fi

# It begins where the other one is after 50 frames, maps without anybody else, and stays to be asked.
"$KINTSUGI_BIN/kintsugi-mapper" --device 'synthetic://loop?speed=3&covered=0:50' --replay --max-frames 350 \
  --resolution 0.02 --map-name second --join first --store second.lcm --cloud second.ply --linger -1 >second.txt 2>&1 &
second=$!
wait_for_text 'points, .* messages published' second.txt

"$root/scripts/trio" --device 'synthetic://loop?speed=3' --max-frames 250 --resolution 0.02 --map-name first \
  --mapper "--cloud first.ply" --out first >first.txt 2>&1 &
first=$!
wait_for_text "the mapper of map 'second' .* joins this map" first/mapper.log
wait_for_text 'loops have joined parts of the map: it is one again' first/mapper.log
kill -KILL "$second"
wait "$second" && fail "the second mapper was not killed"
wait "$first" || fail "the first run: $(cat first.txt)"

[[ "$(ls first/segments*.ply)" == first/segments.ply ]] || fail "not one map: $(ls first)"
own="$(vertices first.ply)"
other="$(vertices second.ply)"
both="$(vertices first/segments.ply)"
((both > own)) || fail "of $both points $own are of the first robot: the second has seen more of the place"
((both < own + other / 2)) || fail "$both points where the robots have $own and $other: much of it is the same surface"
grep -q '1 guests with' first.txt || fail "the status does not tell the guest: $(cat first.txt)"

"$KINTSUGI_BIN/kintsugi-mapper" --device 'synthetic://office?frames=3' --replay --max-frames 3 --resolution 0.02 \
  --map-name second --join second >refused.txt 2>&1 && fail "a map joins itself"
grep -q 'it names the map of another mapper' refused.txt || fail "the reason is not told: $(cat refused.txt)"
