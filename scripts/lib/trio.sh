# Sourced by trio, replay and demo: starting, watching and stopping the processes of one run.
# Every function works on the run in $out; each process writes its log to $out/NAME.log.

kintsugi_root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
KINTSUGI_BIN="${KINTSUGI_BIN:-$kintsugi_root/build/release/bin}"
declare -A trio_pid=()      # name -> process id
declare -A trio_command=()  # name -> command line, quoted
declare -A trio_restarts=() # name -> how often it was restarted
declare -A trio_cpu_s=()    # name -> CPU time, s, when last looked at (not of those it replaced)
stop_requested=0            # set by the script's trap

say() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; }

# value OPTION VALUE: the value of a command-line option, which must be there.
value() { (($# > 1)) && printf '%s' "$2" || { say "$1 needs a value"; exit 2; }; }

check_programs() {
  [[ -x "$KINTSUGI_BIN/kintsugi-mapper" ]] && return
  say "no programs in $KINTSUGI_BIN; run scripts/build first"
  exit 1
}

# trio_start NAME COMMAND...: in the background. The process gets a session of its own, so that Ctrl-C reaches only
# the script, and is ended with the script should that be killed.
trio_start() {
  local name="$1"
  shift
  trio_command[$name]="$(printf '%q ' "$@")"
  setpriv --pdeathsig TERM setsid "$@" >>"$out/$name.log" 2>&1 &
  trio_pid[$name]=$!
}

trio_alive() { [[ -n "${trio_pid[$1]:-}" ]] && kill -0 "${trio_pid[$1]}" 2>/dev/null; }

# trio_note_cpu NAME...: looks at the CPU time of those that run.
trio_note_cpu() {
  local name line
  for name in "$@"; do
    line="$(cat "/proc/${trio_pid[$name]}/stat" 2>/dev/null)" || continue
    trio_cpu_s[$name]="$(awk -v hz="$(getconf CLK_TCK)" '{ printf "%.2f", ($12 + $13) / hz }' <<<"${line##*) }")"
  done
}

# trio_stop SIGNAL SECONDS NAME...: asks the named processes to stop and waits; kills what does not.
trio_stop() {
  local signal="$1" seconds="$2" name deadline
  shift 2
  for name in "$@"; do
    trio_alive "$name" && kill -s "$signal" "${trio_pid[$name]}" 2>/dev/null
  done
  deadline=$((SECONDS + seconds))
  for name in "$@"; do
    while trio_alive "$name" && ((SECONDS < deadline)); do sleep 0.1; done
    trio_alive "$name" || continue
    say "$name did not stop within $seconds s; killing it"
    kill -KILL "${trio_pid[$name]}" 2>/dev/null || true
  done
}

# last_words NAME: the end of its log, for a person who asks why.
last_words() { tail -n 5 "$out/$1.log" 2>/dev/null | sed "s/^/  $1: /" >&2; }

# trio_wait_ready NAME...: until each has been heard on the bus; a stream has no resends yet, so whoever starts
# before its receivers loses its first slices.
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
  trio_start logger lcm-logger -q -f ${LCM_DEFAULT_URL:+--lcm-url="$LCM_DEFAULT_URL"} "$1.partial"
}
trio_end_record() {
  trio_stop INT 10 logger
  mv "$1.partial" "$1"
}

# trio_watch NAME...: shows the progress until every named process has ended. One that a signal killed is started
# again, three times at most; an error that one reports itself ends the run. When the first named has ended and
# nothing moves for 60 s, the others are told to write what they have.
trio_watch() {
  local name code leader="$1" failed=0 leader_stopped=0
  local -A ended=()
  setsid "$KINTSUGI_BIN/kintsugi-status" --until-finished --viewer --timeout 60 &
  trio_pid[progress]=$!
  while ((${#ended[@]} < $#)); do
    sleep 0.2 || true
    trio_note_cpu "$@"
    for name in "$@"; do
      [[ -n "${ended[$name]:-}" ]] || trio_alive "$name" && continue
      code=0
      wait "${trio_pid[$name]}" 2>/dev/null || code=$?
      trio_restart "$name" "$code" && continue
      ended[$name]=1
      ((code == 0)) && continue
      say "$name ended with an error (exit code $code):"
      last_words "$name"
      failed=1 stop_requested=1
    done
    if ((stop_requested && !leader_stopped)); then
      leader_stopped=1
      say "stopping; what the map holds is published, segmented, drawn and written"
      trio_alive "$leader" && kill -s INT "${trio_pid[$leader]}"
    fi
    if ! trio_alive "$leader" && ! trio_alive progress; then
      trio_stop TERM 60 "$@"
    fi
  done
  trio_stop TERM 2 progress
  return "$failed"
}

# trio_restart NAME CODE: starts a process again that a signal killed; fails when it is not to be started again.
trio_restart() {
  local name="$1" code="$2"
  ((code > 128 && !stop_requested && ${trio_restarts[$name]:-0} < 3)) || return 1
  trio_restarts[$name]=$((${trio_restarts[$name]:-0} + 1))
  say "$name was killed (signal $((code - 128))); starting it again"
  eval "trio_start $name ${trio_command[$name]}"
}

# trio_summary: what the run took and wrote.
trio_summary() {
  local file name cpu=""
  for name in mapper segmenter viewer; do
    [[ -n "${trio_cpu_s[$name]:-}" ]] && cpu+="${cpu:+,} $name ${trio_cpu_s[$name]} s"
  done
  printf '  CPU:%s\n' "$cpu"
  say "written:"
  while IFS='|' read -r file what; do
    [[ -e "$out/$file" ]] && printf '  %-28s %s\n' "$out/$file" "$what"
  done <<'FILES'
segments.ply|the map: x y z, normal, colour, segment_id, slice_id, weight
segments.json|every segment: points, box, centroid, normal, colour, area
final.png|the map, its segments and the newest slice
map_final.png|the whole map in true colour
segments_final.png|the whole map, each segment in its own colour
run.mp4|the run as a video
trajectory.txt|the camera's path (TUM format)
run.lcm|everything that was on the bus (scripts/replay plays it)
FILES
  printf '  %-28s %s\n' "$out/snapshot_*.png" "$(find "$out" -name 'snapshot_*.png' | wc -l) pictures of the run"
}

# check_network COMMAND...: when LCM cannot work here, says what is wrong and what cures it, and runs COMMAND on a
# private bus instead. A receive buffer that is merely small loses nothing at the paced rate: it is only said.
check_network() {
  local rmem
  rmem="$(cat /proc/sys/net/core/rmem_max 2>/dev/null || echo 0)"
  if ((rmem < 2097152)); then
    say "note: the largest receive buffer is $rmem bytes; bursts may be lost. This cures it:"
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
