#!/usr/bin/env bash
# With --store-limit the mapper's log stays small, and has the whole map: after a kill, and for who comes late.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

room=(--private --device 'synthetic://patrol?sensor=lidar&noise=off&rate=10&speed=3&frames=300' --replay --resolution 0.025
  --every 1000000 --mapper '--session=7')
run_trio "${room[@]}" --no-log --out all

# removed: the mapper has removed what it does not need of the first files.
removed() { [[ ! -e limited/mapper.1.lcm && -e limited/mapper.lcm ]] && compgen -G 'limited/mapper.*.lcm' >/dev/null; }

"$root/scripts/trio" "${room[@]}" --store-limit 8 --out limited >trio.txt 2>&1 &
trio=$!
until removed; do
  kill -0 "$trio" 2>/dev/null || { cat trio.txt; fail "nothing was removed from the log"; }
  sleep 0.1
done
kill -KILL "$(<limited/mapper.pid)"
wait "$trio" || { cat trio.txt; fail "the run with a limit"; }
grep -q 'mapper was killed' trio.txt || fail "the mapper was not killed during the run"
expect_same_partition all/segments.ply limited/segments.ply
expect_same all/map_final.png limited/map_final.png
expect_no_partial_files limited
[[ ! -e limited/.mapper.base.lcm && ! -e limited/run.lcm ]] || fail "there is: $(ls limited)"
bytes="$(cat limited/mapper*.lcm | wc -c)"
((bytes < 8000000)) || fail "the log has $bytes bytes"
((bytes < $(cat all/mapper*.lcm | wc -c))) || fail "nothing was removed"

# Who comes late: the segmenter has no map yet.
rm limited/segmenter.map* limited/segments.*
run_trio --private --resume --out limited
expect_same_partition all/segments.ply limited/segments.ply
