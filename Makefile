# bumpstop: build, run and test. It needs Python 3.11+ with venv and a Rust toolchain, no more.
# Everything is installed in .venv; stamps beside it say what is up to date.

VENV   := .venv
BIN    := $(VENV)/bin
STAMPS := $(VENV)/stamps
CASE   := cases/sdnl32/case.toml
OUT    := out/sdnl32

PIP   := $(BIN)/python -m pip
CARGO := cargo
# Also for the pip that maturin calls.
export PIP_QUIET := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1
# Compilers that rustup put in its usual place are found even where the shell's profile forgot them.
export PATH := $(PATH):$(HOME)/.cargo/bin
export PYO3_PYTHON := $(CURDIR)/$(BIN)/python

PYTHON_SOURCES := $(shell find python -name '*.py')
# The folders are listed too: a file taken away changes nothing else.
CORE_SOURCES := Cargo.toml Cargo.lock pyproject.toml $(shell find crates)

.PHONY: help run test lint format bench docs wheel clean distclean
.DEFAULT_GOAL := help

help: ## Say what can be made
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 12

run: $(STAMPS)/byte-code ## Compute the validation case SDNL32 and write its report
	@$(BIN)/bumpstop run $(CASE) --out $(OUT)
	@echo "Open $(OUT)/report.html in a browser."

# The tests in Rust are compiled for this machine alone, which gives the same bits; those in Python
# have the core as it is shipped.
test: lint ## Check style and types, then run all tests
	RUSTFLAGS="-C target-cpu=native" $(CARGO) test --locked --quiet --package bumpstop-core
	$(BIN)/python -m pytest -n 2

lint: $(STAMPS)/core $(STAMPS)/dev ## Check style and types of Python and Rust
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(CARGO) fmt --check
	$(CARGO) clippy --locked --quiet --workspace --all-targets -- -D warnings

format: $(STAMPS)/dev ## Bring Python and Rust into the house style
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(CARGO) fmt

# numbalsoda comes as source: pip builds it with cmake and a Fortran compiler.
bench: $(STAMPS)/byte-code $(STAMPS)/dev $(STAMPS)/bench ## Measure the speed beside other solvers
	$(BIN)/python benchmarks/sdnl32.py
	$(BIN)/python benchmarks/batch.py
	$(BIN)/python benchmarks/bifurcation.py
	$(BIN)/python benchmarks/several_stops.py
	$(BIN)/python benchmarks/startup.py
	$(BIN)/python benchmarks/eigen.py
	$(BIN)/python benchmarks/assembly.py
	$(BIN)/python benchmarks/full_model.py
	$(BIN)/python benchmarks/explicit_step.py
	$(BIN)/python benchmarks/friction.py

docs: $(STAMPS)/core $(STAMPS)/docs ## Build the documentation, running its examples
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet \
		--fresh-env --write-all docs docs/_build/html
	@echo "Documentation: docs/_build/html/index.html"

wheel: $(STAMPS)/run ## Build the wheel and try it in an environment of its own
	@sh tools/require-rust
	rm -rf dist target/wheel-check
	$(BIN)/maturin build --release --locked --quiet --out dist
	$(BIN)/python -m venv target/wheel-check
	target/wheel-check/bin/python -m pip install --requirement requirements/run.txt dist/*.whl
	target/wheel-check/bin/bumpstop run $(CASE) --out target/wheel-check/out
	@ls dist/*.whl

clean: ## Remove what was computed and built, but not .venv and the Rust build
	rm -rf out dist docs/_build .mypy_cache .ruff_cache .pytest_cache .hypothesis

distclean: clean ## Remove also .venv and the Rust build
	rm -rf $(VENV) target
	rm -f python/bumpstop/_core*.so python/bumpstop/_core*.pyd

$(STAMPS)/venv:
	@sh tools/require-rust
	@python=$$(PYTHON='$(PYTHON)' sh tools/find-python) && \
		echo "Making $(VENV) with $$python" && "$$python" -m venv $(VENV)
	@mkdir -p $(STAMPS) && touch $@

$(STAMPS)/%: requirements/%.txt $(STAMPS)/venv
	@echo "Installing $<"
	@$(PIP) install --requirement $<
	@touch $@

$(STAMPS)/core: $(STAMPS)/run $(CORE_SOURCES)
	@sh tools/require-rust
	@echo "Building the Rust core (this takes some minutes)"
	@mkdir -p target
	@env -u CONDA_PREFIX VIRTUAL_ENV='$(CURDIR)/$(VENV)' \
		$(BIN)/maturin develop --release --locked --quiet >target/build.log 2>&1 || \
		{ cat target/build.log; exit 1; }
	@touch $@

# As pip does with what it installs: where Python may not write byte code, or has not yet, a run takes half as long again.
$(STAMPS)/byte-code: $(STAMPS)/core $(PYTHON_SOURCES)
	@$(BIN)/python -m compileall -q python
	@touch $@
