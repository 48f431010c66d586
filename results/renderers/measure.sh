#!/bin/sh
# Renders exported cases with both integrators of Mitsuba and judges the samples: mitsuba.csv and bugs.csv.
#
#   TRUEFLIGHT=target/release/trueflight PYTHON=python3 results/renderers/measure.sh
#
# PYTHON has the packages mitsuba and numpy. About ten minutes of one core. PARTS chooses what is measured: the part `colours`
# has a table of its own, colours.csv, to which KEEP=1 appends the rows of another version of Mitsuba.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
: "${TRUEFLIGHT:=trueflight}" "${PYTHON:=python3}" "${DRAWS:=1000000}" "${TABLE:=$root/results/renderers/mitsuba.csv}"
export TRUEFLIGHT
scenes=$(mktemp -d)
trap 'rm -r "$scenes"' EXIT
[ "${PARTS-}" = colours ] || rm -f "$TABLE"

# Exports a case file and measures it with the given ways of finding lights.
measure() {
    case=$1
    [ -f "$case" ] || case=$root/tests/cases/${case#"$cases"/}
    shift
    out=$scenes/$(basename "$(dirname "$case")")-$(basename "$case" .toml)${FORM-}
    "$TRUEFLIGHT" export "$case" --to mitsuba --out "$out" --quiet ${FORM-} || exit 2
    for integrator in volpath volpathmis; do
        for way in "$@"; do
            "$PYTHON" -m trueflight.clients.mitsuba "$out" --integrator "$integrator" $way --draws "$DRAWS" \
                ${OURS---ours} --csv "$TABLE"
            [ $? -ne 2 ] || exit 2
        done
    done
}

cases=$root/cases
lights=--seed=1
hits=--no-emitter-sampling
parts=${PARTS:-transmittance furnace slab single-scattering ball limits bugs}
for part in $parts; do
    case $part in
    transmittance)
        for case in eq21-overview layers-with-gap grid-trilinear-centres; do
            measure "$cases/$part/$case.toml" $lights
        done
        ;;
    furnace) for case in eq21 grid known-bugs; do measure "$cases/$part/$case.toml" $hits $lights; done ;;
    slab) for case in known-bugs cloud; do measure "$cases/$part/$case.toml" $hits $lights; done ;;
    single-scattering)
        for case in known-bugs null-paths-layers grid; do measure "$cases/$part/$case.toml" $lights; done
        ;;
    ball) measure "$cases/$part/black-light.toml" $hits $lights ;;
    # What Mitsuba cannot do: a scene of a hundredth, pixels that depend on each other, a light deep in a medium.
    limits)
        measure "$root/results/renderers/small.toml" $lights --pixels
        DRAWS=4000000
        measure "$root/results/renderers/lamp.toml" $lights
        ;;
    # Channels, in a table of their own.
    colours)
        TABLE=$(dirname "$TABLE")/colours.csv OURS=
        [ -n "${KEEP-}" ] || rm -f "$TABLE"
        measure "$root/results/renderers/cube.toml" $lights
        cp "$root/results/renderers/cube.toml" "$scenes/cube-heterogeneous.toml"
        FORM=--heterogeneous
        measure "$scenes/cube-heterogeneous.toml" $lights
        FORM=
        measure "$cases/transmittance/spectral-layers.toml" $lights
        for case in like-colours known-bugs; do measure "$cases/furnace/spectral-$case.toml" $hits $lights; done
        measure "$cases/slab/spectral-three-albedos.toml" $hits $lights
        measure "$cases/slab/chromatic-like-colours.toml" $hits $lights
        measure "$root/results/renderers/coloured-lamp.toml" $lights
        ;;
    # Bugs of the client, in a table of their own.
    bugs)
        TABLE=$(dirname "$TABLE")/bugs.csv OURS= DRAWS=4000000
        rm -f "$TABLE"
        measure "$cases/transmittance/eq21-overview.toml" --bug=majorant --bug=emission
        DRAWS=1000000
        for case in furnace/eq21 slab/known-bugs; do measure "$cases/$case.toml" --bug=majorant --bug=emission; done
        ;;
    *)
        echo "PARTS: nothing is called $part" >&2
        exit 2
        ;;
    esac
done
