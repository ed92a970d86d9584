#!/usr/bin/env bash
# The log of a run is whole although lcm-logger misses messages: it is stopped for most of the time, and has a tiny
# receive buffer.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

mkdir slow
cat >slow/lcm-logger <<EOF
#!/usr/bin/env bash
"$(command -v lcm-logger)" --lcm-url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4096' "\$@" &
logger=\$!
trap 'kill -CONT \$logger; kill -INT \$logger; wait \$logger; exit 0' INT TERM
while kill -STOP \$logger 2>/dev/null; do
  sleep 0.4
  kill -CONT \$logger
  sleep 0.1
done
EOF
chmod +x slow/lcm-logger
PATH="$work/slow:$PATH" run_trio "${small_room[@]}" --replay --out live

grep -aq RESEND_REQUEST live/run.lcm || fail "lcm-logger has missed nothing: the test shows nothing"
[[ ! -s live/completion.log ]] || fail "$(cat live/completion.log)"
"$KINTSUGI_BIN/kintsugi-segment-events" --log live/run.lcm --quiet >events.txt 2>&1 || {
  cat events.txt
  fail "run.lcm lacks segment updates"
}
mkdir again
"$KINTSUGI_BIN/kintsugi-segmenter" --log live/run.lcm --out again >again.txt 2>&1 || {
  cat again.txt
  fail "run.lcm lacks slices"
}
expect_same_partition live/segments.ply again/segments.ply
