"""What the tests inside Blender share: the add-on as a user installs it, and a small scene."""

import filecmp
import json
import os
import subprocess
import sys
import unittest

import bpy

ZIP, PROGRAM, FOLDER, *MORE = sys.argv[sys.argv.index("--") + 1:]
WORLD = (0.25, 0.5, 0.75)  # exact in floats, and as text


def install():
    """Installs the zip; the caller switches it on."""
    bpy.ops.preferences.addon_install(filepath=ZIP, overwrite=True)


def switch_on():
    """Switches the add-on on, with the program that is tested."""
    bpy.ops.preferences.addon_enable(module="pellucid")
    use_program(PROGRAM)


def use_program(path):
    """What the add-on runs."""
    bpy.context.preferences.addons["pellucid"].preferences.program = path


def program(*words):
    """Runs the program; returns how it ended."""
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)


def _material(name, colour, **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    for socket, value in inputs.items():
        shader.inputs[socket].default_value = value
    if "Alpha" in inputs:
        material.blend_method = "BLEND"
    return material


def _object(add, name, material, **place):
    add(**place)
    made = bpy.context.view_layer.objects.active
    made.name = name
    made.data.materials.append(material)
    return made


def small_scene():
    """A floor and a red box; before them a blue pane, marked, and a glass ball in a marked collection, below an empty.
    The pane moves from frame 1 to 3."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True, load_ui=False)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    scene.render.resolution_x, scene.render.resolution_y = 96, 54
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*WORLD, 1)
    meshes = bpy.ops.mesh
    _object(meshes.primitive_plane_add, "floor", _material("floor", (0.6, 0.6, 0.6)), size=20)
    _object(meshes.primitive_cube_add, "box", _material("red", (0.8, 0.1, 0.1)), size=1.5, location=(-1, 1, 0.75))
    pane = _object(meshes.primitive_plane_add, "pane", _material("blue", (0.1, 0.2, 0.9), Alpha=0.5), size=2,
                   location=(-0.5, -1, 1), rotation=(1.5707963, 0, 0))
    pane.pellucid_transparent = True
    for frame, x in ((1, -0.5), (3, 0.5)):
        pane.location.x = x
        pane.keyframe_insert("location", frame=frame)
    holder = bpy.data.objects.new("holder", None)
    holder.location = (1, 0, 0)
    scene.collection.objects.link(holder)
    ball = _object(meshes.primitive_uv_sphere_add, "ball", _material("glass", (0.9, 1, 0.9), Transmission=1.0,
                                                                     Roughness=0.0), radius=0.7, location=(0, 0, 0.8))
    ball.parent = holder
    things = bpy.data.collections.new("things")
    scene.collection.children.link(things)
    scene.collection.objects.unlink(ball)
    things.objects.link(ball)
    things.pellucid_transparent = True
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("day", "SUN"))
    sun.rotation_euler, sun.data.energy = (0.6, 0.3, 0), 2
    scene.collection.objects.link(sun)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0, -6, 2), (1.3, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.frame_start, scene.frame_end = 1, 3
    scene.frame_set(1)
    scene.pellucid.folder = os.path.join(FOLDER, "shot")
    return scene


class BlenderTest(unittest.TestCase):
    """A test with the add-on switched on."""

    def composite(self):
        """Presses the button."""
        self.assertEqual(bpy.ops.pellucid.composite(), {"FINISHED"})

    def refused(self):
        """Presses the button, and returns the one sentence of its error."""
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.pellucid.composite()
        return str(caught.exception)

    def hold(self, folder, words, number=""):
        """The add-on's picture is the program's, to the byte, of the same two files."""
        name = os.path.join(folder, "again.exr")
        ended = program("composite", os.path.join(folder, f"opaque{number}.exr"),
                        os.path.join(folder, "transparent.glb"), "-o", name, *words)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        mine = os.path.join(folder, f"composited{number}.exr")
        ended = program("compare", mine, name, "--metadata", "ignore")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        if not number:  # the header of a sequence has the digest of what it was made from
            self.assertTrue(filecmp.cmp(mine, name, shallow=False))

    def report(self, path):
        """What `inspect --json` says of a file."""
        ended = program("inspect", path, "--json")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return json.loads(ended.stdout)


def main():
    """Runs the tests of the module that Blender was started with; Blender's exit code is theirs."""
    install()
    switch_on()
    ran = unittest.main(module="__main__", argv=["test"], exit=False, verbosity=2)
    if not ran.result.wasSuccessful() or not ran.result.testsRun:
        raise SystemExit(1)
