# Completion of noonmark's command line for bash. Everything that is offered comes from the program: verbs, their options and
# the kinds of their values from its help (app/verbs/option_values.h has the words for the kinds), settings, metrics, scenes and
# parts from its lists. It is installed where bash-completion finds it; otherwise source this file.

# These read a help on standard input. The verbs: "  run   Measure ...".
_noonmark_verbs() { awk '/^Examples:/ { exit } /^  [a-z]/ { print $1 }'; }
# The options: "  -h,--help   Print ...".
_noonmark_options() { awk '/^  -/ { sub(/^-.,/, "", $1); print $1 }'; }
# The kinds of the values of an option, or of the arguments without one: "  --out FOLDER   Folder ..." has FOLDER.
_noonmark_kinds() {
  awk -v option="$1" '
    /^[A-Z]/ { listed = option == "" ? /^Positionals:/ : /^Options:/ }
    listed && /^  [^ ]/ {
      text = substr($0, 3)
      sub(/  .*/, "", text)
      split(text, words, " ")
      if (option != "" && words[1] != option) next
      gsub(/[|]/, "\n", words[2])
      print words[2]
    }'
}

# These start the program.
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

# The metrics, each with "=".
_noonmark_metrics() {
  "$1" settings 2>/dev/null | awk '/^Metrics/ { on = 1; next } on && /^[a-z][a-z_0-9]* / { print $1 "=" }'
}

# The parts of the experiments among these words, as bash must read them.
_noonmark_parts() {
  local file name
  for file in "${@:2}"; do
    [[ $file == *.[tT][oO][mM][lL] && -f $file ]] || continue
    "$1" run "$file" --print-config 2>/dev/null |
      awk '/^\[/ { part = /^\[\[part\]\]/ } part && /^name = "[^\\]*"$/ { print substr($0, 9, length($0) - 9) }' |
      while IFS= read -r name; do printf '%q\n' "$name"; done
  done
}

# The files whose names end in one of these, in capitals too, and the folders that may contain such files.
_noonmark_files() {
  local ending letter pattern i
  for ending in "${@:2}"; do
    pattern=''
    for ((i = 0; i < ${#ending}; ++i)); do
      letter=${ending:i:1}
      pattern+="[$letter${letter^}]"
    done
    compgen -f -X "!*.$pattern" -- "$1"
  done
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

  local -a choices=() files=() kinds=() endings=()
  local help kind
  if [[ -z $verb ]]; then
    help=$("$program" --help 2>/dev/null)
    if [[ $word == -* ]]; then
      mapfile -t choices < <(_noonmark_options <<<"$help")
    else
      mapfile -t choices < <(_noonmark_verbs <<<"$help")
    fi
  else
    help=$("$program" "$verb" --help 2>/dev/null)
    [[ $previous != --* ]] || mapfile -t kinds < <(_noonmark_kinds "$previous" <<<"$help")
    if [[ -n ${kinds[*]} ]]; then
      :  # a value of an option; a flag has none
    elif [[ $word == -* ]]; then
      mapfile -t choices < <(_noonmark_options <<<"$help")
    else
      mapfile -t kinds < <(_noonmark_kinds '' <<<"$help")
    fi
  fi
  if [[ ${kinds[0]-} == NAME=VALUE ]]; then
    if [[ $word == scene.name=* ]]; then
      kinds=(SCENE FILE.gltf FILE.glb FILE.vrm)
      word=${word#*=}
    elif [[ $word == *=* ]]; then
      read -ra choices < <(_noonmark_settings "$program" | awk -v name="${word%%=*}=" 'index($0, name) == 1 { sub(/^[^=]*=/, ""); print }')
      word=${word#*=}
    else
      mapfile -t choices < <(_noonmark_settings "$program" | awk '{ sub(/=.*/, "="); print }')
      compopt -o nospace 2>/dev/null
    fi
  fi
  for kind in "${kinds[@]}"; do
    case $kind in
      METRIC=VALUE)
        mapfile -t choices < <(_noonmark_metrics "$program")
        compopt -o nospace 2>/dev/null
        ;;
      METRIC) mapfile -t choices < <(_noonmark_metrics "$program" | sed 's/=$//') ;;
      FILE.*) endings+=("${kind#FILE.}") ;;
      FOLDER) mapfile -t files < <(compgen -d -- "$word") ;;
      SCENE) mapfile -t choices < <(_noonmark_scenes "$program") ;;
      PART) mapfile -t choices < <(_noonmark_parts "$program" "${words[@]}") ;;
      VERB) mapfile -t choices < <("$program" --help 2>/dev/null | _noonmark_verbs) ;;
      [a-z]*) choices+=("$kind") ;;
    esac
  done
  ((${#endings[@]} == 0)) || mapfile -t files < <(_noonmark_files "$word" "${endings[@]}")
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
