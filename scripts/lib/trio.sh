# Sourced by trio, replay and faults: starting, watching and stopping the processes of one run.
# Every function works on the run in $out; each process writes its log to $out/NAME.log.

kintsugi_root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
KINTSUGI_BIN="${KINTSUGI_BIN:-$kintsugi_root/build/release/bin}"
declare -A trio_pid=()      # name -> process id
declare -A trio_command=()  # name -> command line, quoted
declare -A trio_since=()    # name -> when it was started, s since the script was
declare -A trio_quick=()    # name -> how many of its starts in a row were soon followed by its death
declare -A trio_cpu_s=()    # name -> CPU time, s, when last looked at (not of those it replaced)
declare -A trio_peak_mb=()  # name -> the most memory it held, MB (also of those it replaced)
stop_requested=0            # how often a person asked to stop: counted by the script's trap

say() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; }

# value OPTION VALUE: the value of a command-line option, which must be there.
value() { (($# > 1)) && printf '%s' "$2" || { say "$1 needs a value"; exit 2; }; }

check_programs() {
  [[ -x "$KINTSUGI_BIN/kintsugi-mapper" ]] && return
  say "no programs in $KINTSUGI_BIN; run scripts/build first"
  exit 1
}

# trio_start NAME COMMAND...: in the background, its process id in $out/NAME.pid. The process gets a session of its own,
# so that Ctrl-C reaches only the script, and is ended with the script should that be killed.
trio_start() {
  local name="$1"
  shift
  trio_command[$name]="$(printf '%q ' "$@")"
  trio_since[$name]="$SECONDS"
  setpriv --pdeathsig TERM setsid "$@" >>"$out/$name.log" 2>&1 &
  trio_pid[$name]=$!
  echo "$!" >"$out/$name.pid"
}

trio_alive() { [[ -n "${trio_pid[$1]:-}" ]] && kill -0 "${trio_pid[$1]}" 2>/dev/null; }

# trio_note_use NAME...: looks at the CPU time and memory of those that run.
trio_note_use() {
  local name line peak_mb
  for name in "$@"; do
    line="$(cat "/proc/${trio_pid[$name]:-none}/stat" 2>/dev/null)" || continue
    trio_cpu_s[$name]="$(awk -v hz="$(getconf CLK_TCK)" '{ printf "%.2f", ($12 + $13) / hz }' <<<"${line##*) }")"
    peak_mb="$(awk '/^VmHWM/ { printf "%d", $2 / 1000 }' "/proc/${trio_pid[$name]}/status" 2>/dev/null)"
    ((${peak_mb:-0} <= ${trio_peak_mb[$name]:-0})) || trio_peak_mb[$name]="$peak_mb"
  done
}

# trio_stop SIGNAL SECONDS NAME...: asks the named processes to stop and waits; kills what does not, and fails then.
trio_stop() {
  local signal="$1" seconds="$2" name deadline killed=0
  shift 2
  for name in "$@"; do
    trio_alive "$name" && kill -s "$signal" "${trio_pid[$name]}" 2>/dev/null
  done
  deadline=$((SECONDS + seconds))
  for name in "$@"; do
    while trio_alive "$name" && ((SECONDS < deadline)); do sleep 0.1 || true; done
    trio_alive "$name" || continue
    say "$name did not stop within $seconds s; killing it"
    kill -KILL "${trio_pid[$name]}" 2>/dev/null || true
    killed=1
  done
  ((!killed))
}

# last_words NAME: the end of its log, for a person who asks why.
last_words() { tail -n 5 "$out/$1.log" 2>/dev/null | sed "s/^/  $1: /" >&2; }

# trio_wait_ready NAME...: until each has been heard on the bus; while a log is played nobody sends its slices again.
trio_wait_ready() {
  local name list
  list="$(IFS=,; echo "$*")"
  "$KINTSUGI_BIN/kintsugi-status" --until-ready "$list" --timeout 20 >/dev/null && return
  say "$list did not come up:"
  for name in "$@"; do last_words "$name"; done
  return 1
}

# trio_record FILE, trio_end_record FILE: the whole bus into an LCM log, which gets its name when it is complete.
trio_record() {
  trio_start logger lcm-logger -q -a ${LCM_DEFAULT_URL:+--lcm-url="$LCM_DEFAULT_URL"} "$1.partial"
}
trio_end_record() {
  trio_stop INT 10 logger
  mv "$1.partial" "$1"
}

# trio_watch LEADER NAME...: shows the progress until the last named, the viewer where there is one, has all it needs and
# has ended by itself; then ends the others, the leader last, for they are asked for what is missing until then. One that
# a signal killed is started again; an error that one reports itself ends the run.
trio_watch() {
  local name leader="$1" last="${!#}" asked=0
  trio_failed=0
  trio_show_progress 60
  while [[ -n "${trio_pid[$last]:-}" ]]; do
    sleep 0.2 || true
    trio_note_use "$@"
    for name in "$@"; do
      [[ -z "${trio_pid[$name]:-}" ]] || trio_alive "$name" || trio_ended "$name"
    done
    [[ -n "${trio_pid[$last]:-}" ]] || break
    if ((stop_requested && !asked)); then
      asked=1
      say "stopping; what the map holds is published, segmented, drawn and written (Ctrl-C again: stop at once)"
      trio_alive progress && ! trio_mapper_lingers && trio_tell_to_stop "$leader"
    fi
    if ((stop_requested > 1)) || trio_stands_still "$leader"; then
      trio_stop TERM 60 "$last" || trio_failed=1
    fi
  done
  trio_close "$@"
  trio_stop TERM 2 progress
  return "$trio_failed"
}

# trio_tell_to_stop NAME: once; told twice it would leave out what it has not published yet.
trio_tell_to_stop() {
  trio_alive "$1" && [[ "${trio_told:-}" != "${trio_pid[$1]}" ]] || return 0
  trio_told="${trio_pid[$1]}"
  kill -s TERM "$trio_told" 2>/dev/null || true
}

# trio_mapper_lingers: it has said that all is published, and stays only to send again what others miss.
trio_mapper_lingers() { [[ "$(grep ',mapper,lingering,' "$out/status.csv" 2>/dev/null | tail -n 1)" == *,1 ]]; }

# trio_show_progress SECONDS: until all have finished, or nothing moved for so long.
trio_show_progress() {
  trio_stop TERM 2 progress
  setpriv --pdeathsig TERM setsid "$KINTSUGI_BIN/kintsugi-status" --until-finished --viewer --timeout "$1" --log "$out/status.csv" &
  trio_pid[progress]=$!
}

# trio_stands_still LEADER: everything is mapped, or nothing will be, and yet the viewer does not get on. A camera that
# is silent may come back.
trio_stands_still() {
  local code=0
  [[ -n "${trio_pid[progress]:-}" ]] && ! trio_alive progress || return 1
  wait "${trio_pid[progress]}" || code=$?
  unset "trio_pid[progress]"
  ((code == 0)) && return 1
  trio_alive "$1" && ! grep -q ',mapper,finished,1' "$out/status.csv" || return 0
  trio_show_progress 60
  return 1
}

# trio_ended NAME: sees to one that has ended. One that a signal killed is started again, unless it died within 2 s of
# its start 5 times running.
trio_ended() {
  local name="$1" code=0
  wait "${trio_pid[$name]}" 2>/dev/null || code=$?
  unset "trio_pid[$name]"
  ((code == 0 || code == 143)) && return # by itself, or as it was told to
  ((SECONDS - trio_since[$name] < 2)) && trio_quick[$name]=$((${trio_quick[$name]:-0} + 1)) || trio_quick[$name]=0
  if ((code > 128 && !stop_requested && trio_quick[$name] < 5)); then
    say "$name was killed (signal $((code - 128))); starting it again"
    trio_restart "$name"
  else
    trio_failed=1
    ((stop_requested)) || stop_requested=1
    say "$name ended with an error (exit code $code):"
    last_words "$name"
    trio_show_progress 5 # the others may still finish what there is, but need not
  fi
}

# trio_restart NAME: with the command it had; the mapper goes on with the session in its store.
trio_restart() {
  local command="${trio_command[$1]}"
  [[ "$1" == mapper && -s "$out/mapper.lcm" ]] && command="${command/ --store=/ --resume=}"
  eval "trio_start $1 $command"
}

# trio_close LEADER NAME...: ends those that have done all they have to, the leader last. One that is killed at this
# moment is started again, and finishes first.
trio_close() {
  local name
  for name in "${@:2}" "$1"; do
    while [[ -n "${trio_pid[$name]:-}" ]]; do
      [[ "$name" != mapper ]] || trio_let_mapper_finish
      trio_stop TERM 60 "$name" || { trio_failed=1; break; }
      trio_ended "$name"
      trio_alive "$name" && "$KINTSUGI_BIN/kintsugi-status" --until-finished --timeout 60 >/dev/null
    done
  done
}

# trio_let_mapper_finish: until it stays only to send again what others miss; one that still maps is told to stop.
trio_let_mapper_finish() {
  local lingers=("$KINTSUGI_BIN/kintsugi-status" --until-ready mapper --lingering)
  trio_alive mapper || return 0
  "${lingers[@]}" --timeout 2 >/dev/null 2>&1 && return
  trio_tell_to_stop mapper
  "${lingers[@]}" --timeout 60 >/dev/null 2>&1 || true
}

# trio_summary: what the run took and wrote.
trio_summary() {
  local file name cpu="" memory=""
  for name in mapper segmenter viewer; do
    [[ -n "${trio_cpu_s[$name]:-}" ]] && cpu+="${cpu:+,} $name ${trio_cpu_s[$name]} s"
    [[ -n "${trio_peak_mb[$name]:-}" ]] && memory+="${memory:+,} $name ${trio_peak_mb[$name]} MB"
  done
  printf '  CPU:%s\n  memory at most:%s\n' "$cpu" "$memory"
  say "written:"
  while IFS='|' read -r file what; do
    [[ -e "$out/$file" ]] && printf '  %-28s %s\n' "$out/$file" "$what"
  done <<'FILES'
segments.ply|the map: x y z, normal, colour, segment_id, slice_id, weight
segments.json|every segment: points, boxes, plane, normal, colour, area, neighbours
segments.csv|the same as a table
final.png|the map, its segments and the newest slice
map_final.png|the whole map in true colour
segments_final.png|the whole map, each segment in its own colour
run.mp4|the run as a video
trajectory.txt|the camera's path (TUM format)
mapper.lcm|everything the mapper published (scripts/replay plays it; --resume goes on with it)
segmenter.map|the segment map as kintsugi-segmenter --resume takes it
run.lcm|everything that was on the bus (scripts/replay plays it)
status.csv|every number the processes said about themselves
FILES
  printf '  %-28s %s\n' "$out/snapshot_*.png" "$(find "$out" -maxdepth 1 -name 'snapshot_*.png' | wc -l) pictures of the run"
}

# end_trio: the script's exit trap.
end_trio() {
  trio_stop TERM 10 "${!trio_pid[@]}"
  rm -f "$out"/{mapper,segmenter,viewer,logger,player}.pid
}

# check_network COMMAND...: when LCM cannot work here, says what is wrong and what cures it, and runs COMMAND on a
# private bus instead. A receive buffer that is small only costs time: what is lost is sent again.
check_network() {
  local rmem
  rmem="$(cat /proc/sys/net/core/rmem_max 2>/dev/null || echo 0)"
  if ((rmem < 2097152)); then
    say "note: the largest receive buffer is $rmem bytes; what is lost is sent again, which takes time. This cures it:"
    say "  sudo sysctl -w net.core.rmem_max=4194304"
  fi
  [[ -n "${LCM_DEFAULT_URL:-}" ]] && return
  ip route get 239.255.76.67 >/dev/null 2>&1 && return
  say "this machine has no route for multicast, so LCM cannot work on it. This cures it:"
  say "  sudo ip link set lo up && sudo ip route add 224.0.0.0/4 dev lo"
  say "until then: running in a private network"
  private_bus "$@"
}

# private_bus COMMAND...: becomes COMMAND in a network of its own; nothing to do when it is in one already.
private_bus() {
  [[ -n "${KINTSUGI_PRIVATE_BUS:-}" ]] && return
  KINTSUGI_PRIVATE_BUS=1 exec "$kintsugi_root/scripts/private_bus" "$@"
}
