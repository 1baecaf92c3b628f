# Completion of shroudhb for bash. Commands and options come from the program's own --help.
_shroudhb() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} program=${COMP_WORDS[0]}
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ] && [[ $word != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("$program" --help 2>/dev/null |
      sed -n 's/^  \([a-z]\{2,\}\) .*/\1/p')" -- "$word")
    return
  fi
  if [[ $word == -* ]]; then
    [ "$COMP_CWORD" -gt 1 ] || command=
    mapfile -t COMPREPLY < <(compgen -W "$("$program" ${command:+"$command"} --help 2>/dev/null |
      grep -oE -e '--[a-z][a-z-]+' | sort -u)" -- "$word")
    return
  fi
  local ending='@(yaml|yml)'
  [[ $command != inspect && $command != field ]] || ending='h5'
  local extglob_was
  extglob_was=$(shopt -p extglob)
  shopt -s extglob
  mapfile -t COMPREPLY < <(compgen -f -X "!*.$ending" -- "$word"
    compgen -d -S / -- "$word")
  eval "$extglob_was"
  compopt -o nospace 2>/dev/null
  [ "${#COMPREPLY[@]}" -ne 1 ] || [[ ${COMPREPLY[0]} == */ ]] || compopt +o nospace 2>/dev/null
}
complete -F _shroudhb shroudhb
