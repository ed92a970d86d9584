# Sourced by faults: single processes of a run in the folder $out, without the rules of scripts/trio. Each writes its log to
# $out/NAME.log.

declare -A process_pid=() # name -> process id

# process_start NAME COMMAND...: in the background; the process ends with the script should that be killed.
process_start() {
  local name="$1"
  shift
  setpriv --pdeathsig KILL setsid "$@" >>"$out/$name.log" 2>&1 &
  process_pid[$name]=$!
}

process_alive() { [[ -n "${process_pid[$1]:-}" ]] && kill -0 "${process_pid[$1]}" 2>/dev/null; }

# process_stop SECONDS NAME: sends SIGTERM and waits; kills what does not end in time, and fails then.
process_stop() {
  local seconds="$1" name="$2" deadline
  process_alive "$name" || return 0
  kill -TERM "${process_pid[$name]}" 2>/dev/null || true
  deadline=$((SECONDS + seconds))
  while process_alive "$name" && ((SECONDS < deadline)); do sleep 0.1; done
  process_alive "$name" || return 0
  say "$name did not stop within $seconds s; killing it"
  kill -KILL "${process_pid[$name]}" 2>/dev/null || true
  return 1
}

# process_wait NAME: until it has ended; fails with its exit code.
process_wait() { wait "${process_pid[$1]}" 2>/dev/null; }
