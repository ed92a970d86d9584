# Bash completion: the options as --help of the program itself says, of all subcommands where it has some, and files.
_kintsugi() {
  local word="${COMP_WORDS[COMP_CWORD]}"
  [[ "$word" == -* ]] || return 0
  mapfile -t COMPREPLY < <(compgen -W "$({ "${COMP_WORDS[0]}" --help-all || "${COMP_WORDS[0]}" --help; } 2>/dev/null | grep -oE -e '--[a-z][a-z0-9-]*' | sort -u)" -- "$word")
}
complete -o default -F _kintsugi @PROGRAMS@
