# SPDX-License-Identifier: MIT
# The front door. `make` alone lists what there is; docs/architecture.md says what it builds.
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory

PRESET ?= release
BUILD := build/$(PRESET)
DEMO ?= 1
PERCEPTION ?= oracle
SECONDS ?= 60
SUITE ?= crossnav-mfmon-1-mini
TARGET ?=
PYTHONS ?=
ROOTS ?= bookworm trixie noble
# One compiler per core, as far as 1.5 GB of free memory each goes.
JOBS ?= $(shell awk -v cores="$$(nproc)" '/MemAvailable/ {n = int($$2 / 1500000)} \
  END {if (n > cores) n = cores; print n < 1 ? 1 : n}' /proc/meminfo 2>/dev/null || echo 1)
TIDY := $(or $(XDG_DATA_HOME),$(HOME)/.local/share)/crossnav/clang-tidy-$(shell \
  sed -n 's/^clang-tidy==\([0-9.]*\).*/\1/p' scripts/clang-tidy.txt)/bin
SOURCES := $(shell find crossnav apps tests benchmarks python examples -name '*.h' -o -name '*.cpp' | sort)
FILES ?= $(SOURCES)

.PHONY: help setup demo test test-long golden bench networks results viewer wheel packages format lint asan tsan fuzz docs clean \
  program everything

help:  ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-12s %s\n", $$1, $$2}' Makefile
	@echo "  Settings: DEMO=1|2  PERCEPTION=oracle|networks  SUITE=$(SUITE)  PRESET=release|dev|ci  JOBS=$(JOBS)"
	@echo "            FILES='a.cpp b.h' for format and lint (default: all)  ARGS='--set KEY=VALUE' for results"

setup:  ## install what the build needs (asks for sudo only when something is missing)
	@scripts/setup.sh

$(BUILD)/build.ninja: | setup
	@cmake --preset $(PRESET)

program: setup $(BUILD)/build.ninja
	@cmake --build --preset $(PRESET) -j $(JOBS) --target crossnav

everything: setup $(BUILD)/build.ninja
	@cmake --build --preset $(PRESET) -j $(JOBS)

demo: program  ## one three-goal episode over two floors; DEMO=2 is another, which goes down
	@$(BUILD)/apps/crossnav/crossnav demo $(DEMO) --perception $(PERCEPTION)

test: everything  ## every test
	@ctest --preset $(PRESET) -j $(JOBS)

test-long: export CROSSNAV_LONG_TESTS := 1
test-long: everything  ## every test, the long ones included
	@ctest --preset $(PRESET) -j $(JOBS)

golden: program  ## after a change of the navigator: how the suite -mini ends now, for test-long
	@tests/suite/mini_test.py $(BUILD)/apps/crossnav/crossnav --update

bench:  ## timings of the kernels and of the whole step (see BENCHMARKS.md)
	@scripts/setup.sh build bench
	@$(MAKE) everything PRESET=bench
	@for program in $$(find build/bench/benchmarks -maxdepth 1 -type f -executable | sort); do \
	  "$$program"; done
	@build/bench/apps/crossnav/crossnav bench

results: program  ## a suite in every variant, into docs/results.md (the full one: days)
	@CROSSNAV=$(BUILD)/apps/crossnav/crossnav scripts/results.py $(SUITE) --jobs $(JOBS) $(ARGS)

networks: program  ## render frames, train, export and evaluate the networks (hours on a CPU)
	@networks/make.sh

viewer:  ## the replay page of viewer/src as one file, viewer/dist/replay.html
	@scripts/setup.sh viewer
	@cd viewer && node build.mjs

wheel: setup $(BUILD)/build.ninja  ## the Python package as a wheel under build/wheel
	@cmake --build --preset $(PRESET) -j $(JOBS) --target rooms crossnav
	@scripts/build_wheel.sh $(BUILD)

packages: setup $(BUILD)/build.ninja  ## portable wheels for each Python here (or PYTHONS="...") and a .deb
	@cmake --build --preset $(PRESET) -j $(JOBS) --target rooms crossnav
	@scripts/portable_wheels.sh $(BUILD) $(PYTHONS)
	@cd $(BUILD) && cpack && ls -l *.deb

try-packages:  ## both in bare ROOTS="bookworm trixie noble" of other distributions (as root)
	@scripts/setup.sh roots
	@scripts/try_packages.sh $(ROOTS)

format:  ## clang-format, in place
	@scripts/setup.sh lint
	@clang-format -i $(FILES)

lint: setup  ## clang-format and clang-tidy, without changing anything
	@scripts/setup.sh lint
	@clang-format --dry-run -Werror $(FILES)
	@cmake --preset lint >/dev/null
	@cmake --build --preset lint -j $(JOBS)  # generated headers
	@PATH="$(TIDY):$$PATH" run-clang-tidy.py -quiet -p build/lint -j $(JOBS) $(addprefix $(CURDIR)/,$(filter %.cpp,$(FILES)))

# Or TBB opens libraries in a way that sanitizers end the process for.
asan tsan: export TBB_ENABLE_SANITIZERS := 1
asan: export LSAN_OPTIONS := suppressions=$(CURDIR)/scripts/lsan.supp
asan:  ## every test under AddressSanitizer and UndefinedBehaviorSanitizer
	@$(MAKE) test PRESET=asan

tsan: export TSAN_OPTIONS := suppressions=$(CURDIR)/scripts/tsan.supp
tsan:  ## every test under ThreadSanitizer
	@$(MAKE) test PRESET=tsan

fuzz:  ## hostile input for SECONDS a target (docs/robustness.md); TARGET=name: only that one
	@scripts/setup.sh build fuzz
	@JOBS=$(JOBS) scripts/fuzz.sh $(SECONDS) $(TARGET)

docs:  ## the API as pages under build/docs
	@scripts/setup.sh docs
	@mkdir -p build/docs && doxygen docs/Doxyfile && echo "open build/docs/html/index.html"

clean:  ## remove build/ (the compiler cache stays)
	@rm -rf build
