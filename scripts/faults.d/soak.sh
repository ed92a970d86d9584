# Three times the normal rate of slices, as patches, for a long time. KINTSUGI_SOAK_S: how many seconds.

fault_row soak "three times the normal rate of slices, as patches, for ${KINTSUGI_SOAK_S:-1800} s" soak_row

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
    must "$process grew after the map had ceased to" is_flat "$process" "$seconds"
  done
  must "$(status_last faulty segmenter lag_slices) slices wait in the end" \
    test "$(status_last faulty segmenter lag_slices)" -eq 0
  must "slices are missing" test "$(status_last faulty segmenter slices_missing)" -eq 0
}

# memory_at PROCESS SHARE SECONDS: peak memory in MB, in the tenth of the time that ends at this share of it.
memory_at() {
  awk -F, -v process="$1" -v share="$2" -v seconds="$3" '
    !start && $2 == "mapper" && $3 == "points_published" && $4 > 0 { start = $1 }
    { t = start ? 1e-6 * ($1 - start) : -1 }
    t <= (share - 0.1) * seconds || t > share * seconds { next }
    $2 == process && $3 == "memory_bytes" && $4 > most { most = $4 }
    END { printf "%.0f", 1e-6 * most }' faulty/status.csv
}
memory_over_time() {
  local share line=""
  for share in 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1.0; do line+=" $(memory_at "$1" "$share" "$2")"; done
  note "$1, MB in each tenth:$line"
}

# Memory may grow by a twentieth and 16 MB from the middle to the end: what an allocator keeps varies.
is_flat() {
  local middle end
  middle="$(memory_at "$1" 0.6 "$2")" end="$(memory_at "$1" 1.0 "$2")"
  test "$end" -le "$((middle + middle / 20 + 16))"
}
