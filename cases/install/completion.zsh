#compdef shroudhb
# Completion of shroudhb for zsh. Commands and options come from the program's own --help.
_shroudhb() {
  local program=$words[1] command=$words[2]
  local -a found
  if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then
    found=(${(f)"$($program --help 2>/dev/null | sed -n 's/^  \([a-z]\{2,\}\) .*/\1/p')"})
    compadd -a found
    return
  fi
  if [[ $words[CURRENT] == -* ]]; then
    (( CURRENT > 2 )) || command=
    found=(${(f)"$($program $command --help 2>/dev/null | grep -oE -e '--[a-z][a-z-]+' | sort -u)"})
    compadd -a found
    return
  fi
  if [[ $command == inspect || $command == field ]]; then
    _files -g '*.h5'
  else
    _files -g '*.(yaml|yml)'
  fi
}
_shroudhb "$@"
