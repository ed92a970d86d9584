#!/usr/bin/env bash
# A killed viewer is restarted, the run ends normally, and the segment map is the same as without.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

run_trio "${small_room[@]}" --replay --out quiet

"$root/scripts/trio" "${small_room[@]}" --replay --out "$work/killed" >trio.txt 2>&1 &
trio=$!
wait_for_file killed/mapper.log
wait_for_file killed/viewer.pid
kill -KILL "$(<killed/viewer.pid)"
wait "$trio" || {
  cat trio.txt
  fail "trio with a killed viewer"
}
grep -q 'viewer was killed' trio.txt || fail "the restart was not said: $(cat trio.txt)"
expect_same_partition quiet/segments.ply killed/segments.ply
