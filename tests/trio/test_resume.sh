#!/usr/bin/env bash
# All processes, or only scripts/trio, are killed in the middle of a run: scripts/trio --resume continues it, and the map
# is that of an uninterrupted run.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --no-log --out quiet

"$root/scripts/trio" "${small_room[@]}" --replay --no-log --out run >trio.txt 2>&1 &
trio=$!
wait_for_text 'segmenter,slices_segmented,[1-9]' run/status.csv
kill -STOP "$trio" # so that it restarts nothing
kill -KILL "$(<run/mapper.pid)" "$(<run/segmenter.pid)" "$(<run/viewer.pid)"
kill -KILL "$trio"
{ wait "$trio"; } 2>/dev/null && fail "the script was not killed"

"$root/scripts/trio" --resume --out run >resumed.txt 2>&1 || {
  cat resumed.txt
  fail "scripts/trio --resume"
}
expect_same_partition quiet/segments.ply run/segments.ply
for file in map_final.png trajectory.txt; do expect_same "quiet/$file" "run/$file"; done

# Only scripts/trio is killed: its processes end too, and the session of the mapper counts as interrupted.
"$root/scripts/trio" "${small_room[@]}" --replay --no-log --out orphaned >trio.txt 2>&1 &
trio=$!
for file in mapper.pid mapper.lcm; do wait_for_file "orphaned/$file"; done
kill -KILL "$trio"
{ wait "$trio"; } 2>/dev/null && fail "the script was not killed"
for process in mapper segmenter viewer; do
  timeout 60 tail --pid="$(<"orphaned/$process.pid")" -f /dev/null || fail "the $process is still there"
done
"$root/scripts/trio" --resume --out orphaned >resumed.txt 2>&1 || {
  cat resumed.txt
  fail "scripts/trio --resume after the script was killed"
}
expect_same_partition quiet/segments.ply orphaned/segments.ply
for file in map_final.png trajectory.txt; do expect_same "quiet/$file" "orphaned/$file"; done

# The log of the mapper can be replayed like any other.
"$root/scripts/replay" run/mapper.lcm --private --speed 4 --out replay >replay.txt 2>&1 || {
  cat replay.txt
  fail "the mapper's log is not replayed"
}
expect_same_partition quiet/segments.ply replay/segments.ply

"$root/scripts/trio" --resume --out nothing >resumed.txt 2>&1 && fail "a run that does not exist was resumed"
grep -q 'no run to go on with' resumed.txt || fail "the reason is not given: $(cat resumed.txt)"
