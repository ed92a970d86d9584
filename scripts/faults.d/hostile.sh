# A publisher of random bytes and of mutated valid messages on every channel, 1,000 a second.

fault_row hostile "random and mutated messages on every channel, 1,000 a second for 60 s" hostile_row

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

# sent CHANNEL...: how many hostile messages were sent on these channels.
sent() {
  local channel sum=0
  for channel in "$@"; do sum=$((sum + $(json_number hostile.json "$channel"))); done
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
