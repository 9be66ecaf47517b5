#!/usr/bin/env bash
# Compares the man page with the program: it must contain every verb, every option of each verb in that verb's section, and
# every exit code that the help and docs/reference/exit-codes.md name. The help is parsed in another way than in
# app/shell/man_page.sh. docs/reference/command-line.md must list the verbs.
#   man_page_test.sh PROGRAM PAGE REFERENCE
set -euo pipefail
program=$1 page=$2 reference=$3
export LC_ALL=C
bad=0
complain() { printf '%s\n' "$*"; bad=1; }

plain=$(sed 's/\\-/-/g' "$page")  # roff's \- is -
section() { awk -v head=".SS noonmark $1 " '/^\.S[SH] / { on = index($0, head) == 1 } on' <<<"$plain"; }
words() { grep -oE -- '(^|[ ,])--[a-z][a-z-]*' | grep -oE -- '--.*' | sort -u; }

verbs=$("$program" --help | sed -n '/^Examples:/q;s/^  \([a-z][a-z]*\) .*/\1/p')
(($(wc -w <<<"$verbs") >= 7)) || complain "the help lists no verbs: '$verbs'"
for option in $("$program" --help | words); do
  grep -q -- "$option" <<<"$plain" || complain "the page lacks $option"
done
options=0
for verb in $verbs; do
  text=$(section "$verb")
  [[ -n $text ]] || complain "the page has no section of the verb $verb"
  help=$("$program" "$verb" --help)
  says=${help%%$'\n'*}
  grep -qF -- "$says" <<<"$text" || complain "the page does not describe $verb as '$says'"
  for option in $(sed -n '/^Options:/,/^$/p' <<<"$help" | words); do
    [[ $option == --help ]] && continue
    options=$((options + 1))
    grep -qE "^\.B $option( [A-Za-z0-9_=/.|,]+)?$" <<<"$text" || complain "the page's section of $verb lacks $option"
  done
  while read -r option; do
    grep -q -- "  $option" <<<"$help" || complain "the page gives $verb an option $option that it does not have"
  done < <(sed -n 's/^\.B \(--[a-z-]*\).*/\1/p' <<<"$text")
done
((options >= 15)) || complain "only $options options were compared"

# shellcheck disable=SC2016  # the back quotes of Markdown
listed=$(sed -n '/^| verb |/,/^$/s/^| `\([a-z]*\)[ `].*/\1/p' "$reference/command-line.md" | sort)
[[ $listed == "$(sort <<<"$verbs")" ]] || complain "command-line.md lists the verbs '${listed//$'\n'/ }', the help '${verbs//$'\n'/ }'"

codes() { sort | tr '\n' ' '; }
in_page=$(sed -n '/^\.SH EXIT STATUS/,/^\.SH FILES/s/^\.B \([0-9]\)$/\1/p' <<<"$plain" | codes)
in_help=$("$program" --help | sed -n '/^Exit codes /,$s/^  \([0-9]\)  .*/\1/p' | codes)
in_reference=$(sed -n '/^| exit code |/,/^$/s/^| \([0-9]\) |.*/\1/p' "$reference/exit-codes.md" | codes)
[[ $in_page == "$in_help" && $in_page == "$in_reference" && $in_page == '0 1 2 3 4 5 6 ' ]] ||
  complain "exit codes: '$in_page' in the page, '$in_help' in the help, '$in_reference' in exit-codes.md"
grep -qF "Noonmark $("$program" --version | cut -d' ' -f1)" "$page" || complain "the page is of another version"
((bad)) || printf '%s verbs and %s options stand in the man page\n' "$(wc -w <<<"$verbs")" "$options"
exit "$bad"
