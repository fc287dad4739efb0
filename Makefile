# make setup   makes .venv: a Python 3.13 or 3.11, the bpy that fits it, and all that requirements/dev.txt pins
# make demo    sets up, builds, and colorizes the example in examples/cones; the results are in demo/
# make test    sets up, checks style and types, builds the zip and tests it (in CI with every Python that is there)
# make test-window  tests in the window of a real Blender: BLENDER=/path/to/blender names one
# make test-no-network  the tests that need no Blender, under a library that refuses sockets (tools/test_no_network.sh)
# make build   the extension's zip for this machine and this Python, in dist/
# make dist    the zip to hand out: for this platform, with the wheels of every Python that a Blender runs
# make dist-all  the same for every platform that has the wheels
# make release  what a release hands out, in dist/release: every zip, SHA256SUMS, the index of an extension repository
# make bench   how fast the engine is, beside others (python -m benchmarks.geodesic); a quarter of an hour
# make bench-job  the whole job, part by part, beside an older build (python -m benchmarks.job); hours; BASE=checkout
# make fuzz    random images through the kernel under sanitizers (tools/fuzz_kernel.sh), and 100,000 files that are
#              changed at random through every reader (python -m fuzz, in tests/); half an hour
# make check   style and types alone;  make format  mends the style
# make clean   removes what was built;  make distclean  the environments, too
#
# PYTHON=/path/to/python names the Python to use; VENV=folder the environment.

VENV ?= .venv
PYTHON ?=
# Set by make test in CI only: the one Python version to take.
FOR_PYTHON ?=
# Of make bench-job: the checkout of the older build.
BASE ?=
RUN = $(VENV)/bin/python

# What test-one runs (tools/run_tests.sh): plain, smoke, blender.
KINDS ?= plain blender
# The newest bpy beside the LTS that an environment has, and where it is put.
NEWEST_BPY = 5.3.0
BPY = build/bpy-$(NEWEST_BPY)

.PHONY: help setup kernel build dist dist-all release demo bench bench-job fuzz check format test test-one test-no-network test-newest test-all test-window lock clean distclean

help:
	@sed -n 's/^# \{0,1\}//p;/^$$/q' Makefile

setup:
	@PYTHON="$(PYTHON)" tools/setup.sh $(VENV) $(FOR_PYTHON)

# The wheel of the kernel goes into the environment, too, where the tests without a Blender find it.
kernel: setup
	@tools/build_kernel.sh $(VENV)

build: setup kernel
	@$(RUN) tools/build_extension.py

dist: setup kernel
	@$(RUN) tools/build_extension.py --python all

dist-all: setup
	@rm -rf build/kernel-wheels
	@$(RUN) kernel/build.py build/kernel-wheels
	@$(RUN) tools/build_extension.py --python all --platform all

release: setup
	@rm -rf build/kernel-wheels
	@$(RUN) kernel/build.py build/kernel-wheels
	@$(RUN) tools/release.py

demo: build
	@$(RUN) tools/demo.py

bench: setup kernel
	@$(RUN) -m benchmarks.geodesic

bench-job: build
	@tools/bench_job.sh $(RUN) $(BASE)

fuzz: setup kernel
	@tools/fuzz_kernel.sh
	@PYTHONPATH=tests:. $(RUN) -m fuzz

check: setup
	@$(VENV)/bin/ruff check
	@$(VENV)/bin/ruff format --check
	@$(VENV)/bin/mypy

format: setup
	@$(VENV)/bin/ruff check --fix
	@$(VENV)/bin/ruff format

ifeq ($(CI),true)
test: test-all
else
test: check test-one
endif

test-one: build
	@tools/run_tests.sh $(RUN) $(KINDS)

test-no-network: setup kernel
	@tools/test_no_network.sh $(RUN)

# The tests in Blender with the newest bpy, in the same environment.
test-newest: build $(BPY)/stamp
	@BPY=$(BPY) tools/run_tests.sh $(RUN) blender

$(BPY)/stamp: requirements/bpy-newest.txt
	@rm -rf $(BPY)
	@$(RUN) -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --only-binary=:all: \
		--target $(BPY) --requirement requirements/bpy-newest.txt
	@touch $@

# Two LTS Blenders and the newest, two Pythons, one after the other, whichever are there.
test-all:
	@tools/test_all.sh

# -k WORDS in SCENARIOS chooses some of them (tests/window/README.md).
test-window: setup kernel
	@$(RUN) tools/window_blender.py
	@$(RUN) -m pytest tests/window/run_scenarios.py $(SCENARIOS)

lock:
	@tools/lock.sh

clean:
	rm -rf build dist demo

distclean: clean
	rm -rf .venv .venv-3.*
