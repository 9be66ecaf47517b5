#!/usr/bin/env bash
# Tests what bash completes after a command line of noonmark. The completion function is called as bash calls it, without
# bash-completion and without a terminal.
#   completion_test.sh PROGRAM COMPLETION WORK
set -euo pipefail
program=$1 completion=$2 work=$3
rm -rf "$work"
mkdir -p "$work/sweeps" "$work/models"
cd "$work"
touch one.toml TWO.TOML notes.txt tree.glb figure.vrm shadow.exr SHADOW.PNG base.json lit.npy page.html acne.svg shot.rdc models/street.gltf models/readme.md sweeps/three.toml
printf '[[part]]\nname = "sun"\n[[part]]\nname = "spot light"\n' >sweeps/parts.toml
ln -s "$program" noonmark
# shellcheck source=/dev/null
source "$completion"
[[ $(complete -p noonmark) == 'complete -F _noonmark noonmark' ]] || { echo "nothing is registered for noonmark"; exit 1; }

bad=0 asked=0
# completed WORD...: the completions of the last word. Words are split as in bash ("--set map.wrap=re" is 4 words).
completed() {
  COMP_WORDS=(./noonmark "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _noonmark ./noonmark "${@: -1}" "${COMP_WORDS[-2]}"
  printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' '
}
# expect TEXT WORD...: the completions must be exactly those in TEXT.
expect() {
  asked=$((asked + 1))
  local wanted=$1 found
  shift
  found=$(completed "$@")
  found=${found# }
  [[ ${found% } == "$wanted" ]] && return
  printf "'%s' is completed by\n  '%s' instead of\n  '%s'\n" "$*" "${found% }" "$wanted"
  bad=1
}
# has WORD WORD...: the first word must be among the completions of the others.
has() {
  asked=$((asked + 1))
  local wanted=$1
  shift
  [[ " $(completed "$@")" == *" $wanted "* ]] && return
  printf "'%s' is completed by\n  '%s', without %s\n" "$*" "$(completed "$@")" "$wanted"
  bad=1
}

verbs=$(./noonmark --help | sed -n '/^Examples:/q;s/^  \([a-z][a-z]*\) .*/\1/p')
expect "$(sort <<<"$verbs" | tr '\n' ' ' | sed 's/ $//')" ''
has check ''
expect 'recommend' rec
expect '--help --version' -
expect '--dry-run --help --json --out --overwrite --part --print-config --quiet --set --shard --threads' run --
expect '--part --point' render --p
expect '--help' doctor -
expect '' scenes ''
expect '' run --threads ''

# TAB for every verb of the help and every option of its help: the options, then what is offered for each value. The help is
# read in another way than by the completion.
help_of() { ./noonmark "$1" --help; }
# sample KIND: what must be offered for a value of this kind; nothing for a number.
sample() {
  case $1 in
    FILE.toml) echo one.toml ;;
    FILE.gltf) echo models ;;
    FILE.glb) echo tree.glb ;;
    FILE.vrm) echo figure.vrm ;;
    FILE.exr) echo shadow.exr ;;
    FILE.png) echo SHADOW.PNG ;;
    FILE.json) echo base.json ;;
    FILE.npy) echo lit.npy ;;
    FILE.html) echo page.html ;;
    FILE.svg) echo acne.svg ;;
    FILE.rdc) echo shot.rdc ;;
    METRIC=VALUE) echo frame_acne= ;;
    METRIC) echo peter_panning ;;
    [a-z]*) echo "$1" ;;
    FOLDER) echo sweeps ;;
    SCENE) echo plate ;;
    NAME=VALUE) echo map.resolution= ;;
    PART) echo sun ;;
    VERB) echo check ;;
    INT | NUMBER | SHARE | I/N | X,Y) ;;
    *)
      echo "the completion does not know the kind $1" >&2
      return 1
      ;;
  esac
}
# offers KINDS WORD...: each of the kinds, separated by "|", must have its sample among the completions.
offers() {
  local kinds=$1 kind wanted
  shift
  for kind in ${kinds//|/ }; do
    if ! wanted=$(sample "$kind"); then
      bad=1
    elif [[ -n $wanted ]]; then
      has "$wanted" "$@"
    else
      expect '' "$@"
    fi
  done
}
for verb in $verbs; do
  expect "$(help_of "$verb" | grep -oE '^  (-.,)?--[a-z-]+' | grep -oE -- '--.*' | sort | tr '\n' ' ' | sed 's/ $//')" "$verb" --
  arguments=$(help_of "$verb" | sed -n '/^Positionals:/,/^$/s/^  [a-z]* \([^ ]*\).*/\1/p' | sort -u)
  [[ -n $arguments ]] || expect '' "$verb" ''
  for kinds in $arguments; do offers "$kinds" "$verb" ''; done
  while read -r option kinds; do
    offers "$kinds" "$verb" sweeps/parts.toml "$option" ''
  done < <(help_of "$verb" | sed -nE 's/^  (--[a-z-]+) ([^ ]+)( .*|$)/\1 \2/p')
done
expect '--help --version' -
expect 'recommend' help rec
expect "spot\\ light sun" check sweeps/parts.toml --part ''
expect '' check one.toml --part ''

# Experiments, and folders that may contain some.
expect 'TWO.TOML models one.toml sweeps' run ''
expect 'one.toml' check sweeps o
expect 'sweeps/parts.toml sweeps/three.toml' render --point 3 sweeps/
expect 'models sweeps' report ''
expect 'models sweeps' run one.toml --out ''

# Settings: their names, then their values. Bash splits words at =.
expect 'map.far_m= map.fit= map.fit_fov_deg= map.format= map.fov_deg=' run --set map.f
has scene.name= render one.toml --set ''
has filter.kind= check --set=f --set f
expect 'map.wrap=' run --set map.wrap
expect 'clamp_to_border clamp_to_edge repeat' run --set map.wrap =
expect 'clamp_to_border clamp_to_edge' run one.toml --set map.wrap = cl
expect 'false true' run --set map.snap =
expect '16 24 32f' run --set map.format =
expect 'auto' run --set view.fov_deg =
expect '' run --set bias.constant =
expect '' run --set no.such = ''
expect 'directional' run --set = light.kind = d
expect '--overwrite' run --set map.wrap = repeat --ov
has vogel run --set map.wrap = repeat --set filter.kind = v

# Scenes: the built-in ones, and files.
expect 'pillars plane plate point-room' run --set scene.name = p
expect 'tree.glb' run --set scene.name = t
expect 'models/street.gltf' run --set scene.name = models/
built_in=$(./noonmark scenes | awk 'NF == 0 { exit } { print $1 }' | wc -l)
(($(completed run --set scene.name = '' | wc -w) == built_in + 4)) || { echo "not all $built_in scenes are completed"; bad=1; }

# If bash does not split words at =, the completion replaces the whole word.
COMP_WORDBREAKS=${COMP_WORDBREAKS//=/}
expect 'map.wrap=clamp_to_border map.wrap=clamp_to_edge' run --set map.wrap=cl
expect '--set=map.wrap=repeat' run --set=map.wrap=r
expect 'scene.name=models/street.gltf' run --set scene.name=models/

((bad)) || printf '%s completions are as they should be\n' "$asked"
exit "$bad"
