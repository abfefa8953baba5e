#!/usr/bin/env bash
# reference_test.sh <program> <docs> <python>: the committed generated pages are the same as those from this program, and the
# completion works.
set -uo pipefail
program="$1" docs="$2" python="$3"
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
: > "$folder/calls"
made="$folder/made"

"$python" -B "$docs/generator/reference.py" "$program" "$made" > "$folder/output" 2>&1
expect "all pages are made" test "$(cd "$made" && echo *)" = \
  "commands.md gate.md hard.md program.md scene.md slipstick.1 slipstick.bash study.md"
for page in "$made"/*; do
  diff "$docs/reference/${page##*/}" "$page" > "$folder/output" 2>&1
  expect "${page##*/} is current (else: make reference)" test $? = 0
done

source "$made/slipstick.bash"
complete_after() {  # <words, of which the last is to be completed>
  COMP_WORDS=(slipstick "$@")
  COMP_CWORD=$#
  _slipstick 2> /dev/null
  echo "${COMPREPLY[*]}" > "$folder/output"
}
offers() {  # <word> <words, of which the last is to be completed>
  complete_after "${@:2}"
  [[ " $(cat "$folder/output") " == *" $1 "* ]]
}
for option in --set --accuracy --accuracy-of --plan --fields --figure --model --memory-limit --json --quiet; do
  expect "solve --<TAB> offers $option" offers "$option" solve --
done
expect "no option that --help hides is offered" not offers --keep solve --
expect "no command that --help hides is offered" not offers reference ""
expect "an option is known in each command" not offers --twist solve --
complete_after s
expect "the first word is a command" says "solve study"
complete_after solve --accuracy-of ""
expect "an option's words are offered" says "twist traction stick_radius"
complete_after solve scene.toml --set load.mom
expect "after --set the keys of a scene are offered" says "load.moment_ratio= load.moment="
complete_after solve --json ""
expect "elsewhere bash completes files" test -z "$(tr -d '[:space:]' < "$folder/output")"

conclude
