#!/usr/bin/env bash
# Remakes the weights that ship, restore/models/shimmer.safetensors, from nothing: clips, stacked frames, training. An
# hour and a half on two cores; killed, it goes on where it stopped.
#
#   scripts/train/reproduce.sh [FOLDER]     which gets some 2 GB, default build/train
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/train}
scripts/setup.sh --training --photos
scripts/build.sh release
programs=build/release/bin
mkdir -p "$folder"
for kind in static dynamic; do
  "$programs/shimmer" generate "configs/train_$kind.json" --set clips=420 --out "$folder/$kind"
  scripts/train/stack.py "$folder/$kind" --out "$folder/stacked/$kind" --clips 400 --program "$programs/unshimmer"
done
# One thread, as it was trained: two are hardly faster, and sums in another order are other weights.
OMP_NUM_THREADS=1 scripts/train/train.py scripts/train/small.json --data "$folder" --out "$folder/trained" --threads 1
cp "$folder/trained/shimmer-small.safetensors" restore/models/shimmer.safetensors
scripts/build.sh release
