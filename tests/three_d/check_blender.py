# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes and terrain opened and drawn by Blender: blender -b -P check_blender.py -- OUT."""
import math
import os
import sys

import bpy
from mathutils import Vector


def opened(out, frames):
    """The sequence of volumes and the ground, in an empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_mesh.ply(filepath=f"{out}/3d/volumes/terrain.ply")
    ground = bpy.context.object
    bpy.ops.object.volume_import(filepath=f"{out}/3d/volumes/flow.{frames // 3:04}.vdb")
    flow = bpy.context.object
    assert flow.data.grids.load(), f"Blender cannot load the volume: {flow.data.grids.error_message}"
    grids = {grid.name: grid.data_type for grid in flow.data.grids}
    assert grids == {"density": "FLOAT", "velocity": "VECTOR_FLOAT"}, f"Blender sees {grids}"
    return ground, flow


def box(thing):
    corners = [thing.matrix_world @ Vector(corner) for corner in thing.bound_box]
    return [(min(c[a] for c in corners), max(c[a] for c in corners)) for a in range(3)]


def check_places(ground, flow):
    """The flow lies within the ground's sides, and not far above or below it."""
    g, f = box(ground), box(flow)
    cell = g[0][1] / 20
    for a in range(2):
        assert g[a][0] - cell <= f[a][0] and f[a][1] <= g[a][1] + cell, f"axis {a}: flow {f[a]}, ground {g[a]}"
    assert g[2][0] - 20 <= f[2][0] and f[2][1] <= g[2][1] + 100, f"heights: flow {f[2]}, ground {g[2]}"
    print(f"Blender {bpy.app.version_string}: flow {f}, ground {g} [m]")


def material(thing, kind, **inputs):
    made = bpy.data.materials.new(kind)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    nodes.clear()
    shader, end = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
    for name, value in inputs.items():
        shader.inputs[name.replace("_", " ")].default_value = value
    made.node_tree.links.new(shader.outputs[0], end.inputs["Volume" if "Volume" in kind else "Surface"])
    thing.data.materials.append(made)


def draw(out, ground, flow):
    material(ground, "ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.45, 1))
    # Density is in kg/m3: 0.0001 of it lets light some metres into the mass.
    material(flow, "ShaderNodeVolumePrincipled", Color=(0.9, 0.25, 0.1, 1), Density=0.0001)
    g = box(ground)
    middle = Vector([0.5 * (low + high) for low, high in g])
    size = max(high - low for low, high in g)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = middle + Vector((0.15 * size, -0.9 * size, 0.9 * size))
    camera.rotation_euler = (middle - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_end = 10 * size
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 4
    sun.rotation_euler = (math.radians(40), math.radians(-30), 0)
    scene = bpy.context.scene
    for thing in (camera, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 8
    scene.cycles.use_denoising = False
    scene.cycles.volume_step_rate = 4
    scene.render.resolution_x, scene.render.resolution_y = 480, 360
    scene.render.filepath = f"{out}/blender.png"
    bpy.ops.render.render(write_still=True)


def main():
    (out,) = sys.argv[sys.argv.index("--") + 1 :]
    frames = len([name for name in os.listdir(f"{out}/3d/volumes") if name.endswith(".vdb")])
    ground, flow = opened(out, frames)
    check_places(ground, flow)
    draw(out, ground, flow)


main()
