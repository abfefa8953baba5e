# Tests of the front door source this file: it counts and reports expectations. It sets `folder`, which is removed at the end.
# Programs write to $folder/output; made-up programs note their calls in $folder/calls.
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
failures=0

expect() {  # <what> <command...>
  local what="$1"
  shift
  if ! "$@"; then
    echo "FAILED: $what"
    sed 's/^/    /' "$folder/output" "$folder/calls"
    failures=$((failures + 1))
  fi
}
says() { [[ "$(cat "$folder/output")" == *"$1"* ]]; }
not() { ! "$@"; }

conclude() {
  ((failures == 0)) && echo "all as expected"
  exit $((failures > 0))
}
