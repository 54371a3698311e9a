# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps with coordinates, units and CRS."""
import numpy
import xarray


def on_map(values, west, south, cell, unit, title, crs_wkt, name=None):
    """A map as a DataArray on y and x, the centres of its cells [m]; NaN where it has no value.

    values: [rows][columns], row 0 southernmost, or any array with these as its last two axes and time before them.
    west, south: edges of the first cell [m]; cell: its width [m]. The CRS stands where rioxarray and GDAL look for it:
    in the attribute crs_wkt of the coordinate spatial_ref ("": local metric coordinates).
    """
    rows, columns = values.shape[-2:]
    x = xarray.Variable("x", west + cell * (numpy.arange(columns) + 0.5), _axis("projection_x_coordinate", "easting"))
    y = xarray.Variable("y", south + cell * (numpy.arange(rows) + 0.5), _axis("projection_y_coordinate", "northing"))
    reference = xarray.Variable((), 0, {"crs_wkt": crs_wkt, "spatial_ref": crs_wkt} if crs_wkt else {"crs_wkt": ""})
    dimensions = ("time", "y", "x")[-len(values.shape):]
    attributes = {"units": unit, "long_name": title, "grid_mapping": "spatial_ref", "cell_m": float(cell)}
    coordinates = {"y": y, "x": x, "spatial_ref": reference}
    # A Dataset leaves on disk what is read when it is looked at; the constructor of DataArray reads it.
    whole = xarray.Dataset({"values": xarray.Variable(dimensions, values, attributes)}, coordinates)
    return whole["values"].rename(name)


def _axis(standard_name, title):
    return {"units": "m", "standard_name": standard_name, "long_name": title}


def read_raster(path):
    """A raster of Talus (survey/*.tif, maps/*.tif) as a DataArray on y and x, south to north; nodata is NaN.

    Needs rasterio. Its metadata items stand among the attributes.
    """
    import rasterio

    with rasterio.open(path) as file:
        values = file.read(1, masked=True).astype(float).filled(numpy.nan)[::-1]
        crs = file.crs.to_wkt() if file.crs else ""
        unit, title = file.units[0] or "", file.descriptions[0] or file.tags().get("QUANTITY", "")
        bounds, cell, tags = file.bounds, file.transform.a, file.tags()
    raster = on_map(values, bounds.left, bounds.bottom, cell, unit, title, crs)
    raster.attrs.update({name: value for name, value in tags.items() if name != "AREA_OR_POINT"})
    return raster
