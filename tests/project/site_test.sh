#!/usr/bin/env bash
# Builds the documentation as a site (scripts/docs), and checks that a page fetches nothing from the network and that the
# search answers in a page that is opened as a file. Exit code 77: there is no mkdocs here.
#   site_test.sh SOURCE WORK
set -euo pipefail
source=$1 work=$2
if ! command -v mkdocs >/dev/null; then
  echo 'SKIPPED: mkdocs is not installed (scripts/docs installs it)'
  exit 77
fi
bad=0
complain() { printf 'FAILED: %s\n' "$*"; bad=1; }

rm -rf "$work"
NOONMARK_SETUP=skip "$source/scripts/docs" "$work"

# What a browser fetches for a page by itself: scripts, pictures, style sheets and what these name. A link to click is none.
fetched=$(grep -rnoE --include='*.html' '<(script|img|iframe|source|embed)[^>]* src="(https?:)?//[^"]*"|<link[^>]* href="(https?:)?//[^"]*"' "$work" |
  grep -v 'rel="canonical"' || true)
[[ -z $fetched ]] || complain "pages fetch from the network: $(head -n 3 <<<"$fetched")"
fetched=$(grep -rnoE --include='*.css' "(url\(|@import )[\"' ]*(https?:)?//[^)\"']*" "$work" || true)
[[ -z $fetched ]] || complain "style sheets fetch from the network: $(head -n 3 <<<"$fetched")"

pages=$(find "$work/docs" -name "*.html" ! -name "live-cube-room.html" | wc -l)  # but for the live page, which the program writes
((pages == $(find "$source/docs" -name '*.md' | wc -l))) || complain "the site has $pages pages of docs/"
while read -r picture; do
  [[ -s $work/${picture#"$source"/} ]] || complain "the site lacks $picture"
done < <(find "$source/docs" -name '*.png')

chromium=$(command -v chromium || command -v chromium-browser || true)
if [[ -n $chromium ]]; then
  profile=$(mktemp -d)
  found=$("$chromium" --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking --disable-component-update \
    --disable-sync --user-data-dir="$profile" --virtual-time-budget=10000 --dump-dom "file://$work/search.html?q=placement" 2>/dev/null |
    grep -o '<article>' | wc -l || true)
  rm -rf "$profile"
  ((found >= 3)) || complain "the search for 'placement' in a page that is opened as a file finds $found pages"
fi
((bad)) || printf '%s pages\n' "$pages"
exit "$bad"
