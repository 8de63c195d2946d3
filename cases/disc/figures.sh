#!/usr/bin/env bash
# The source's Figures 1 and 2: energy and contact pressure at the lowest node, under the conserving scheme and under
# Newmark's with the equivalent mass; and a third, what both were looking for: the same under reduced-kane.
# figures.sh [FOLDER [FORM]] draws figure-1, figure-2 and figure-3 (svg, pdf or png) into a folder, by default out/disc;
# runs that ./dev demo would make are made where they are missing.
set -euo pipefail
case "${1:-} ${2:-svg}" in
  -*) sed -n '2,5s/^# //p' "$0"; exit ;;
  *" svg" | *" pdf" | *" png") ;;
  *) echo "figures.sh: a figure is svg, pdf or png, not $2" >&2; exit 1 ;;
esac
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
ricochet=${RICOCHET:-$root/build/ricochet}
folder=${1:-$root/out/disc} form=${2:-svg} runs=$root/out/disc
mkdir -p "$folder"

run() {
  [[ -f "$runs/$1/summary.json" ]] ||
    "$ricochet" run "$here/disc.toml" -o "$runs/$1" --quiet --log-level error --set "time.scheme=$1" --set "mass.type=$2" \
      --set output.fields_every=5 "${@:3}" >/dev/null
}
run klr-conserving consistent
run newmark equivalent --set time.preset=textbook-half
run reduced-kane equivalent
"$ricochet" plot "$runs/klr-conserving" --what energy --what pressure -o "$folder/figure-1.$form"
"$ricochet" plot "$runs/newmark" --what energy --what pressure -o "$folder/figure-2.$form"
"$ricochet" plot "$runs/reduced-kane" --what energy --what pressure -o "$folder/figure-3.$form"
