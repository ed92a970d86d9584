# Sourced by the scripts: where things are, messages, values of options.

kintsugi_root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
KINTSUGI_BIN="${KINTSUGI_BIN:-$kintsugi_root/build/release/bin}"

say() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; }

# value OPTION VALUE: the value of a command-line option, which must be there.
value() { (($# > 1)) && printf '%s' "$2" || { say "$1 needs a value"; exit 2; }; }

check_programs() {
  [[ -x "$KINTSUGI_BIN/kintsugi-mapper" ]] && return
  say "there are no programs in $KINTSUGI_BIN; run scripts/build first"
  exit 1
}
