#!/usr/bin/env bash
# A second run in the folder of an earlier one moves the files of that aside; a second run at the same time is refused.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

tiny=(--private --device 'synthetic://office?frames=20' --replay --resolution 0.02 --volume-size 3.2 --no-log --out run)
mkdir run
echo "somebody's own" >run/notes.txt
run_trio "${tiny[@]}" --mapper --session=7
first="$(cksum <run/segments.ply)"

"$root/scripts/trio" "${tiny[@]}" --mapper --session=8 >trio.txt 2>&1 &
trio=$!
wait_for_file run/mapper.pid
kill -STOP "$(<run/mapper.pid)" # the run must last until the next command has failed
code=0
"$root/scripts/trio" "${tiny[@]}" >second.txt 2>&1 || code=$?
kill -CONT "$(<run/mapper.pid)"
((code)) || fail "two runs used one folder at the same time"
grep -q 'another scripts/trio is at work in run' second.txt || fail "the reason is not given: $(cat second.txt)"
wait "$trio" || {
  cat trio.txt
  fail "the second run failed"
}
kept="$(grep -oP 'held an earlier run; it is now in \Krun/earlier/.*' trio.txt)" || fail "not said: $(cat trio.txt)"
[[ "$(cksum <"$kept/segments.ply")" == "$first" ]] || fail "the earlier map is not the one that was made"
cmp -s "$kept/segments.ply" run/segments.ply && fail "the map of the second run is that of the first"
expect_file run/notes.txt
[[ ! -e run/mapper.pid ]] || fail "run/mapper.pid was not removed"
