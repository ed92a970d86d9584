#!/usr/bin/env bash
# A run over a real bus writes all files that it names. Its log, replayed at 1x and 4x, gives the same segment map. The
# points and normals in that map are those that were segmented: segmenting them again gives as many segments.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --video --out live
for file in segments.ply segments.json final.png map_final.png segments_final.png trajectory.txt run.lcm run.mp4; do
  expect_file "live/$file"
  grep -q "live/$file" trio.txt || fail "the summary does not name $file: $(cat trio.txt)"
done
compgen -G 'live/snapshot_*.png' >/dev/null || fail "no snapshots"
expect_no_partial_files live
(($(grep -vc '^#' live/trajectory.txt) == 120)) || fail "the trajectory has not one pose a frame"
(($(vertices live/segments.ply) > 2000)) || fail "the map has hardly any points"

for speed in 1 4; do
  "$root/scripts/replay" live/run.lcm --private --speed "$speed" --out "replay$speed" >replay.txt 2>&1 || {
    cat replay.txt
    fail "replay at ${speed}x"
  }
  expect_same_partition live/segments.ply "replay$speed/segments.ply"  # a datagram may be lost on the way
done
"$root/scripts/replay" live/mapper.lcm --private --speed 4 --out stored >replay.txt 2>&1 || {
  cat replay.txt
  fail "replay of the log of the mapper"
}
expect_same_partition live/segments.ply stored/segments.ply

"$KINTSUGI_BIN/kintsugi-segment-cloud" live/segments.ply again.ply --mode batch --resolution 0.02 --json again.json \
  >again.txt 2>&1 || {
  cat again.txt
  fail "kintsugi-segment-cloud"
}
num_segments() { grep -m1 '"num_segments"' "$1"; }
[[ "$(num_segments live/segments.json)" == "$(num_segments again.json)" ]] ||
  fail "the map in the file is segmented otherwise: $(num_segments again.json)"
