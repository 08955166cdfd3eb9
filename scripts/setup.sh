#!/usr/bin/env bash
# Installs what Shimmer builds and runs with, from Debian 12 packages. Running it again is quick and changes nothing.
#
#   scripts/setup.sh             what building, the demo and the tests need
#   scripts/setup.sh --photos    also 36 real photographs (wallpapers), those of configs/photos_*.txt
#   scripts/setup.sh --training  also what scripts/train needs: PyTorch, and what reads sets and draws curves
#   scripts/setup.sh --torch     also libtorch, for restoration by networks: then cmake --preset release -DSHIMMER_TORCH=ON
#   scripts/setup.sh --all       all of it, with the peers that some tests compare against
set -euo pipefail

required=(
  g++ cmake ninja-build pkg-config ccache git
  libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev libopencv-videoio-dev libopencv-dev
  libopenimageio-dev openimageio-tools libopenexr-dev  # OpenImageIO's CMake files name its programs
  libtbb-dev libhwy-dev nlohmann-json3-dev libcli11-dev libssl-dev zlib1g-dev libarchive-dev libisal-dev
  libavcodec-dev libavutil-dev libswscale-dev
  libgtest-dev libgmock-dev libbenchmark-dev libpng-dev
  python3
)
photos=(lomiri-wallpapers-16.04 lomiri-wallpapers-20.04 mate-backgrounds plasma-workspace-wallpapers)
# Debian's PyTorch multiplies by whatever BLAS there is: with the reference one training takes four times as long.
training=(python3-numpy python3-opencv python3-openimageio python3-torch python3-yaml python3-matplotlib libopenblas0-pthread)
torch=(libtorch-dev)
# Peers that single tests use: the noise library that the paper names; readers of what we write, a browser too.
peers=(python3-noise python3-jsonschema python3-pil chromium fonts-dejavu-core)
cluster=(slurm-wlm munge)  # of which a test starts its own

packages=("${required[@]}")
for option in "$@"; do
  case "$option" in
    --photos) packages+=("${photos[@]}") ;;
    --training) packages+=("${training[@]}") ;;
    --torch) packages+=("${torch[@]}") ;;
    --all) packages+=("${photos[@]}" "${training[@]}" "${torch[@]}" "${peers[@]}" "${cluster[@]}") ;;
    *) echo "setup.sh: unknown option '$option'; --photos, --training, --torch and --all are those there are" >&2; exit 2 ;;
  esac
done

installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' 2>/dev/null | sed -n 's/^ii  *//p' | sort -u)
missing=()
for package in "${packages[@]}"; do
  grep -qxF "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: needs root (or sudo) to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
