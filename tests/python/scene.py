# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the package share: two runs of the bowl, made by tests/pipeline/python_test.sh where they stand."""
import pathlib

HERE = pathlib.Path.cwd()
FIRST, SECOND, RECIPE = HERE / "a", HERE / "b", HERE / "recipe.toml"
