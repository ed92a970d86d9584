#!/usr/bin/env bash
# Ctrl-C in the middle of a live run: what was mapped until then is published, segmented, drawn and written.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# The whole room at the camera's own speed: about 12 s, of which a few are let run.
"$root/scripts/trio" --private --device synthetic://office --resolution 0.02 --volume-size 3.2 --out live \
  >trio.txt 2>&1 &
trio=$!
wait_for_file live/mapper.log
sleep 4
# A background job of a script ignores SIGINT; SIGTERM takes the same way through the script.
kill -TERM "$trio"
wait "$trio" || {
  cat trio.txt
  fail "trio was not stopped cleanly"
}
for file in segments.ply segments.json final.png trajectory.txt run.lcm; do expect_file "live/$file"; done
expect_no_partial_files live
poses="$(grep -vc '^#' live/trajectory.txt)"
((poses > 5 && poses < 370)) || fail "$poses poses: the run was not interrupted in its middle"
