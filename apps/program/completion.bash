# bash completion for viewgain: subcommands, flags and their values as --help names them
_viewgain() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} offered help
  [ "$word" != = ] || word=
  if [ "$before" = = ] && [ "$COMP_CWORD" -gt 2 ]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
  if [ "$COMP_CWORD" -eq 1 ]; then
    offered="$(viewgain --help | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p') --help --version"
  else
    # A list of values may go on in the next line.
    help=$({ viewgain "${COMP_WORDS[1]}" --help; viewgain --help; } 2>/dev/null | sed ':a;N;$!ba;s/,\n */,/g')
    if [[ $word == -* ]]; then
      offered=$(sed -nE 's/^  (--[a-z-]+).*/\1/p' <<<"$help")
    else
      offered=$(sed -nE "s/^  $before [A-Z]+:\{([^}]*)\}.*/\1/p" <<<"$help" | tr , ' ')
    fi
  fi
  COMPREPLY=($(compgen -W "$offered" -- "$word"))
}
complete -o default -F _viewgain viewgain
