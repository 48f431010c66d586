#!/bin/sh
# Renders every exported case with both integrators of Mitsuba and judges the pixels: mitsuba.csv.
#
#   TRUEFLIGHT=target/release/trueflight PYTHON=python3 results/renderers/measure.sh
#
# PYTHON has the packages mitsuba and numpy. About half an hour on one core.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
: "${TRUEFLIGHT:=trueflight}" "${PYTHON:=python3}" "${DRAWS:=2000000}" "${TABLE:=$root/results/renderers/mitsuba.csv}"
export TRUEFLIGHT PYTHONPATH="$root/bindings/python"
scenes=$(mktemp -d)
trap 'rm -r "$scenes"' EXIT
rm -f "$TABLE"

# Exports a case file and measures it with the given ways of finding lights.
measure() {
    case=$1
    shift
    out=$scenes/$(basename "$(dirname "$case")")-$(basename "$case" .toml)
    "$TRUEFLIGHT" export "$case" --to mitsuba --out "$out" --quiet || exit 2
    for integrator in volpath volpathmis; do
        for way in "$@"; do
            "$PYTHON" -m trueflight.clients.mitsuba "$out" --integrator "$integrator" $way --draws "$DRAWS" \
                --ours --csv "$TABLE"
            [ $? -ne 2 ] || exit 2
        done
    done
}

cases=$root/cases
lights=--seed=1
hits=--no-emitter-sampling
for case in eq21-overview layers-with-gap grid-trilinear-centres; do
    measure "$cases/transmittance/$case.toml" $lights
done
for case in eq21 grid known-bugs; do measure "$cases/furnace/$case.toml" $hits $lights; done
for case in known-bugs cloud; do measure "$cases/slab/$case.toml" $hits $lights; done
for case in known-bugs null-paths-layers grid; do measure "$cases/single-scattering/$case.toml" $lights; done
measure "$cases/sphere/black-light.toml" $hits $lights
# What Mitsuba cannot do: a scene of a hundredth, a light deep in a medium, and pixels that depend on each other.
measure "$root/results/renderers/small.toml" $lights --pixels
measure "$root/results/renderers/lamp.toml" $lights
