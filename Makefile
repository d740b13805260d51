# `make demo` and `make test` do all their own set-up. See README.md.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.alula
CORE := $(shell find core/include bindings -name '*.hpp' -o -name '*.cpp') CMakeLists.txt pyproject.toml

.PHONY: build demo test bench verify lint core-test clean
build: $(STAMP)

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet "scikit-build-core>=0.11" "nanobind>=2.4" "cmeel-eigen>=3.4" "cmake>=3.25" ninja

# Editable, without isolation: the build tools stay in the environment, so a rebuild finds them.
$(STAMP): $(BIN)/python $(CORE)
	PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python -m pip install --quiet --no-build-isolation --editable ".[test]"
	@touch $(STAMP)

demo: $(STAMP)
	@$(BIN)/python examples/demo/demo.py

test: $(STAMP)
	$(BIN)/python -m pytest -m "not slow"

bench: $(STAMP)
	$(BIN)/python -m pip install --quiet ".[bench]" --no-build-isolation --editable ".[bench]"
	$(BIN)/python benchmarks/bench.py

verify: $(STAMP)
	$(BIN)/python benchmarks/verify.py

lint: $(STAMP)
	$(BIN)/python -m pip install --quiet "ruff>=0.6" "mypy>=1.11" "import-linter>=2.0" pandas-stubs scipy-stubs clang-format
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

clean:
	rm -rf build $(VENV)
