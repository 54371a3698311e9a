# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Says how far a second run differs from a first one.

usage: compare_two_runs.py FIRST SECOND [THRESHOLD_M]
"""
import sys

import talus


def main(first, second, threshold_m=None):
    found = talus.compare(first, second, threshold_m and float(threshold_m))
    print(f"share of the deposit that lies elsewhere  {100 * found.elsewhere:.2f} %")
    print(f"overlap of the footprints (CSI)           {found.footprint_csi:.3f}")
    print(f"overlap of the deposits (CSI)             {found.deposit_csi:.3f}")
    print(f"run-out                                   {found.runout_first_m:.0f} m and {found.runout_second_m:.0f} m")
    a, b = (talus.open_run(path).used("solve") for path in (first, second))
    key = "solve.base.friction_angle_deg"
    print(f"friction angle of the bed                 {a[key]:g} deg and {b[key]:g} deg")


if __name__ == "__main__":
    main(*sys.argv[1:])
