#!/usr/bin/env python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do the intervals of a calibration hold the truth? The likelihood of 'talus calibrate' on made-up surveys.

Runs one large ensemble of a recipe. Its first members are truths. Each becomes a survey: its deposit with a discrepancy
that is added, multiplies the thickness or displaces the mass (of 10 to 50 %, alike over 0.1 to 0.4 of the deposit's
extent), and with noise. All other members are weighted by their likelihood given that survey. The ranks of truths are
uniform where the posterior is right (Talts et al. 2018). Runs that --out holds already are taken (counts.h5).

    tools/measure-coverage.py valley.toml --out cover/valley
"""

import argparse
import csv
import json
import pathlib
import subprocess
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy as np
import scipy.ndimage
import scipy.stats
from osgeo import gdal

KINDS = ("added", "multiplied", "displaced")
THRESHOLD_M = 0.1  # a cell thicker than this belongs to the deposit


def run(stage, recipe, out, settings, *flags):
    """Runs a stage program on a recipe with other values."""
    changed = [part for setting in settings for part in ("--set", setting)]
    subprocess.run([f"talus-{stage}", recipe, "--out", out, *changed, *flags], check=True, stdout=subprocess.DEVNULL)


def deposits_of(counts, members, cells):
    """Thickness [m] of the first members' deposits, one row each, from runs of empty and filled cells."""
    kept = counts["members/deposit_thickness"]
    ends = kept["ends"][:members]
    runs, quantum = kept["runs"][: ends[-1]], kept.attrs["quantum_m"]
    values = quantum * kept["values"][: runs.sum()]
    maps = np.zeros((members, cells))
    filled = 0
    for member, (first, end) in enumerate(zip([0, *ends[:-1]], ends)):
        cell = 0
        for number, length in enumerate(runs[first:end]):
            if number % 2:
                maps[member, cell : cell + length] = values[filled : filled + length]
                filled += length
            cell += length
    return maps


def surveyed(truth, kind, shape, distance, noise, random):
    """One deposit [m] as a survey would show it, one value a cell."""
    deposit = truth > THRESHOLD_M
    cell = distance[0, 1]
    extent = np.sqrt(deposit.sum()) * cell
    size = np.exp(random.uniform(*np.log([0.1, 0.5])))
    length = extent * np.exp(random.uniform(*np.log([0.1, 0.4])))
    root = np.linalg.cholesky(np.exp(-distance / length) + 1e-9 * np.eye(truth.size))

    def field():
        return root @ random.standard_normal(truth.size)

    if kind == "added":  # no more than there is, up as down, so that its mean is nothing
        survey = truth + np.clip(size * np.sqrt((truth[deposit] ** 2).mean()) * field(), -truth, truth)
    elif kind == "multiplied":
        survey = truth * np.exp(size * field() - size**2 / 2)
    else:
        moved = 0.25 * size * extent / cell
        row, column = np.divmod(np.arange(truth.size), shape[1])
        places = [row + moved * field(), column + moved * field()]
        survey = scipy.ndimage.map_coordinates(truth.reshape(shape), places, order=1).ravel()
        survey *= truth.sum() / survey.sum()
    return survey + noise * random.standard_normal(truth.size)


def write_survey(path, survey, scene, shape):
    """Writes a survey as a GeoTIFF."""
    cell = scene["cell_m"]
    image = gdal.GetDriverByName("GTiff").Create(str(path), shape[1], shape[0], 1, gdal.GDT_Float32)
    image.SetGeoTransform((scene["west_m"], cell, 0, scene["south_m"] + shape[0] * cell, 0, -cell))
    image.SetProjection(scene["crs_wkt"].decode())
    image.GetRasterBand(1).WriteArray(survey.reshape(shape)[::-1].astype("f4"))


def ranks_of(recipe, out, study, survey, member, values):
    """Ranks of a truth's keys among the other members, by their likelihood, and how many draws n these stand for: with
    k of n draws below, a rank is (k + 1/2) / (n + 1)."""
    given = [f"postprocess.survey.thickness={survey}"]
    work = survey.with_suffix("")
    work.mkdir(exist_ok=True)
    for name in ("counts.h5", "members.h5"):
        if not (work / name).exists():
            (work / name).symlink_to((out / name).resolve())
    run("postprocess", recipe, work, study + given, "--members-only", "--quiet")
    likelihood = np.array(json.loads((work / "likelihood.json").read_text())["log_likelihood"], dtype=float)
    likelihood[member] = -np.inf
    weights = np.exp(likelihood - np.nanmax(likelihood))
    weights = np.nan_to_num(weights / np.nansum(weights))
    draws = 1 / (weights**2).sum()
    below = draws * (weights[:, None] * (values < values[member])).sum(axis=0)
    return (below + 0.5) / (draws + 1), draws


def line(name, key, ranks):
    """Shares inside the central 90 and 95 %, and the chance of ranks as uneven as these (chi-square, ten classes)."""
    inside = [np.mean(np.abs(ranks - 0.5) < level / 2) for level in (0.90, 0.95)]
    chance = scipy.stats.chisquare(np.histogram(ranks, 10, (0, 1))[0]).pvalue
    print(f"{name:14} {key:38} {ranks.size:5} {inside[0]:6.3f} {inside[1]:6.3f} {chance:8.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("recipe", type=pathlib.Path, help="with [[ensemble.vary]]")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--surveys", type=int, default=67)
    parser.add_argument("--members", type=int, default=8192)
    parser.add_argument("--noise", type=float, default=0.2, help="of a cell of the survey [m]")
    parser.add_argument("--hide-error", action="store_true", help="do not give the noise as sigma_m")
    parser.add_argument("--seed", type=int, default=77)
    options = parser.parse_args()
    (options.out / "surveys").mkdir(parents=True, exist_ok=True)
    study = [f"ensemble.members={options.members}", f"ensemble.seed={options.seed}", "ensemble.design=monte-carlo",
             'ensemble.keep=["deposits"]']
    if not (options.out / "counts.h5").exists():
        run("preprocess", options.recipe, options.out, study)
        run("solve", options.recipe, options.out, study)
    if not options.hide_error:
        study.append(f"postprocess.survey.sigma_m={options.noise}")
    counts, members = h5py.File(options.out / "counts.h5"), h5py.File(options.out / "members.h5")
    scene = dict(counts["scene"].attrs)
    shape = (int(scene["rows"]), int(scene["columns"]))
    truths = deposits_of(counts, options.surveys, shape[0] * shape[1])
    keys = [members[f"keys/{key}"].attrs["key"].decode() for key in members["keys"]]
    values = np.stack([members[f"keys/{key}"][:] for key in members["keys"]], axis=1)
    row, column = np.divmod(np.arange(truths.shape[1]), shape[1])
    distance = scene["cell_m"] * np.hypot(row[:, None] - row, column[:, None] - column)
    random = np.random.default_rng(options.seed)
    surveys = [options.out / "surveys" / f"s{member:03d}.tif" for member in range(options.surveys)]
    for member, path in enumerate(surveys):
        survey = surveyed(truths[member], KINDS[member % 3], shape, distance, options.noise, random)
        write_survey(path, survey, scene, shape)

    def ranks_and_draws(member):
        return ranks_of(options.recipe, options.out, study, surveys[member], member, values)

    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(ranks_and_draws, range(options.surveys)))
    ranks, draws = np.array([one[0] for one in found]), np.array([one[1] for one in found])
    with open(options.out / "ranks.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["survey", "kind", "draws", *keys])
        for member in range(options.surveys):
            table.writerow([surveys[member].stem, KINDS[member % 3], f"{draws[member]:.1f}", *ranks[member]])
    print(f"{'scene':14} {'key':38} {'n':>5} {'90 %':>6} {'95 %':>6} {'ranks p':>8}")
    for number, key in enumerate(keys):
        line(options.out.name, key, ranks[:, number])
    for number, kind in enumerate(KINDS):
        line(options.out.name, "all keys, " + kind, ranks[number::3].ravel())
    line(options.out.name, "all keys", ranks.ravel())
    print(f"draws a survey: {np.percentile(draws, 5):.0f} (5 %), {np.median(draws):.0f} (median)")


if __name__ == "__main__":
    main()
