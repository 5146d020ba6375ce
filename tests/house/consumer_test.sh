#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# consumer_test.sh BUILD_DIR: installs what is built there, and builds and runs tests/consumer against that.
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../consumer" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --install "$1" --prefix "$scratch/prefix" >"$scratch/install.log"
for internal in cli/options.h render/path/path_tracer.h groom/follicles/follicle_candidates.h; do
  [ ! -e "$scratch/prefix/include/pelage/$internal" ] || { echo "$internal is internal, but installed"; exit 1; }
done
cmake -S "$source_dir" -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/prefix"
cmake --build "$scratch/build"
# A scene to a picture, in thirty lines: the program that the README shows. It loads textures from a module.
examples=$(cd "$source_dir/../../examples" && pwd)
cat >"$scratch/small.yaml" <<SCENE
include: $examples/tuft.yaml
image: {width: 64, height: 36}
render: {samples: 1}
SCENE
"$scratch/build/consumer" "$scratch/small.yaml" "$scratch/out.exr"
[ -s "$scratch/out.exr" ]

said=$("$scratch/build/strands")
echo "$said"
[ "$said" = "2 strands, 6 points, box -0.100 -0.100 -0.100 to 3.100 2.100 0.100" ]

# A host without files: a mesh from memory, strands into arrays, passes and layers of a frame, a misspelt key.
said=$("$scratch/build/host_scene")
echo "$said"
[ "$said" = "500 strands, 2000 points, passes seen, layers seen, light seen
grooms.grass.operators.lenght.value | no item 'lenght' in the list; did you mean 'length'?" ]

# A host in plain C that calls the motion blur and the other eye.
said=$("$scratch/build/host")
echo "$said"
[ "$said" = "blurred: 0 0 0 0 0 0.5 0.5 0.5 0.5 0 0 0
other eye: 0 0 1 1 0 0 0 0 0 0 0 0
scale must be 1 to 8" ]

# A renderer in plain C that loads the plugin. The coat has maps, which the plugin reads with a module beside it.
cat >"$scratch/maps.yaml" <<SCENE
include: $examples/rat.yaml
camera: {shutter: [0, 0]}
grooms: {under: {strands: 3000}, guard: {strands: 200}}
SCENE
plugin=$scratch/prefix/lib/pelage/libpelage_ri.so
said=$("$scratch/build/renderer" "$plugin" "$scratch/maps.yaml coat=under detail=full threads=2")
echo "$said"
[ "$said" = "3000 strands, 0 errors" ]
said=$("$scratch/build/renderer" "$plugin" "$scratch/nothing.yaml")
echo "$said"
[ "$(tail -1 <<<"$said")" = "0 strands, 1 errors" ]
[ "$(nm -D --defined-only "$plugin" | awk '{print $3}' | sort | tr '\n' ' ')" = "ConvertParameters Free Subdivide " ]

# The installed command, where there is one, runs from there and finds what it needs.
if [ -x "$scratch/prefix/bin/pelage" ]; then "$scratch/prefix/bin/pelage" --version; fi
