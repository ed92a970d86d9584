#!/usr/bin/env bash
# Python on a bus: a client that follows a map of patches which corrections move ends with the points and labels that the
# segmenter saved, started early and late and from the log; and the examples run.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
export PYTHONPATH="$KINTSUGI_BIN/../share/python"
if ! compgen -G "$PYTHONPATH/kintsugi/_kintsugi*.so" >/dev/null; then
  echo "skipped: the Python package is not built"
  exit 77
fi
if [[ -z "${KINTSUGI_PRIVATE_BUS:-}" ]]; then
  KINTSUGI_PRIVATE_BUS=1 "$root/scripts/private_bus" "$root/tests/trio/test_python.sh" && exit
  exit 1
fi
examples="$root/segmenter/python/examples"

# follow.py SAVED.map [LOG]: follows the map to its end, and compares it with the saved one.
cat >follow.py <<'PYTHON'
import sys, threading, time
import kintsugi, numpy as np

client = kintsugi.read_log(sys.argv[2]) if len(sys.argv) > 2 else kintsugi.connect()
print("listening", flush=True)
counter = [0]
threading.Thread(target=lambda: [time.sleep(0.01) or counter.append(0) for _ in range(2000)], daemon=True).start()
end = time.monotonic() + 60
while not client.has_ended and time.monotonic() < end:
    client.wait(timeout=2.0)
assert client.is_complete and client.has_ended and not client.problem, client.problem
assert client.objects() == []
assert len(sys.argv) > 2 or len(counter) > 10, "wait() holds the interpreter's lock"
saved = None
while saved is None:
    try:
        saved = kintsugi.load_map(sys.argv[1])
        if not saved.is_complete:
            saved = None
    except RuntimeError:
        assert time.monotonic() < end
    time.sleep(0.1)
np.testing.assert_array_equal(client.segments(), saved.segments())
points = np.concatenate([client.points(piece) for piece in client.pieces])
labels = np.concatenate([client.labels(piece) for piece in client.pieces])
points, labels = points[labels > 0], labels[labels > 0]
assert len(points) == len(saved.points), (len(points), len(saved.points))
def ordered(points, labels):
    columns = np.column_stack([points["position"].view(np.uint32), points["normal"].view(np.uint32), labels])
    return columns[np.lexsort(columns.T)]
np.testing.assert_array_equal(ordered(points, labels), ordered(saved.points, saved.labels))
print("%d points, %d segments" % (len(points), len(saved.segments())))
PYTHON

declare -A follower=()
follow() {
  local name="$1"
  shift
  timeout 90 /usr/bin/python3 "$@" >"$name.txt" 2>"$name.err" &
  follower[$name]=$!
  wait_for_file "$name.txt"
}

follow early follow.py saved.map
follow example "$examples/live_map.py" 60
lcm-logger -q -a run.lcm >logger.log 2>&1 &
logger=$!
# --linger: so that there is somebody to answer the query of the example.
"$KINTSUGI_BIN/kintsugi-segmenter" --preset paper --out live --save saved.map --save-every 20 --exit-on-final --linger=5 \
  >segmenter.log 2>&1 &
segmenter=$!
"$KINTSUGI_TEST_BIN/slice_player" --session=7 --points=100000 --slice-points=2000 --speed=20 --batch=5 --corrections=3 \
  --linger=5 >player.log 2>&1 &
player=$!
wait_for_file saved.map
follow late follow.py saved.map
for name in "${!follower[@]}"; do
  wait "${follower[$name]}" || fail "$name: $(cat "$name.txt" "$name.err")"
done
wait "$player" || fail "$(cat player.log)"
wait "$segmenter" || fail "$(cat segmenter.log)"
kill -INT "$logger"
wait "$logger" || fail "$(cat logger.log)"
grep -q "complete: .* the largest is" example.txt || fail "live_map.py: $(cat example.txt)"

/usr/bin/python3 follow.py saved.map run.lcm >log.txt || fail "from the log: $(cat log.txt)"
/usr/bin/python3 "$examples/read_log.py" run.lcm >read.txt || fail "read_log.py: $(cat read.txt)"
grep -q "of them in $(grep -oP '\d+ segments' log.txt | tail -n 1)" read.txt || fail "read_log.py: $(tail -n 1 read.txt)"
/usr/bin/python3 "$examples/saved_map.py" saved.map >list.txt || fail "saved_map.py"
grep -q 'normal' list.txt || fail "saved_map.py: $(cat list.txt)"

# Without anybody on the bus, errors are sentences, and Ctrl-C ends a wait and a query.
/usr/bin/python3 - <<'PYTHON' || fail "errors on the bus"
import os, signal, threading, time
import kintsugi
client = kintsugi.connect()
assert not client.wait(timeout=0.0)
try:
    client.query(timeout=0.5)
    raise SystemExit("somebody answered")
except RuntimeError as error:
    assert "nobody answered within 0.5 s" in str(error), error
for call, error in ((lambda: client.wait(timeout=-1), ValueError), (lambda: client.query(timeout=float("nan")), ValueError),
                    (lambda: client.points(3), ValueError),
                    (lambda: kintsugi.connect("nonsense"), RuntimeError)):
    try:
        call()
        raise SystemExit("was accepted")
    except error:
        pass
for call in (client.wait, client.query):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    try:
        call(timeout=float("inf"))
        raise SystemExit("Ctrl-C was not heard")
    except KeyboardInterrupt:
        assert time.monotonic() - start < 5
PYTHON
