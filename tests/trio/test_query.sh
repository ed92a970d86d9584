#!/usr/bin/env bash
# kintsugi-query asks a live segmenter during and after mapping; the saved map gives the same answers; and a missing
# segmenter is reported.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
if [[ -z "${KINTSUGI_PRIVATE_BUS:-}" ]]; then
  KINTSUGI_PRIVATE_BUS=1 "$root/scripts/private_bus" "$root/tests/trio/test_query.sh" && exit
  exit 1
fi

query() { timeout 60 "$KINTSUGI_BIN/kintsugi-query" "$@"; }

# field FILE EXPRESSION: a value of the JSON answer `a`.
field() { python3 -c 'import json, sys; a = json.load(open(sys.argv[1])); print(eval(sys.argv[2]))' "$@"; }

query --timeout 0.5 >silent.txt 2>&1 && fail "an answer, and nobody is there"
grep -q 'is kintsugi-segmenter running?' silent.txt || fail "silence is not told: $(cat silent.txt)"

"$KINTSUGI_BIN/kintsugi-segmenter" --out live --save live/segmenter.map --exit-on-final --linger=10 >segmenter.log 2>&1 &
segmenter=$!
query --largest 1 --timeout 30 >empty.txt 2>&1 && fail "an answer, and there is no map"
grep -q 'no map is kept yet' empty.txt || fail "it does not say that there is no map: $(cat empty.txt)"

"$KINTSUGI_BIN/kintsugi-mapper" --replay --device 'synthetic://office?frames=120' --resolution 0.02 --volume-size 3.2 \
  --session=7 --linger=5 --output-trajectory=trajectory.txt >mapper.log 2>&1 &
mapper=$!

# During mapping: the segment at a pixel of the current view, as soon as some of the view is in the map.
seen=0
while kill -0 "$mapper" 2>/dev/null; do
  if query --pixel 320 240 --radius 0.1 --timeout 3 --json >pixel.json 2>pixel.txt &&
    [[ "$(field pixel.json 'len(a["segments"])')" == 1 ]]; then
    seen=1
    break
  fi
done
((seen)) || echo "no segment in the middle of the view was told while it was mapped: $(cat pixel.txt pixel.json)"
wait "$mapper" || fail "$(cat mapper.log)"
wait_for_file live/segments.json

# At the end, the middle of the view after one second is in the map.
pose="$(sed -n 30p trajectory.txt | cut -d ' ' -f 2-8)"

answers() {
  local name="$1"
  shift
  # shellcheck disable=SC2086 # seven numbers
  query "$@" --pixel 319.5 239.5 --pose $pose --radius 0.05 --json >"$name.pixel.json" || fail "$name: --pixel"
  [[ "$(field "$name.pixel.json" 'len(a["segments"])')" == 1 ]] || fail "$name: nothing in the middle of the view"
  query "$@" --largest 5 --json >"$name.json" || fail "$name: --largest"
  id="$(field "$name.json" 'a["segments"][0]["id"]')"
  at="$(field "$name.json" '" ".join(map(str, a["segments"][0]["centroid"]))')"
  # shellcheck disable=SC2086 # three numbers
  query "$@" --at $at --radius 100 --json >"$name.at.json" || fail "$name: --at"
  query "$@" --planar --largest 0 --json >"$name.planar.json" || fail "$name: --planar"
  query "$@" --id "$id" >"$name.txt" || fail "$name: --id"
}
answers bus --timeout 30
wait "$segmenter" || fail "$(cat segmenter.log)"
answers file --map live/segmenter.map
for kind in json pixel.json at.json planar.json txt; do expect_same "bus.$kind" "file.$kind"; done

python3 - <<'PYTHON' || fail "the answers are not those of segments.json"
import json
told = json.load(open("live/segments.json"))
by_size = sorted(told["segments"], key=lambda s: (-s["points"], s["id"]))
answer = json.load(open("bus.json"))
assert answer["map"]["points"] == told["num_points"] and answer["matching"] == told["num_segments"]
assert [s["id"] for s in answer["segments"]] == [s["id"] for s in by_size[:5]]
for mine, its in zip(answer["segments"], by_size):
    assert all(mine[key] == its[key] for key in ("points", "box_min", "box_max", "centroid", "area"))
planar = json.load(open("bus.planar.json"))["segments"]
assert planar and all(s["planar"] and s["plane"]["inliers"] >= 0.9 for s in planar)
assert len(json.load(open("bus.at.json"))["segments"]) == 1
PYTHON
