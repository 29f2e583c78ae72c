# Two commands: `make run` and `make test`. Both set up what they need on a machine with Rust and Node.
SHELL := /bin/bash
.DEFAULT_GOAL := help
# Recorded people, where there are some; without them the synthetic visitor walks.
COVR_TRACES ?= $(wildcard ../shared/traces)
ifneq ($(COVR_TRACES),)
export COVR_TRACES := $(abspath $(COVR_TRACES))
else
unexport COVR_TRACES
endif
# The binary that the browser tests start.
export COVR_BIN ?= $(or $(CARGO_TARGET_DIR),$(CURDIR)/target)/debug/covr
# The Python that the example script runs with; tests/setup makes it.
export COVR_PYTHON ?= $(or $(CARGO_TARGET_DIR),$(CURDIR)/target)/python/bin/python3
# Where `make run` listens.
BIND ?= 127.0.0.1:7878

SECONDS ?= 3600

.PHONY: help run test bench prove soak setup build fmt check-format clippy test-rust test-web test-e2e

help: ## This list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

run: build ## Start the server (simulated gantry, demo scene) with a visitor; the dashboard is on http://127.0.0.1:7878
	BIND=$(BIND) deploy/demo

test: setup check-format clippy test-rust test-web test-e2e ## Everything: format, lint, types, unit, closed-loop, API, store and browser tests

bench: ## Every figure that the server promises, into server/BENCHMARKS.md; BENCH="--only stop" or --quick for less
	cargo build --locked --release --package covr-server
	cargo bench --locked --profile release --package covr-tests --bench figures -- --out $(CURDIR)/server/BENCHMARKS.md $(BENCH)

prove: ## Ten million steps against people at their worst; STEPS=100000000 SEED=2 for more and others
	cargo build --locked --release --package covr-server
	$(or $(CARGO_TARGET_DIR),target)/release/covr prove --steps $(or $(STEPS),10000000) --seed $(or $(SEED),1)

soak: ## One hour of the real server with faults on: no stop missed, no acknowledged write lost, no growth; SECONDS=600 for less
	COVR_SOAK_SECS=$(SECONDS) cargo test --locked --package covr-tests --test soak -- --nocapture

setup: ## Install what the tests need and this machine lacks
	tests/setup

build:
	cargo build --locked --package covr-server

fmt: ## Format Rust and web sources
	cargo fmt --all
	cd web && npx prettier --log-level warn --write .

check-format:
	cargo fmt --all --check

clippy:
	cargo clippy --locked --workspace --all-targets -- --deny warnings

test-rust:
	cargo nextest run --locked --workspace --no-fail-fast
	cargo test --locked --workspace --doc --quiet

test-web:
	cd web && npm run lint && npm run types && npm test

test-e2e: build
	cd tests/e2e && npm test
	@# First light once more, unchanged, on emulated boards over a pseudo-terminal. The kernel carries its bytes at normal priority: a host that
	@# stalls for 100 ms is a silent machine, so a test is tried twice.
	cd tests/e2e && COVR_MACHINE=roboclaw npm test -- --retry=1 reach stop prior restart machine
	cd tests/e2e && COVR_MACHINE=odrive npm test -- --retry=1 reach stop prior restart machine
