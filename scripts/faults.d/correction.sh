# Faults while the whole map is corrected, as when a loop is closed. KINTSUGI_KILL_RUNS: the number of runs in a row with
# kills, each with other random moments (default 5, with --quick 1).
#
# correction_watch (tests/support) hears a correction on the bus and kills at a random moment before the segmenter's update
# for it, which is its acknowledgement; a correction whose moment comes too late for that does not count, the next one does.

source "$kintsugi_root/scripts/lib/played_run.sh"

for process in mapper segmenter viewer; do
  fault_row "correction-kill-$process" "$process killed between a correction of the map and its acknowledgement" \
    correction_kill_row 0 "$process"
done
fault_row correction-kill-loss-10 "10 % of datagrams dropped, and segmenter, viewer and mapper killed at corrections" \
  correction_kill_row 10 segmenter viewer mapper
fault_row correction-loss-10 "10 % of datagrams dropped in a run of corrections" correction_loss_row 10
for process in segmenter viewer; do
  fault_row "correction-late-$process" "$process started right after a correction of the map" \
    correction_late_row "$process"
done
fault_row correction-kill-loop "mapper killed at the correction by which it closes a loop of synthetic://loop" \
  correction_kill_loop_row

# A map in patches that is corrected all along, at last when all of it is there.
num_corrections=8
choose_corrected() {
  choose_played
  played=(--session=7 --points=1000000 --most-points=2000 --batch=10 --speed=40 "--corrections=$num_corrections")
  if_quick &&
    played=(--session=7 --points=60000 --most-points=500 --batch=10 --speed=80 "--corrections=$num_corrections")
  resumable=1
}

# start_watch FILE CORRECTION [OPTION...]: waits for that correction or a later one, from now on; FILE gets its report.
start_watch() {
  rm -f watching
  process_start watch "${player%/*}/correction_watch" --correction="$2" --ready="$PWD/watching" --report="$1" \
    --seed="$RANDOM" "${@:3}"
  until [[ -s watching ]]; do
    process_alive watch || { failures+=("correction_watch failed, see $out/watch.log"); return; }
    sleep 0.05
  done
}

# kill_at_correction PROCESS FIRST: kills a played process at a correction, the FIRST or a later one, and starts it again.
kill_at_correction() {
  local process="$1" code=0
  echo "${process_pid[$process]}" >"$process.pid"
  start_watch "$out/kill-$process.json" "$2" --kill="$process.pid"
  process_wait watch || { failures+=("$process was not killed, see $out/watch.log"); return; }
  process_wait "$process" || code=$?
  must "$process ended with code $code before it was killed" test "$code" -eq 137
  kills+=("$process $(json_number "$out/kill-$process.json" after_ms | cut -d. -f1) ms after correction \
$(json_number "$out/kill-$process.json" correction)")
  start_played "$process"
}

# kill_some_at_corrections PROCESS...: one after the other, each at one of its share of the corrections. The last of
# them is left as a reserve, should an acknowledgement come before the moment.
kill_some_at_corrections() {
  local share=$((num_corrections / $#)) first=1 process
  for process in "$@"; do
    kill_at_correction "$process" $((first + RANDOM % (share > 1 ? share - 1 : 1)))
    ((!${#failures[@]})) || return 0
    first=$((first + share))
  done
}

correction_kill_row() {
  local percent="$1" num_runs="${KINTSUGI_KILL_RUNS:-5}" run most_s=0 since kills sent
  if_quick && num_runs="${KINTSUGI_KILL_RUNS:-1}"
  # With a ttl above 0 chunks are smaller, so that enough of them are lost.
  ((percent == 0)) || export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=212992'
  choose_corrected
  played_reference
  ((percent == 0)) || drop_datagrams "$percent"
  for ((run = 1; run <= num_runs; ++run)); do
    out="$PWD/faulty" kills=() since="$EPOCHREALTIME"
    start_played log segmenter viewer mapper
    kill_some_at_corrections "${@:2}"
    finish_played 300
    most_s="$(calculate "$most_s > $(since_s "$since") ? $most_s : $(since_s "$since")" 1)"
    same_map
    note "$(joined "${kills[@]}")"
    ((${#failures[@]})) && { failures+=("in run $run"); break; }
    ((run == num_runs)) || rm -rf faulty
  done
  figure[seconds]="$most_s"
  if ((percent)); then
    read -r sent "figure[lost]" < <(sent_and_lost_datagrams)
    note "of $sent datagrams"
    must "nothing was dropped" test "${figure[lost]}" -gt 0
  fi
}

correction_loss_row() {
  local sent
  export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=1&recv_buf_size=212992'
  choose_corrected
  played_reference
  drop_datagrams "$1"
  played_run faulty
  read -r sent "figure[lost]" < <(sent_and_lost_datagrams)
  note "of $sent datagrams"
  must "nothing was dropped" test "${figure[lost]}" -gt 0
  same_map
}

correction_late_row() {
  local late="$1" early=segmenter since
  [[ "$late" == segmenter ]] && early=viewer
  choose_corrected
  played_reference
  out="$PWD/faulty" since="$EPOCHREALTIME"
  mkdir -p "$out"
  start_watch "$out/late.json" $((1 + RANDOM % num_corrections))
  start_played log "$early" mapper
  process_wait watch || failures+=("no correction came, see $out/watch.log")
  start_played "$late"
  finish_played 300
  figure[seconds]="$(since_s "$since")"
  note "started after correction $(json_number "$out/late.json" correction) of $num_corrections"
  same_map
}

# The mapper itself: it corrects the map once, at the end of the path, and after it was killed it maps all frames again.
correction_kill_loop_row() {
  scene=(--replay --no-log --every 1000000 --device 'synthetic://loop?speed=3'
    --mapper '--session=7 --volume-memory 25')
  reference
  must "the map of the run without a fault was not corrected" test "$(status_last "$reference" mapper corrections)" -gt 0
  out="$PWD"
  start_watch "$PWD/kill.json" 1 --kill=faulty/mapper.pid
  faulty_start
  while process_alive watch && kill -0 "$faulty_pid" 2>/dev/null; do sleep 0.1; done
  process_stop 10 watch
  process_wait watch || failures+=("the mapper was not killed, see $PWD/watch.log")
  faulty_wait
  must "the mapper was not started again" grep -q 'mapper was killed' faulty.txt
  note "killed $(json_number kill.json after_ms | cut -d. -f1) ms after correction $(json_number kill.json correction)"
  same_map
}
