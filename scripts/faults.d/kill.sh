# A process is killed (SIGKILL) at a random moment of a run, and scripts/trio starts it again. KINTSUGI_KILL_RUNS: the number
# of runs in a row, each with other random moments (default 20, with --quick 2).

for process in segmenter viewer mapper; do
  fault_row "kill-$process" "$process killed at a random moment of each run" kill_row "$process"
done
fault_row kill-all "all three killed, each at a random moment of its own in each run" kill_row segmenter viewer mapper

# kill_at MOMENT PROCESS: kills it so many seconds after the start of the faulty run, unless it has ended by then.
kill_at() {
  local wait_s pid
  wait_s="$(calculate "$1 - $(since_s "$faulty_since")")"
  [[ "$wait_s" == -* ]] || sleep "$wait_s"
  pid="$(pid_of "$2")" && kill -KILL "$pid" 2>/dev/null || true
}

# draw_moment: sets $moment to a random number of seconds, in which the reference had not yet finished. See draw_share.
draw_moment() {
  local share
  draw_share
  moment="$(calculate "0.95 * ${figure[reference_s]} * $share" 2)"
}

# plan_kills PROCESS...: sets $planned to a line for each, `MOMENT PROCESS`, earliest first.
plan_kills() {
  local process moment
  planned=""
  for process in "$@"; do
    draw_moment
    planned+="$moment $process"$'\n'
  done
  planned="$(sort -g <<<"${planned%$'\n'}")"
}

kill_row() {
  local num_runs="${KINTSUGI_KILL_RUNS:-20}" run process kills=0 most_s=0 moments planned
  if_quick && num_runs="${KINTSUGI_KILL_RUNS:-2}"
  choose_scene
  reference
  for ((run = 1; run <= num_runs; ++run)); do
    moments=""
    plan_kills "$@"
    faulty_start
    while read -r moment process; do
      moments+="${moments:+, }$process at $moment s"
      kill_at "$moment" "$process"
    done <<<"$planned"
    faulty_wait
    kills=$((kills + $(grep -c 'was killed' faulty.txt || true)))
    most_s="$(calculate "$most_s > ${figure[seconds]} ? $most_s : ${figure[seconds]}" 1)"
    same_map
    if ((${#failures[@]})); then
      failures+=("in run $run: $moments")
      return
    fi
    rm -rf faulty
  done
  figure[seconds]="$most_s"
  note "$kills kills in $num_runs runs; the longest run is given"
}
