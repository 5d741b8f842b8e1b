# The two commands are `make demo` and `make test`. Everything else is for people who work on the code.
# Packages of apt.txt are installed where they are missing; nothing else outside this folder is touched.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := build

JOBS    ?= $(shell nproc)
THREADS ?= $(shell nproc)
FABRICA := build/fabrica
OUT     ?= out

.PHONY: help demo test build bench validate format format-check clean packages

help: ## list these targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 24

packages:
	@missing=(); \
	for p in $$(grep -vE '^\s*(#|$$)' apt.txt); do \
	  dpkg-query -W -f '$${Status}' "$$p" 2>/dev/null | grep -q 'ok installed' || missing+=("$$p"); \
	done; \
	if [ $${#missing[@]} -gt 0 ]; then \
	  root=; if [ "$$(id -u)" -ne 0 ]; then root=sudo; fi; \
	  echo "installing: $${missing[*]}"; \
	  $$root apt-get -qq update; \
	  $$root env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends \
	    "$${missing[@]}" > /dev/null; \
	fi

build: packages ## the program, optimised, as build/fabrica
	@echo "building release in build/"
	@cmake --preset release > build.log 2>&1 || { cat build.log; exit 1; }
	@cmake --build --preset release -j $(JOBS) >> build.log 2>&1 || { tail -50 build.log; exit 1; }
	@rm -f build.log

demo: build ## crush a square tube and draw the result
	@echo "crushing a tube: cases/tube-crush -> $(OUT)/tube-crush (one to two minutes)"
	@$(FABRICA) run cases/tube-crush/tube-crush.k --out $(OUT)/tube-crush --threads $(THREADS)
	@$(FABRICA) picture $(OUT)/tube-crush --out $(OUT)/tube-crush/tube-crush.png --times 0,5,10,20 > /dev/null
	@$(FABRICA) plot $(OUT)/tube-crush glstat:kinetic_energy glstat:internal_energy glstat:hourglass_energy \
	  glstat:total_energy --out $(OUT)/tube-crush/energy.png --title "Energy of the crush" > /dev/null
	@echo "results: $(OUT)/tube-crush (read summary.json first)"
	@echo "picture: $(OUT)/tube-crush/tube-crush.png"
	@echo "energies: $(OUT)/tube-crush/energy.png"

# Kernels are tested in float and in double. Whole-solver tests run in float here; `ctest --preset double` after
# `cmake --build --preset double` runs them in double too.
DOUBLE_TESTS := base material element
test: build ## all tests in float, and those of the kernels in double
	@echo "testing release"
	@ctest --preset release
	@echo "building the kernel tests in double in build-double/"
	@cmake --preset double > build.log 2>&1 || { cat build.log; exit 1; }
	@cmake --build --preset double -j $(JOBS) --target $(addsuffix _tests,$(DOUBLE_TESTS)) >> build.log 2>&1 || { tail -50 build.log; exit 1; }
	@rm -f build.log
	@echo "testing double"
	@ctest --preset double -R '^(base|material|element)$$'

bench: build ## speed of the kernels and of whole models
	@$(FABRICA) bench --threads $(THREADS)

validate: build ## run the cases that are not up to date, compare them, write their pages
	@$(FABRICA) validate --out $(OUT)/validation --threads $(THREADS)

SOURCE_DIRS := src tests tools
SOURCES := .*\.\(h\|cpp\|cc\|cu\|cuh\)
format: ## lay out the sources by .clang-format
	@find $(SOURCE_DIRS) -regex '$(SOURCES)' | xargs clang-format -i

format-check: ## fail where a source is laid out otherwise
	@find $(SOURCE_DIRS) -regex '$(SOURCES)' | xargs -P $(JOBS) -n 40 clang-format --dry-run -Werror

clean: ## remove what was built; results in out/ stay
	@rm -rf build build-*/ build.log
