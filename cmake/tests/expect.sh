# For the tests of the front door: what they expect, counted and reported. Sets folder, which is removed at the end;
# programs write to $folder/output, and those made up note their calls in $folder/calls.
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
