# `make demo` shows what this is about; `make test` is what every change has to pass.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: help demo test tools proofs mutants mutants-code readers check format regenerate constraints bench bench-compare playground clean

help:
	@echo "make demo        install what is needed into $(VENV) and show the main job on a mobile robot"
	@echo "make test        install the development tools too; lint, types, import walls, tests"
	@echo "make check       all of that but the tests"
	@echo "make tools       install tools that some tests of exports need, which are skipped without them"
	@echo "make proofs      compile the theorems in proofs/coq, and that of every example's policy (needs Coq)"
	@echo "make mutants     20,000 changed policies, certificates and specifications through every prover (half an hour)"
	@echo "make mutants-code  300 faults in the trusted base, each through the tests meant for it (ten minutes)"
	@echo "make readers     25,000 damaged specifications, policies and certificates through both readers (ten minutes)"
	@echo "make format      put the sources into shape"
	@echo "make regenerate  write proofs/ and the generated tables anew"
	@echo "make constraints  write constraints.txt anew: the versions that are installed in $(VENV)"
	@echo "make bench       measure every family of benchmarks/ (minutes; ARGUMENTS=--quick: about one)"
	@echo "make bench-compare  the last two full measurements, with what became worse"
	@echo "make playground  the package in a browser, as static files in playground/build (needs npm)"
	@echo "make clean       remove $(VENV) and all caches"

demo: $(VENV)/.runtime
	@BIN="$(abspath $(BIN))" sh examples/demo.sh

check: $(VENV)/.development
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/mypy --strict proofs/checker.py
	$(BIN)/lint-imports

# Byte code is written whatever the environment says: tests start the program some hundred times.
test: export PYTHONDONTWRITEBYTECODE =
test: check
	$(BIN)/python -m pytest -n auto --dist worksteal

tools: $(VENV)/.development
	@$(BIN)/python -c '$(GROUP)' tools <pyproject.toml >$(VENV)/tools.txt
	$(INSTALL) -r $(VENV)/tools.txt
	@$(BIN)/python -m tests.export.install

proofs: $(VENV)/.development
	@$(BIN)/python -m tests.export

mutants: $(VENV)/.development
	$(BIN)/python -m tests.mutants $(ARGUMENTS)

mutants-code: $(VENV)/.development
	$(BIN)/python -m tests.mutants_code $(ARGUMENTS)

format: $(VENV)/.development
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

readers: $(VENV)/.development
	$(BIN)/python -m tests.readers $(ARGUMENTS)

regenerate: $(VENV)/.development
	$(BIN)/python -m tests.repo.regenerate

constraints: $(VENV)/.development
	@{ head -n 1 constraints.txt; $(BIN)/python -m pip freeze --all --exclude-editable --disable-pip-version-check | grep -v '^pip=='; } \
	  >$(VENV)/constraints.txt && mv $(VENV)/constraints.txt constraints.txt

bench: $(VENV)/.development
	$(BIN)/python -m benchmarks.run $(ARGUMENTS)

bench-compare: $(VENV)/.development
	$(BIN)/python -m benchmarks.compare $(ARGUMENTS)

playground: $(VENV)/.runtime playground/node_modules/.package-lock.json
	$(BIN)/python -m playground.assemble

playground/node_modules/.package-lock.json: playground/package.json playground/package-lock.json
	npm ci --prefix playground --no-audit --no-fund
	@touch $@

clean:
	rm -rf $(VENV) build dist playground/build playground/node_modules .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis

# Stamps: what is installed is installed again only when pyproject.toml or constraints.txt changes.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt
GROUP := import sys, tomllib; print(*tomllib.load(sys.stdin.buffer)["dependency-groups"][sys.argv[1]], sep="\n")

$(VENV)/.made:
	@$(PYTHON) -c 'import sys; sys.exit(None if sys.version_info >= (3, 11) else "Python 3.11 or newer is needed (make PYTHON=…)")'
	$(PYTHON) -m venv $(VENV)
	@touch $@

$(VENV)/.runtime: pyproject.toml constraints.txt | $(VENV)/.made
	$(INSTALL) -e .
	$(BIN)/python -m compileall -q tumato_symbolic
	@touch $@

$(VENV)/development.txt: pyproject.toml | $(VENV)/.made
	@$(BIN)/python -c '$(GROUP)' dev <pyproject.toml >$@.new && mv $@.new $@

$(VENV)/.development: pyproject.toml constraints.txt $(VENV)/development.txt | $(VENV)/.made
	$(INSTALL) -e . -r $(VENV)/development.txt
	$(BIN)/python -m compileall -q tumato_symbolic
	@touch $@ $(VENV)/.runtime
