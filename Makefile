# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
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
WITH_TESTS ?=
CASES  ?=
RECIPES ?= 500
RECIPE_JOBS ?= 2

programs := talus talus-preprocess talus-solve talus-postprocess talus-make-terrain
# With a compiler cache every source is a unit of its own; without one those of a folder are compiled together.
ccache ?= $(shell command -v ccache)
quickly := $(if $(ccache),-DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_CUDA_COMPILER_LAUNCHER=ccache,-DTALUS_BATCHES=ON)

# Man pages, completions, styles and notices go with the programs (cmake/manuals.cmake).
programs += talus-manuals
# The Python module goes with them where pybind11 is there (library/CMakeLists.txt).
programs += talus-python
PREFIX ?= /usr/local

# What the build folder was configured for; another wish configures it again.
asked := $(PRESET) $(CUDAARCHS)

# What is installed through apt: what building and running needs, and the rest for those who test.
for_tests := test setup-tests sanitized check check-threads check-faults check-docs check-tutorials pictures validate
groups := $(if $(filter $(for_tests),$(MAKECMDGOALS))$(filter-out 0 no,$(WITH_TESTS)),tests) \
  $(if $(filter package check-install image,$(MAKECMDGOALS)),package)

.PHONY: help setup setup-tests build say-demo demo demo-weakening install install-library wheel package \
  check-install image with-tests test sanitized check check-threads check-faults check-qgis check-three-d \
  check-recipes fuzz validate lint docs pictures facts scores test-gpu check-docs check-tutorials bundle bundle-solver \
  clean FORCE

help: ## this list
	@echo "make TARGET [PRESET=default|cpu|gpu|check|check-threads] [JOBS=n]"
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-14s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))

setup: ## install through apt what building and running needs; SETUP=no leaves this out
ifneq ($(SETUP),no)
	@tools/install-dependencies.sh $(groups)
endif

setup-tests: setup ## install what the tests need besides: a browser, readers that are not ours, ffmpeg

$(BUILD)/asked.txt: FORCE
	@mkdir -p $(@D); [[ -f $@ && "$$(<$@)" == '$(asked)' ]] || echo '$(asked)' >$@

$(BUILD)/build.ninja: CMakePresets.json $(BUILD)/asked.txt | setup
	cmake --preset $(PRESET) -B $(BUILD) $(quickly) $(if $(CUDAARCHS),-DCMAKE_CUDA_ARCHITECTURES='$(CUDAARCHS)')
	@touch $@

build: setup $(BUILD)/build.ninja ## the programs, in build/bin/ [CUDAARCHS=90-real: kernels for other GPUs]
	@cat $(BUILD)/kernels.txt
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs)

# What compiling takes where nothing is compiled yet, in minutes of one processor.
BUILD_MINUTES := 16
say-demo:
	@[[ -x $(BUILD)/bin/talus-solve ]] || printf '%s\n' \
	  'First what is missing comes through apt (how much, is said before it is fetched).' \
	  "Then the programs are compiled, about $$(( ($(BUILD_MINUTES) + $(JOBS) - 1) / $(JOBS) )) minutes on" \
	  "$(JOBS) processors, and the scene is run, half a minute. Nothing is installed for tests." >&2

demo: say-demo build ## the synthetic valley from its two elevation models to a scored map
	@$(MAKE) --no-print-directory -C pipelines synthetic-valley \
	  OUT="$$(realpath -ms -- '$(OUT)')" BIN="$$(realpath -ms -- '$(BUILD)/bin')"
	@echo
	@tools/show-six-numbers.sh '$(OUT)/synthetic-valley/score.txt'
	@printf '%s\n' '' 'The survey of this valley is a lobe drawn by hand: the overlap shows that the programs work' \
	  'together, not how well they predict. For that: docs/explanation/validation.md'
	@printf '%s\n' '' "Results in $$(realpath -ms -- '$(OUT)')/synthetic-valley:" \
	  '  report.html                  all of it on one page, for a browser' \
	  '  map.png                      the map as a picture' \
	  '  history.csv                  energy, volume, speed and steps over time' \
	  '  maps/synthetic-valley.qgs    all of it in QGIS: maps, outlines, hillshade' \
	  '  maps/*.tif, maps/results.nc  the fields, for a GIS' \
	  '  score.json, score.txt        these numbers and all others' \
	  '  3d/run.pvd                   ground, flow and points over time, for ParaView'

# One slide on two beds: friction that falls with slip speed, and the friction of its start kept.
weakening := $(OUT)/synthetic-weakening
demo-weakening: say-demo build ## a rock slope on a bed that weakens with speed, beside one that does not
	@for bed in weakening constant; do \
	  extra=(); [[ $$bed == weakening ]] || extra=(--set solve.base.law=coulomb --set solve.base.friction_angle_deg=35); \
	  $(BUILD)/bin/talus run pipelines/synthetic-weakening/recipe.toml --out '$(weakening)'/$$bed --on $(ON) \
	    "$${extra[@]}" >/dev/null || exit; done
	@$(BUILD)/bin/talus compare '$(weakening)/weakening' '$(weakening)/constant' >/dev/null
	@for bed in weakening constant; do printf '\n%s\n' "Friction of the bed: $$bed"; \
	  tools/show-six-numbers.sh '$(weakening)'/$$bed/score.txt | grep -v 'not scored'; done
	@printf '%s\n' '' 'At rest both beds have a friction of 0.7 (35 degrees); the first falls to 0.23 at speed.' \
	  "Both on one page: $$(realpath -ms -- '$(weakening)')/weakening/comparison.html"

install: build ## the programs with recipes, styles, manuals and documents, to PREFIX [PREFIX=/usr/local] [DESTDIR=]
	@cmake --install $(BUILD) --prefix '$(PREFIX)' --strip >$(BUILD)/install.log
	@echo "Installed $$(grep -c '^-- Inst' $(BUILD)/install.log) files: $${DESTDIR:-}$(PREFIX)"

install-library: setup $(BUILD)/build.ninja ## libtalus with headers, CMake's package and Python module, to PREFIX
	@cmake --build $(BUILD) -j $(JOBS) --target talus_library talus-python
	@cmake --install $(BUILD) --component dev --prefix '$(PREFIX)' --strip >$(BUILD)/install-library.log
	@echo "Installed $$(grep -c '^-- Inst' $(BUILD)/install-library.log) files: $${DESTDIR:-}$(PREFIX)"

wheel: setup $(BUILD)/build.ninja ## the Python package with its module, in build/wheels/
	@tools/install-dependencies.sh python
	@cmake -B $(BUILD) -S . >/dev/null
	@cmake --build $(BUILD) -j $(JOBS) --target talus-python
	@tools/make-wheel.sh $(BUILD)

package: docs ## Debian packages, in build/packages/: talus (or talus-gpu, with kernels for GPUs) and talus-doc
	@tools/make-packages.sh $(BUILD)

check-install: package ## the packages in a fresh root of this distribution: installed, run on the example, removed
	@tools/check-install.sh $(BUILD)/packages

image: package ## an image of the packages, by buildah, podman or docker [IMAGE=talus] [BASE=debian:12]
	@tools/make-image.sh $(BUILD) '$(or $(IMAGE),talus)' $(BASE)

# A folder that was configured before GoogleTest was there gets its tests now.
with-tests: setup-tests $(BUILD)/build.ninja
	@[[ -f $(BUILD)/tests/CTestTestfile.cmake ]] || cmake -B $(BUILD) -S . >/dev/null

test: with-tests ## everything built, every test run
	@cat $(BUILD)/kernels.txt
	@cmake --build $(BUILD) -j $(JOBS)
	@TALUS_REQUIRE_TOOLS=$(if $(filter no,$(SETUP)),,1) \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -j $(TEST_JOBS)

check: ## tests under address and undefined-behaviour sanitizers [TESTS=regex: only those] [SLOW=1: all]
	@$(MAKE) --no-print-directory sanitized PRESET=check

check-threads: ## tests of what runs in threads under the thread sanitizer [TESTS=regex] [SLOW=1]
	@$(MAKE) --no-print-directory sanitized PRESET=check-threads

# What needs no programs from outside and ends in time under a sanitizer: of each folder what the label "quick" names,
# and the replays. docs/explanation/reliability.md says when it last passed.
check_tests            := ^(common|preprocess|postprocess|solver|fuzz)[.]
check_programs         := $(addprefix talus-tests-,common preprocess postprocess solver) talus-replay
check-threads_tests    := ^(preprocess|postprocess|solver)[.]
check-threads_programs := $(addprefix talus-tests-,preprocess postprocess solver)

sanitized: with-tests
	@cmake --build $(BUILD) -j $(JOBS) --target $($(PRESET)_programs)
	@ASAN_OPTIONS=abort_on_error=0 LSAN_OPTIONS="suppressions=$(CURDIR)/tests/lsan-suppressions.txt print_suppressions=0" \
	  UBSAN_OPTIONS=print_stacktrace=1 \
	  TSAN_OPTIONS="suppressions=$(CURDIR)/tests/tsan-suppressions.txt second_deadlock_stack=1 report_mutex_bugs=0" \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -j $(TEST_JOBS) $(if $(SLOW),,-L 'quick|fuzz') \
	  -R '$(or $(TESTS),$($(PRESET)_tests))'

fuzz: ## the fuzz targets, with clang, for FUZZ_SECONDS each [FUZZ_SECONDS=60] [TARGETS="recipe run"]
	@tools/install-dependencies.sh fuzz
	@tools/fuzz.sh '$(or $(FUZZ_SECONDS),60)' $(TARGETS)

# The rows name the commit of the tree that was just built, with -dirty behind it where that has changes.
validate: with-tests ## error beside tolerance, into build/validation.json [LONG=1] [ON=cpu|gpu] [CASES="A1 B2"]
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs) talus-validate
	@$(BUILD)/bin/talus-validate --on $(ON) $(if $(filter-out 0 no,$(LONG)),--long) \
	  --commit "$$(git describe --always --dirty --abbrev=9 --exclude='*' 2>/dev/null || echo unknown)" $(CASES)

check-faults: with-tests ## kills, failing calls, processes in one folder, power cuts: all tables [SCENES="run slides"]
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs) talus-faults
	@for scene in $(or $(SCENES),run ensemble slides); do \
	  /usr/bin/python3 tests/faults/faults.py --full --scene $$scene --bin $(BUILD)/bin \
	    --shim $(BUILD)/bin/talus-faults.so --work $(BUILD)/scratch/check-faults \
	    --table $(BUILD)/faults-$$scene.md || exit 1; done

check-three-d: build ## what runs leave in 3d/, opened by ParaView; picture compared
	@tools/install-dependencies.sh three-d
	@tests/three_d/check.sh $(BUILD)/bin $(BUILD)/scratch/check-three-d

check-qgis: build ## the plugin and the projects of results, in QGIS itself, which is installed for it (about 1 GB)
	@tools/install-dependencies.sh qgis
	@/usr/bin/python3 tests/qgis/check_qgis.py --bin $(BUILD)/bin --plugin $(BUILD)/qgis/talus_provider.zip \
	  --work $(BUILD)/scratch/check-qgis $(if $(CHECKS),--only $(CHECKS))

check-recipes: build ## random recipes: a result that holds or a clear refusal [RECIPES=500] [RECIPE_JOBS=2]
	@/usr/bin/python3 tools/check-recipes.py --bin $(BUILD)/bin --out $(BUILD)/recipes \
	  --count $(RECIPES) --jobs $(RECIPE_JOBS)

lint: ## formatting and static analysis of everything [CHANGED=n: analyse only the n units changed last]
	@tools/install-dependencies.sh lint
	@tools/lint.sh $(if $(CHANGED),--changed $(CHANGED))

docs: build ## the site of documents, in build/site/html; the programmers' reference is part of it
	@tools/install-dependencies.sh docs
	@tools/make-docs.sh $(BUILD)/code >/dev/null
	@/usr/bin/python3 tools/make-site.py --out $(BUILD)/site --bin $(BUILD)/bin --code $(BUILD)/code/html

pictures: with-tests ## the documents' pictures, from runs and tables [PICTURES="a.png"] [DATA=folder of real events]
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs)
	@/usr/bin/python3 tools/make-pictures.py --bin $(BUILD)/bin --work $(BUILD)/pictures \
	  $(if $(DATA),--data '$(DATA)') $(PICTURES)

test-gpu: with-tests ## the tests of kernels on this machine's GPU, into docs/benchmarks/gpu-tests.csv
	@cmake --build $(BUILD) -j $(JOBS) --target talus-tests-solver
	@tools/record-gpu-tests.py $(BUILD)/bin/talus-tests-solver

facts: ## the documents' tables and what is drawn of them; names figures without a source [VALIDATION=FILE.json]
	@python3 tools/make-tables.py $(if $(VALIDATION),--validation $(VALIDATION))
	@/usr/bin/python3 tools/make-pictures.py speed-against-error.png --bin $(BUILD)/bin --work $(BUILD)/pictures

# All scenes that end in a score; those of real events need their data, and the rest of Xinmo's are nobody's to give.
scenes_without_score := xinmo frank-ensemble synthetic-ensemble synthetic-slides
scores: build ## scores of all scenes into the documents' tables [DATA=folder of real events] [ON=gpu]
	@scenes=($$($(MAKE) --no-print-directory -C pipelines list | grep -vxFf <(printf '%s\n' $(scenes_without_score)))); \
	for scene in "$${scenes[@]}"; do \
	  $(MAKE) --no-print-directory -C pipelines $$scene OUT="$$(realpath -ms -- '$(OUT)')" ON=$(ON) \
	    BIN="$$(realpath -ms -- '$(BUILD)/bin')" $(if $(DATA),DATA='$(abspath $(DATA))') || exit; done; \
	python3 tools/make-tables.py --scores "$${scenes[@]/#/$(OUT)/}"

check-tutorials: with-tests ## every tutorial, run as it is written
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs)
	@TALUS_REQUIRE_TOOLS=$(if $(filter no,$(SETUP)),,1) \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -R '^documents[.]tutorials'

check-docs: with-tests ## the documents: site and search in a browser, tutorials
	@cmake --build $(BUILD) -j $(JOBS) --target $(programs)
	@TALUS_REQUIRE_TOOLS=$(if $(filter no,$(SETUP)),,1) \
	  ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -R '^documents[.]'

# Bundles go to other machines: their kernels are compiled for every supported GPU, unless CUDAARCHS says otherwise.
$(RELEASE_BUILD)/build.ninja: CMakePresets.json | setup
	cmake --preset default -B $(RELEASE_BUILD) $(quickly) \
	  $(if $(CUDAARCHS),-DCMAKE_CUDA_ARCHITECTURES='$(CUDAARCHS)',-DTALUS_ALL_GPUS=ON)
	@touch $@

# WITH_TESTS=1 takes the tests along, to run them on a machine that has no compiler.
bundled := $(if $(filter-out 0 no,$(WITH_TESTS)),,--target $(programs))
bundle: setup $(RELEASE_BUILD)/build.ninja ## programs, libraries, recipes: build-release/talus-bundle.tar.xz
	@cmake --build $(RELEASE_BUILD) -j $(JOBS) $(bundled)
	@tools/make-bundle.sh $(RELEASE_BUILD) $(if $(bundled),,--with-tests)

bundle-solver: setup $(RELEASE_BUILD)/build.ninja ## the solver alone [WITH_TESTS=1: tests go along]
	@cmake --build $(RELEASE_BUILD) -j $(JOBS) $(bundled)
	@tools/make-bundle.sh $(RELEASE_BUILD) --solver $(if $(bundled),,--with-tests)

clean: ## remove the build folder and the pipelines' results
	rm -rf $(BUILD) $(RELEASE_BUILD) build-check build-check-threads build-fuzz build-lint pipelines/out
