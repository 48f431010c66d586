#!/bin/sh
# Renders every exported case with both integrators of Mitsuba and judges the pixels: mitsuba.csv.
#
#   TRUEFLIGHT=target/release/trueflight PYTHON=python3 results/renderers/measure.sh
#
# PYTHON has the packages mitsuba and numpy. About half an hour on one core.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
: "${TRUEFLIGHT:=trueflight}" "${PYTHON:=python3}" "${PASSES:=2}" "${TABLE:=$root/results/renderers/mitsuba.csv}"
export TRUEFLIGHT PYTHONPATH="$root/bindings/python"
scenes=$(mktemp -d)
trap 'rm -r "$scenes"' EXIT
rm -f "$TABLE"

# Exports a case and measures it with the given ways of finding lights.
measure() {
    case=$1
    shift
    out=$scenes/$(echo "$case" | tr / -)
    "$TRUEFLIGHT" export "$root/cases/$case.toml" --to mitsuba --out "$out" --quiet || exit 2
    for integrator in volpath volpathmis; do
        for way in "$@"; do
            "$PYTHON" -m trueflight.clients.mitsuba "$out" --integrator "$integrator" $way --passes "$PASSES" \
                --ours --csv "$TABLE"
            [ $? -ne 2 ] || exit 2
        done
    done
}

lights=--seed=1
hits=--no-emitter-sampling
for case in eq21-overview layers-with-gap grid-trilinear-centres; do measure transmittance/$case $lights; done
for case in eq21 grid known-bugs; do measure furnace/$case $hits $lights; done
for case in known-bugs cloud; do measure slab/$case $hits $lights; done
for case in known-bugs null-paths-layers grid; do measure single-scattering/$case $lights; done
measure sphere/black-light $hits $lights
