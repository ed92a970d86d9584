#!/usr/bin/env bash
# Everything is killed in the middle of a run, as when the power fails; scripts/trio --resume goes on with it, and ends
# with the map of a run that was never interrupted.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --no-log --out quiet

"$root/scripts/trio" "${small_room[@]}" --replay --no-log --out run >trio.txt 2>&1 &
trio=$!
wait_for_file run/mapper.lcm
sleep 1
kill -STOP "$trio" # it shall start nothing again
kill -KILL "$(<run/mapper.pid)" "$(<run/segmenter.pid)" "$(<run/viewer.pid)"
kill -KILL "$trio"
{ wait "$trio"; } 2>/dev/null && fail "the script was not killed"

"$root/scripts/trio" --resume --out run >resumed.txt 2>&1 || {
  cat resumed.txt
  fail "scripts/trio --resume"
}
for file in segments.ply map_final.png segments_final.png trajectory.txt; do expect_same "quiet/$file" "run/$file"; done

# What the mapper keeps is a log like another.
"$root/scripts/replay" run/mapper.lcm --private --speed 4 --out replay >replay.txt 2>&1 || {
  cat replay.txt
  fail "the mapper's log is not replayed"
}
expect_same quiet/segments.ply replay/segments.ply

"$root/scripts/trio" --resume --out nothing >resumed.txt 2>&1 && fail "a run that was not there was gone on with"
grep -q 'no run to go on with' resumed.txt || fail "the reason is not given: $(cat resumed.txt)"
