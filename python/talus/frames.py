# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a run that are read when they are looked at."""
import h5py
import numpy
from xarray.backends import BackendArray
from xarray.core import indexing


class FramesOnDisk(BackendArray):
    """Thickness over time [time][rows][columns] in a run.h5. No handle stays open; what is asked for is read."""

    def __init__(self, path, name):
        self._path, self._name = path, name
        with h5py.File(path) as file:
            self.shape, self.dtype = file[name].shape, numpy.dtype(file[name].dtype)

    def __getitem__(self, key):
        # HDF5 takes no negative steps and only one list of indices; xarray does the rest in memory.
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key):
        forwards, turned = [], []
        for part, length in zip(key, self.shape):
            if isinstance(part, slice) and part.step is not None and part.step < 0:
                chosen = range(*part.indices(length))[::-1]
                part = slice(chosen.start, chosen.stop, chosen.step)
                turned.append(slice(None, None, -1))
            elif isinstance(part, slice):
                turned.append(slice(None))
            forwards.append(part)
        with h5py.File(self._path) as file:
            return file[self._name][tuple(forwards)][tuple(turned)]


def on_disk(path, name):
    """The dataset `name` of a file, in the form that xarray reads when it is looked at."""
    return indexing.LazilyIndexedArray(FramesOnDisk(path, name))
