# The data flow as rules. STUDY is the name of a file in studies/ or the path of one.
STUDY ?= motorcycle

PYTHON := .venv/bin/python
SET_UP := .venv/.set-up
# One script pipeline/<stage>.py a stage; a stage whose inputs did not change says so and ends.
STAGES := sweep optima limits fits match winding fields figures report

# Every solve runs on one thread; the sweep keeps the cores busy with designs.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

.PHONY: help pipeline $(STAGES) losses flux_map inspect check test benchmark clean
.DEFAULT_GOAL := help

help:
	@echo "make pipeline   all stages, results in results/<study>/ (report.html first)"
	@echo "make <stage>    one stage with those before it: $(STAGES)"
	@echo "make losses     loss and efficiency map of the wound machine"
	@echo "make flux_map   flux linkage over current of the wound machine, with export"
	@echo "make inspect    the machine and its field in a window, or as PNG and HTML without a display"
	@echo "make check      is the study file usable?"
	@echo "make test       all tests"
	@echo "make benchmark  speed and accuracy against other codes"
	@echo "make clean      delete the results of all studies (not results/reference)"
	@echo "STUDY=<name>    another study than $(STUDY): a file of studies/ or a path"

pipeline: report

# What a stage reads is written by the stages on the right.
sweep: $(SET_UP)
optima: sweep
limits: $(SET_UP)
fits: optima
match: fits
winding: match
fields: winding
figures: fields limits
report: figures

$(STAGES):
	@$(PYTHON) -m pipeline.$@ "$(STUDY)"

losses flux_map: winding
	@$(PYTHON) -m pipeline.$@ "$(STUDY)"

inspect: $(SET_UP)
	@$(PYTHON) -m pipeline.inspect_fields "$(STUDY)"

check: $(SET_UP)
	@$(PYTHON) -m study.check "$(STUDY)"

test: $(SET_UP)
	$(PYTHON) -m pytest

BENCHMARK_SET_UP := .venv-benchmark/.set-up

benchmark: $(SET_UP) $(BENCHMARK_SET_UP)
	$(PYTHON) -m benchmarks.other_codes
	$(PYTHON) -m benchmarks.speed

$(BENCHMARK_SET_UP): benchmarks/peer_requirements.txt benchmarks/set_up
	@sh benchmarks/set_up

clean:
	find results -mindepth 1 -maxdepth 1 ! -name reference ! -name README.md -exec rm -rf {} +
	find . -path ./.venv -prune -o \( -name __pycache__ -o -name .pytest_cache \) -type d -exec rm -rf {} +

$(SET_UP): pyproject.toml constraints.txt pipeline/setup
	@sh pipeline/setup
