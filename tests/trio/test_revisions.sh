#!/usr/bin/env bash
# A third of the slices of a recorded run is corrected, and corrected back: over a real bus the segmenter and the viewer
# end with the map and the picture of the uncorrected run.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --slices shift --out live
"$KINTSUGI_TEST_BIN/trio_revise_slices" live/run.lcm revised.lcm >revise.txt 2>&1 || fail "$(cat revise.txt)"
"$root/scripts/replay" revised.lcm --private --speed 2 --out replay >replay.txt 2>&1 || {
  cat replay.txt
  fail "replay"
}

number() { grep -m1 -oP "\"$2\": \K\d+" "$1/segments.json"; }
for what in num_slices num_points num_segments; do
  [[ "$(number live $what)" == "$(number replay $what)" ]] ||
    fail "$what is $(number live $what) live and $(number replay $what) with corrections"
done
corrected="$(grep -oP '\d+(?= of them corrected)' revise.txt)"
grep -q "$((2 * corrected)) corrections" replay/segmenter.log || fail "the segmenter has not segmented the corrections"
[[ "$(grep -c '"revision": 2' replay/segments.json)" == "$corrected" ]] || fail "not every slice is in revision 2"
expect_same live/map_final.png replay/map_final.png
