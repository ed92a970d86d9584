#!/usr/bin/env bash
# A signed bus: the map is the same as without a key; its log is verified when it is read, and may be played once to a
# process; Python and C++ verify each other's messages.
source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

for name in bus other; do "$KINTSUGI_BIN/kintsugi-keygen" "$name.key" >/dev/null || fail "kintsugi-keygen"; done
run_trio "${small_room[@]}" --replay --no-log --out plain
run_trio "${small_room[@]}" --replay --out signed --bus-key bus.key
expect_same_partition plain/segments.ply signed/segments.ply
expect_same plain/map_final.png signed/map_final.png
for kind in unsigned forged replayed; do
  ! grep -E ",messages_$kind,[1-9]" signed/status.csv || fail "messages were refused"
done
! grep -q "dropped a message" signed/*.log || fail "messages were refused"

# The log.
events="$KINTSUGI_BIN/kintsugi-segment-events"
# refuses PATTERN OPTION...: kintsugi-segment-events fails with a message that matches PATTERN.
refuses() {
  local pattern="$1"
  shift
  ! "$events" --quiet "$@" >events.txt 2>&1 || fail "kintsugi-segment-events $*: accepted"
  grep -q "$pattern" events.txt || fail "kintsugi-segment-events $*: $(cat events.txt)"
}
"$events" --quiet --log signed/run.lcm --bus-key bus.key >verified.txt 2>said.txt || fail "with the key: $(cat said.txt)"
[[ ! -s said.txt ]] || fail "with the key: $(cat said.txt)"
"$events" --quiet --log signed/run.lcm --trust-log >trusted.txt || fail "--trust-log: $(cat trusted.txt)"
expect_same verified.txt trusted.txt
grep -q "segments" verified.txt || fail "no segments: $(cat verified.txt)"
if compgen -G "$KINTSUGI_BIN/../share/python/kintsugi/_kintsugi*.so" >/dev/null; then
  /usr/bin/python3 "$root/scripts/segment_events.py" --quiet --log signed/run.lcm --bus-key bus.key >python.txt ||
    fail "segment_events.py"
  expect_same verified.txt python.txt
fi
refuses "is signed: give the key with --bus-key FILE" --log signed/run.lcm
refuses "no message that is signed with the key" --log signed/run.lcm --bus-key other.key
refuses "no message that is signed with the key" --log signed/mapper.lcm --bus-key bus.key
chmod 640 other.key
refuses "has mode 0640.*chmod 600" --log signed/run.lcm --bus-key other.key
"$KINTSUGI_BIN/kintsugi-segmenter" --log signed/mapper.lcm --bus-key bus.key --trust-log --out trusted >trusted.log 2>&1 ||
  fail "a session log with --trust-log: $(tail -n 3 trusted.log)"
"$root/scripts/replay" signed/run.lcm --private --speed 4 --bus-key bus.key --out replayed >replay.txt 2>&1 || {
  cat replay.txt
  fail "scripts/replay"
}
expect_same_partition signed/segments.ply replayed/segments.ply

# The same log twice to one process; and Python on the bus.
cat >python_on_bus.py <<'PYTHON'
"""python_on_bus.py KEY sign|not: receives and sends LCM's datagrams without LCM, until it is ended."""
import socket, struct, sys, time, zlib
import kintsugi.lcm
from kintsugi.lcm.signing import BusKey, Refused, Signer, Verifier

GROUP = ("239.255.76.67", 7667)
SHORT = 0x4C433032  # begins a message of one datagram: magic, number, channel, zero, data
receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
receiver.bind(GROUP)
receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                    struct.pack("4s4s", socket.inet_aton(GROUP[0]), socket.inet_aton("127.0.0.1")))
receiver.settimeout(20)
key = BusKey.read(sys.argv[1])
verifier = Verifier(key)
while True:
    datagram = receiver.recv(65536)
    channel, data = datagram[8:].split(b"\0", 1)
    if struct.unpack(">I", datagram[:4])[0] == SHORT and channel == b"SEGMENTER_STATUS":
        break
status = kintsugi.lcm.segmenter_status_t.decode(verifier.open("SEGMENTER_STATUS", data))
assert status.session > 0 and kintsugi.lcm.segmenter_status_t.decode(data).session == status.session
for changed in (data[:-41] + bytes([data[-41] ^ 1]) + data[-40:], data):
    try:
        verifier.open("SEGMENTER_STATUS", changed)
        raise SystemExit("let through")
    except Refused as refused:
        assert refused.reason in ("forged", "replayed"), refused

sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
viewer = kintsugi.lcm.viewer_status_t()
viewer.utime, viewer.session, viewer.map_name = 1, 1, "from python"
encoded = bytearray(viewer.encode())
encoded[8:12] = struct.pack(">I", zlib.crc32(encoded))
signer = Signer(key) if sys.argv[2] == "sign" else None
number = 0
while True:
    data = signer.sign("VIEWER_STATUS", bytes(encoded)) if signer else bytes(encoded)
    sender.sendto(struct.pack(">II", SHORT, number) + b"VIEWER_STATUS\0" + data, GROUP)
    print(number, flush=True)
    number += 1
    time.sleep(0.1)
PYTHON
cat >inside.sh <<'SHELL'
set -euo pipefail
export KINTSUGI_BUS_KEY="$PWD/bus.key" PYTHONPATH="$KINTSUGI_BIN/../share/python"
mkdir twice
"$KINTSUGI_BIN/kintsugi-status" --log status.csv >status.txt 2>&1 &
watching=$!
"$KINTSUGI_BIN/kintsugi-segmenter" --out twice --linger=-1 >twice/segmenter.log 2>&1 &
segmenter=$!
"$KINTSUGI_BIN/kintsugi-status" --until-ready segmenter --timeout 20
# last FIELD: its last value in the statuses of the segmenter.
last() { awk -F, -v f="$1" '$2 == "segmenter" && $3 == f { v = $4 } END { print v + 0 }' status.csv; }
# wait_for FIELD: until its last value is not 0, at most 30 s.
wait_for() {
  local i
  for ((i = 0; i < 300; i++)); do
    (($(last "$1"))) && return
    sleep 0.1
  done
  echo "no $1"
  return 1
}
for shown_by in finished messages_replayed; do
  lcm-logplayer -l "$LCM_DEFAULT_URL" -s 4 -e '^(CLOUD_SLICE|CAMERA_POSE|MAPPER_STATUS)$' signed/run.lcm >player.txt 2>&1
  wait_for "$shown_by"
  echo "$shown_by $(last slices_segmented) $(last messages_replayed)" >>played.txt
done
if compgen -G "$PYTHONPATH/kintsugi/_kintsugi*.so" >/dev/null; then
  for how in sign not; do
    code=0
    /usr/bin/python3 python_on_bus.py bus.key "$how" >"sent-$how.txt" &
    sending=$!
    until [[ -s "sent-$how.txt" ]]; do
      kill -0 "$sending"
      sleep 0.1
    done
    # What is signed is heard at once; what is not, not in all that time.
    "$KINTSUGI_BIN/kintsugi-status" --until-ready viewer --timeout "$([[ $how == sign ]] && echo 60 || echo 4)" \
      >"heard-$how.txt" 2>&1 || code=$?
    kill "$sending"
    wait "$sending" || true
    echo "$how $code" >>heard.txt
  done
fi
kill "$segmenter" "$watching"
wait "$segmenter"
kill "$segmenter" 2>/dev/null || true
SHELL
"$root/scripts/private_bus" bash inside.sh >inside.txt 2>&1 || fail "on a private bus: $(cat inside.txt)"
read -r _ first_segmented first_replayed < <(sed -n 1p played.txt)
read -r _ second_segmented second_replayed < <(sed -n 2p played.txt)
((first_segmented > 0 && first_replayed == 0)) || fail "played once: $(cat played.txt)"
((second_segmented == first_segmented && second_replayed > 0)) || fail "played twice: $(cat played.txt)"
grep -q "it was received before: somebody repeats recorded messages" twice/segmenter.log || fail "no word of a repetition"
if [[ -e heard.txt ]]; then
  [[ "$(cat heard.txt)" == $'sign 0\nnot 2' ]] || fail "what Python sends: $(cat heard.txt heard-*.txt)"
  grep -q "dropped a message on VIEWER_STATUS: it is not signed" heard-not.txt || fail "$(cat heard-not.txt)"
fi
