# Every target makes the environment that it needs from nothing: plain python3 (3.11 or newer) and wheels.
PYTHON ?= python3
JOBS ?= 2
DEVICE ?= cpu
DEMO := .venv-demo
TEST := .venv-test
DOCS := .venv-docs
# Without bytecode every process would compile all sources again, and pytest all tests.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help demo test test-slow test-pages test-processors test-mpi test-gpu test-view coverage check lint bench bench-page bench-check bench-smoke kills manual fuzz drops endurance docs clean

help:
	@echo "make demo   both examples and the drop of a part: tables, and pictures in demo/"
	@echo "make test   unit tests, verification cases, doctests"
	@echo "make test-slow  those that take long: many impacts, fine meshes, kills, sweeps, every command of the pages"
	@echo "make test-pages  what takes minutes: commands of the pages, every scenario as shipped, more seeds and values, a fresh clone to its first picture"
	@echo "make test-processors  tests that decide by numbers with the instructions of several processors, into docs/verification/processors.md; SETS=nehalem for one"
	@echo "make test-mpi  installs mpi4py and MPICH, and compares runs on 1, 2 and 4 processes bit by bit"
	@echo "make test-gpu  installs Warp, and compares its kernels with those of the processor: on the processor, or on a CUDA device with DEVICE=cuda:0"
	@echo "make test-view the page of softway view in a Chromium without a screen, which has to be there"
	@echo "make coverage  the same, with the lines and branches that did not run"
	@echo "make check  ruff, mypy, import-linter, house rules"
	@echo "make lint   the same without the house rules, which are tests of make test"
	@echo "make bench  all measurements: docs/verification/benchmarks.md and benchmarks/results/latest.json; BENCH=--quick for a few"
	@echo "make bench-check  a few measurements against the stored ones: fails where a ratio got worse by a fifth"
	@echo "make bench-page   the page without the figures of code that has changed since, in a second"
	@echo "make bench-smoke  every figure with the smallest meshes, in a minute or two: whether all of them still run"
	@echo "make kills  runs killed at 50 random instants, resumed and compared bit by bit: KILLS='--kills 500 --seed 2' for more"
	@echo "make manual  all verification cases: docs/verification/manual.md, and docs/_build/verification.html with curves"
	@echo "make fuzz   ten thousand damaged inputs, and five thousand scenarios, meshes and decks mutated by meaning, into docs/verification/robustness.md"
	@echo "make drops  five hundred random drops, two hundred with rigid bodies, two hundred assemblies, into the same page"
	@echo "make endurance  a hundred thousand slabs with all records, and their memory, into the same page"
	@echo "make docs   pages, reference and examples as HTML in docs/_build/html, none of which needs the network"

# $(call environment,folder,extras): the file "ready" comes last, so that an interrupted installation is repeated
define environment
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "softway needs Python 3.11 or newer")'
	test -x $(1)/bin/python || $(PYTHON) -m venv $(1)
	$(1)/bin/python -m pip install --quiet --constraint constraints.txt --editable '.$(2)'
	touch $(1)/ready
endef

$(DEMO)/ready: pyproject.toml constraints.txt
	$(call environment,$(DEMO),)

$(TEST)/ready: pyproject.toml constraints.txt
	$(call environment,$(TEST),[dev])

$(DOCS)/ready: pyproject.toml constraints.txt
	$(call environment,$(DOCS),[docs])

demo: $(DEMO)/ready
	$(DEMO)/bin/python examples/demo.py

test: $(TEST)/ready
	$(TEST)/bin/python -m pytest -n $(JOBS) --dist loadscope -m "not slow and not minutes"

test-slow: $(TEST)/ready
	$(TEST)/bin/python -m pytest -n $(JOBS) --dist loadscope -m "slow and not minutes" --durations=15

test-pages: $(TEST)/ready
	$(TEST)/bin/python -m pytest -n $(JOBS) -m minutes --durations=0

test-processors: $(TEST)/ready
	$(TEST)/bin/python tests/robustness/processors.py $(SETS) --jobs $(JOBS) --out docs/verification/robustness/processors.json

test-mpi: $(TEST)/ready
	$(TEST)/bin/python -m pip install --quiet --constraint constraints.txt --editable '.[dev,mpi]' mpich
	@$(TEST)/bin/python -c 'import petsc4py' 2>/dev/null || echo "petsc4py is not installed: its tests are skipped (docs/reference/runs/cluster.md#petsc)"
	$(TEST)/bin/python -m pytest -q tests/unit/ranks/test_processes.py tests/unit/ranks/test_petsc.py

test-gpu: $(TEST)/ready
	$(TEST)/bin/python -m pip install --quiet --constraint constraints.txt --editable '.[dev,gpu]'
	SOFTWAY_TEST_DEVICE=$(DEVICE) $(TEST)/bin/python -m pytest -q tests/unit/solve/device

test-view: $(TEST)/ready
	$(TEST)/bin/python -m pip install --quiet --constraint constraints.txt --editable '.[dev,browser]'
	$(TEST)/bin/python -m pytest -q tests/unit/apps/viewer

coverage: $(TEST)/ready
	$(TEST)/bin/python -m pytest -n $(JOBS) --dist loadscope -m "not minutes" --cov --cov-report=term-missing:skip-covered

check: lint
	$(TEST)/bin/python -m pytest -q tests/house

lint: $(TEST)/ready
	$(TEST)/bin/ruff check .
	$(TEST)/bin/ruff format --check .
	$(TEST)/bin/mypy
	$(TEST)/bin/lint-imports

bench: $(TEST)/ready
	$(TEST)/bin/python benchmarks/run.py $(BENCH)

bench-check: $(TEST)/ready
	$(TEST)/bin/python benchmarks/run.py --quick --check

bench-page: $(TEST)/ready
	$(TEST)/bin/python benchmarks/run.py --page

bench-smoke: $(TEST)/ready
	$(TEST)/bin/python benchmarks/run.py --smoke

kills: $(TEST)/ready
	$(TEST)/bin/python tests/robustness/kills.py $(KILLS)

manual: $(TEST)/ready
	mkdir -p docs/_build
	$(TEST)/bin/softway verify --jobs $(JOBS) --json docs/_build/verification.json --out docs/_build/verification.html || test $$? -eq 1
	$(TEST)/bin/python docs/scripts/manual.py docs/_build/verification.json docs/verification/manual.md

fuzz: $(TEST)/ready
	$(TEST)/bin/python tests/robustness/fuzz.py --out docs/verification/robustness/fuzz.json
	$(TEST)/bin/python tests/robustness/page.py

drops: $(TEST)/ready
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(TEST)/bin/python -W ignore tests/robustness/run_drops.py 500 --jobs $(JOBS) --out docs/verification/robustness/drops.jsonl
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(TEST)/bin/python -W ignore tests/robustness/run_drops.py 100 --adapt --seconds 900 --jobs $(JOBS) --out docs/verification/robustness/adapted_drops.jsonl
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(TEST)/bin/python -W ignore tests/robustness/run_drops.py 200 --rigid --jobs $(JOBS) --out docs/verification/robustness/rigid_drops.jsonl
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(TEST)/bin/python -W ignore tests/robustness/run_drops.py 200 --assemblies --jobs $(JOBS) --out docs/verification/robustness/assemblies.jsonl
	$(TEST)/bin/python tests/robustness/page.py

endurance: $(TEST)/ready
	$(TEST)/bin/python tests/robustness/endurance.py 100000 --out docs/verification/robustness/endurance.json
	$(TEST)/bin/python tests/robustness/page.py

docs: $(DOCS)/ready
	$(DOCS)/bin/sphinx-build --fail-on-warning --keep-going -q -b html docs docs/_build/html

clean:
	rm -rf $(DEMO) $(TEST) $(DOCS) docs/_build docs/examples demo
