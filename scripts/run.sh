#!/usr/bin/env bash
# Run a ready-made experiment into results/NAME and draw its figures there:
#   scripts/run.sh NAME [OPTION OF `esker run`]...
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/prepare.sh
. scripts/prepare.sh

name=${1:-}
[ -f "experiments/$name/analyse.py" ] ||
    fail "which experiment? scripts/run.sh NAME, with NAME one of:" \
        "$(cd experiments && echo */analyse.py | sed 's,/analyse.py,,g')"
prepare_system
prepare_python
cargo run --release --package experiments "${cargo_flags[@]}" -- run "$name" --out "results/$name" "${@:2}"
.venv/bin/python "experiments/$name/analyse.py" "results/$name"
