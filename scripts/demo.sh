#!/usr/bin/env bash
# From a fresh machine to a picture: sets up, builds, makes a small data set and draws it.
# Uses real photographs where `scripts/setup.sh --photos` has put them, and drawn scenes otherwise.
#
#   scripts/demo.sh [FOLDER]     default: demo/
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-demo}

scripts/setup.sh
scripts/build.sh release
shimmer=build/release/bin/shimmer

config=configs/demo_drawn.json
[ -e /usr/share/backgrounds/life_by_Aitzol_Berasategi.jpg ] && [ -e /usr/share/wallpapers/Path ] && config=configs/demo_photos.json

dataset=$out/$(basename "$config" .json)
"$shimmer" generate "$config" --out "$dataset"
"$shimmer" preview "$dataset" --out "$out/sheet.png"
"$shimmer" preview "$dataset" --out "$out/clip.gif"
echo "Look at $out/sheet.png and $out/clip.gif"
