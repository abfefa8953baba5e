#!/usr/bin/env bash
# against_test.sh <source folder>: exit codes of bench/against and what it runs, in a made-up repository where each
# revision's programs say how the comparison ends. cmake is made up, too.
set -uo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
export CALLS="$folder/calls" SLIPSTICK_SKIP_SETUP=1 GIT_CONFIG_GLOBAL="$folder/gitconfig" LC_ALL=C.UTF-8
unset MAKEFLAGS MAKELEVEL MFLAGS BUILD
failures=0
git config --file "$folder/gitconfig" user.name somebody
git config --file "$folder/gitconfig" user.email somebody@example.org

mkdir -p "$folder/programs" "$folder/tree/bench" "$folder/tree/cmake" "$folder/tree/build"
cp "$1/Makefile" "$folder/tree"
cp "$1/bench/against" "$folder/tree/bench"
cp "$1/cmake/setup" "$folder/tree/cmake"
cat > "$folder/programs/cmake" <<'END'
#!/usr/bin/env bash
echo "cmake $*" >> "$CALLS"
case "$1" in
  -S) mkdir -p "$4" && echo "$2" > "$4/source" ;;
  --build) [[ ! -f "$2/source" ]] || bash "$(cat "$2/source")/compile" "$2" ;;
esac
END
cat > "$folder/tree/build/slipstick" <<'END'
#!/usr/bin/env bash
echo "slipstick $*" >> "$CALLS"
"$3"
END
chmod +x "$folder/programs/cmake" "$folder/tree/build/slipstick"
export PATH="$folder/programs:$PATH"
cd "$folder/tree" || exit 1
cat > build/CMakeCache.txt <<'END'
CMAKE_BUILD_TYPE:STRING=Release
CMAKE_CXX_COMPILER_LAUNCHER:STRING=ccache
CMAKE_CXX_FLAGS:STRING=-O3 -g
CMAKE_GENERATOR:INTERNAL=Ninja
SLIPSTICK_NATIVE:BOOL=ON
SLIPSTICK_TESTS:BOOL=ON
END
touch build/build.ninja
echo /build/ > .gitignore
git init --quiet

# revision <name> <commands that build it>
revision() {
  printf '%s\n' "${@:2}" > compile
  git add --all
  git commit --quiet --message "$1"
  git tag "$1"
}
program() {  # <exit code of the comparison with it>
  printf 'mkdir -p "$1/bench"; printf "#!/bin/sh\\nexit %s\\n" > "$1/bench/slipstick_benchmarks"\n' "$1"
  printf 'chmod +x "$1/bench/slipstick_benchmarks"\n'
}
revision without_benchmarks true
revision as_quick "$(program 0)"
revision quicker "$(program 1)"
revision elsewhere "$(program 2)"
revision broken "exit 1"

# expect <exit code> <what must be written or called> <command...>
expect() {
  : > "$CALLS"
  "${@:3}" > "$folder/output" 2>&1
  local status=$?
  if [[ "$status" != "$1" ]] || [[ "$(cat "$folder/output" "$CALLS")" != *"$2"* ]]; then
    echo "FAILED: ${*:3} (exit code $status, not $1), or nothing says “$2”"
    sed 's/^/    /' "$folder/output" "$CALLS"
    failures=$((failures + 1))
  fi
}
expect 2 "no benchmarks" bench/against without_benchmarks
expect 0 "-G Ninja -DCMAKE_BUILD_TYPE:STRING=Release -DCMAKE_CXX_COMPILER_LAUNCHER:STRING=ccache \
-DCMAKE_CXX_FLAGS:STRING=-O3 -g -DSLIPSTICK_NATIVE:BOOL=ON -D SLIPSTICK_TESTS=OFF" bench/against as_quick
written="$(stat --format=%y build/against/compile)"
expect 0 "cmake --build build --target slipstick slipstick_benchmarks" bench/against as_quick
expect 0 "$written" stat --format=%y build/against/compile  # what is there is not checked out again
expect 1 "--rounds 4" bench/against quicker --rounds 4 --filter "a b"
expect 2 "slipstick bench" bench/against elsewhere
expect 2 "broken does not build" bench/against broken
expect 2 "no revision nothing" bench/against nothing
expect 2 "no revision origin/main" bench/against
expect 0 "--rounds 5" make bench-against REV=as_quick BENCH_OPTIONS="--rounds 5"
expect 2 "slipstick bench" make bench-against REV=quicker
rm -r build/against  # as `make clean` does
expect 0 "slipstick bench" bench/against as_quick
rm build/CMakeCache.txt
expect 2 "make configure" bench/against as_quick
expect 0 "working tree clean" git status

((failures == 0)) && echo "all as expected"
exit $((failures > 0))
