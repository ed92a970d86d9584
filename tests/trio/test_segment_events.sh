#!/usr/bin/env bash
# Clients that follow segments through time know at the end what the segmenter knows: live, late, over corrections and
# from a log, in C++ and in Python; and say so when a log lacks something.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
if [[ -z "${KINTSUGI_PRIVATE_BUS:-}" ]]; then
  KINTSUGI_PRIVATE_BUS=1 "$root/scripts/private_bus" "$0" && exit
  exit 1
fi

events="$KINTSUGI_BIN/kintsugi-segment-events"
python_events=("$root/scripts/segment_events.py")
has_python_bus=0
python3 -c 'import lcm' 2>/dev/null && has_python_bus=1
((has_python_bus)) || echo "Python over the bus: not tested, there is no module lcm here"

expect_table() {
  python3 "$root/tests/trio/compare_tables.py" "$1" "$2" >&2 || fail "$2 differs from $1"
}

# follow NAME COMMAND...: a client on the bus until the map is complete, what it says in NAME.txt and NAME.json.
declare -A follower=()
follow() {
  local name="$1"
  shift
  timeout 120 "$@" --exit-on-final --json "$name.json" >"$name.txt" 2>"$name.err" &
  follower[$name]=$!
}
# expect_followed SEGMENTS.json: all that follow have ended, with this table.
expect_followed() {
  local name
  for name in "${!follower[@]}"; do
    wait "${follower[$name]}" || fail "$name: $(cat "$name.err")"
    expect_table "$1" "$name.json"
  done
  follower=()
}

# Live: one from the start, one that begins when there is a map already.
follow early "$events"
((has_python_bus)) && follow early_python "${python_events[@]}"
(
  wait_for_file live/segmenter.map # saved after the first slices
  exec "$events" --exit-on-final --json late.json >late.txt 2>late.err
) &
follower[late]=$!
run_trio "${small_room[@]}" --replay --segmenter '--save-every=1' --out live
expect_followed live/segments.json

# From the log: the two programs say the same, letter by letter.
from_log() {
  "$events" --log "$1" --grown --json cpp.json >cpp.txt 2>cpp.err
  cpp_code=$?
  "${python_events[@]}" --log "$1" --grown --json python.json >python.txt 2>python.err
  python_code=$?
  expect_same cpp.txt python.txt
}
expect_known() {
  from_log "$1" || true
  ((cpp_code == 0 && python_code == 0)) || fail "$1: $(cat cpp.err python.err)"
  expect_table "$2" cpp.json
  expect_table "$2" python.json
}
expect_known live/run.lcm live/segments.json

# Over corrections: a third of the slices moves and comes back; segments split, merge and go.
"$KINTSUGI_TEST_BIN/trio_revise_slices" live/run.lcm revised.lcm >revise.txt 2>&1 || fail "$(cat revise.txt)"
lcm-logger --quiet revised_run.lcm >logger.log 2>&1 &
logger=$!
follow corrected "$events"
((has_python_bus)) && follow corrected_python "${python_events[@]}"
sleep 0.5
"$KINTSUGI_BIN/kintsugi-segmenter" --log revised.lcm --out revised --save revised/segmenter.map >revised.log 2>&1 ||
  fail "$(cat revised.log)"
expect_followed revised/segments.json
kill -INT "$logger" && wait "$logger" || true
expect_known revised_run.lcm revised/segments.json
for what in 'revision 2' 'created: ' 'merged into' 'split off' 'retired$'; do
  grep -q "$what" cpp.txt || fail "nobody was told '$what': $(grep slice cpp.txt)"
done

# Late, when all is over: the full state of a segmenter that was started again.
"$KINTSUGI_BIN/kintsugi-segmenter" --log revised.lcm --out resumed --resume revised/segmenter.map --linger 3 \
  >resumed.log 2>&1 &
segmenter=$!
wait_for_file resumed/segments.json
follow after "$events"
expect_followed resumed/segments.json
wait "$segmenter" || fail "$(cat resumed.log)"
expect_table revised/segments.json after.json
grep -q 'all listed' after.txt || fail "no full state was heard: $(cat after.txt)"

# A log that is cut off, and one with a byte that has changed, are read as far as they go, and that is said.
expect_lacking() {
  from_log "$1" || true
  ((cpp_code == 1 && python_code == 1)) || fail "$1: exit status $cpp_code and $python_code"
  grep -q "$2" cpp.err || fail "kintsugi-segment-events does not say '$2' but: $(cat cpp.err)"
  grep -q "$2" python.err || fail "segment_events.py does not say '$2' but: $(cat python.err)"
}
size="$(stat -c %s revised_run.lcm)"
for part in 3 5 7; do
  head -c $((size * part / 8)) revised_run.lcm >cut.lcm
  expect_lacking cut.lcm 'is damaged at byte'
done
python3 - <<'END'
data = bytearray(open("revised_run.lcm", "rb").read())
first = data.index(b"SEGMENT_UPDATE")
data[first + 300] ^= 1
open("spoilt.lcm", "wb").write(data)
END
expect_lacking spoilt.lcm 'checksum'
grep -q 'missing' python.err || fail "segment_events.py does not say that updates are missing: $(cat python.err)"
