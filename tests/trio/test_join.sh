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

# After 250 frames its camera is covered: what the other one has mapped comes in its own time.
"$root/scripts/trio" --device 'synthetic://loop?speed=3&laps=30&covered=250:30000' --resolution 0.02 --map-name first \
  --mapper "--cloud first.ply --restart-after 0" --out first >first.txt 2>&1 &
first=$!
wait_for_text "the mapper of map 'second' .* joins this map" first/mapper.log
wait_for_text ': lost, ' first/mapper.log
wait_for_text 'loops have joined parts of the map: it is one again' first/mapper.log
kill -KILL "$second"
wait "$second" && fail "the second mapper was not killed"
kill -TERM "$first"
wait "$first" || fail "the first run: $(cat first.txt)"

[[ "$(ls first/segments*.ply)" == first/segments.ply ]] || fail "not one map: $(ls first)"
own="$(vertices first.ply)"
both="$(vertices first/segments.ply)"
((both > own)) || fail "of $both points $own are of the first robot: the second has seen more of the place"
# Most of the place both have seen: everything twice would be more than half as many again. Some points are beside each
# other where those of one robot end and those of the other begin.
points_in_cells() { python3 "$root/tests/trio/points_in_100_cells.py" "$1" 0.05; }
once="$(points_in_cells second.ply)"
joined="$(points_in_cells first/segments.ply)"
((10 * joined < 13 * once)) ||
  fail "in 100 cells $joined points, and $once in the map of one robot: some surface is there twice"
grep -q '1 guests with' first.txt || fail "the status does not tell the guest: $(cat first.txt)"

"$KINTSUGI_BIN/kintsugi-mapper" --device 'synthetic://office?frames=3' --replay --max-frames 3 --resolution 0.02 \
  --map-name second --join second >refused.txt 2>&1 && fail "a map joins itself"
grep -q 'it names the map of another mapper' refused.txt || fail "the reason is not told: $(cat refused.txt)"
