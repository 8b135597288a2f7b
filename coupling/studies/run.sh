#!/usr/bin/env bash
# The studies of the coupling: tables (*.csv), map.png and accuracy.png in this folder.
# One of them: coupling/studies/run.sh map (or loose, shear, intervals, deborah).
set -euo pipefail
cd "$(dirname "$0")/../.."
# shellcheck source=scripts/prepare.sh
. scripts/prepare.sh

prepare_python
cargo test --release -p coupling --test verification -- \
    --ignored --nocapture "study_${1:-}"
.venv/bin/python coupling/studies/figure.py
