# Each target does all of its own set-up: a fresh machine needs Python 3.10+, pip or venv, and make.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Halves of the list, not turns: what a module shares is made once then.
PYTEST_ARGS ?= -n auto --dist worksteal

.PHONY: demo test lint typecheck typecheck-tools pytest fuzz sweep day attacks layout native docs site lock wasm runtimes node wheel clean

demo: $(VENV)/.tools wasm  ## the whole job on built-in input, no hardware
	$(BIN)/zerorate demo

test: lint typecheck typecheck-tools pytest  ## everything that CI runs

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell

# Kernels have rules of their own (host_tests/runtimes/test_kernel_rules.py), and machine code has no types.
FIRMWARE := $(shell find firmware/zerorate -name '*.py')
KERNELS := $(shell grep -lrE --include='*.py' '^ptr(8|32) = None' firmware/zerorate)
MACHINE_CODE := $(wildcard firmware/zerorate/native/*.py)
BOARD := $(sort $(filter-out $(KERNELS) $(MACHINE_CODE),$(FIRMWARE)) \
	$(filter-out %/linux.py,$(wildcard drivers/zerorate_i2c/*.py)))

typecheck: $(VENV)/.dev $(VENV)/.board-stubs
	$(BIN)/mypy --config-file mypy-board.ini $(BOARD)

typecheck-tools: $(VENV)/.dev  ## the host tools
	$(BIN)/mypy

pytest: $(VENV)/.dev runtimes
	$(BIN)/python -m pytest $(PYTEST_ARGS)

FUZZ ?= 3000
fuzz: $(VENV)/.dev  ## every reader of files against FUZZ damaged ones each; what fails is kept
	ZERORATE_FUZZ=$(FUZZ) $(BIN)/python -m pytest host_tests/hostile -k any $(PYTEST_ARGS)

SWEEP ?= 10000
sweep: $(VENV)/.dev  ## SWEEP random sensors and settings: does anything leave 31 bits?
	$(BIN)/python -m host_tests.firmware.sweep --configurations $(SWEEP)

day: $(VENV)/.dev  ## examples/main.py for a simulated day: 200 resets, 200 times pulled out
	$(BIN)/python -m host_tests.boards.day

ATTACK = ZERORATE_FUZZ=200 $(BIN)/python -m pytest -q -p no:cacheprovider
attacks: $(VENV)/.dev  ## every attack of docs/faults.md, until one succeeds
	$(ATTACK) host_tests/drivers/test_faults.py
	$(ATTACK) host_tests/firmware -k 'test_store or test_places'
	$(BIN)/python -m host_tests.turned_words --on x86 --on armhf
	$(ATTACK) host_tests/tools -k 'test_model or test_atomic or test_drafts or test_growing'
	$(ATTACK) host_tests/hostile -k any
	$(BIN)/python -m host_tests.hostile.many_logs
	$(ATTACK) -s host_tests/hostile/test_guarded.py -k "end or page or mat or sidecar"
	$(BIN)/python -m host_tests.tools.killed_writers
	$(BIN)/python -m host_tests.tools.killed_recorders
	$(ATTACK) host_tests/report/test_page.py host_tests/fleet/test_population.py -k name
	$(BIN)/python -m host_tests.firmware.sweep
	$(ATTACK) host_tests/service
	$(BIN)/python -m host_tests.boards.day

layout: $(VENV)/.dev  ## write the constants of tools/zerorate_tools/layout where they are used
	$(BIN)/python -m host_tests.layout.page

native: layout  ## write firmware/zerorate/native from the kernels
	$(BIN)/python -m zerorate_bench.native.native_files

docs: $(VENV)/.dev wasm  ## write what in docs/ and README.md is made by a command
	$(BIN)/python -m host_tests.docs.outputs

site: $(VENV)/.dev  ## docs/ as a site in site/, with search; site/index.html opens from disk
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict

wasm: $(VENV)/.tools node
	$(BIN)/zerorate runtimes get wasm

# What cannot be had is left out by the tests, which say so; ZERORATE_REQUIRE makes them fail.
runtimes: $(VENV)/.dev node
	-$(BIN)/zerorate runtimes get wasm x86 armhf x64 rp2040

node: $(VENV)/.tools
	-@$(BIN)/zerorate runtimes node >/dev/null 2>&1 || \
		$(PIP) -r requirements/node.txt

# Python compiles what it imports; pip would compile all that it installs, for as long as it fetches.
PIP := $(BIN)/python -m pip install --quiet --no-compile

# Without ensurepip (Debian's python3 without python3-venv) the machine's own pip fills the folder.
$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || \
		{ echo "zerorate needs Python 3.10 or newer; name one: make PYTHON=python3.12 ..."; exit 1; }
	$(PYTHON) -m venv $(VENV) || { $(PYTHON) -m venv --without-pip --clear $(VENV) && \
		$(PYTHON) -m pip --python $@ install pip; }

$(VENV)/.tools: requirements/tools.txt pyproject.toml | $(BIN)/python
	@echo "Fetching the tools' Python packages into $(VENV), 225 MB, once"
	$(PIP) -r requirements/tools.txt
	$(PIP) --no-deps --no-build-isolation -e .
	touch $@

$(VENV)/.dev: requirements/dev.txt $(VENV)/.tools
	@echo "Fetching what the tests need, once"
	$(PIP) -r requirements/dev.txt
	touch $@

$(VENV)/.board-stubs: requirements/dev.txt $(VENV)/.dev
	rm -rf $(VENV)/board-stubs
	$(PIP) --no-deps --target $(VENV)/board-stubs \
		$$(grep -oE '^micropython-(rp2|stdlib)-stubs==[^ ;]+' requirements/dev.txt)
	touch $@

# The two locks agree: the larger one is resolved under the smaller one's versions.
COMPILE := uv pip compile --quiet --universal --python-version 3.10 --no-header
lock: $(VENV)/.dev  ## resolve the lock files again
	$(BIN)/$(COMPILE) pyproject.toml requirements/build.in --extra tools -o requirements/tools.txt
	$(BIN)/$(COMPILE) pyproject.toml --all-extras -c requirements/tools.txt -o requirements/dev.txt
	$(BIN)/$(COMPILE) requirements/node.in -o requirements/node.txt

$(VENV)/.build: requirements/dev.txt | $(BIN)/python
	$(PIP) -c requirements/dev.txt hatchling numpy pyarrow ziglang
	touch $@

wheel: $(VENV)/.build  ## dist/*.whl and dist/*.tar.gz
	PYTHONPATH=tools:firmware:drivers $(BIN)/python -m zerorate_tools.kernels.library
	$(BIN)/python -m hatchling build -d dist

clean:
	rm -rf $(VENV) dist site .mypy_cache .ruff_cache .pytest_cache .hypothesis
