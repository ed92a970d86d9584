#!/usr/bin/env bash
# The camera is suddenly in another room and stays lost: the map goes on in another part. Both parts are segmented and
# written, also when mapper and segmenter are killed in the second one.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# The frames of two rooms, one after the other, as one recording.
frames=20
"$KINTSUGI_BIN/kintsugi-render-scene" synthetic://office --out rooms --frames "0:$frames" 2>render.txt
mv rooms/associations.txt office.txt
"$KINTSUGI_BIN/kintsugi-render-scene" synthetic://loop --out rooms --frames "$frames:$((2 * frames))" 2>render.txt
cat office.txt rooms/associations.txt >both.txt
mv both.txt rooms/associations.txt
rm rooms/depth.txt rooms/rgb.txt

two_rooms=(--private --device "folder://$work/rooms" --replay --resolution 0.02 --volume-size 4
  --mapper '--session=7 --restart-after=0.2')

run_trio "${two_rooms[@]}" --out quiet
for name in segments.ply segments.part1.ply segments.part1.json trajectory.txt trajectory.part1.txt final.png \
  final.part0.png; do
  expect_file "quiet/$name"
done
expect_no_partial_files quiet
grep -q 'the map has 2 parts' trio.txt || fail "the parts were not said: $(cat trio.txt)"
grep -q 'segments.part1.ply' trio.txt || fail "the files of part 1 are not named: $(cat trio.txt)"
! grep -q 'restarted' trio.txt || fail "a part was taken for a restart: $(cat trio.txt)"
(($(vertices quiet/segments.ply) > 100)) || fail "part 0 is empty"
(($(vertices quiet/segments.part1.ply) > 100)) || fail "part 1 is empty"

# The rate of the bus holds the mapper up in part 1, so that there is time to kill it there.
"$root/scripts/trio" "${two_rooms[@]}" --mapper '--rate=0.05' --out "$work/killed" >trio.txt 2>&1 &
trio=$!
wait_for_file killed/mapper.log
for ((i = 0; i < 300; i++)); do
  grep -q 'part 1 of the map begins' killed/mapper.log && break
  sleep 0.1
done
kill -KILL "$(<killed/mapper.pid)" "$(<killed/segmenter.pid)"
wait "$trio" || {
  cat trio.txt
  fail "trio with a killed mapper and segmenter"
}
grep -q 'mapper was killed' trio.txt || fail "the mapper was not killed: $(cat trio.txt)"
expect_same_partition quiet/segments.ply killed/segments.ply
expect_same_partition quiet/segments.part1.ply killed/segments.part1.ply
expect_same quiet/trajectory.part1.txt killed/trajectory.part1.txt
