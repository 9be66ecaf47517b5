# shellcheck shell=bash
# What setup, demo and test share: sourced, not run. Sets root and jobs, changes into root.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$root"
jobs=${NOONMARK_JOBS:-$(nproc)}
preset=${NOONMARK_PRESET:-release}
build_dir=$root/build/$preset

say() { printf '== %s\n' "$*"; }
die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

[[ $jobs =~ ^[1-9][0-9]*$ ]] || die "NOONMARK_JOBS is '$jobs'; give a number of parallel jobs, 1 or more"

# ccache and Mesa keep caches under the home folder; where there is none to write to, they go into the build folder.
use_writable_cache() {
  local cache=${XDG_CACHE_HOME:-${HOME:+$HOME/.cache}}
  if [[ -z $cache ]] || ! mkdir -p "$cache" 2>/dev/null || [[ ! -w $cache ]]; then
    export XDG_CACHE_HOME=$root/build/.cache
    export CCACHE_DIR=${CCACHE_DIR:-$XDG_CACHE_HOME/ccache}
    export HOME=${HOME:-$XDG_CACHE_HOME}  # ccache refuses to start for a user of whom neither HOME nor passwd knows a home
    mkdir -p "$XDG_CACHE_HOME"
  fi
}

# build [TARGET...]: configures with the preset and builds; everything without a target. demo and test share the folder,
# so that nothing is compiled twice.
build() {
  use_writable_cache
  say "configuring with the preset '$preset' into ${build_dir#"$root"/}"
  cmake --preset "$preset" </dev/null
  say "building with $jobs jobs"
  cmake --build "$build_dir" --parallel "$jobs" ${1:+--target "$@"} </dev/null
}
