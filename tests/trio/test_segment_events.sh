#!/usr/bin/env bash
# Clients that follow the segments, also through corrections, end with the same table as the segmenter: started early,
# started late and from a log, in C++ and in Python. They report an incomplete log.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
if [[ -z "${KINTSUGI_PRIVATE_BUS:-}" ]]; then
  KINTSUGI_PRIVATE_BUS=1 "$root/scripts/private_bus" "$root/tests/trio/test_segment_events.sh" && exit
  exit 1
fi

events="$KINTSUGI_BIN/kintsugi-segment-events"
python_events=("$root/scripts/segment_events.py")
# With sanitizers there is no Python package; then the C++ client stands in.
compgen -G "$KINTSUGI_BIN/../share/python/kintsugi/_kintsugi*.so" >/dev/null || {
  echo "segment_events.py is not tested, because the Python package is not built"
  python_events=("$events")
}

expect_table() {
  python3 "$root/tests/trio/compare_tables.py" "$1" "$2" >&2 || fail "$2 differs from $1"
}

# follow NAME COMMAND...: starts a client that runs until the map is complete, with its output in NAME.txt and NAME.json,
# and waits until it listens.
declare -A follower=()
follow() {
  local name="$1"
  shift
  timeout 60 "$@" --exit-on-final --json "$name.json" >"$name.txt" 2>"$name.err" &
  follower[$name]=$!
  wait_for_file "$name.err"
}
# expect_followed SEGMENTS.json: waits for all clients; each has this table.
expect_followed() {
  local name
  for name in "${!follower[@]}"; do
    wait "${follower[$name]}" || fail "$name: $(cat "$name.err")"
    expect_table "$1" "$name.json"
  done
  follower=()
}

# Live: clients from the start, and one that starts when part of the map exists. After all slices but the last, all are
# corrected. With the parameters of the paper, hundreds of segments appear, merge and split.
follow early "$events"
follow early_python "${python_events[@]}"
lcm-logger -q -a run.lcm >logger.log 2>&1 &
logger=$!
"$KINTSUGI_BIN/kintsugi-segmenter" --preset paper --out live --save live/segmenter.map --write-every=4 --exit-on-final \
  --linger=3 >segmenter.log 2>&1 &
segmenter=$!
"$KINTSUGI_TEST_BIN/slice_player" --session=7 --points=100000 --slice-points=2000 --speed=10 --seconds=4 --linger=3 \
  >player.log 2>&1 &
player=$!
wait_for_file live/segments.json
follow late "$events"
wait "$player" || fail "$(cat player.log)"
wait "$segmenter" || fail "$(cat segmenter.log)"
kill -INT "$logger"
wait "$logger" || fail "$(cat logger.log)"
expect_followed live/segments.json

# From the log: both clients print the same text.
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
expect_known run.lcm live/segments.json
for what in 'revision [1-9]' 'created: ' 'merged into' 'split off'; do
  grep -q "$what" cpp.txt || fail "nobody was told '$what': $(grep slice cpp.txt)"
done

# A restarted segmenter sends the full state, in which no segments appear or vanish.
follow after "$events"
follow after_python "${python_events[@]}"
"$KINTSUGI_BIN/kintsugi-segmenter" --preset paper --log run.lcm --lcm-url "$LCM_DEFAULT_URL" --out resumed \
  --resume live/segmenter.map --linger=3 >resumed.log 2>&1 || fail "$(cat resumed.log)"
expect_followed live/segments.json
grep -q 'all listed' after.txt || fail "no full state was heard: $(cat after.txt)"

# A truncated log, and one with a changed byte, are read as far as possible, and the damage is reported.
expect_lacking() {
  from_log "$1" || true
  ((cpp_code == 1 && python_code == 1)) || fail "$1: exit status $cpp_code and $python_code"
  grep -q "$2" cpp.err || fail "kintsugi-segment-events does not say '$2' but: $(cat cpp.err)"
  grep -q "$2" python.err || fail "${python_events[0]} does not say '$2' but: $(cat python.err)"
}
size="$(stat -c %s run.lcm)"
for part in 3 5 7; do
  head -c $((size * part / 8)) run.lcm >cut.lcm
  expect_lacking cut.lcm 'is damaged at byte'
done
python3 - <<'END'
import re
data = bytearray(open("run.lcm", "rb").read())
updates = [m.end() for m in re.finditer(rb"(?s)\0\0\0\x0e....SEGMENT_UPDATE", data)]  # length of the channel, of the data
number = lambda update: data[update + 20:update + 36]  # session and sequence
newest = bytes(max(number(update) for update in updates))  # no later update replaces it
for update in updates:
    if number(update) == newest:  # it may have been sent more than once
        data[update + 200] ^= 1
open("spoilt.lcm", "wb").write(data)
END
expect_lacking spoilt.lcm 'checksum'
grep -q 'missing' python.err || fail "${python_events[0]} does not say that updates are missing: $(cat python.err)"

# A log is not replaced by what is written of it, and a table that cannot be printed is an error.
cp run.lcm same.lcm
! "$events" --log same.lcm --json ./same.lcm >same.txt 2>same.err || fail "the log was replaced by its table"
cmp run.lcm same.lcm
grep -q 'the same file as that of' same.err || fail "not told why: $(cat same.err)"
! "$events" --log run.lcm --quiet >/dev/full 2>full.err || fail "a table that was not printed is no error"
grep -q 'standard output cannot be written' full.err || fail "not told: $(cat full.err)"
