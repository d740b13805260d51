# `make demo` and `make test` do all their own set-up. See README.md.
PYTHON ?= python3
JOBS ?= $(shell getconf _NPROCESSORS_ONLN)
VENV := .venv
BIN := $(VENV)/bin
# host: the core for this machine's processor alone, in half the time. all: for others, too, as a
# wheel has it; once built so, it stays so.
INSTRUCTION_SETS ?= $(if $(wildcard $(VENV)/.alula-all),all,host)
STAMP := $(VENV)/.alula-$(INSTRUCTION_SETS)
CPP := $(shell find core bindings -name '*.hpp' -o -name '*.cpp')
CORE := $(shell find core/include core/host bindings -name '*.hpp' -o -name '*.cpp') CMakeLists.txt pyproject.toml

.PHONY: build demo test bench verify lint core-test stubs format clean
build: $(STAMP)

# A set-up that was interrupted starts over.
.DELETE_ON_ERROR:

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit("Alula needs Python 3.11 or newer; name it: make demo PYTHON=python3.12" if sys.version_info < (3, 11) else 0)'
	@echo "Setting up $(VENV), once; all of it takes a few minutes."
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet "scikit-build-core>=0.11" "nanobind>=2.4" "cmeel-eigen>=3.4" "cmake>=3.25" ninja

# Editable, without isolation: the build tools stay in the environment, so a rebuild finds them.
$(VENV)/.alula-%: $(BIN)/python $(CORE)
	@echo "Building the core and installing what it needs."
	PATH="$(CURDIR)/$(BIN):$$PATH" CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) $(BIN)/python -m pip install --quiet --no-build-isolation --editable ".[test]" \
		--config-settings=cmake.define.ALULA_INSTRUCTION_SETS=$* \
		--config-settings=build-dir=build/$*
	@rm -f $(VENV)/.alula-*
	@touch $@

demo: $(STAMP)
	@$(BIN)/python examples/demo/demo.py

test: $(STAMP)
	$(BIN)/python -m pytest -m "not slow" --numprocesses auto --maxprocesses 8 --dist loadfile

# With both instruction sets. numba is the peer that the filters are measured against; the other
# peers are optional.
bench: $(VENV)/.alula-all
	@$(BIN)/python -c "import numba" 2>/dev/null || $(BIN)/python -m pip install --quiet "numba>=0.60"
	$(BIN)/python benchmarks/bench.py

verify: $(VENV)/.alula-all
	@$(BIN)/python -c "import numba" 2>/dev/null || $(BIN)/python -m pip install --quiet "numba>=0.60"
	$(BIN)/python benchmarks/verify.py

lint: $(STAMP)
	@$(BIN)/python -m pip install --quiet "ruff>=0.6" "mypy>=1.11" "import-linter>=2.0" pandas-stubs scipy-stubs "clang-format==23.1.5"
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	@$(BIN)/clang-format --dry-run -Werror $(CPP)

# C++ tests of the core, GoogleTest from the system. Where it is missing they are skipped and say
# so; with ALULA_REQUIRE_DATA set that is a failure.
core-test: $(BIN)/python
	@$(BIN)/cmake -S . -B build/core-tests -DALULA_PYTHON=OFF -DALULA_TESTS=ON -DCMAKE_BUILD_TYPE=Release
	@$(BIN)/cmake --build build/core-tests --parallel $(JOBS)
	@$(BIN)/ctest --test-dir build/core-tests --output-on-failure $(if $(ALULA_REQUIRE_DATA),--no-tests=error)

# The committed description of the compiled core, as its build gives it.
stubs: $(STAMP)
	$(BIN)/python -m nanobind.stubgen -q -m alula._core -o src/alula/_core.pyi

format: $(STAMP)
	$(BIN)/ruff format .
	$(BIN)/clang-format -i $(CPP)

clean:
	rm -rf build $(VENV)
