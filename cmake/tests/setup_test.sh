#!/usr/bin/env bash
# setup_test.sh <source folder>: runs cmake/setup with made-up package managers. It installs every package or fails, on any
# slow machine.
set -uo pipefail
setup="$1/cmake/setup"
source "$1/cmake/tests/expect.sh"
export CALLS="$folder/calls" INSTALLED="$folder/installed" FLINT=2.9.0-5 LACKS=none

# Made-up programs. $INSTALLED lists the installed packages, $CALLS the calls of apt-get.
mkdir "$folder/debian"
cat > "$folder/debian/dpkg-query" <<'FAKE'
#!/usr/bin/env bash
grep --line-regexp --fixed-strings "${!#}" "$INSTALLED" >/dev/null || exit 1
case "$*" in
  *Version*) echo "$FLINT" ;;
  *) printf 'installed ' ;;
esac
FAKE
cat > "$folder/debian/dpkg" <<'FAKE'
#!/usr/bin/env bash
[[ "$1 $3" == "--compare-versions lt" ]] || exit 2
((${2%%.*} < $4))
FAKE
# Prints the important lines first, and many more after them: a reader that stops early breaks the pipe.
cat > "$folder/debian/apt-cache" <<'FAKE'
#!/usr/bin/env bash
printf '%s:\n  Installed: (none)\n  Candidate: 1.0\n' "${!#}"
for ((line = 0; line < 20000; ++line)); do echo "     1.0 500 http://deb.debian.org/debian" || exit 1; done
FAKE
cat > "$folder/debian/apt-get" <<'FAKE'
#!/usr/bin/env bash
echo "$*" >> "$CALLS"
[[ " $* " == *" install "* ]] || exit 0
for word in "$@"; do
  [[ "$word" == "$LACKS" ]] && { echo "E: Unable to locate package $word" >&2; exit 100; }
done
[[ "$LACKS" == all_in_silence ]] || printf '%s\n' "$@" >> "$INSTALLED"
FAKE
printf '#!/usr/bin/env bash\nexec "$@"\n' > "$folder/debian/sudo"
chmod +x "$folder"/debian/*

# A machine without apt-get: the few programs that setup itself needs.
mkdir "$folder/elsewhere"
for program in bash dirname grep env; do ln -s "$(command -v $program)" "$folder/elsewhere/"; done

bare() {
  : > "$INSTALLED"
  : > "$CALLS"
}
run_setup() {  # [NAME=value...]: sets exit_code
  env PATH="$folder/debian:$PATH" "$@" "$setup" > "$folder/output" 2>&1
  exit_code=$?
}
exits_with() { [[ "$exit_code" == "$1" ]]; }
installed() { grep --line-regexp --fixed-strings "$1" "$INSTALLED" >/dev/null; }
not_asked_for() { [[ " $(cat "$CALLS") " != *" $1"* ]]; }
nothing_asked_for() { [[ ! -s "$CALLS" ]]; }

bare
run_setup
expect "a bare machine with FLINT 2 is set up" exits_with 0
for package in g++ libgsl-dev python3-h5py libflint-dev libflint-arb-dev valgrind; do
  expect "$package is installed" installed "$package"
done
: > "$CALLS"
run_setup
expect "a second run succeeds" exits_with 0
expect "a second run asks for nothing" nothing_asked_for

bare
run_setup FLINT=3.1.3-1
expect "a bare machine with FLINT 3 is set up" exits_with 0
expect "libflint-dev is installed" installed libflint-dev
expect "Arb, a part of FLINT 3, is not asked for" not_asked_for libflint-arb-dev

for package in libflint-dev libflint-arb-dev valgrind libgsl-dev; do
  bare
  run_setup LACKS="$package"
  expect "setup fails where $package cannot be installed" exits_with 2
  expect "setup names $package" says "could not install"
done

bare
run_setup LACKS=all_in_silence
expect "setup fails where nothing came of a success" exits_with 2

bare
run_setup SLIPSTICK_SKIP_SETUP=1
expect "setup can be skipped" exits_with 0
expect "skipped setup asks for nothing" nothing_asked_for

bare
run_setup PATH="$folder/elsewhere"
expect "setup stops where there is no apt-get" exits_with 2
for words in libgsl-dev libflint-arb-dev SLIPSTICK_SKIP_SETUP=1; do
  expect "setup says $words there" says "$words"
done

# A reader that stops early breaks the pipe of the writer, and pipefail then reports a failure.
: > "$CALLS"
grep --line-number --extended-regexp '\| *grep.* (-[a-zA-Z]*q|--quiet|--silent)' "$setup" "$1/.ci/run" > "$folder/output"
expect "no pipe ends in a grep that leaves early" test ! -s "$folder/output"

conclude
