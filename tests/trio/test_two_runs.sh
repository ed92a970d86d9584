#!/usr/bin/env bash
# Two runs on one bus: with the same map name the second refuses to start and the first is not disturbed, nor does a
# mapper without scripts/trio disturb it; with a name each, both finish with their own maps.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
if [[ -z "${KINTSUGI_TEST_TWO_RUNS:-}" ]]; then
  KINTSUGI_TEST_TWO_RUNS=1 "$root/scripts/private_bus" "$root/tests/trio/test_two_runs.sh" && exit
  exit 1
fi

# [beside=1] run OUT ARGS...: a run of the office. beside: in the place of this shell, which then is the one to be stopped.
run() {
  local out="$1"
  shift
  ${beside:+exec} "$root/scripts/trio" --resolution 0.03 --volume-size 3.2 --no-log --mapper "--cloud $out.ply" --out "$out" "$@" \
    >"$out.txt" 2>&1
}

# At the rate of the camera it takes longer than all that happens beside it.
beside=1 run first --device 'synthetic://office?speed=0.1' &
first=$!
wait_for_file first/mapper.lcm
"$KINTSUGI_BIN/kintsugi-status" --until-ready mapper --timeout 60 || fail "the first run: $(cat first.txt)"
room=(--device 'synthetic://office?frames=200' --replay --max-frames 60)

run second "${room[@]}" && fail "a second run with the same map name was started"
grep -q "another mapper makes a map called 'map' on this bus" second.txt || fail "the reason is not told: $(cat second.txt)"
[[ ! -e second ]] || fail "a run that is refused has made its folder"
"$KINTSUGI_BIN/kintsugi-mapper" --device 'synthetic://office?frames=30' --replay --store none.lcm >mapper.txt 2>&1 &&
  fail "a second mapper with the same map name was started"
grep -q "another mapper with the map name 'map'" mapper.txt || fail "the reason is not told: $(cat mapper.txt)"
[[ ! -e none.lcm ]] || fail "a mapper that is refused has made its log"

run other "${room[@]}" --map-name other || fail "the run with another map name: $(cat other.txt)"
kill -TERM "$first"
wait "$first" || fail "the first run: $(cat first.txt)"

# frames OUT: how many the mapper mapped.
frames() { grep -oP '\d+(?= frames in )' "$1/mapper.log"; }
(($(frames first) > 0)) || fail "the first run mapped nothing"
[[ "$(frames other)" == 60 ]] || fail "the other run mapped $(frames other) of 60 frames"
for out in first other; do
  [[ "$(ls "$out"/segments*.ply)" == "$out/segments.ply" ]] || fail "$out has more than its own map: $(ls "$out")"
  mapped="$(grep -oP 'cloud of \K\d+(?= points)' "$out/mapper.log")"
  [[ "$(vertices "$out/segments.ply")" == "$mapped" ]] ||
    fail "$out/segments.ply has $(vertices "$out/segments.ply") of $mapped points"
  expect_file "$out/final.png"
done

# Of two mappers that start together one goes on.
start_mapper() {
  exec "$KINTSUGI_BIN/kintsugi-mapper" --device 'synthetic://office?frames=30' --replay --linger 3 --resolution 0.03 \
    >"$1.txt" 2>&1
}
start_mapper a &
a=$!
start_mapper b &
b=$!
codes=""
for mapper in "$a" "$b"; do wait "$mapper" && codes+=0 || codes+=1; done
[[ "$codes" == 01 || "$codes" == 10 ]] || fail "of two mappers that start together: $codes, $(cat a.txt b.txt)"
