#!/usr/bin/env bash
# The studies of the lattice: tables (*.csv) and convergence.png in this folder. Five minutes on two cores.
# One of them: lbm/studies/run.sh orders (or cavity, spheres, packing, numbers).
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=scripts/prepare.sh
. scripts/prepare.sh

prepare_python
cargo test --release -p lbm --test verification -- \
    --ignored --nocapture --test-threads 1 "study_${1:-}"
.venv/bin/python lbm/studies/figure.py
