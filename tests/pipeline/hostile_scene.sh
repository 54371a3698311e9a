#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The small scene with names that would run, close or climb if anything took them for more than text.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# What each of them sets or makes where it is taken for a program: a variable of the page, a file.
script='</script><script>window.pwned=1</script>'
image='<img src=x onerror=window.pwned=1>'
shell='$(touch pwned)`touch pwned`;touch pwned;'
title="$script $image \"><svg onload=window.pwned=1> @DATA@ @TITLE@ \${7*7} {{7*7}} [% 7*7 %] %s%n & ]]> <!--"
file="b'\"<img src=x onerror=window.pwned=1>%s;\$(touch pwned).asc"

# quoted TEXT: a TOML basic string.
quoted() { printf '"%s"' "$(sed 's/\\/\\\\/g; s/"/\\"/g' <<<"$1")"; }

# hostile_recipe: recipe.toml and its files, in a folder of such a name, which becomes the current one.
hostile_recipe() {
  scene
  mkdir -p "in <b>&'\"x"
  cd "in <b>&'\"x"
  grid "$file" "$bowl - 4 * $in_source"
  grid one.asc "4 * (i >= 3 && i < 5 && j >= 8 && j < 12)"
  grid two.asc "4 * (i >= 5 && i < 7 && j >= 8 && j < 12)"
  cp ../survey.asc "$image.asc"
  gdalsrsinfo -o wkt1 EPSG:32633 | tr -d '\n' >utm.wkt
  sed "s|WGS 84 / UTM zone 33N|$image|; s|,AUTHORITY\[\"EPSG\",\"32633\"\]||" utm.wkt >b.wkt
  local raster
  for raster in "$file" one.asc two.asc "$image.asc"; do cp b.wkt "${raster%.asc}.prj"; done
  cat >recipe.toml <<TOML
[scene]
name = "..-hostile"
title = $(quoted "$title")

[preprocess]
base_dem = $(quoted "$file")

[[preprocess.release]]
name = $(quoted "../../$script")
thickness_raster = "one.asc"

[[preprocess.release]]
name = $(quoted "..-..-$shell$image")
thickness_raster = "two.asc"

[preprocess.grid]
layer_height_m = 2.0

[solve]
end_time_s = 2.0
frame_interval_s = 1.0

[postprocess]
institution = $(quoted "$image $shell")

[postprocess.survey]
name = $(quoted "$image\" '\\u2028")
thickness = $(quoted "$image.asc")
TOML
}

# hostile_stages: the three of them.
hostile_stages() {
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
}

hostile_scene() {
  hostile_recipe
  hostile_stages
}

# hostile_ensemble: the same recipe, with six members that differ in a law, given by its name, and in a friction.
hostile_ensemble() {
  hostile_recipe
  cat >>recipe.toml <<'TOML'

[ensemble]
members = 6

[[ensemble.vary]]
key = "solve.base.law"
distribution = "discrete"
words = ["coulomb", "voellmy"]

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 10.0
high = 25.0
TOML
  hostile_stages
}

# hostile_slides: two slides in the bowl whose names, and the attributes that give them, are markup too.
hostile_slides() {
  hostile_recipe
  TITLE=$title IMAGE=$image SCRIPT=$script /usr/bin/python3 - <<'PYTHON' || fail "no outlines of slides"
import json, os
image, names = os.environ["IMAGE"], [os.environ["TITLE"], "../../" + os.environ["SCRIPT"]]
features = []
for n, (x, y) in enumerate([(30, 80), (50, 80)]):
    ring = [[500000 + x + dx, 5000000 + y + dy] for dx, dy in ((0, 0), (20, 0), (20, 40), (0, 40), (0, 0))]
    features.append({"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [ring]},
                     "properties": {image: names[n], "depth": 4 - n, image + "2": 15 + n}})
json.dump({"type": "FeatureCollection", "name": image, "features": features,
           "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32633"}}},
          open("areas.geojson", "w"))
PYTHON
  sed -i '/^\[\[preprocess.release/,/^$/d; /^\[postprocess.survey/,$d' recipe.toml
  cat >>recipe.toml <<TOML
[slides]
outlines = "areas.geojson"
name_from = $(quoted "$image")
margin_m = 100.0

[[slides.set]]
key = "preprocess.release[0].thickness_m"
attribute = "depth"

[[slides.set]]
key = "solve.base.friction_angle_deg"
attribute = $(quoted "${image}2")
TOML
  hostile_stages
}
