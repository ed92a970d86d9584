# A segmenter or a viewer that starts after a part of a large map has been published.

for process in segmenter viewer; do
  for percent in 10 50 100; do
    fault_row "late-$process-$percent" "$process started after $percent % of a map of 4 million points" \
      late_row "$process" "$percent"
  done
done

# A map that takes about a minute to publish.
choose_large() {
  choose_played
  played=(--session=7 --points=4000000 --speed=8)
  if_quick && played=(--session=7 --points=60000 --slice-points=2000 --speed=10)
  return 0
}

late_row() {
  local late="$1" percent="$2" early=segmenter total since joined_us
  [[ "$late" == segmenter ]] && early=viewer
  choose_large
  played_reference
  total="$(status_last "$reference" mapper points_published)"
  out="$PWD/faulty" since="$EPOCHREALTIME"
  start_played log "$early" mapper
  must "the map was not published" wait_for_points "$(calculate "$percent * $total / 100" 0)"
  joined_us="${EPOCHREALTIME/./}"
  start_played "$late"
  finish_played 300
  figure[seconds]="$(since_s "$since")"
  note "full state after $(full_state_s "$late" "$joined_us") s"
  note "$(calculate "1e-6 * $(json_number faulty/player.json bytes_resent)" 1) MB of the map's \
$(calculate "1e-6 * $(json_number faulty/player.json bytes)" 1) MB sent again"
  [[ "$late" == segmenter ]] ||
    note "full states: $(status_last faulty segmenter states_sent), of $(calculate "1e-6 * \
$(status_last faulty segmenter state_bytes)" 1) MB"
  same_map
}

# wait_for_points N: waits at most 200 s until so many points are published.
wait_for_points() {
  local i
  for ((i = 0; i < 1000; i++)); do
    (($(status_last faulty mapper points_published 2>/dev/null || echo 0) >= $1)) && return
    sleep 0.2
  done
  return 1
}

# full_state_s PROCESS JOINED_US: seconds from then until it had all published points with their labels, except for two
# slices that may be on the way.
full_state_s() {
  awk -F, -v process="$1" -v joined="$2" '
    $2 == "mapper" && $3 == "points_published" { published = $4 }
    $2 == process && $1 >= joined { now[$3] = $4; time = $1 }
    $2 == process && $1 >= joined && $3 == "points" { near = $4 > 0 && $4 >= published - 25000 }
    $2 == process && $1 >= joined && $3 == "lag_slices" { level = $4 <= 2 }
    near && level { printf "%.1f", 1e-6 * (time - joined); found = 1; exit }
    END { if (!found) printf "?" }' faulty/status.csv
}
