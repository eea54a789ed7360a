"""The add-on on a small scene, inside Blender."""

import json
import os
import stat
import types

import bpy
from blender_stage import FOLDER, PROGRAM, BlenderTest, main, program, small_scene, switch_on, use_program

SCENE_FLAGS = ["--environment", "0.25,0.5,0.75", "--filter", "blackman-harris:1.5", "--set", "glass.thin=false"]


def what_blender_has():
    """All that an add-on may leave behind."""
    types = {name for name in dir(bpy.types) if "pellucid" in name.lower()}
    operators = set(dir(bpy.ops.pellucid)) if "pellucid" in dir(bpy.ops) else set()
    properties = {(owner.__name__, name) for owner in (bpy.types.Scene, bpy.types.Object, bpy.types.Collection)
                  for name in owner.bl_rna.properties.keys()}
    handlers = {name: len(getattr(bpy.app.handlers, name)) for name in dir(bpy.app.handlers)
                if isinstance(getattr(bpy.app.handlers, name), list)}
    return types, operators, properties, handlers


def state_of(scene):
    """What the button must leave as it was."""
    render = scene.render
    return {**{name: str(getattr(render, name)) for name in render.bl_rna.properties.keys()},
            **{"image " + name: str(getattr(render.image_settings, name)) for name in ("file_format", "color_mode",
                                                                                      "color_depth", "exr_codec")},
            "hidden": [each.name for each in scene.objects if each.hide_render],
            "passes": [(layer.name, layer.use, layer.use_pass_z) for layer in scene.view_layers],
            "nodes": scene.use_nodes, "frame": scene.frame_current, "selected": len(bpy.context.selected_objects)}


def script(name, text):
    """A program of our own, of another version."""
    path = os.path.join(FOLDER, name)
    with open(path, "w", encoding="utf-8") as out:
        out.write("#!/bin/sh\n[ \"$1\" != --version ] || { echo another; exit; }\n" + text)
    os.chmod(path, stat.S_IRWXU)
    return path


class Registering(BlenderTest):
    """The add-on as a guest."""

    def test_it_leaves_nothing(self):
        bpy.ops.preferences.addon_disable(module="pellucid")
        before = what_blender_has()
        switch_on()
        self.assertNotEqual(what_blender_has(), before)
        self.assertIn(("Scene", "pellucid"), what_blender_has()[2])
        bpy.ops.preferences.addon_disable(module="pellucid")
        self.assertEqual(what_blender_has(), before)
        switch_on()

    def test_widgets_say_what_the_help_says(self):
        scene = small_scene()
        told = " ".join(program("composite", "--help").stdout.split())
        shown = [each for each in scene.pellucid.bl_rna.properties if each.identifier.startswith("flag_")]
        self.assertGreaterEqual(len(shown), 6)
        for each in shown:
            self.assertIn("--" + each.identifier[5:].replace("_", "-"), told)
            self.assertIn(" ".join(each.description.split()), told)


    def test_the_panel_shows_what_there_is(self):
        scene = small_scene()
        panel, layout = bpy.types.PELLUCID_PT_render, Layout()
        panel.draw(types.SimpleNamespace(layout=layout, _draw_marks=panel._draw_marks), bpy.context)
        settings = {each.identifier for each in scene.pellucid.bl_rna.properties} - {"rna_type", "name"}
        self.assertEqual(settings - layout.shown, set())
        self.assertIn("pellucid.composite", layout.shown)


class Layout:
    """Stands for Blender's, which there is only with a window: notes what is shown, all of which must exist."""

    def __init__(self):
        self.shown = set()

    def row(self, **_words):
        """Part of the same."""
        return self

    column = row

    def label(self, **_words):
        """A text."""

    def prop(self, owner, name, **_words):
        """A widget."""
        getattr(owner, name)
        self.shown.add(name)

    def operator(self, name, **_words):
        """A button."""
        module, function = name.split(".")
        getattr(getattr(bpy.ops, module), function).get_rna_type()
        self.shown.add(name)
        return types.SimpleNamespace()


class Compositing(BlenderTest):
    """The button."""

    def setUp(self):
        self.scene = small_scene()
        self.folder = self.scene.pellucid.folder

    def test_the_picture_is_the_programs(self):
        before = state_of(self.scene)
        self.composite()
        self.assertEqual(state_of(self.scene), before)
        self.hold(self.folder, SCENE_FLAGS)
        opaque, picture = (os.path.join(self.folder, name) for name in ("opaque.exr", "composited.exr"))
        self.assertEqual(program("compare", opaque, picture, "--metadata", "ignore").returncode, 1)
        report = self.report(opaque)
        types = {channel["name"]: channel["type"] for channel in report["parts"][0]["channels"]}
        self.assertEqual(types["ViewLayer.Combined.R"], "float")
        self.assertEqual(types["ViewLayer.Depth.Z"], "float")
        self.assertEqual(report["preset"]["name"], "blender")
        image = bpy.data.images["Pellucid"]
        len(image.pixels)  # Blender reads it when it is first asked for
        self.assertEqual((image.filepath, image.type), (picture, "MULTILAYER"))

    def test_the_glb_holds_what_is_marked_where_it_is(self):
        self.composite()
        page = os.path.join(self.folder, "page.html")
        ended = program("inspect", os.path.join(self.folder, "opaque.exr"), "--scene",
                        os.path.join(self.folder, "transparent.glb"), "--html", page)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        with open(page, encoding="utf-8") as text:
            rows = text.read().split("<h2>Scene</h2>")[1].split("</table>")[0]
        self.assertEqual([name for name in ("pane", "ball", "box", "floor") if f"<td>{name}</td>" in rows],
                         ["pane", "ball"])
        # The ball stands 6 m before the camera, whose axis falls by 0.27 rad, and has a radius of 0.7 m.
        self.assertRegex(rows, r"<td>ball</td><td>glass</td>.*?<td>5\.\d+ to 6\.\d+ m</td>")

    def test_what_the_view_layer_leaves_out_stays_out(self):
        lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
        bpy.data.collections["things"].objects.link(lamp)
        bpy.context.view_layer.layer_collection.children["things"].exclude = True
        self.composite()
        with open(os.path.join(self.folder, "transparent.glb"), "rb") as glb:
            names = [node["name"] for node in json.loads(glb.read()[20:].split(b"BIN\0")[0][:-4])["nodes"]]
        self.assertEqual(sorted(names), ["camera", "pane", "sun"])

    def test_widgets_become_flags(self):
        chosen = self.scene.pellucid
        chosen.flag_method, chosen.flag_aa, chosen.flag_edges, chosen.more = "weighted", 2, "off", "--weight eq7"
        chosen.flag_environment, chosen.solid = "0.1,0.1,0.1", False
        self.composite()
        self.hold(self.folder, ["--method", "weighted", "--aa", "2", "--edges", "off", "--weight", "eq7",
                                "--environment", "0.1,0.1,0.1", "--filter", "blackman-harris:1.5"])

    def test_shadows_dim_the_light_groups(self):
        bpy.context.view_layer.lightgroups.add(name="suns")
        self.scene.objects["sun"].lightgroup = "suns"
        self.scene.pellucid.flag_shadows = "exact"
        self.composite()
        self.hold(self.folder, ["--shadows", "exact", "--light", "day=ViewLayer.Combined_suns", *SCENE_FLAGS])

    def test_it_composites_again_without_rendering(self):
        self.composite()
        opaque = os.path.join(self.folder, "opaque.exr")
        before = os.stat(opaque).st_mtime_ns
        self.scene.pellucid.render_again, self.scene.pellucid.flag_method = False, "average"
        self.composite()
        self.assertEqual(os.stat(opaque).st_mtime_ns, before)
        self.hold(self.folder, ["--method", "average", *SCENE_FLAGS])

    def test_frames_move(self):
        self.scene.pellucid.animation, self.scene.pellucid.compositor = True, True
        self.composite()
        names = sorted(name for name in os.listdir(self.folder) if name.startswith("composited.0"))
        self.assertEqual(names, [f"composited.000{frame}.exr" for frame in (1, 2, 3)])
        for frame in (1, 3):
            self.hold(self.folder, [*SCENE_FLAGS, "--frame", str(frame), "--fps", "24"], f".000{frame}")
        first, last = (os.path.join(self.folder, f"composited.000{frame}.exr") for frame in (1, 3))
        self.assertEqual(program("compare", first, last, "--metadata", "ignore").returncode, 1)
        node = self.scene.node_tree.nodes["Pellucid"]
        self.assertEqual((node.image.source, node.frame_start, node.frame_duration), ("SEQUENCE", 1, 3))

    def test_the_compositor_shows_it(self):
        self.scene.pellucid.compositor = True
        self.composite()
        node = self.scene.node_tree.nodes["Pellucid"]
        self.assertEqual(node.image, bpy.data.images["Pellucid"])
        self.assertTrue(any(link.from_node == node for link in self.scene.node_tree.links))

    def test_marks(self):
        for each in self.scene.objects:
            each.select_set(each.name in ("floor", "box"))
        bpy.ops.pellucid.mark(transparent=True)
        self.assertEqual({each.name for each in self.scene.objects if each.pellucid_transparent},
                         {"floor", "box", "pane"})
        bpy.ops.pellucid.mark(transparent=False)
        self.assertEqual({each.name for each in self.scene.objects if each.pellucid_transparent}, {"pane"})


class Trouble(BlenderTest):
    """Each ends with one sentence, and leaves Blender and the folder as they were."""

    def setUp(self):
        self.scene = small_scene()
        self.chosen = self.scene.pellucid
        self.chosen.folder = os.path.join(FOLDER, "trouble", self.id())

    def tearDown(self):
        use_program(PROGRAM)

    def test_nothing_marked(self):
        self.scene.objects["pane"].pellucid_transparent = False
        bpy.data.collections["things"].pellucid_transparent = False
        self.assertIn("No object of the scene is marked as transparent: mark some", self.refused())
        self.assertFalse(os.path.exists(self.chosen.folder))

    def test_all_that_is_marked_is_hidden(self):
        for name in ("pane", "ball"):
            self.scene.objects[name].hide_render = True
        self.assertIn("All 2 marked objects are hidden from renders", self.refused())

    def test_unsaved(self):
        self.chosen.folder = "//pellucid/"
        self.assertIn("The file is not saved, and the folder //pellucid/ lies beside it: save the file", self.refused())

    def test_no_camera(self):
        self.scene.camera = None
        self.assertIn("no active camera", self.refused())

    def test_a_shifted_camera(self):
        self.scene.camera.data.shift_x = 0.1
        self.assertIn("shifted by 0.1, 0: expected 0, 0, because glTF has no shifted cameras", self.refused())

    def test_pixels_that_are_not_square(self):
        self.scene.render.pixel_aspect_x = 2
        self.assertIn("Pixels are 2 to 1: expected square ones", self.refused())

    def test_no_command_line(self):
        self.chosen.more = "--set 'a"
        self.assertIn("which is no command line", self.refused())

    def test_no_program(self):
        state = state_of(self.scene)
        use_program("/nowhere/pellucid")
        self.chosen.folder = os.path.join(FOLDER, "no-program")
        self.assertIn("/nowhere/pellucid: cannot be run: No such file or directory; expected the program",
                      self.refused())
        self.assertEqual(state_of(self.scene), state)
        self.assertEqual(os.listdir(self.chosen.folder), [], "nothing is rendered for it")

    def test_the_program_refuses(self):
        self.chosen.flag_method, self.chosen.flag_precision = "average", "published"
        self.chosen.folder = os.path.join(FOLDER, "refused")
        sentence = self.refused()
        self.assertEqual(os.listdir(self.chosen.folder), [], "nothing is rendered for it")
        self.assertIn("--precision: found published", sentence)
        self.assertIn("Exit code 2: A verb or a flag is unknown, malformed or cannot be honoured.", sentence)

    def test_a_program_that_fails(self):
        for text, expected in (("exit 77\n", "failed without a word. Exit code 77, which pellucid does not use."),
                               ("echo oh >&2; exit 6\n", "oh. Exit code 6: Disk, memory or the GL device ran out."),
                               ("kill -9 $$\n", "It was ended by signal 9.")):
            use_program(script("failing", text))
            self.assertIn(expected, self.refused())

    def test_notes_of_the_program(self):
        note = json.dumps({"level": "info", "message": "a guess", "frame": "7"})
        out = os.path.join(self.chosen.folder, "composited.exr")
        use_program(script("noting", f"echo '{note}' >&2; cp '{self.chosen.folder}/opaque.exr' '{out}'\n"))
        operator = __import__("pellucid.program", fromlist=["run"])
        self.composite()
        self.assertEqual(operator.run(os.path.join(FOLDER, "noting"), []), ["Frame 7: a guess"])

    def test_a_program_that_is_ended(self):
        module = __import__("pellucid.program", fromlist=["Running"])
        running = module.Running(script("endless", "exec sleep 600\n"), [])
        self.assertFalse(running.ended())
        running.stop()
        self.assertTrue(running.ended())
        with self.assertRaisesRegex(Exception, "It was ended by signal 15"):
            running.notes()


if __name__ == "__main__":
    main()
