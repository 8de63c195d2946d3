#!/usr/bin/env bash
set -euo pipefail
cmake -S . -B build-conda -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DRICOCHET_BUILD_TESTS=OFF \
  -DCMAKE_INSTALL_PREFIX="$PREFIX" -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_PREFIX_PATH="$PREFIX"
cmake --build build-conda --parallel "${CPU_COUNT:-1}"
cmake --install build-conda

# Meshes are converted and figures drawn by the Python of the environment, also where the system has one.
mkdir -p "$PREFIX/etc/conda/activate.d" "$PREFIX/etc/conda/deactivate.d"
echo 'export RICOCHET_PYTHON="$CONDA_PREFIX/bin/python3"' >"$PREFIX/etc/conda/activate.d/ricochet.sh"
echo 'unset RICOCHET_PYTHON' >"$PREFIX/etc/conda/deactivate.d/ricochet.sh"
