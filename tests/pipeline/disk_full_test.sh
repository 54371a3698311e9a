#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A full disk while writing: a small tmpfs, mounted where only this test sees it. Whatever its size, a stage either
# succeeds or says that the disk is full, and every file that carries a final name is whole. The sizes are few: a page,
# parts of what the stage writes, and the edge found by bisection.
source "$(dirname "${BASH_SOURCE[0]}")/scene.sh"

# on_small_disk STAGE KIB [OPTIONS...]: the stage writes to disk/, which holds what is in out/ already and has KIB
# left. kept/ is a copy of the disk afterwards.
on_small_disk() {
  local stage=$1 kib=$2
  shift 2
  cat >small_disk.sh <<SCRIPT
set -e
mkdir -p disk kept
mount -t tmpfs -o size=$(($(room out) + kib))k tmpfs disk
if [[ -d out ]]; then cp -r out/. disk/; fi
code=0
"$bin/talus-$stage" recipe.toml --out disk $* || code=\$?
cp -r disk/. kept/
exit \$code
SCRIPT
  rm -rf disk kept
  with_mounts bash small_disk.sh
}

# whole FOLDER: other programs read all that lies there; in one process, whose start takes longer than that.
whole() {
  local file
  while IFS= read -r file; do
    cmp -s "$file" out/domain.vdb || expect_exit 0 "$bin/talus-solve" recipe.toml --out "$(dirname "$file")" --check
  done < <(find "$1" -name '*.vdb' -not -path '*/.frames/*')
  /usr/bin/python3 - "$1" <<'PYTHON' || fail "what a full disk leaves is not whole"
import json, pathlib, sys, xml.etree.ElementTree as tree
import h5py, netCDF4
from osgeo import gdal, ogr
gdal.UseExceptions()
ENDS = {".vtp": b"</VTKFile>\n", ".html": b"</html>\n", ".toml": b"\n", ".txt": b"\n", ".csv": b"\n",
        ".log": b"\n"}
def look(_, item):
    list(item.attrs.items())
    if isinstance(item, h5py.Dataset): item[()]
files = [file for file in pathlib.Path(sys.argv[1]).rglob("*") if file.is_file() and ".frames" not in file.parts]
for file in {(file.suffix, file.read_bytes()): file for file in files}.values():
    name, kind = str(file), file.suffix
    if kind in (".tif", ".png"): gdal.Open(name).ReadRaster()
    elif kind == ".gpkg": [feature.ExportToJson() for layer in ogr.Open(name) for feature in layer]
    elif kind == ".nc": [variable[...] for variable in netCDF4.Dataset(name).variables.values()]
    elif kind == ".h5": look("", h5py.File(name)), h5py.File(name).visititems(look)
    elif kind == ".json": json.loads(file.read_text())
    elif kind in (".qml", ".qgs", ".pvd"): tree.parse(name)
    elif kind in ENDS and not file.read_bytes().endswith(ENDS[kind]): sys.exit(f"{name} is cut short")
    elif kind not in ENDS and kind != ".vdb": sys.exit(f"{name} was left behind")
PYTHON
}

full="^talus-[a-z]+: disk(/[a-z_/.0-9]+)?: .*cannot (be written|be created|write) ?"
full+=".*(disk is full|No space left on device).*--out"

# room FOLDER: what its files take [KiB].
room() { (find "$1" -type f -printf '%k\n' 2>/dev/null || true) | awk '{ sum += $1 } END { print sum + 0 }'; }

# succeeds_on KIB STAGE [OPTIONS...]: whether the stage gets by with so much; where it does not, it has to say so, and
# what it leaves, kept in failed/, has to be whole.
succeeds_on() {
  local kib=$1 stage=$2 code=0
  shift 2
  on_small_disk "$stage" "$kib" "$@" >stdout 2>stderr </dev/null || code=$?
  [[ $code -ne 0 ]] || return 0
  [[ $code -eq 3 ]] || fail "exit code $code instead of 3 on a disk of $kib KiB"
  failures=$((failures + 1))
  tail -n 1 stderr | grep -qE "$full" || fail "it does not say that the disk is full ($kib KiB)"
  [[ ! -s stdout ]] || fail "it names results on a full disk"
  [[ -z $(find kept -name '*.partial') ]] || fail "left behind: $(find kept -name '*.partial')"
  mv kept "failed/$kib"
  return 1
}

# fills STAGE [OPTIONS...]: on a disk of a page, of an eighth and of half of what the stage writes; then the edge
# between too small and large enough by bisection, to an eighth: there the last of its files meet the end of the disk.
fills() {
  local stage=$1 failures=0 low high middle needed kib
  shift
  mkdir failed
  succeeds_on 65536 "$stage" "$@" || fail "it does not succeed on 64 MiB either"
  needed=$(($(room kept) - $(room out)))
  [[ $needed -ge 64 ]] || fail "it writes $needed KiB: this test looks at nothing"
  low=4 high=65536
  for kib in 4 $((needed / 8)) $((needed / 2)); do
    succeeds_on "$kib" "$stage" "$@" && fail "it succeeds on $kib KiB, though it writes $needed"
    low=$kib
  done
  # What is written aside and removed again may take more than what stays.
  for ((kib = needed + needed / 4 + 8; high == 65536; kib *= 2)); do
    [[ $kib -le 65536 ]] || fail "it writes $needed KiB and does not succeed on $((kib / 2))"
    if succeeds_on "$kib" "$stage" "$@"; then high=$kib; else low=$kib; fi
  done
  while ((high - low > 4 + low / 8)); do
    middle=$(((low + high) / 2))
    if succeeds_on "$middle" "$stage" "$@"; then high=$middle; else low=$middle; fi
  done
  [[ $failures -ge 3 ]] || fail "only $failures disks were too small: this test looks at nothing"
  whole failed
}

need_readers() {
  need_mounts
  /usr/bin/python3 -c 'import h5py, netCDF4, osgeo' 2>/dev/null || need_tool python3-netcdf4
}

test_preprocess() {
  need_readers
  scene
  fills preprocess
}

test_solve() {
  need_readers
  scene
  sed -i 's/^end_time_s.*/end_time_s = 1.0\ncheckpoint_interval_s = 0.5/' recipe.toml
  expect_exit 0 preprocess
  fills solve --on cpu
}

test_postprocess() {
  need_readers
  scene
  expect_exit 0 preprocess
  expect_exit 0 solve
  fills postprocess
}

run_test "$@"
