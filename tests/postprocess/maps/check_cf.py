#!/usr/bin/python3
# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of the CF conventions 1.8 that bear on a file of gridded maps, one check each, by their sections.

usage: check_cf.py FILE.nc...            faults, one a line; exit code 1 if there are any
"""
import ctypes
import os
import re
import subprocess
import sys
import tempfile

import netCDF4
import numpy
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()

STANDARD_NAMES = {
    "projection_x_coordinate": "m",
    "projection_y_coordinate": "m",
    "time": "s",
}  # with their canonical units
METHODS = """point sum maximum maximum_absolute_value median mid_range minimum minimum_absolute_value mean
mean_absolute_value mean_of_upper_decile mode range root_mean_square standard_deviation sum_of_squares
variance""".split()
CALENDARS = "gregorian standard proleptic_gregorian noleap 365_day all_leap 366_day 360_day julian none".split()
ORIGIN = {"longitude_of_projection_origin", "latitude_of_projection_origin"}
CONE = {"standard_parallel", "longitude_of_central_meridian", "latitude_of_projection_origin"}
MAPPINGS = {  # appendix F: the parameters that are not optional
    "albers_conical_equal_area": CONE,
    "lambert_conformal_conic": CONE,
    "lambert_azimuthal_equal_area": ORIGIN,
    "mercator": {"longitude_of_projection_origin", "scale_factor_at_projection_origin"},
    "oblique_mercator": ORIGIN | {"azimuth_of_central_line", "scale_factor_at_projection_origin"},
    "polar_stereographic": {"straight_vertical_longitude_from_pole", "latitude_of_projection_origin"},
    "stereographic": ORIGIN | {"scale_factor_at_projection_origin"},
    "transverse_mercator": {
        "scale_factor_at_central_meridian",
        "longitude_of_central_meridian",
        "latitude_of_projection_origin",
    },
}
MAPPING_WORDS = {
    "grid_mapping_name",
    "crs_wkt",
    "geographic_crs_name",
    "horizontal_datum_name",
    "prime_meridian_name",
    "projected_crs_name",
    "reference_ellipsoid_name",
}
TOGETHER = ["reference_ellipsoid_name", "prime_meridian_name", "horizontal_datum_name", "geographic_crs_name"]
OWN = {"spatial_ref", "GeoTransform"}  # GDAL's, not CF's
BOUND_TO = {"units", "standard_name", "axis", "positive", "calendar"}  # not to be repeated on bounds


class Units:
    """UDUNITS, the package that CF defines units by."""

    def __init__(self):
        self.udunits = ctypes.CDLL("libudunits2.so.0")
        for name in ("ut_read_xml", "ut_parse"):
            getattr(self.udunits, name).restype = ctypes.c_void_p
        self.udunits.ut_parse.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
        self.udunits.ut_are_convertible.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
        self.udunits.ut_set_error_message_handler(ctypes.cast(self.udunits.ut_ignore, ctypes.c_void_p))
        self.system = self.udunits.ut_read_xml(None)

    def parse(self, unit):
        return self.udunits.ut_parse(self.system, unit.encode(), 0)

    def convertible(self, unit, other):
        pair = self.parse(unit), self.parse(other)
        return None not in pair and self.udunits.ut_are_convertible(*pair) != 0


units = Units()


def writable_copy(path, copy):
    """A copy that can be written to: a file made in memory keeps no order of creation, which NetCDF asks for."""
    subprocess.run(["nccopy", path, copy], check=True)


def convertible(unit, other):
    return (
        subprocess.run(["udunits2", "-H", unit, "-W", other], capture_output=True, stdin=subprocess.DEVNULL).returncode
        == 0
    )


class Check:
    def __init__(self, path):
        self.path = path
        self.file = netCDF4.Dataset(path)
        self.file.set_auto_maskandscale(False)
        self.variables = self.file.variables
        self.bounds = {v.bounds for v in self.variables.values() if "bounds" in v.ncattrs()}
        self.mappings = {v.grid_mapping for v in self.variables.values() if "grid_mapping" in v.ncattrs()}
        self.coordinates = {n for n, v in self.variables.items() if v.dimensions == (n,)}
        self.data = [n for n in self.variables if n not in self.bounds | self.mappings | self.coordinates]
        self.faults = []

    def need(self, truth, section, text):
        if not truth:
            self.faults.append(f"{section}: {text}")

    def run(self):
        self.need(self.path.endswith(".nc"), "2.1", "the file's name does not end in .nc")
        header = subprocess.run(["ncdump", "-h", self.path], capture_output=True, text=True, check=True).stdout
        self.need(
            not re.search(r"^\s*string \w*:", header, re.M), "2.2", "an attribute is of type string, not of characters"
        )
        self.names()
        self.description()
        for name, variable in self.variables.items():
            self.variable(name, variable)
        for name in self.coordinates:
            self.coordinate(name, self.variables[name])
        for name in self.data:
            self.data_variable(name, self.variables[name])
        for name in self.mappings:
            self.grid_mapping(name)
        for name, variable in self.variables.items():
            if "bounds" in variable.ncattrs():
                self.boundary(name, variable)
        self.file.close()
        return self.faults

    def names(self):
        words = (
            list(self.variables)
            + list(self.file.dimensions)
            + [a for v in self.variables.values() for a in v.ncattrs() if a != "_FillValue"]
        )
        for word in words:
            self.need(
                re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", word),
                "2.3",
                f"the name {word} holds more than letters, digits and underscores",
            )
        self.need(
            len({n.lower() for n in self.variables}) == len(self.variables), "2.3", "two names differ in case alone"
        )

    def description(self):
        get = lambda name: getattr(self.file, name, "")
        self.need("CF-1.8" in re.split(r"[ ,]+", get("Conventions")), "2.6.1", "Conventions does not say CF-1.8")
        for name in ("title", "history", "institution", "source", "comment"):
            self.need(isinstance(get(name), str) and get(name), "2.6.2", f"{name} is missing or no text")

    def variable(self, name, v):
        has = v.ncattrs()
        self.need(len(set(v.dimensions)) == len(v.dimensions), "2.4", f"{name} has a dimension twice")
        places = [
            "TZYX".find(self.variables[d].axis)
            for d in v.dimensions
            if d in self.coordinates and "axis" in self.variables[d].ncattrs()
        ]
        self.need(places == sorted(places), "2.4", f"the dimensions of {name} are not in the order T, Z, Y, X")
        for fill in ("_FillValue", "missing_value"):
            if fill in has:
                self.need(
                    numpy.asarray(v.getncattr(fill)).dtype == v.dtype, "2.5.1", f"{fill} of {name} is of another type"
                )
        self.need(
            not ("valid_range" in has and {"valid_min", "valid_max"} & set(has)),
            "2.5.1",
            f"{name} says its range twice",
        )
        if name in self.bounds:
            return
        self.need("long_name" in has or "standard_name" in has, "3", f"{name} has neither long_name nor standard_name")
        if name in self.mappings:
            return
        self.need("units" in has and units.parse(v.units), "3.1", f"the units of {name} are not understood by UDUNITS")
        if "standard_name" in has:
            canonical = STANDARD_NAMES.get(v.standard_name)
            self.need(canonical, "3.3", f"{name}: {v.standard_name} is not among the standard names known here")
            unit = re.sub(" since .*", "", getattr(v, "units", ""))
            self.need(
                canonical is None or units.convertible(unit, canonical),
                "3.1",
                f"{name}: its units are not those of {v.standard_name}",
            )
        for other in ("axis", "calendar", "bounds"):
            self.need(
                other not in has or name in self.coordinates, "4", f"{name} has {other} but is no coordinate variable"
            )
        self.need(
            "scale_factor" not in has and "add_offset" not in has, "8.1", f"{name} is packed, which is not checked here"
        )

    def coordinate(self, name, v):
        values = v[:]
        self.need(
            numpy.isfinite(values).all()
            and (values.size < 2 or (numpy.diff(values) > 0).all() or (numpy.diff(values) < 0).all()),
            "5",
            f"{name} is not strictly monotonic",
        )
        self.need(
            not {"_FillValue", "missing_value"} & set(v.ncattrs()), "5", f"{name} is a coordinate and has a fill value"
        )
        # Of what is no place and no time, such as a threshold, CF asks for no axis; it has no standard name either.
        elsewhere = "axis" not in v.ncattrs() and "standard_name" not in v.ncattrs()
        self.need(elsewhere or getattr(v, "axis", "") in ("X", "Y", "Z", "T"), "4", f"{name} has no legal axis")
        is_time = getattr(v, "axis", "") == "T"
        self.need(
            is_time == (" since " in getattr(v, "units", "")),
            "4.4",
            f"{name}: time, and time alone, counts from a reference time",
        )
        self.need(is_time or "calendar" not in v.ncattrs(), "4.4.1", f"{name} is no time and has a calendar")
        if not is_time:
            return
        calendar = getattr(v, "calendar", "standard")
        self.need(calendar.lower() in CALENDARS, "4.4.1", f"{calendar} is no calendar of CF")
        try:
            dates = netCDF4.num2date(values, v.units, calendar)
            self.need(
                (dates[0].year, dates[0].month, dates[0].day) > (1582, 10, 15),
                "4.4.1",
                "time crosses the reform of the calendar",
            )
        except Exception as error:
            self.need(False, "4.4", f"the reference time of {name} is not legal: {error}")

    def data_variable(self, name, v):
        coordinates = [self.variables[d] for d in v.dimensions if d in self.coordinates]
        axes = [c.axis for c in coordinates if "axis" in c.ncattrs()]
        self.need(len(coordinates) == len(v.dimensions), "5", f"a dimension of {name} has no coordinate variable")
        self.need(len(set(axes)) == len(axes), "4", f"{name} has two coordinates for an axis")
        for other in getattr(v, "coordinates", "").split():
            self.need(other in self.variables, "5", f"{name} names the coordinate {other}, which does not exist")
        if "grid_mapping" in v.ncattrs():
            self.need(
                v.grid_mapping in self.variables,
                "5.6",
                f"{name} names the grid mapping {v.grid_mapping}, which does not exist",
            )
        if "cell_methods" in v.ncattrs():
            self.cell_methods(name, v)

    def cell_methods(self, name, v):
        one = r"((?:\w+: )+)(\w+)( where \w+( over \w+)?)?( \(.*?\))?"
        self.need(
            re.fullmatch(rf"{one}( {one})*", v.cell_methods),
            "7.3",
            f"{name}: cell_methods are not of the form 'name: method'",
        )
        seen = []
        for words, method, *_ in re.findall(one, v.cell_methods):
            self.need(method in METHODS, "7.3", f"{name}: {method} is no method of appendix E")
            seen += words.replace(":", "").split()
        legal = set(v.dimensions) | set(STANDARD_NAMES) | {"area"}
        self.need(set(seen) <= legal, "7.3", f"{name}: cell_methods name what is neither dimension nor standard name")
        self.need(len(set(seen)) == len(seen), "7.3", f"{name}: cell_methods name a dimension twice")
        self.need("time" not in v.dimensions or "time" in seen, "7.3", f"{name}: nothing is said of time")

    def grid_mapping(self, name):
        if name not in self.variables:
            return
        v = self.variables[name]
        has = set(v.ncattrs())
        self.need(v.dimensions == (), "5.6", f"{name} has dimensions")
        self.need(
            getattr(v, "grid_mapping_name", "") in MAPPINGS, "5.6", f"{name} has no grid_mapping_name of appendix F"
        )
        missing = MAPPINGS.get(getattr(v, "grid_mapping_name", ""), set()) - has
        self.need(not missing, "F", f"{name} lacks {', '.join(missing)}")
        for key in has - OWN - {"long_name"}:
            self.need(
                isinstance(v.getncattr(key), str) == (key in MAPPING_WORDS), "F", f"{name}: {key} is of the wrong type"
            )
        self.need(len(has & set(TOGETHER)) in (0, len(TOGETHER)), "5.6", f"of the names in {name} some are missing")
        self.need(
            "projected_crs_name" not in has or "geographic_crs_name" in has, "5.6", f"{name} has no geographic_crs_name"
        )
        try:
            known = osr.SpatialReference(wkt=v.crs_wkt)
        except Exception as error:
            return self.need(False, "5.6", f"crs_wkt is no WKT: {error}")
        self.need(
            known.GetName() == getattr(v, "projected_crs_name", known.GetName()),
            "5.6.1",
            "projected_crs_name is not that of crs_wkt",
        )
        self.need(
            self.same_place(name, known), "5.6.1", f"the parameters of {name} are another projection than its crs_wkt"
        )

    def same_place(self, name, known):
        """From its parameters alone the corners have the same longitudes and latitudes (1e-8 degrees: a millimetre)."""
        opened = self.by_parameters(name)
        if opened is None:
            return False
        places = []
        for crs in (known, opened):
            crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            base = crs.CloneGeogCS()
            base.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
            to = osr.CoordinateTransformation(crs, base)
            x, y = self.variables["x"][:], self.variables["y"][:]
            places.append([to.TransformPoint(float(a), float(b))[:2] for a in (x[0], x[-1]) for b in (y[0], y[-1])])
        return numpy.abs(numpy.subtract(*places)).max() < 1e-8

    def by_parameters(self, name):
        """What GDAL makes of the grid mapping without its WKT."""
        v = self.variables[name]
        if v.grid_mapping_name == "oblique_mercator":  # GDAL takes it for another variant; CF refers to PROJ's omerc
            crs = osr.SpatialReference()
            crs.ImportFromProj4(
                f"+proj=omerc +lat_0={v.latitude_of_projection_origin} +lonc={v.longitude_of_projection_origin} "
                f"+alpha={v.azimuth_of_central_line} +k={v.scale_factor_at_projection_origin} "
                f"+x_0={v.false_easting} +y_0={v.false_northing} "
                f"+a={v.semi_major_axis} +rf={v.inverse_flattening}"
            )
            return crs
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "parameters.nc")
            writable_copy(self.path, path)
            with netCDF4.Dataset(path, "a") as copy:
                for attribute in OWN | {"crs_wkt"}:
                    if attribute in copy[name].ncattrs():
                        copy[name].delncattr(attribute)
            user = next(n for n in self.data if getattr(self.variables[n], "grid_mapping", "") == name)
            return gdal.Open(f'NETCDF:"{path}":{user}').GetSpatialRef()

    def boundary(self, name, v):
        self.need(v.bounds in self.variables, "7.1", f"{name} names bounds that do not exist")
        if v.bounds not in self.variables:
            return
        b = self.variables[v.bounds]
        self.need(
            b.dimensions[:-1] == v.dimensions and b.shape[-1] == 2,
            "7.1",
            f"{v.bounds} has other dimensions than {name}",
        )
        self.need(b.dtype.kind == "f", "7.1", f"{v.bounds} does not hold numbers")
        self.need(
            not BOUND_TO & set(b.ncattrs()) and "_FillValue" not in b.ncattrs(),
            "7.1",
            f"{v.bounds} repeats attributes of {name}",
        )
        low, high = b[:].min(axis=-1), b[:].max(axis=-1)
        self.need(
            ((low < v[:]) & (v[:] < high)).all() and numpy.array_equal(high[:-1], low[1:]),
            "7.1",
            f"{name} does not lie in its cells",
        )


if __name__ == "__main__":
    lines = [f"{os.path.basename(path)}: {fault}" for path in sys.argv[1:] for fault in Check(path).run()]
    print("\n".join(lines) if lines else "no faults")
    sys.exit(1 if lines else 0)
