#!/usr/bin/env bash
# Measure a graphics device, and keep the figures:
#   scripts/gpu-figures.sh PROGRAM FOLDER [OPTION OF `esker bench speed`]...
# Needs PROGRAM, a graphics driver and the Vulkan loader, and builds nothing. PROGRAM is made elsewhere:
#   cargo build --release -p experiments --features experiments/static && strip target/release/esker
# FOLDER receives gpu-info.txt, gpu-speed.txt (the table of grains) and gpu-speed.json (the same rows),
# gpu-water.txt and gpu-water.json, gpu-wet.txt and gpu-wet.json (grains with water between them: dry
# step, prediction and fluid step apart), whole at any time: a size that does not fit, or for which time is
# up, is left out and said to be.
set -euo pipefail

if [ $# -lt 2 ]; then
    sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
    exit 2
fi
program=$1 folder=$2
mkdir -p "$folder"
chmod +x "$program" 2>/dev/null || true
"$program" info | tee "$folder/gpu-info.txt"
water=128,256,512
wet=10000,100000,1000000
if ! grep -q 'hardware (' "$folder/gpu-info.txt"; then
    water=32
    wet=1000
    echo "no graphics hardware here: what follows shows that it works, not how fast it is" >&2
fi
"$program" bench speed --backend gpu --json "$folder/gpu-speed.json" "${@:3}" |
    tee "$folder/gpu-speed.txt"
"$program" bench speed --backend gpu --fluid "$water" --json "$folder/gpu-water.json" |
    tee "$folder/gpu-water.txt"
"$program" bench speed --backend gpu --wet "$wet" --json "$folder/gpu-wet.json" |
    tee "$folder/gpu-wet.txt"
echo "figures are in $folder"
