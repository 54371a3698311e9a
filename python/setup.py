# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the package with the module that CMake has built beside it (tools/make-wheel.sh)."""
import os

import setuptools


class WithModule(setuptools.Distribution):
    """A package that holds machine code: its wheel is of one Python and one machine."""

    def has_ext_modules(self):
        return True


setuptools.setup(
    name="talus",
    version=os.environ["TALUS_VERSION"],
    description="landslides in three dimensions, from survey to map",
    license="GPL-3.0-or-later",
    packages=["talus"],
    package_data={"talus": ["*.so*"]},
    python_requires=">=3.11",
    install_requires=["numpy"],
    extras_require={"results": ["h5py", "xarray", "rasterio"]},
    distclass=WithModule,
)
