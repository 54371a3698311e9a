# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The three stages of one scene, seen from the folder of its results: names in it need no path, so that spaces in the
# path do no harm. run-scene sets recipe, results, bin, on and TALUS_DATA, and writes .inputs.
MAKEFLAGS += --no-builtin-rules --no-builtin-variables
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.SUFFIXES:
# A result carries its name only when it is whole, and the last one of a stage is written last: make deletes none, also
# where it is interrupted.
.PRECIOUS: domain.vdb run.h5 budget.h5 counts.h5 score.json probability.nc

# Names as the shell and as make's rules take them.
quoted  = '$(subst ','\'',$1)'
empty  :=
escaped = $(subst $(empty) ,\ ,$(subst :,\:,$1))
run     = $(call quoted,$(value bin)/talus-$1) $(call quoted,$(value recipe)) --out $(call quoted,$(value results))

# What solve and postprocess write last: of a single run, of its error budget, or of an ensemble. Counts of parts of an
# ensemble are taken as they are.
last   = $(or $(shell sed -nE 's,^(\./)?($2)[ :].*,\2,p' .inputs/$1.d),$3)
solved := $(call last,solve,budget\.h5|counts\.h5|run\.h5,run.h5)
scored := $(call last,postprocess,probability\.nc|score\.json,score.json)

.PHONY: scene force
scene: $(scored)
	@echo "$${results##*/}: results in $$results" >&2

domain.vdb: .inputs/preprocess.toml $(call escaped,$(value bin)/talus-preprocess)
	$(call run,preprocess)

$(solved): .inputs/solve.toml $(call escaped,$(value bin)/talus-solve)
	$(call run,solve) --on $(on) --resume

$(scored): .inputs/postprocess.toml $(call escaped,$(value bin)/talus-postprocess)
	$(call run,postprocess)

# The files that each result depends on besides, as the programs print them.
include .inputs/preprocess.d .inputs/solve.d .inputs/postprocess.d

# What a stage writes beside its result; where a later stage wants one that was removed, the stage runs again.
survey/% budget/%: domain.vdb ;
ifeq ($(solved),budget.h5)
run.h5: budget.h5 ;
endif
obstacles.vdb members.h5 preprocess.used.toml: domain.vdb ;
solve.used.toml: $(solved) ;
wanted := $(shell sed -n 's,^\(survey/.*\|obstacles\.vdb\|members\.h5\):$$,\1,p' .inputs/*.d)
domain.vdb: $(if $(filter-out $(wildcard $(wanted)),$(wanted)),force)

# Any other file that is not there.
%::
	@missing=$(call quoted,$@); \
	if [[ $$missing == "$$TALUS_DATA"/* ]]; then \
	  folder=$${missing#"$$TALUS_DATA"/}; folder=$${folder%/*}; \
	  echo "$$missing is missing (the recipes look for their data in $$TALUS_DATA). Put $$folder there, or say where" \
	    "the data are: make -C pipelines SCENE DATA=dir" >&2; \
	else \
	  echo "$$missing is missing (a recipe names it). Put it back, or mend the recipe" >&2; \
	fi; exit 2
