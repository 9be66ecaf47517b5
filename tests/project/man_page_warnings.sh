#!/usr/bin/env bash
# groff must print no warning about the man page. Ends with 77 if there is no groff (Debian's groff-base).
#   man_page_warnings.sh PAGE
set -euo pipefail
if ! command -v groff >/dev/null; then
  echo 'skipped: there is no groff here (apt install groff-base)'
  exit 77
fi
said=$(groff -man -Tutf8 -ww -z "$1" 2>&1)
[[ -z $said ]] || { printf '%s\n' "$said"; exit 1; }
