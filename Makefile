# The commands of the project; 'make' alone lists them. Everything is built by CMake (see CMakePresets.json).
SHELL  := /bin/bash
PRESET ?= default
BUILD  ?= $(if $(filter cpu check check-threads fuzz,$(PRESET)),build-$(PRESET),build)
RELEASE_BUILD ?= build-release
JOBS   ?= $(shell nproc)
TEST_JOBS ?= 2
SETUP  ?= yes
OUT    ?= pipelines/out
ON     ?= auto
LONG   ?=
CASES  ?=
RECIPES ?= 500
RECIPE_JOBS ?= 2

programs := talus-preprocess talus-solve talus-postprocess talus-make-terrain
# With a compiler cache every source is a unit of its own; without one those of a folder are compiled together.
ccache := $(shell command -v ccache)
quickly := $(if $(ccache),-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache,-DTALUS_BATCHES=ON)

# What the build folder was configured for; another wish configures it again.
asked := $(PRESET) $(CUDAARCHS)

.PHONY: help setup build demo test check check-threads check-faults check-recipes fuzz validate lint docs bundle \
  bundle-solver clean FORCE

help: ## this list
	@echo "make TARGET [PRESET=default|cpu|gpu|check|check-threads] [JOBS=n]"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

setup: ## install what is missing through apt (Debian 12, Ubuntu 24.04); SETUP=no leaves this out
ifneq ($(SETUP),no)
	@tools/install-dependencies.sh
endif

$(BUILD)/asked.txt: FORCE
	@mkdir -p $(@D); [[ -f $@ && "$$(<$@)" == '$(asked)' ]] || echo '$(asked)' >$@

$(BUILD)/build.ninja: CMakePresets.json $(BUILD)/asked.txt | setup
	cmake --preset $(PRESET) -B $(BUILD) $(quickly) $(if $(CUDAARCHS),-DCMAKE_CUDA_ARCHITECTURES='$(CUDAARCHS)')
	@touch $@

build: setup $(BUILD)/build.ninja ## the programs, in build/bin/ [CUDAARCHS=90-real: kernels for other GPUs]
	@cat $(BUILD)/kernels.txt
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs)

demo: build ## the synthetic valley from its two elevation models to a scored map
	@touch $(BUILD)/.demo-begins
	@$(MAKE) --no-print-directory -C pipelines synthetic-valley \
	  OUT="$$(realpath -ms -- '$(OUT)')" BIN="$$(realpath -ms -- '$(BUILD)/bin')"
	@# A run has printed its table; where nothing was left to do, show it again.
	@table='$(OUT)/synthetic-valley/score.txt'; [[ $$table -nt $(BUILD)/.demo-begins ]] || cat "$$table"
	@printf '%s\n' '' "Results in $$(realpath -ms -- '$(OUT)')/synthetic-valley:" \
	  '  report.html                  all of it on one page, for a browser' \
	  '  map.png                      the map as a picture' \
	  '  history.csv                  energy, volume, speed and steps over time' \
	  '  maps/synthetic-valley.qgs    all of it in QGIS: maps, outlines, hillshade' \
	  '  maps/*.tif, maps/results.nc  the fields, for a GIS' \
	  '  score.json, score.txt        the numbers above' \
	  '  run.h5                       the points over time, for ParaView'

test: setup $(BUILD)/build.ninja ## everything built, every test run
	@cat $(BUILD)/kernels.txt
	@cmake --build $(BUILD) -j $(JOBS)
	@TALUS_REQUIRE_TOOLS=$(if $(filter no,$(SETUP)),,1) \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -j $(TEST_JOBS)

check: ## tests under address and undefined-behaviour sanitizers [TESTS=regex: only those] [SLOW=1: all]
	@$(MAKE) --no-print-directory sanitized PRESET=check

check-threads: ## tests of what runs in threads under the thread sanitizer [TESTS=regex] [SLOW=1]
	@$(MAKE) --no-print-directory sanitized PRESET=check-threads

# What needs no programs from outside and ends in time under a sanitizer: of each folder what the label "quick" names,
# and the replays. docs/reliability.md says when it last passed.
check_tests            := ^(common|preprocess|postprocess|solver|fuzz)[.]
check_programs         := $(addprefix talus-tests-,common preprocess postprocess solver) talus-replay
check-threads_tests    := ^(preprocess|postprocess|solver)[.]
check-threads_programs := $(addprefix talus-tests-,preprocess postprocess solver)

sanitized: setup $(BUILD)/build.ninja
	@cmake --build $(BUILD) -j $(JOBS) --target $($(PRESET)_programs)
	@ASAN_OPTIONS=abort_on_error=0 UBSAN_OPTIONS=print_stacktrace=1 \
	  TSAN_OPTIONS="suppressions=$(CURDIR)/tests/tsan-suppressions.txt second_deadlock_stack=1 report_mutex_bugs=0" \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -j $(TEST_JOBS) $(if $(SLOW),,-L 'quick|fuzz') \
	  -R '$(or $(TESTS),$($(PRESET)_tests))'

fuzz: ## the fuzz targets, with clang, for FUZZ_SECONDS each [FUZZ_SECONDS=60] [TARGETS="recipe run"]
	@tools/install-dependencies.sh fuzz
	@tools/fuzz.sh '$(or $(FUZZ_SECONDS),60)' $(TARGETS)

# The table names the commit of the tree that was just built, with -dirty behind it where that has changes.
validate: setup $(BUILD)/build.ninja ## error beside tolerance, docs/validation.md [LONG=1] [ON=cpu|gpu] [CASES="A1 B2"]
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs) talus-validate
	@code=0; $(BUILD)/bin/talus-validate --on $(ON) $(if $(filter-out 0 no,$(LONG)),--long) \
	  --commit "$$(git describe --always --dirty --abbrev=9 --exclude='*' 2>/dev/null || echo unknown)" $(CASES) \
	  || code=$$?; \
	[[ $$code -gt 1 ]] || tools/tabulate-validation.py $(BUILD)/validation.json $(BUILD)/validation-table.md; \
	exit $$code

check-faults: setup $(BUILD)/build.ninja ## kills, failing calls, processes in one folder, power cuts: all tables
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs) talus-faults
	@python3 tests/faults/faults.py --full --bin $(BUILD)/bin --shim $(BUILD)/bin/talus-faults.so \
	  --work $(BUILD)/scratch/check-faults --table $(BUILD)/faults.md

check-recipes: build ## random recipes: a result that holds or a clear refusal [RECIPES=500] [RECIPE_JOBS=2]
	@tools/check-recipes.py --bin $(BUILD)/bin --out $(BUILD)/recipes --count $(RECIPES) --jobs $(RECIPE_JOBS)

lint: ## formatting and static analysis of everything [CHANGED=n: analyse only the n units changed last]
	@tools/install-dependencies.sh lint
	@tools/lint.sh $(if $(CHANGED),--changed $(CHANGED))

docs: ## the programmers' reference, in build-docs/html
	@tools/install-dependencies.sh docs
	@tools/make-docs.sh build-docs

# Bundles go to other machines: their kernels are compiled for every supported GPU, unless CUDAARCHS says otherwise.
$(RELEASE_BUILD)/build.ninja: CMakePresets.json | setup
	cmake --preset default -B $(RELEASE_BUILD) $(quickly) \
	  $(if $(CUDAARCHS),-DCMAKE_CUDA_ARCHITECTURES='$(CUDAARCHS)',-DTALUS_ALL_GPUS=ON)
	@touch $@

bundle: setup $(RELEASE_BUILD)/build.ninja ## programs and tests with their libraries: build-release/talus-bundle.tar.xz
	@cmake --build $(RELEASE_BUILD) -j $(JOBS)
	@tools/make-bundle.sh $(RELEASE_BUILD)

bundle-solver: setup $(RELEASE_BUILD)/build.ninja ## the solver and its tests: build-release/talus-bundle-solver.tar.xz
	@cmake --build $(RELEASE_BUILD) -j $(JOBS)
	@tools/make-bundle.sh $(RELEASE_BUILD) --solver

clean: ## remove the build folder and the pipelines' results
	rm -rf $(BUILD) $(RELEASE_BUILD) build-check build-check-threads build-fuzz build-docs build-lint pipelines/out
