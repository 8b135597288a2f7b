#!/usr/bin/env bash
# Run all tests: scripts/test.sh [OPTION OF `cargo test`]...
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/prepare.sh
. scripts/prepare.sh

prepare_system
prepare_vulkan
prepare_python
cargo test --workspace "${cargo_flags[@]}" "$@"
# What users read with: the files of a short run of the program, opened with xarray.
cargo build --package experiments "${cargo_flags[@]}"
ESKER="${CARGO_TARGET_DIR:-target}/debug/esker" .venv/bin/python -m pytest -p no:cacheprovider tests/python
