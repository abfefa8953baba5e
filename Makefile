# The front door: each target sets up, configures and builds what is out of date, then runs.

BUILD := build
PREFIX ?= /usr/local
REPORT_OPTIONS ?=
BENCH_OPTIONS ?=
GATE_OPTIONS ?=
SEARCH_OPTIONS ?=
SANITIZE ?=
# How many instructions a solve takes is gated where it is known of this compiler.
INSTRUCTION_GATES = $(wildcard bench/gates/instructions-gcc-$(firstword $(subst ., ,$(shell c++ -dumpversion))).toml)

.DEFAULT_GOAL := help
.PHONY: help setup build report test gate sanitize lint bench bench-baseline bench-trust references hardest install clean

help: ## show this list
	@echo "slipstick: make TARGET"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s %s\n", $$1, $$2 }' Makefile

setup: ## install the missing Debian/Ubuntu packages (elsewhere: list them)
	@cmake/setup

$(BUILD)/build.ninja: | setup
	cmake --preset release

build: $(BUILD)/build.ninja ## build everything, the program is build/slipstick
	@cmake --build $(BUILD)

report: build ## run the validation and the studies, write the page (REPORT_OPTIONS="--quick")
	@$(BUILD)/slipstick report --output $(BUILD)/report $(REPORT_OPTIONS)
	@echo "The page: $(CURDIR)/$(BUILD)/report/index.html"

test: build ## run every test
	@ctest --test-dir $(BUILD) --output-on-failure -j$$(nproc)

gate: build ## check the numbers that README.md promises, and counts of work (GATE_OPTIONS="--junit FILE --summary FILE.md")
	@$(BUILD)/bench/slipstick_work --instructions --json $(BUILD)/gates/work.json
	@$(BUILD)/slipstick gate convergence/gates/quick.toml bench/gates/work.toml $(INSTRUCTION_GATES) --results $(BUILD)/gates \
	  --output $(BUILD)/gates $(GATE_OPTIONS)

sanitize: setup ## run every test under the address and undefined-behaviour sanitizers (a part: SANITIZE="operators analytic")
	@test -f build-asan-ubsan/build.ninja || cmake --preset asan-ubsan
	@cmake --build build-asan-ubsan $(if $(SANITIZE),--target $(SANITIZE:%=%_tests))
	@ctest --test-dir build-asan-ubsan --output-on-failure -j$$(nproc) \
	  $(if $(SANITIZE),-R "^($$(echo $(SANITIZE) | tr ' ' '|'))_tests",-E '^reports')

lint: build ## check format and clang-tidy's rules (needs clang-format, clang-tidy 14 or later)
	@git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
	@git ls-files '*.cpp' | xargs -n 4 -P $$(nproc) clang-tidy -p $(BUILD) --quiet

bench: build ## time everything beside the error that it buys, draw it, compare with what is remembered
	@$(BUILD)/slipstick bench $(BENCH_OPTIONS)
	@if [ -f "bench/baselines/$$($(BUILD)/slipstick bench --machine).json" ]; then \
	  $(BUILD)/slipstick bench --baselines bench/baselines; \
	else \
	  echo "No times of this kind of machine are remembered: make bench-baseline REASON='the first on this machine'"; \
	fi

bench-baseline: build ## remember this build's times on this kind of machine (REASON="what changed them")
	@$(BUILD)/slipstick bench --baselines bench/baselines --renew "$(REASON)"

bench-trust: build ## is a build never slower than itself, and 15 % always found? (a quarter of an hour)
	@cmake --build $(BUILD) --target bench-trust

references: build ## make the table of proven values anew (2 minutes; needs FLINT with Arb)
	@$(BUILD)/analytic/certified/slipstick_references table --output analytic/tests/certified_references.csv

hardest: build ## look for harder inputs of the exact functions (SEARCH_OPTIONS="--seed 2 --samples 1000")
	@$(BUILD)/analytic/certified/slipstick_references search --folder analytic/tests/hardest $(SEARCH_OPTIONS)

install: build ## install under PREFIX (default /usr/local)
	@cmake --install $(BUILD) --prefix "$(abspath $(PREFIX))"

clean: ## remove what was built
	@rm -rf $(BUILD) build-*
