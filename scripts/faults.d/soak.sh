# Long runs. KINTSUGI_SOAK_S: how many seconds of three times the normal rate of slices. KINTSUGI_PATROL_HOURS: how long the
# camera walks its round; KINTSUGI_PATROL_S: after so many seconds here it is stopped before (default: never).

fault_row soak "three times the normal rate of slices, as patches, for ${KINTSUGI_SOAK_S:-1800} s" soak_row
fault_row patrol "the same round walked for ${KINTSUGI_PATROL_HOURS:-12} h, as fast as it can be mapped, with --store-limit" patrol_row

# The map grows to 4 million points in 170 s; then its patches are revised, at the same rate.
soak_row() {
  local seconds="${KINTSUGI_SOAK_S:-1800}" process since
  if_quick && seconds=8
  choose_played
  played=(--session=7 --points=4000000 --speed=3 --batch=3 "--seconds=$seconds")
  if_quick && played=(--session=7 --points=60000 --slice-points=1500 --speed=12 --batch=3 "--seconds=$seconds")
  out="$PWD/faulty"
  start_played log segmenter viewer mapper
  must "nothing was published" wait_for_points 1 # generating the map takes its time
  since="$EPOCHREALTIME"
  sleep "$seconds"
  finish_played 120
  figure[seconds]="$(since_s "$since")"
  for process in mapper segmenter viewer; do
    memory_over_time "$process" "$seconds"
    # In 8 s the map is small, and what the allocators of a busy machine keep is more than all of it.
    if_quick || must "$process grew after the map had ceased to" is_flat "$process" "$seconds"
  done
  must "$(status_last faulty segmenter lag_slices) slices wait in the end" \
    test "$(status_last faulty segmenter lag_slices)" -eq 0
  must "slices are missing" test "$(status_last faulty segmenter slices_missing)" -eq 0
}

# Of few and small images and large voxels, so that hours take minutes. A round takes 100 s. What left the volume fills the
# memory that is given to it, here after some rounds.
patrol_row() {
  local hours="${KINTSUGI_PATROL_HOURS:-12}" limit_mb=150 rate_hz=2 laps process seconds walked_s most_mb
  if_quick && hours=0.03 limit_mb=16
  laps="$(calculate "$hours * 36 < 1 ? 1 : $hours * 36" 0)"
  scene+=(--device "synthetic://patrol?sensor=lidar&rate=$rate_hz&laps=$laps" --resolution 0.02
    --store-limit "$limit_mb" --every 100000000 --mapper '--session=7 --kept-memory=30')
  faulty_start
  watch_sizes &
  if [[ -n "${KINTSUGI_PATROL_S:-}" ]]; then
    { sleep "$KINTSUGI_PATROL_S"; kill -TERM "$faulty_pid"; } 2>/dev/null &
  fi
  faulty_wait
  seconds="$(seconds_of_statuses)"
  walked_s="$(calculate "($(status_last faulty mapper frames_tracked) + $(status_last faulty mapper frames_lost)) / $rate_hz" 0)"
  note "$(calculate "$walked_s / 3600" 2) h walked, $(calculate "$walked_s / $seconds" 1) times as fast as the camera"
  for process in mapper segmenter viewer; do
    memory_over_time "$process" "$seconds"
    if_quick || must "$process grew" is_flat "$process" "$seconds" 0.9 # then come the rest of the map and the last pictures
  done
  note "files, MB in each tenth: of the log$(sizes_over_time 2), of the folder$(sizes_over_time 3)"
  most_mb="$(sort -g -k2 sizes.txt | awk 'END { print $2 }')"
  must "the log had $most_mb MB" test "$(calculate "$most_mb <= $limit_mb" 0)" -eq 1
  note "$(calculate "1e-6 * $(status_last faulty mapper chunks_published)" 3) million chunks published, most slices behind in \
each tenth:$(lag_over_time)"
  must "nothing was removed from the log" test ! -e faulty/mapper.1.lcm
  must "$(status_last faulty segmenter lag_slices) slices wait in the end" \
    test "$(status_last faulty segmenter lag_slices)" -eq 0
  must "slices are missing" test "$(status_last faulty segmenter slices_missing)" -eq 0
}

# A line for each second: the time, MB of the log's files and of all files of the run; until the run has ended.
watch_sizes() {
  local since="$EPOCHREALTIME"
  while kill -0 "$faulty_pid" 2>/dev/null; do
    printf '%s %s %s\n' "$(since_s "$since")" "$(mb_of faulty/mapper.lcm faulty/mapper.*.lcm)" "$(mb_of faulty/*)" >>sizes.txt
    sleep 1
  done
}
mb_of() { stat -c %s "$@" 2>/dev/null | awk '{ n += $1 } END { printf "%.1f", 1e-6 * n }'; }

# sizes_over_time COLUMN: the most in each tenth of the time.
sizes_over_time() {
  awk -v c="$1" '{ t[NR] = $1; v[NR] = $c } END {
    for (i = 1; i <= NR; ++i) { k = int(10 * t[i] / (t[NR] + 0.001)); if (v[i] > m[k]) m[k] = v[i] }
    for (k = 0; k < 10; ++k) printf " %.0f", m[k] }' sizes.txt
}
lag_over_time() {
  awk -F, '!start { start = $1 } { last = $1 } $2 == "segmenter" && $3 == "lag_slices" { t[++n] = $1; v[n] = $4 } END {
    for (i = 1; i <= n; ++i) { k = int(10 * (t[i] - start) / (last - start + 1)); if (v[i] > m[k]) m[k] = v[i] }
    for (k = 0; k < 10; ++k) printf " %d", m[k] }' faulty/status.csv
}

# From the first slice to the last status.
seconds_of_statuses() {
  awk -F, '!start && $2 == "mapper" && $3 == "points_published" && $4 > 0 { start = $1 } { last = $1 }
    END { printf "%.1f", 1e-6 * (last - start) }' faulty/status.csv
}

# most_memory PROCESS FROM TO SECONDS: peak memory in MB between two shares of the time.
most_memory() {
  awk -F, -v process="$1" -v from="$2" -v to="$3" -v seconds="$4" '
    !start && $2 == "mapper" && $3 == "points_published" && $4 > 0 { start = $1 }
    { t = start ? 1e-6 * ($1 - start) : -1 }
    t <= from * seconds || t > to * seconds { next }
    $2 == process && $3 == "memory_bytes" && $4 > most { most = $4 }
    END { printf "%.0f", 1e-6 * most }' faulty/status.csv
}
memory_over_time() {
  local tenth line=""
  for tenth in 1 2 3 4 5 6 7 8 9 10; do line+=" $(most_memory "$1" "0.$((tenth - 1))" "$(calculate "$tenth / 10" 1)" "$2")"; done
  note "$1, MB in each tenth:$line"
}

# is_flat PROCESS SECONDS [SHARE]: in the second half of the time, up to this share of it, a process may take a twentieth and 16 MB
# more than in the first. Single tenths say little: what waits, and what an allocator keeps, varies.
is_flat() {
  local before after
  before="$(most_memory "$1" 0 0.5 "$2")" after="$(most_memory "$1" 0.5 "${3:-1.0}" "$2")"
  test "$after" -le "$((before + before / 20 + 16))"
}
