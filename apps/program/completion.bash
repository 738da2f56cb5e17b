# bash completion for viewgain: subcommands, flags and their values as --help names them
_viewgain() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} offered help
  [ "$word" != = ] || word=
  if [ "$before" = = ] && [ "$COMP_CWORD" -gt 2 ]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
  local subcommand= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ ${COMP_WORDS[i]} != -* && ${COMP_WORDS[i - 1]} != --@(threads|trace|config|save-config) ]]; then
      subcommand=${COMP_WORDS[i]}
      break
    fi
  done
  if [ -z "$subcommand" ]; then
    offered="$(viewgain --help | sed -nE 's/^  ([a-z]+)  .*/\1/p; s/^  (--[a-z-]+).*/\1/p')"
  else
    # A list of values may go on in the next line.
    help=$({ viewgain "$subcommand" --help; viewgain --help; } 2>/dev/null | sed ':a;N;$!ba;s/,\n */,/g')
    if [[ $word == -* ]]; then
      offered=$(sed -nE 's/^  (--[a-z-]+).*/\1/p' <<<"$help")
    else
      offered=$(sed -nE "s/^  $before [A-Z]+:\{([^}]*)\}.*/\1/p" <<<"$help" | tr , ' ')
    fi
  fi
  COMPREPLY=($(compgen -W "$offered" -- "$word"))
}
complete -o default -F _viewgain viewgain
