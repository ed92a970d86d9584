# Publishers of messages that nobody on the bus should believe.

fault_row hostile "random and mutated messages on every channel, 1,000 a second for 60 s" hostile_row
fault_row forged "a signed bus: forged and repeated messages about the map, 500 a second for 30 s, without the key" forged_row
fault_row forged-keyless "the same without a key: what whoever is on the bus may do" forged_keyless_row

hostile_row() {
  local seconds=60 allowed_mb=32 since
  choose_played
  # Publishing the map takes as long.
  played=(--session=7 --points=1400000 --speed=3)
  if_quick && { seconds=3; played=(--session=7 --points=60000 --slice-points=2000 --speed=4); }
  played_reference
  out="$PWD/faulty" viewer_ends=() since="$EPOCHREALTIME"
  start_played log segmenter viewer mapper
  must "nothing was published" wait_for_points 1 # so all three listen
  process_start hostile "${player%/*}/hostile_publisher" --seconds="$seconds" --seed="$seed" --listen=1 \
    --report=hostile.json
  process_wait hostile || failures+=("hostile_publisher failed")
  must "the map was not drawn" status_says viewer finished 120
  sleep 1 # until the last statuses have come
  figure[lost]="$(datagrams_lost)"
  process_stop 60 viewer
  finish_played 10
  figure[seconds]="$(since_s "$since")"
  # Each stream counts a bad heartbeat: two of the segmenter, four of the viewer.
  counted segmenter "$(sent CLOUD_SLICE CAMERA_VIEW HEARTBEAT HEARTBEAT RESEND_REQUEST SEGMENT_QUERY)"
  counted viewer "$(sent CLOUD_SLICE CAMERA_VIEW SEGMENT_UPDATE SEGMENT_ANSWER CAMERA_POSE SEGMENTER_STATUS \
    OBJECT_DETECTION DETECTOR_STATUS \
    HEARTBEAT HEARTBEAT HEARTBEAT HEARTBEAT)"
  counts_match mapper "$(json_number faulty/player.json requests_bad)" "$(sent RESEND_REQUEST)"
  no_growth segmenter "$allowed_mb"
  no_growth viewer "$allowed_mb"
  same_map
}

# status_says PROCESS FIELD SECONDS: waits at most so long until a status has the field set.
status_says() {
  local deadline=$((SECONDS + $3))
  until grep -q ",$1,$2,1" "$out/status.csv"; do
    ((SECONDS < deadline)) || return 1
    sleep 0.2
  done
}

# sent CHANNEL...: how many messages the report $sent_report tells of on these channels.
sent_report=hostile.json
sent() {
  local channel sum=0
  for channel in "$@"; do sum=$((sum + $(json_number "$sent_report" "$channel"))); done
  echo "$sum"
}

# datagrams_lost: how many the sockets on the bus dropped because their receive buffers were full.
datagrams_lost() { awk '$2 ~ /:1DF3$/ { sum += $NF } END { print sum + 0 }' /proc/net/udp; }

# counted PROCESS SENT: the status has to count as bad each message that reached the process.
counted() { counts_match "$1" "$(status_last faulty "$1" messages_bad)" "$2"; }
counts_match() {
  note "$1: $2 of $3 counted as bad"
  must "$1 counted $2 bad messages of $3" test "$2" -le "$3" -a "$2" -ge "$(($3 - figure[lost]))"
}

# no_growth PROCESS MB: the process may take only so much more memory than in the run without a fault.
no_growth() {
  local before growth
  before="$(status_most "$reference" "$1" memory_bytes)"
  growth="$(calculate "1e-6 * ($(status_most faulty "$1" memory_bytes) - $before)" 0)"
  note "$1: $growth MB more than without"
  must "$1 took $growth MB more than without" test "$growth" -le "$2"
}

# choose_forged: a map of patches that takes about twice as long as the lies about it.
choose_forged() {
  seconds=30
  choose_played
  played=(--session=7 --points=1000000 --batch=5 --speed=2)
  if_quick && { seconds=5; played=(--session=7 --points=60000 --slice-points=2000 --batch=5 --speed=3); }
  return 0
}
# forge: lies about the map, without a key. From when all listen: who has not heard a message cannot tell that it is repeated.
forge() {
  must "nothing was published" wait_for_points 1
  process_start forger env -u KINTSUGI_BUS_KEY "${player%/*}/forging_publisher" --seconds="$seconds" --report=forged.json
  process_wait forger || failures+=("forging_publisher failed, see forger.log")
}

forged_row() {
  local since
  "$KINTSUGI_BIN/kintsugi-keygen" "$PWD/bus.key" >keygen.txt
  choose_forged
  played_reference
  out="$PWD/faulty" viewer_ends=() since="$EPOCHREALTIME"
  export KINTSUGI_BUS_KEY="$PWD/bus.key"
  start_played log segmenter viewer mapper
  forge
  must "the map was not drawn" status_says viewer finished 120
  sleep 1 # until the last statuses have come
  figure[lost]="$(datagrams_lost)"
  process_stop 60 viewer
  finish_played 10
  figure[seconds]="$(since_s "$since")"
  must "nothing was repeated" test "$(json_number forged.json repeated)" -gt 0
  refused mapper RESEND_REQUEST
  refused segmenter CLOUD_SLICE HEARTBEAT RESEND_REQUEST SEGMENT_QUERY
  refused viewer CLOUD_SLICE SEGMENT_UPDATE SEGMENT_ANSWER CAMERA_POSE SEGMENTER_STATUS HEARTBEAT
  must "a query was answered" test "$(json_number forged.json answered)" -eq 0
  same_map
}

# refused PROCESS CHANNEL...: the process has dropped each lie on these channels, and no decoder has seen one.
refused() {
  local process="$1" kind counts=() sum=0 sent
  shift
  sent="$(sent_report=forged.json sent "$@")"
  for kind in unsigned forged replayed; do
    counts+=("$(status_last faulty "$process" "messages_$kind")")
    sum=$((sum + counts[-1]))
  done
  note "$process: $sum of $sent refused (${counts[0]} unsigned, ${counts[1]} forged, ${counts[2]} replayed)"
  must "$process refused $sum messages of $sent" test "$sum" -le "$sent" -a "$sum" -ge "$((sent - figure[lost]))"
  must "a decoder of the $process saw a lie" test "$(status_last faulty "$process" messages_bad)" -eq 0
}

# Without a key every well-made lie is believed: the map may become another one, queries are answered, and chunks sent
# again. But no message ends a process, and none makes it write anything but its own files.
forged_keyless_row() {
  local name since="$EPOCHREALTIME"
  choose_forged
  played_reference
  out="$PWD/faulty" viewer_ends=()
  start_played log segmenter viewer mapper
  forge
  for name in mapper segmenter viewer; do must "a message has ended the $name" process_alive "$name"; done
  figure[lost]="$(datagrams_lost)"
  for name in viewer segmenter mapper log; do process_stop 60 "$name" || failures+=("$name did not stop"); done
  figure[seconds]="$(since_s "$since")"
  must "no query was answered" test "$(json_number forged.json answered)" -gt 0
  must "the mapper sent nothing again" test "$(status_last faulty mapper requests_received)" -gt 0
  must "the map is the true one" is_other_map
  note "the map is another one, $(json_number forged.json answered) queries were answered"
}
is_other_map() { ! "$kintsugi_root/scripts/lib/same_partition.py" "$reference/segments.ply" faulty/segments.ply >/dev/null 2>&1; }
