#!/usr/bin/env bash
# Ctrl-C in the middle of a live run: everything mapped so far is published, segmented, drawn and written.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# At the rate of the camera the whole room takes two minutes; the run is interrupted when some of it is mapped.
"$root/scripts/trio" --private --device 'synthetic://office?speed=0.1' --resolution 0.02 --volume-size 3.2 --out live \
  >trio.txt 2>&1 &
trio=$!
wait_for_file live/status.csv
until grep -qE ',mapper,slices_published,[1-9]' live/status.csv; do
  kill -0 "$trio" || fail "trio: $(cat trio.txt)"
  sleep 0.1
done
# SIGTERM, because a background job of a script ignores SIGINT; scripts/trio handles both alike.
kill -TERM "$trio"
wait "$trio" || {
  cat trio.txt
  fail "trio was not stopped cleanly"
}
for file in segments.ply segments.json final.png trajectory.txt run.lcm; do expect_file "live/$file"; done
expect_no_partial_files live
poses="$(grep -vc '^#' live/trajectory.txt)"
((poses > 5 && poses < 3700)) || fail "$poses poses: the run was not interrupted in its middle"
