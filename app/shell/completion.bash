# Completion of noonmark's command line for bash. The program itself lists its verbs, options, settings and scenes, so
# this file needs no update when they change. It is installed where bash-completion finds it; otherwise source this
# file.

# The verbs, or a verb's options, as the help lists them: "  run   Measure ...", "  -h,--help   Print ...".
_noonmark_verbs() { "$1" --help 2>/dev/null | awk '/^[A-Z]/ { on = /^Subcommands:/ } on && /^  [a-z]/ { print $1 }'; }
_noonmark_options() { "$@" --help 2>/dev/null | awk '/^  -/ { sub(/^-.,/, "", $1); print $1 }'; }

_noonmark_scenes() { "$1" scenes 2>/dev/null | awk '!NF { exit } { print $1 }'; }

# The settings, each with "=" and, if it is a choice, its choices: "map.wrap= repeat clamp_to_edge ...". The program
# lists a setting in two lines, the second with its range: "repeat | clamp_to_edge", or "1 ... 170 deg, or auto".
_noonmark_settings() {
  "$1" settings 2>/dev/null | awk '
    /^Metrics/ { exit }
    /^[a-z_]+\.[a-z_0-9]+ / { name = $1; next }
    name != "" && /^ / {
      if (/ \| /) gsub(/[ |]+/, " ")
      else $0 = / or auto$/ ? " auto" : ""
      print name "=" $0
      name = ""
    }'
}

# The files whose names end in one of these patterns, and the folders that may contain such files.
_noonmark_files() {
  local ending
  for ending in "${@:2}"; do compgen -f -X "!*.$ending" -- "$1"; done
  compgen -d -- "$1"
}

_noonmark() {
  COMPREPLY=()
  local program=${COMP_WORDS[0]/#\~/$HOME} word previous='' verb='' i
  # Bash splits --set map.wrap=re into four words; here they become two.
  local -a words=()
  for ((i = 1; i <= COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if ((${#words[@]} > 0)) && [[ $word == =* || ${words[-1]} == *= && ${COMP_WORDS[i - 1]} == *= ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
  done
  ((${#words[@]} > 0)) || return 0
  word=${words[-1]}
  ((${#words[@]} < 2)) || previous=${words[-2]}
  ((${#words[@]} < 2)) || verb=${words[0]}
  if [[ $word == --*=* ]]; then  # --set=NAME=VALUE
    previous=${word%%=*}
    word=${word#*=}
  fi

  local -a choices=() files=()
  if [[ -z $verb && $word == -* ]]; then
    mapfile -t choices < <(_noonmark_options "$program")
  elif [[ -z $verb ]]; then
    mapfile -t choices < <(_noonmark_verbs "$program")
  elif [[ $previous == --set && $word == scene.name=* ]]; then
    word=${word#*=}
    mapfile -t choices < <(_noonmark_scenes "$program")
    mapfile -t files < <(_noonmark_files "$word" '[gG][lL][tT][fF]' '[gG][lL][bB]')
  elif [[ $previous == --set && $word == *=* ]]; then
    read -ra choices < <(_noonmark_settings "$program" | awk -v name="${word%%=*}=" 'index($0, name) == 1 { sub(/^[^=]*=/, ""); print }')
    word=${word#*=}
  elif [[ $previous == --set ]]; then
    mapfile -t choices < <(_noonmark_settings "$program" | awk '{ sub(/=.*/, "="); print }')
    compopt -o nospace 2>/dev/null
  elif [[ $previous == --out && $verb == init ]]; then
    mapfile -t files < <(_noonmark_files "$word" '[tT][oO][mM][lL]')
  elif [[ $previous == --out ]]; then
    mapfile -t files < <(compgen -d -- "$word")
  elif [[ $previous == --picture ]]; then
    mapfile -t files < <(_noonmark_files "$word" '[eE][xX][rR]' '[pP][nN][gG]')
  elif [[ $previous == --baseline ]]; then
    mapfile -t files < <(_noonmark_files "$word" '[jJ][sS][oO][nN]')
  elif [[ $previous == --part || $previous == --baseline-times || $previous == --point || $previous == --threads || $previous == --acne ||
    $previous == --peter-panning || $previous == --from || $previous == --to || $previous == --rows ||
    $previous == --placements || $previous == --shard ]]; then
    :  # a name or a number that cannot be listed
  elif [[ $word == -* ]]; then
    mapfile -t choices < <(_noonmark_options "$program" "$verb")
  elif [[ $verb == run || $verb == check || $verb == render ]]; then
    mapfile -t files < <(_noonmark_files "$word" '[tT][oO][mM][lL]')
  elif [[ $verb == map ]]; then
    mapfile -t choices < <(_noonmark_scenes "$program")
    mapfile -t files < <(_noonmark_files "$word" '[gG][lL][tT][fF]' '[gG][lL][bB]')
  elif [[ $verb == init || $verb == inspect ]]; then
    mapfile -t files < <(_noonmark_files "$word" '[gG][lL][tT][fF]' '[gG][lL][bB]')
  elif [[ $verb == report || $verb == merge ]]; then
    mapfile -t files < <(compgen -d -- "$word")
  fi
  # If = separates words, bash replaces only the text after it. Otherwise the replies need the text before it too.
  if [[ $COMP_WORDBREAKS != *=* && ${words[-1]} == *=* ]]; then
    local before=${words[-1]%"$word"}
    choices=("${choices[@]/#/$before}")
    files=("${files[@]/#/$before}")
    word=$before$word
  fi
  ((${#files[@]} == 0)) || compopt -o filenames 2>/dev/null
  for i in "${choices[@]}"; do [[ $i != "$word"* ]] || COMPREPLY+=("$i"); done
  COMPREPLY+=("${files[@]}")
  return 0
}
complete -F _noonmark noonmark
