#!/usr/bin/env bash
# exports_test.sh NM LIBRARY HEADER: the library shows what the header declares, at most 30 functions, and no symbol more.
set -euo pipefail
declared="$(grep -oE '\bslipstick_[a-z_]+\(' "$3" | tr -d '(' | sort -u)"
shown="$("$1" -D --defined-only "$2" | awk '$2 != "A" { sub("@.*", "", $3); print $3 }' | sort -u)"
if [ "$declared" != "$shown" ]; then
  echo "the header declares (<) and the library shows (>):"
  diff <(echo "$declared") <(echo "$shown")
  exit 1
fi
count="$(wc -l <<< "$declared")"
echo "$count functions"
[ "$count" -ge 10 ] && [ "$count" -le 30 ]
for language in "c -std=c99" "c++ -std=c++11"; do
  cc -x $language -Wall -Wextra -Wpedantic -Werror -fsyntax-only "$3"
done
