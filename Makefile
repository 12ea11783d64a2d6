# Every target makes what it needs: python3 (3.11 or newer, with venv) and make are enough.
# On Windows, in the shell that Git brings (Git Bash).
ifeq ($(OS),Windows_NT)
PYTHON ?= python
BIN := .venv/Scripts
else
PYTHON ?= python3
BIN := .venv/bin
endif
READY := .venv/ready

# Hundreds of tests start processes: each would compile all sources of Python again
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help demo test test-long test-all durations quick lint check site tutorials sketches films bench \
  test-gpu bench-gpu validate parts clean
help:
	@echo "make demo      run a channel flow and draw it with the theory"
	@echo "make test      run the tests but the long ones: half an hour on two cores"
	@echo "make test-long run the long ones; make test-all runs all, with further kinds on devices"
	@echo "make durations print the slowest tests of the last time, and what each folder takes"
	@echo "make quick     run the tests that simulate nothing: cases, theory, statistics, documents"
	@echo "make lint      lint and types"
	@echo "make check     the same, import rules, and that the physics compiles for a GPU"
	@echo "make site      write the documentation as a site: build/site/index.html"
	@echo "make tutorials run the notebooks of docs/tutorials and store what they show"
	@echo "make sketches  draw the sketches of the guide"
	@echo "make films     make the films of README"
	@echo "make bench     measure the speed, side by side with LAMMPS"
	@echo "make test-gpu  run the tests that need a card; DEVICE=emulated rehearses them without one"
	@echo "make bench-gpu measure the speed of a card, kernel by kernel"
	@echo "make validate  write docs/validation: measured against theory, law by law"
	@echo "make parts     compile the parts that a wheel brings, for this Python and system"
	@echo "make clean     remove what these made"

$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "mesokit needs python 3.11 or newer: make PYTHON=/path/to/python3"; exit 1; }
	@echo "installing into .venv (once; a minute or two)"
	@$(PYTHON) -m venv --clear .venv
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	@touch $(READY)

# A clone makes the parts of all templates and examples once its first run has ended, at the lowest
# priority: beside it, two processes would want the same cores and the same kernels.
WARM := build/warm.log
demo: $(READY)
	@$(BIN)/python -c 'import shutil; shutil.rmtree("demo", ignore_errors=True)'
	@$(BIN)/mesokit run src/mesokit/method/mpcd/templates/poiseuille.toml --output demo
	@echo "look at demo/velocity-profile.png"
	@mkdir -p build
	@[ -e $(WARM) ] || echo "compiling other kinds of case in the background, once; see $(WARM)"
	@[ -e $(WARM) ] || nohup nice -n 19 $(BIN)/mesokit warm --all </dev/null >$(WARM) 2>&1 &

TEST := $(BIN)/python -m pytest -n 2 --dist worksteal
# What each test takes: tables that CI prints and keeps
DURATIONS := -p tests.durations --durations-file build/durations
test: $(READY)
	@$(TEST) $(DURATIONS)/test.csv -m "not long"
test-long: $(READY)
	@$(TEST) $(DURATIONS)/test-long.csv -m "long and not further"
test-all: $(READY)
	@$(TEST) $(DURATIONS)/test-all.csv
durations:  # no $(READY): CI prints them also when something failed
	@$(BIN)/python tests/durations.py build/durations/*.csv

QUICK := tests/architecture tests/case tests/theory tests/statistics tests/docs/test_documents.py
quick: $(READY)
	@$(TEST) -m "not long" $(QUICK)

lint: $(READY)
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/mypy

check: lint
	@$(TEST) tests/architecture tests/gpu

site: export NO_MKDOCS_2_WARNING = 1
site: $(READY)
	@$(BIN)/python -m mkdocs build --strict --quiet
	@echo "look at build/site/index.html"

tutorials: $(READY)
	@$(BIN)/python docs/generate/run_tutorials.py

sketches: $(READY)
	@$(BIN)/python docs/generate/sketches.py

films: $(READY)
	@$(BIN)/python docs/generate/films.py

bench: $(READY)
	@$(BIN)/python -m benchmarks

# The first card; DEVICE=cuda:1 is the second
DEVICE ?= cuda
test-gpu: $(READY)
	@MESOKIT_TEST_DEVICE=$(DEVICE) $(BIN)/python -m pytest -rs tests/on_card

bench-gpu: $(READY)
	@$(BIN)/python -m benchmarks.gpu --device $(DEVICE)

validate: $(READY)
	@$(BIN)/python validation/all.py

# What a wheel for this Python and system brings, so that a first run compiles little of its own.
# Begun from nothing: what an older file has would not be made again, and old parts would be shipped.
PARTS := src/mesokit/kernels/shipped
parts: export NUMBA_CACHE_DIR := build/parts
parts: $(READY)
	@rm -rf build/parts $(PARTS)
	@$(BIN)/mesokit warm --all --quiet
ifneq ($(OS),Windows_NT)  # which has no MPI
	@$(BIN)/mesokit warm --all --quiet --ranks 2
endif
	@$(BIN)/mesokit cache --export "$(PARTS)/$$($(BIN)/python -c 'from mesokit.kernels.kept import era; print(era())').sqlite"

clean:
	@rm -rf .venv demo build/validation build/parts $(WARM) $(PARTS)
