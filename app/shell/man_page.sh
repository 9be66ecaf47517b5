#!/usr/bin/env bash
# Makes the man page from the program's own help (verbs, arguments, options, exit codes) and a template. The template
# names the places: @VERSION@ within a line; @VERBS@ and @EXIT_STATUS@ on lines of their own.
#   man_page.sh PROGRAM TEMPLATE OUT
set -euo pipefail
program=$1 template=$2 out=$3
export LC_ALL=C

# A function for all awk programs below: escapes text for roff, where -, \ and a leading . or ' have a meaning.
# shellcheck disable=SC2016  # awk's dollars
roff='
  function roff(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    return text ~ /^[.\x27]/ ? "\\&" text : text
  }'

verbs() { "$program" --help | awk '/^Examples:/ { exit } /^  [a-z]/ { print $1 }'; }

# A verb: its synopsis, its description, then its arguments and options as the help lists them:
#   "  --name VALUE     description". The description is in the next line if the name is long.
# shellcheck disable=SC2016
verb_section() {
  "$program" "$1" --help | awk -v verb="$1" "$roff"'
    function flush() {
      if (name != "") printf ".TP\n.B %s\n%s\n", roff(name), roff(meaning)
      name = ""
    }
    NR == 1 { says = $0 }
    /^Usage: / {
      sub(/^.* \[OPTIONS\]/, "[OPTIONS]")
      printf ".SS noonmark %s %s\n%s.\n", verb, roff($0), roff(says)
    }
    /^(Positionals|Options):/ { listed = 1; next }
    /^[^ ]/ { listed = 0 }
    listed && /^  [^ ]/ {
      flush()
      line = substr($0, 3)
      at = match(line, /   */)
      name = at ? substr(line, 1, at - 1) : line
      meaning = at ? substr(line, at + RLENGTH) : ""
      if (name == "-h,--help") name = ""  # the template says that each verb has it
      sub(/ REQUIRED$/, "", name)
      next
    }
    listed && /^   / { sub(/^ +/, ""); meaning = meaning (meaning == "" ? "" : " ") $0 }
    END { flush() }'
}

# "Exit codes say ...": a paragraph, then one for each code: "  1  the shadows: ...", which may go on in a line further in.
# shellcheck disable=SC2016
exit_status() {
  "$program" --help | awk "$roff"'
    /^Exit codes / { listed = 1; print roff($0); next }
    !listed { next }
    /^  [0-9]  / { printf ".TP\n.B %s\n", $1; sub(/^  [0-9]  /, "") }
    NF { sub(/^ +/, ""); print roff($0) }'
}

version=$("$program" --version)
: >"$out.new"
while IFS= read -r line; do
  case $line in
    @VERBS@) for verb in $(verbs); do verb_section "$verb"; done ;;
    @EXIT_STATUS@) exit_status ;;
    *) printf '%s\n' "${line//@VERSION@/${version%% *}}" ;;
  esac
done <"$template" >>"$out.new"
mv "$out.new" "$out"
