#!/usr/bin/env bash
# Draws the pictures of docs/GUIDE.md anew, without a display: docs/guide.sh [NAME...]
# All of them, or those with these names.
# Needs ImageMagick, and the viewer: set VIEWER to its program, or it is built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly FOLDER=docs/guide
readonly LARGEST=150000

if ! command -v convert >/dev/null; then
  echo "ImageMagick is missing; on Debian: apt-get install imagemagick" >&2
  exit 2
fi
if [[ -z ${VIEWER:-} ]]; then
  cargo build --release --locked -p viewer-client
  VIEWER=${CARGO_TARGET_DIR:-target}/release/viewer-client
fi
VIEWER=$(realpath "$VIEWER")
mkdir -p "$FOLDER"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
readonly wanted=" $* "

# The viewer without a window, in a folder of its own.
look() {
  (cd "$work" && "$VIEWER" --headless --screenshot-to shot.png "$@" 2>log) \
    || { cat "$work/log" >&2; return 1; }
}

# shot NAME SCENE SIZE CROP PATHS, with the commands on standard input. CROP is a geometry of
# ImageMagick from the upper right, or `all`; so many paths come before the picture is taken, or so
# many seconds pass, as in `8s`.
shot() {
  local name=$1 scene=$2 size=$3 crop=$4 paths=$5
  cat >"$work/script"
  [[ $wanted == "  " || $wanted == *" $name "* ]] || return 0
  local wait=(--wait-paths "$paths")
  [[ $paths != *s ]] || wait=(--wait "${paths%s}")
  look --scene "$scene" --size "$size" "${wait[@]}" --run script
  local cut=()
  [[ $crop == all ]] || cut=(-gravity NorthEast -crop "$crop" +repage -gravity None)
  local colors
  for colors in 192 96 48 24; do
    convert "$work/shot.png" "${cut[@]}" -dither None -colors "$colors" -strip \
      "PNG8:$FOLDER/$name.png"
    [[ $(stat -c %s "$FOLDER/$name.png") -ge $LARGEST ]] || break
  done
  echo "$FOLDER/$name.png: $(stat -c %s "$FOLDER/$name.png") bytes"
}

shot window caustic 1280x720 all 60000 <<'EOF'
panel path off
panel explorer off
panel diagnostics off
cloud shown 1200
image fit
EOF

shot hint cornell 1280x720 640x420+372+262 20000 <<'EOF'
panel path off
panel explorer off
hint on
cloud shown 400
EOF

shot paths caustic 1280x720 902x720+378+0 60000 <<'EOF'
panel path off
panel explorer off
cloud color strategy
cloud shown 700
scene opacity 0.4
EOF

shot throughput caustic 1280x720 902x720+378+0 60000 <<'EOF'
panel path off
panel explorer off
cloud color throughput
cloud blend weighted
cloud shown 900
scene opacity 0.4
EOF

shot shading caustic 1280x720 902x720+378+0 5000 <<'EOF'
panel path off
panel explorer off
cloud shown 60
scene lighting phong
scene light at 0.5 0.7 0.4
EOF

shot explorer caustic 1280x860 all 60000 <<'EOF'
panel image off
panel statistics off
panel diagnostics off
panel filter off
panel scene off
cloud opacity 0.08
path pick 0.02 -0.06 0.08
explorer seed newest
explorer step 60
EOF

shot path caustic 1280x900 all 60000 <<'EOF'
panel image off
panel statistics off
panel diagnostics off
panel explorer off
panel filter off
panel scene off
cloud opacity 0.08
path stay 0
path vertex 1
EOF

shot filter caustic 1280x720 all 1200 <<'EOF'
panel path off
panel explorer off
panel statistics off
panel diagnostics off
panel image off
panel cloud off
cloud shown 900
filter add any 0.35 0 0.35 0.28
filter set lpe "C.*DS+L"
EOF

shot builder caustic 1280x720 284x600+996+34 1200 <<'EOF'
panel cloud off
panel scene off
cloud shown 900
filter set edges >= 4 and (lpe "C.*DS+L" or any on material "glass")
EOF

shot miss caustic 1280x720 all 12s <<'EOF'
panel path off
panel explorer off
panel statistics off
panel diagnostics off
panel image off
panel cloud off
panel scene off
filter add any -0.85 1.75 -0.85 0.04
filter set lpe "C.*DS+L" and edges >= 5
EOF

shot fan door 1280x720 all 60000 <<'EOF'
panel image off
panel path off
panel statistics off
panel diagnostics off
cloud opacity 0.05
camera through on
path pick 0.1 0 0.2
explorer seed newest
explorer fan 0 60
EOF

shot palette cornell 1280x720 all 5000 <<'EOF'
panel path off
panel explorer off
panel statistics off
panel diagnostics off
palette on
EOF

shot image cornell 1280x900 380x640+0+34 4000 <<'EOF'
panel path off
panel explorer off
filter set film in rect(0.3, 0.3, 0.6, 0.5)
EOF

shot pixels cornell 1280x720 all 1500 <<'EOF'
panel path off
panel explorer off
panel diagnostics off
panel statistics off
filter set film in rect(0.72, 0.78, 0.86, 0.9)
cloud shown 800
EOF

shot false-colour caustic 1280x900 380x640+0+34 100000 <<'EOF'
panel path off
panel explorer off
image tone false
EOF

# The first picture of a scene, as the reference of a later one.
echo "image save short.exr" >"$work/save"
look --scene cornell --wait-paths 20000 --run save
shot compare cornell 1280x900 380x760+0+34 100000 <<'EOF'
panel path off
panel explorer off
image reference short.exr
image exposure 1
EOF

shot chains door 1280x1080 380x1000+0+34 150000 <<'EOF'
panel path off
panel explorer off
panel image off
panel statistics off
EOF

shot map-dwell door 1280x900 380x640+0+34 150000 <<'EOF'
panel path off
panel explorer off
image show dwell
EOF

shot map-disagreement door 1280x900 380x640+0+34 150000 <<'EOF'
panel path off
panel explorer off
image show disagreement
EOF

shot statistics caustic 1280x720 380x420+0+34 60000 <<'EOF'
panel path off
panel explorer off
panel image off
panel diagnostics off
EOF

shot light door 1280x720 all 40000 <<'EOF'
panel path off
panel explorer off
theme light
cloud color class
panel diagnostics off
EOF

shot scaled caustic 1600x900 all 40000 <<'EOF'
panel path off
panel explorer off
scale 150
panel diagnostics off
panel scene off
EOF
