# Each target installs missing packages, configures, builds the parts that it needs and that are out of date, and runs.

BUILD := build
PREFIX ?= /usr/local
REPORT_OPTIONS ?=
FULL ?=
BENCH_OPTIONS ?=
REV ?= origin/main
GATE_OPTIONS ?=
SEARCH_OPTIONS ?=
HARD_OPTIONS ?=
DATASET_OPTIONS ?=
SANITIZE ?=
SANITIZER ?= asan-ubsan
COMPILER ?=
LINT_SINCE ?=
# The interpreter that CMake found.
PYTHON = "$$(sed -n 's/^SLIPSTICK_PYTHON:[A-Z]*=//p' $(BUILD)/CMakeCache.txt)"
# The gates on instructions exist for some compilers.
INSTRUCTION_GATES = $(wildcard bench/gates/instructions-gcc-$(firstword $(subst ., ,$(shell c++ -dumpversion))).toml)

.DEFAULT_GOAL := help
.PHONY: help setup configure build report gallery report-pdf test gate literature hard sanitize coverage lint bench bench-against \
  bench-trust references reference hardest dataset docs install python wheel deb clean

help: ## show this list
	@echo "slipstick: make TARGET"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s %s\n", $$1, $$2 }' Makefile

setup: ## install the missing Debian/Ubuntu packages (elsewhere: list them)
	@cmake/setup

# Configures again if packages were missing the last time that setup can install.
configure: setup
	@if [ ! -f $(BUILD)/build.ninja ] || grep -qs 'make setup' $(BUILD)/not_built.txt; then cmake --preset release; fi

# $(call build,targets): builds them, and then lists the optional parts that were not built.
define build
@cmake --build $(BUILD) --target $(1)
@if [ -s $(BUILD)/not_built.txt ]; then echo; cat $(BUILD)/not_built.txt; echo; fi >&2
endef

build: configure ## build everything, the program is build/slipstick
	$(call build,all)

report: configure ## compute the validation page and write it (FULL=1: finer meshes; REPORT_OPTIONS="--quick")
	$(call build,slipstick slipstick_python)
	@$(BUILD)/slipstick report --output $(BUILD)/report --benchmarks $(BUILD)/benchmarks $(if $(FULL),--full) $(REPORT_OPTIONS)
	@echo "The page: $(CURDIR)/$(BUILD)/report/index.html"

gallery: configure ## make a page of every scene of the project, with an index, build/gallery/index.html (5 minutes; REPORT_OPTIONS="--quick": 3)
	$(call build,slipstick slipstick_python)
	@$(BUILD)/slipstick report convergence/scenes/*.toml --output $(BUILD)/gallery $(REPORT_OPTIONS)

report-pdf: configure ## print the page of `make report` to build/report/report.pdf (needs chromium-driver and python3-selenium)
	@$(PYTHON) -B reports/pdf.py $(BUILD)/report/index.html \
	  --output $(BUILD)/report/report.pdf

test: configure ## run every test
	$(call build,tests)
	@status=0; ctest --test-dir $(BUILD) --output-on-failure -j$$(nproc) || status=$$?; python=$(PYTHON); \
	  "$${python:-python3}" -B cmake/tests/skipped.py $(BUILD); exit $$status

gate: configure ## check the numbers stated in README.md and the guides, and counts of work (GATE_OPTIONS="--junit FILE --summary FILE.md")
	$(call build,slipstick slipstick_work)
	@$(PYTHON) -B bench/work/count_work.py $(BUILD)/bench/slipstick_work $(BUILD)/gates/work.json
	@digits() { $(BUILD)/slipstick digits convergence/scenes/paper.toml --set "grid.cells=[48,48]" \
	    --set "load.moment_ratio=$$2" --output $(BUILD)/gates/digits --json "$(BUILD)/gates/$$1.json" --quiet; }; \
	  digits digits 0.9 && digits digits-limit 0.999999 && digits digits-nothing 1e-9
	@$(PYTHON) -B analytic/references/exact_errors.py \
	  $(BUILD)/slipstick $(BUILD)/gates/exact.json
	@$(BUILD)/slipstick gate $(patsubst %,convergence/gates/%.toml,quick digits exact) bench/gates/work.toml $(INSTRUCTION_GATES) \
	  --results $(BUILD)/gates --output $(BUILD)/gates $(GATE_OPTIONS)

literature: configure ## compare published numbers with this program's (GATE_OPTIONS as for gate)
	$(call build,slipstick)
	@$(BUILD)/slipstick gate convergence/literature/*.toml --output $(BUILD)/literature $(GATE_OPTIONS)

hard: configure ## solve 782 hard scenes and equivalent ones, and audit all with NumPy (3 minutes)
	$(call build,slipstick)
	@status=0; mkdir -p $(BUILD)/hard; \
	  $(BUILD)/slipstick hard convergence/hard/*.toml --output $(BUILD)/hard --fields $(BUILD)/hard/fields \
	    --json $(BUILD)/hard/hard.json $(HARD_OPTIONS) || status=$$?; \
	  [ $$status -gt 1 ] || echo "The audit with NumPy:" >&2; \
	  [ $$status -gt 1 ] || $(PYTHON) convergence/hard/audit.py $(BUILD)/hard/hard.json || status=1; exit $$status

SANITIZED = build-$(SANITIZER)$(addprefix -,$(COMPILER))
sanitize: setup ## run every test under sanitizers (SANITIZER=tsan: threads; COMPILER=clang++; a part: SANITIZE="operators analytic")
	@test -f $(SANITIZED)/build.ninja || cmake --preset $(SANITIZER) -B $(SANITIZED) $(addprefix -DCMAKE_CXX_COMPILER=,$(COMPILER))
	@cmake --build $(SANITIZED) --target $(if $(SANITIZE),$(SANITIZE:%=%_tests),tests)
	@ctest --test-dir $(SANITIZED) --output-on-failure -j$$(nproc) \
	  $(if $(SANITIZE),-R "^($$(echo $(SANITIZE) | tr ' ' '|'))_tests",-E '^(reports|docs|python)')

coverage: setup ## check that the tests run 95 % of the lines of analytic, solver and convergence (needs lcov)
	@command -v lcov >/dev/null || { echo "make coverage: lcov is missing; on Debian: apt-get install lcov" >&2; exit 2; }
	@test -f build-coverage/build.ninja || cmake --preset coverage
	@cmake --build build-coverage --target tests
	@ctest --test-dir build-coverage --output-on-failure -j$$(nproc) -E '^(reports|docs|python)'
	@build-coverage/slipstick report --quick --output build-coverage/report
	@cmake/coverage build-coverage 95

lint: setup ## check the format and clang-tidy's rules, 14 or later (only changed files: LINT_SINCE=origin/main)
	@git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
	@test -f build-dev/build.ninja || cmake --preset dev
	@cmake --build build-dev --target slipstick_commit
	@git $(if $(LINT_SINCE),diff --name-only --diff-filter=d $(LINT_SINCE),ls-files) -- '*.cpp' \
	  | xargs --no-run-if-empty -n 4 -P $$(nproc) clang-tidy -p build-dev --quiet \
	  --extra-arg=-Wno-unused-command-line-argument --extra-arg=-Wno-unknown-warning-option

bench: configure ## time everything, each time with its error, and draw the results
	$(call build,slipstick slipstick_python slipstick_benchmarks)
	@$(BUILD)/slipstick bench $(BENCH_OPTIONS)

peers: configure ## install other programs from PyPI (build/peers) and Debian, draw pages with their answers, run simulators and finite elements
	$(call build,slipstick slipstick_python)
	@interfaces/programs/peers $(BUILD)/slipstick $(BUILD)

bench-against: configure ## compare the speed of this tree with REV, origin/main (bench/against itself exits with 0, 1 or 2)
	@BUILD="$(BUILD)" bench/against "$(REV)" $(BENCH_OPTIONS)

bench-trust: configure ## check that comparisons find a slowdown of 15 % and no other (a quarter of an hour)
	@cmake --build $(BUILD) --target bench-trust

references: configure ## compute the table of proven values (minutes; needs FLINT with Arb)
	$(call build,slipstick)
	@$(PYTHON) -B analytic/references/proven_references.py $(BUILD)/slipstick table

hardest: configure ## search for inputs at which the exact functions are least accurate (SEARCH_OPTIONS="--seed 2 --samples 1000")
	$(call build,slipstick)
	@$(PYTHON) -B analytic/references/proven_references.py $(BUILD)/slipstick search $(SEARCH_OPTIONS)

dataset: configure ## write values, fields and discrete problems for tests of other programs, build/dataset (minutes; needs FLINT with Arb)
	$(call build,slipstick slipstick_python)
	@PYTHONPATH=$(BUILD)/python $(PYTHON) -B convergence/dataset/dataset.py $(BUILD)/slipstick $(BUILD)/dataset $(DATASET_OPTIONS)

docs: ## build the documentation's site, build/site/index.html (needs MkDocs)
	@command -v mkdocs > /dev/null || \
	  { echo "make docs: mkdocs is missing. On Debian or Ubuntu: apt-get install --no-install-recommends mkdocs" >&2; exit 2; }
	@mkdocs build --strict --quiet --config-file docs/site/mkdocs.yml --site-dir "$(abspath $(BUILD))/site"
	@echo "The documentation: $(abspath $(BUILD))/site/index.html"

reference: configure ## write the generated pages of docs/reference; with doxygen also the C++ reference
	$(call build,reference)

python: configure ## build the Python package in build/python (pip install . makes a wheel instead)
	$(call build,slipstick_python)
	@echo "To use it: PYTHONPATH=$(CURDIR)/$(BUILD)/python python3 -c 'import slipstick'"

wheel: ## build a wheel for Linux, with the libraries that it needs, in build/wheel (tools from PyPI)
	@cmake/wheel $(BUILD)/wheel

deb: configure ## build a Debian package in build/deb
	$(call build,slipstick slipstick_c)
	@cd $(BUILD) && rm -f deb/*.deb && { cpack -B deb > deb.log || { cat deb.log >&2; exit 1; }; } && ls "$$PWD"/deb/*.deb

install: configure ## install under PREFIX (default /usr/local)
	$(call build,slipstick slipstick_c)
	@cmake --install $(BUILD) --prefix "$(abspath $(PREFIX))"

clean: ## remove all build folders
	@rm -rf $(BUILD) build-*
