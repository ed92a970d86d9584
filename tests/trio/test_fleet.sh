#!/usr/bin/env bash
# A fleet of each kind of input, with the programs themselves: clouds, a log, recordings; with truth and without. The maps
# are those that the programs make by themselves, and those of a second fleet with two tasks at a time are the same.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
command -v parallel >/dev/null || {
  echo "skipped: there is no parallel; scripts/packages-fleet.txt has what this test needs"
  exit 77
}
fleet() { "$root/scripts/fleet" "$@" >fleet.txt 2>&1; }
# column NAME COLUMN: of results.csv.
column() { python3 -c 'import csv, sys
print(next(row for row in csv.DictReader(open(sys.argv[1] + "/results.csv")) if row["name"] == sys.argv[2])[sys.argv[3]])' "$@"; }
# expect NAME COLUMN VALUE
expect() { [[ "$(column out "$1" "$2")" == "$3" ]] || fail "$2 of $1 is $(column out "$1" "$2"), not $3: $(cat fleet.txt)"; }

scene='synthetic://office?frames=12'
coarse='--resolution 0.02 --volume-size 3.2'
"$KINTSUGI_BIN/kintsugi-render-scene" "$scene" --out walk >render.txt 2>&1 || fail "$(cat render.txt)"
"$KINTSUGI_BIN/kintsugi-mapper" --device "$scene" --replay $coarse --session 1 --lcm-url memq:// --linger 0 --store walk.lcm \
  --cloud walk.ply >mapper.log 2>&1 || fail "$(cat mapper.log)"
"$KINTSUGI_BIN/kintsugi-ground-truth" "$scene" walk.ply truth.ply >truth.log 2>&1 || fail "$(cat truth.log)"
sed 's/^element vertex .*/element vertex 1000000/' walk.ply >spoilt.ply
cat >list.txt <<LIST
walk.ply name=cloud truth=truth.ply
walk.lcm name=log truth=truth.ply
walk name=recording mapper='$coarse'
$scene name=scene mapper='$coarse'
spoilt.ply
LIST
# Real recordings, where they are.
if [[ -d "${KINTSUGI_DATA:-}/oni_small" ]]; then
  printf '%s\n' "$KINTSUGI_DATA"/oni_small/*.oni >>list.txt
else
  echo "without real recordings: KINTSUGI_DATA names no folder with oni_small"
fi

fleet run list.txt --out out --scheduler parallel --jobs 1 && fail "a spoilt cloud is no failure: $(cat fleet.txt)"
grep -q '^fleet: spoilt failed: .*spoilt.ply' fleet.txt || fail "the spoilt cloud is not named: $(cat fleet.txt)"
(($(grep -c ' failed: ' fleet.txt) == 1)) || fail "more has failed: $(cat fleet.txt)"
for name in cloud log recording scene; do
  expect "$name" state done
  (($(column out "$name" segments) > 10)) || fail "$name has too few segments"
done
for name in cloud log scene; do
  python3 -c 'import sys; sys.exit(not 0.2 < float(sys.argv[1]) <= 1)' "$(column out "$name" object_iou)" ||
    fail "the quality of $name is $(column out "$name" object_iou)"
done
for name in recording scene; do
  expect "$name" frames 12
  python3 -c 'import sys; sys.exit(not 0 < float(sys.argv[1]) < 0.02)' "$(column out "$name" ate_m)" ||
    fail "the error of the path of $name is $(column out "$name" ate_m)"
done
"$KINTSUGI_BIN/kintsugi-segment-cloud" walk.ply alone.ply 2>alone.log || fail "$(cat alone.log)"
expect_same alone.ply out/results/cloud/labelled.ply
expect_same_partition out/results/log/segments.ply out/results/scene/segments.ply
expect_file out/report.html
expect_no_partial_files out

fleet run list.txt --out two --scheduler parallel --jobs 2 && fail "a spoilt cloud is no failure: $(cat fleet.txt)"
for name in cloud log recording scene; do
  for file in out/results/"$name"/*.ply; do expect_same "$file" "two/results/$name/$(basename "$file")"; done
done

cp out/results.csv before.csv
fleet run list.txt --out out --scheduler parallel --preset paper && fail "other options were not refused"
grep -q 'begun with other options' fleet.txt || fail "$(cat fleet.txt)"
fleet run list.txt --out new --scheduler parallel --mapper '--resolutoin 0.02' && fail "a wrong flag was not refused"
[[ ! -e new ]] || fail "a wrong flag left a folder"
expect_same before.csv out/results.csv
