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

hostile_scene() {
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
  expect_exit 0 preprocess
  expect_exit 0 solve
  expect_exit 0 postprocess
}
