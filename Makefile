# What a user does, as rules. STUDY is the name of a file in studies/ (or, for pipeline, in machines/) or a path.
STUDY ?= motorcycle

PYTHON := .venv/bin/python
SET_UP := .venv/.set-up
# The stages of the graph that pipeline/stages.py declares; a test holds the two together.
STAGES := requirements linkage sweep optima limits fits match flux_map current_losses gap_stress gearbox winding drive braking magnets mechanics losses heat fields outcome tolerances uncertainty package ride energy judged strategies quarter_car bench chapters

# Every solve runs on one thread; the sweep keeps the cores busy with designs.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

.PHONY: help pipeline $(STAGES) optimise inspect check compare diagnose ledger test benchmark blind-score clean
.DEFAULT_GOAL := help

help:
	@echo "make pipeline   all stages, results in results/<study>/ (report.html first)"
	@echo "make <stage>    one stage with those before it: $(STAGES)"
	@echo "make optimise   radius, slots, length, ratio and linkage together, beside the stage-by-stage design"
	@echo "make chapters   chapters 4 and 5 of the thesis with the designed actuator, beside the printed tables"
	@echo "make inspect    the machine and its field in a window, or as PNG and HTML without a display"
	@echo "make check      is the study file usable?"
	@echo "make compare    where does the model fail against the bench data in CAMPAIGN=<folder>?"
	@echo "make diagnose   which effect is missing, how sure, what to measure next?"
	@echo "make ledger     add what is missing, step by step, until nothing is"
	@echo "make test       all tests"
	@echo "make benchmark  speed and accuracy against other codes"
	@echo "make blind-score  how often the diagnosis is right, on campaigns made by other laws"
	@echo "make clean      delete the results of all studies (not results/reference)"
	@echo "STUDY=<name>    another study than $(STUDY): a file of studies/ or machines/, or a path"

pipeline: $(SET_UP)
	@.venv/bin/airgap run "$(STUDY)"

# One process runs a stage with those before it; what did not change is not run again.
$(STAGES) optimise: $(SET_UP)
	@.venv/bin/airgap run "$(STUDY)" --to $@

inspect: $(SET_UP)
	@.venv/bin/airgap inspect "$(STUDY)"

check: $(SET_UP)
	@.venv/bin/airgap check "$(STUDY)"

compare diagnose ledger: $(SET_UP)
	@test -n "$(CAMPAIGN)" || { echo "say which campaign: make $@ CAMPAIGN=measurements/<folder>" >&2; exit 2; }
	@.venv/bin/airgap $@ "$(CAMPAIGN)"

test: $(SET_UP)
	$(PYTHON) -m pytest

BENCHMARK_SET_UP := .venv-benchmark/.set-up

benchmark: $(SET_UP) $(BENCHMARK_SET_UP)
	$(PYTHON) -m benchmarks.other_codes
	$(PYTHON) -m benchmarks.other_kinds
	$(PYTHON) -m benchmarks.speed

blind-score: $(SET_UP)
	$(PYTHON) -m benchmarks.blind_score

$(BENCHMARK_SET_UP): benchmarks/peer_requirements.txt benchmarks/set_up
	@sh benchmarks/set_up

clean:
	find results -mindepth 1 -maxdepth 1 ! -name reference ! -name README.md -exec rm -rf {} +
	find . -path ./.venv -prune -o \( -name __pycache__ -o -name ".*_cache" \) -type d -exec rm -rf {} +

$(SET_UP): pyproject.toml constraints.txt pipeline/setup
	@sh pipeline/setup
