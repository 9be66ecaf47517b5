#!/usr/bin/env bash
# groff has nothing to say about the man page; 77 where there is no groff (Debian's groff-base).
#   man_page_warnings.sh PAGE
set -euo pipefail
if ! command -v groff >/dev/null; then
  echo 'skipped: there is no groff here (apt install groff-base)'
  exit 77
fi
said=$(groff -man -Tutf8 -ww -z "$1" 2>&1)
[[ -z $said ]] || { printf '%s\n' "$said"; exit 1; }
