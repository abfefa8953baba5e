#!/usr/bin/env bash
# make_test.sh <source folder>: each target of the Makefile builds exactly the targets that it runs, and then lists the parts
# that were not built. cmake, ctest and the programs are made up.
set -uo pipefail
cd "$1" || exit 1
source cmake/tests/expect.sh
export CALLS="$folder/calls" SLIPSTICK_SKIP_SETUP=1
unset MAKEFLAGS MAKELEVEL MFLAGS
build="$folder/build"

mkdir -p "$folder/programs" "$build/bench"
for program in "$folder"/programs/{cmake,ctest,python} "$build"/{slipstick,bench/slipstick_work}; do
  printf '#!/usr/bin/env bash\necho "%s $*" >> "$CALLS"\necho "%s was run"\n' "${program##*/}" "${program##*/}" > "$program"
  chmod +x "$program"
done
echo "SLIPSTICK_PYTHON:STRING=$folder/programs/python" > "$build/CMakeCache.txt"

check() {  # <target> <targets that it builds>
  : > "$CALLS"
  PATH="$folder/programs:$PATH" make BUILD="$build" "$1" > "$folder/output" 2>&1
  expect "make $1 succeeds" test $? = 0
  expect "make $1 builds $2" test "$(sed --quiet "s|^cmake --build $build --target ||p" "$CALLS")" = "$2"
}
configured() { [[ "$(cat "$CALLS")" == *"cmake --preset release"* ]]; }

check report "slipstick slipstick_python"
expect "make report configures what was never configured" configured
touch "$build/build.ninja" "$build/not_built.txt"
check report "slipstick slipstick_python"
expect "make report does not configure again" not configured
expect "everything is built" not says "NOT BUILT"
echo "NOT BUILT: solves on several ranks, because of this test" > "$build/not_built.txt"
check report "slipstick slipstick_python"
expect "what is not built is said after building" says "cmake was run

NOT BUILT: solves on several ranks, because of this test"
expect "what setup does not install is not looked for again" not configured
echo "NOT BUILT: certified digits: install libflint-dev (or run \`make setup\`)" > "$build/not_built.txt"
check report "slipstick slipstick_python"
expect "what setup installs is looked for again" configured
check test tests
expect "make test ends with the skipped tests" test "$(tail -n 2 "$folder/output" | tr '\n' ' ')" = "ctest was run python was run "
printf '#!/usr/bin/env bash\nexit 8\n' > "$folder/programs/ctest"
PATH="$folder/programs:$PATH" make BUILD="$build" test > "$folder/output" 2>&1
expect "make test fails as the test runner does" test $? = 2
expect "a failure leaves no list out" says "python was run"
check gate "slipstick slipstick_work"
expect "make gate asks for exact answers" grep --quiet "exact_errors.py $build/slipstick $build/gates/exact.json" "$CALLS"
check bench "slipstick slipstick_python slipstick_benchmarks"
check references slipstick
check install "slipstick slipstick_c"
check python slipstick_python
check dataset "slipstick slipstick_python"
check reference reference
check build all

PATH="$folder/programs" "$(command -v make)" BUILD="$build" docs > "$folder/output" 2>&1
expect "make docs fails without MkDocs" test $? = 2
expect "make docs says what is missing" says "mkdocs is missing"
ln -s cmake "$folder/programs/mkdocs"
check docs ""
expect "make docs is strict" grep --quiet "build --strict" "$CALLS"

# A wheel that takes longer than a minute, here a tenth of a second.
wheel="$folder/wheel"
mkdir -p "$wheel/tools/bin"
printf '#!/usr/bin/env bash\n[ "$1" != wheel ] || { sleep 1; touch "%s/slipstick-1.whl"; }\n' "$wheel" > "$wheel/tools/bin/pip"
printf '#!/usr/bin/env bash\n[ "$2" != build ] || touch "%s/slipstick-1.tar.gz"\n' "$wheel" > "$wheel/tools/bin/python"
for tool in auditwheel check-wheel-contents twine; do printf '#!/usr/bin/env bash\n' > "$wheel/tools/bin/$tool"; done
chmod +x "$wheel"/tools/bin/*
SLIPSTICK_WHEEL_MINUTE=0.1 cmake/wheel "$wheel" > "$folder/output" 2>&1
expect "make wheel succeeds" test $? = 0
expect "make wheel says every minute that it still builds" test "$(grep --count 'building the wheel.*, 0 min' "$folder/output")" -ge 3
printf '#!/usr/bin/env bash\nexit 3\n' > "$wheel/tools/bin/pip"
cmake/wheel "$wheel" > "$folder/output" 2>&1
expect "make wheel fails as its tools do" test $? = 3

conclude
