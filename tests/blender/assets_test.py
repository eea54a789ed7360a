"""The add-on on the scene of ../shared/assets/blender: panes, a glass ball, smoke cards and cut-out leaves."""

import os
import runpy
import sys

import bpy
from blender_stage import FOLDER, MORE, BlenderTest, main, program, switch_on

SIZE, SAMPLES = "320x180", "8"


class Assets(BlenderTest):
    """The scene that the script makes, with its lit materials."""

    def test_the_picture_is_the_programs(self):
        sys.argv = ["make.py", "--", "--out", os.path.join(FOLDER, "made"), "--what", "none", "--res", SIZE, "--spp",
                    SAMPLES, "--seed", "21"]
        made = runpy.run_path(MORE[0])
        switch_on()  # the script reads the factory settings, which know no add-on
        made["look"](True)
        made["cutout"](False)
        scene = bpy.context.scene
        scene.cycles.samples, scene.cycles.use_denoising = int(SAMPLES), False
        bpy.data.collections["transparent"].pellucid_transparent = True
        chosen = scene.pellucid
        chosen.folder = folder = os.path.join(FOLDER, "assets")
        chosen.more = f"--preview {folder}/composited.png"
        self.composite()
        colour = ",".join(f"{value * strength:.9g}" for value, strength in self.world(scene))
        # The ball is the only closed mesh with transmission.
        self.hold(folder, ["--environment", colour, "--filter", "blackman-harris:1.5", "--set", "ball_lit.thin=false"])
        changed = program("compare", os.path.join(folder, "opaque.exr"), os.path.join(folder, "composited.exr"),
                          "--metadata", "ignore")
        self.assertEqual(changed.returncode, 1)
        print("look at", os.path.join(folder, "composited.png"))

    @staticmethod
    def world(scene):
        """The colours of the world, each with the strength."""
        inputs = scene.world.node_tree.nodes["Background"].inputs
        return [(value, inputs["Strength"].default_value) for value in inputs["Color"].default_value[:3]]


if __name__ == "__main__":
    main()
