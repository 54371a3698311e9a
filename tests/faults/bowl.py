# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of the fault tests, and what its files say: a digest of every file that does not change with time, ids and
places, so that two runs of one recipe agree."""
import csv
import hashlib
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess

try:  # they spare a process for every file
    import h5py
except ImportError:
    h5py = None
try:
    from osgeo import gdal
    gdal.UseExceptions()
except ImportError:
    gdal = None

STAGES = ("preprocess", "solve", "postprocess")

# What the pipeline's scene has not: a wall, and more events in less time.
OBSTACLE = """
[[preprocess.obstacle]]
name = "wall"
polygons = "wall.geojson"
height_m = 6.0

[[solve.obstacle]]
name = "wall"
"""
EVENTS = "frame_interval_s = 0.25\ncheckpoint_interval_s = 0.4"

# What follows the scene's recipe in the scenes that compute more than one run.
MORE_RUNS = {
    "ensemble": """
[ensemble]
members = 3
keep = ["1"]

[[ensemble.vary]]
key = "solve.base.friction_angle_deg"
low = 14.0
high = 30.0

[[ensemble.vary]]
key = "preprocess.thickness_factor"
low = 0.9
high = 1.1
""",
    "slides": """
[slides]
outlines = "areas.geojson"
name_from = "name"
margin_m = 60.0
set = [{ key = "preprocess.release[0].thickness_m", attribute = "depth" }]
""",
}
SCENES = ("run", *MORE_RUNS)

WALL = """{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry":
{"type": "Polygon", "coordinates":
[[[500120, 5000070], [500140, 5000070], [500140, 5000130], [500120, 5000130], [500120, 5000070]]]}}]}
"""


def with_key(recipe, key, line):
    """The recipe with another line in the place of the one that sets `key`."""
    changed, count = re.subn(rf"(?m)^{key} = .*$", line, recipe)
    if count != 1:
        raise ValueError(f"{count} lines of the recipe of tests/pipeline/scene.sh set {key}, and one is needed")
    return changed


def areas():
    """Three squares in the bowl, as GeoJSON with a name and a depth each."""
    features = []
    for number, (west, south) in enumerate([(500040, 5000120), (500100, 5000060), (500140, 5000140)]):
        ring = [[west + x, south + y] for x, y in ((0, 0), (30, 0), (30, 30), (0, 30), (0, 0))]
        features.append({"type": "Feature", "properties": {"name": f"area {number}", "depth": 3.0 + number},
                         "geometry": {"type": "Polygon", "coordinates": [ring]}})
    return json.dumps({"type": "FeatureCollection", "features": features})


def make_scene(folder, layer=2.0, end=1.0, scene="run"):
    """The scene of tests/pipeline/scene.sh in `folder`: elevation models and recipe.toml. A block of 4 x 4 cells, 4 m
    thick, fails in a bowl; `layer` [m], `end` [s]. The single run has a wall in it; the other scenes are an ensemble
    and three slides over the model."""
    folder.mkdir(parents=True, exist_ok=True)
    script = pathlib.Path(__file__).resolve().parent.parent / "pipeline" / "scene.sh"
    asked_for = {name: str(folder.resolve()) for name in ("TALUS_SOURCE", "TALUS_BUILD", "TALUS_SCRATCH")}
    subprocess.run(["bash", "-c", 'source "$0" && scene', script], cwd=folder, env=os.environ | asked_for, check=True)
    recipe = (folder / "recipe.toml").read_text()
    recipe = with_key(recipe, "layer_height_m", f"layer_height_m = {layer}")
    recipe = with_key(recipe, "end_time_s", f"end_time_s = {end}\n{EVENTS if scene == 'run' else ''}")
    if scene == "run":
        (folder / "wall.geojson").write_text(WALL)
        recipe += OBSTACLE
    else:
        recipe += MORE_RUNS[scene]
    if scene == "slides":
        (folder / "areas.geojson").write_text(areas())
        recipe = re.sub(r'(?m)^after_dem = .*\n', "", recipe, count=1).replace("before_dem", "base_dem", 1)
        recipe = re.sub(r"(?ms)^\[postprocess\.survey\]\n.*?(?=^\[)", "", recipe)
    (folder / "recipe.toml").write_text(recipe)


GOES_ON = re.compile(r"(^|/)(checkpoint|unfinished)[^/]*\.h5$")


def is_final(name):
    """A name under which results are shown: not hidden."""
    return not any(part.startswith(".") for part in pathlib.PurePath(name).parts)


def of_hdf5(file):
    # Ids, times, versions and the history of commands stand in attributes and in two groups.
    if h5py is not None:
        said = []

        def look(name, item):
            if isinstance(item, h5py.Dataset) and not name.startswith("profile") and "wall_time" not in name:
                values = item[()]
                data = repr(values.tolist()).encode() if values.dtype.hasobject else values.tobytes()
                said.append((name, hashlib.sha256(data).hexdigest()))
        with h5py.File(file, "r") as root:
            root.visititems(look)
        return repr(sorted(said))
    text = subprocess.run(["h5dump", "-m", "%.17g", file], capture_output=True, text=True, check=True).stdout
    text = re.sub(r'(?s)GROUP "(profile|provenance)" \{.*?\n   \}\n', "", text)
    text = re.sub(r'(?ms)^( *)DATASET "[^"]*wall_time[^"]*" \{.*?^\1\}\n', "", text)
    text = re.sub(r'(?s)ATTRIBUTE "[^"]*" \{.*?\n\s*\}\n\s*\}\n', "", text)
    return text.replace(str(file), "")


def of_raster(file):
    if gdal is not None:
        raster = gdal.Open(str(file))
        bands = [raster.GetRasterBand(i + 1) for i in range(raster.RasterCount)]
        return repr([(raster.GetGeoTransform(), band.DataType, hashlib.sha256(band.ReadRaster()).hexdigest())
                     for band in bands])
    text = subprocess.run(["gdalinfo", "-checksum", file], capture_output=True, text=True, check=True).stdout
    if "Checksum=" not in text or re.search(r"(?m)^ERROR \d", text):
        raise ValueError("no checksum")
    volatile = re.compile(r"_ID=|FINGERPRINT=|Files:|SOURCE=|ACCEPTED")
    return "".join(line for line in text.splitlines(True) if not volatile.search(line))


def of_geopackage(file):
    base = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    if base.execute("pragma integrity_check").fetchone() != ("ok",):
        raise ValueError("broken data base")
    tables = [row[0] for row in base.execute("select table_name from gpkg_contents order by 1")]
    def rows(table):
        found = base.execute(f'select * from "{table}"')
        kept = [place for place, column in enumerate(found.description) if "wall_time" not in column[0]]
        return sorted(repr([row[place] for place in kept]) for row in found)
    return repr([(table, rows(table)) for table in tables])


def of_openvdb(file):
    # OpenVDB writes no two files alike, so that their checksums differ as well; ids and marks of recipes tell an old
    # one from a new one. What reads the file next says whether it is whole.
    data = re.sub(rb"# talus-seal .*\Z", b"", file.read_bytes(), flags=re.S)
    marks = re.findall(rb"(?<![0-9a-f-])[0-9a-f]{16}(?![0-9a-f-])", data)
    return repr((sorted(set(marks)), len(data)))


def of_json(file):
    volatile = re.compile("wall|run_id|version|memory|per_second|hardware|^on$")

    def lasting(value):
        if isinstance(value, dict):
            return {key: lasting(below) for key, below in value.items() if not volatile.search(key)}
        return [lasting(below) for below in value] if isinstance(value, list) else value
    return json.dumps(lasting(json.loads(file.read_text())))


def of_text(file):
    text = file.read_text()
    if not text.endswith("\n"):
        raise ValueError("ends within a line")
    volatile = re.compile("^#|wall|version|memory|steps per|points per|  run  |computed on|  on  ")
    return "".join(line for line in text.splitlines(True) if not volatile.search(line))


def of_table(file):
    """A table without its columns of wall time."""
    text = file.read_text()
    if not text.endswith("\n"):
        raise ValueError("ends within a line")
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    kept = [place for place, name in enumerate(rows[0]) if "wall" not in name] if rows else []
    return repr([[row[place] for place in kept if place < len(row)] for row in rows])


def of_log(file):
    if not file.read_text().endswith("\n"):
        raise ValueError("ends within a line")
    return "whole"


def of_page(file):
    if not file.read_text().rstrip().endswith("</html>"):
        raise ValueError("ends within the page")
    return "whole"


def of_project(file):
    return re.sub("run [0-9a-f]{16}", "run", file.read_text())  # its print layout names the run


READERS = {".h5": of_hdf5, ".nc": of_hdf5, ".tif": of_raster, ".gpkg": of_geopackage, ".vdb": of_openvdb,
           ".json": of_json, ".html": of_page, ".toml": of_text, ".txt": of_text, ".csv": of_table,
           ".log": of_log, ".qgs": of_project}


def digest(file):
    """What a file says, or "BROKEN: why"."""
    try:
        reader = READERS.get(file.suffix)
        said = reader(file) if reader else hashlib.sha256(file.read_bytes()).hexdigest()
        return hashlib.sha256(said.encode()).hexdigest()[:16]
    except (ValueError, OSError, RuntimeError, sqlite3.Error, subprocess.CalledProcessError) as fault:
        return f"BROKEN: {fault}"


def digests(out, names=None):
    """name -> digest, of everything in an output folder that carries a final name, but what a run goes on from."""
    found = {}
    for file in sorted(out.rglob("*")):
        name = str(file.relative_to(out))
        if file.is_file() and is_final(name) and not GOES_ON.search(name) and (names is None or name in names):
            found[name] = digest(file)
    return found


def hidden(out):
    """Names of what is hidden in an output folder."""
    return sorted(str(file.relative_to(out)) for file in out.rglob("*")
                  if file.is_file() and not is_final(str(file.relative_to(out))))


def fresh_copy(source, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
