// The table of producers. Facts marked "documented" are the vendor's words, "tested" those of a file that was looked
// at, "source" those of the program's text. What nobody says is left to the planes of the picture, and asked where they
// are silent.
#include "gbuffer/producers.h"

namespace pellucid {
namespace {

constexpr const char* kExrCamera = "worldToCamera and worldToNDC, read";

std::vector<Producer> filmRenderers() {
  return {
      {.name = "blender",
       .title = "Blender's multilayer EXR, Cycles and Eevee",
       .marks = {{"BlenderMultiChannel"}, {"cycles.", true}},
       .depth = "depth.z",
       .kind = "planar",
       .normals = NormalSpace::worldZUp,
       .givesWay = "composite",
       .nothing = "1e10; 1e11 outside a render border",
       .filter = "the first hit of the pixel's first sample, transparent things included; panoramas store rays",
       .beauty = "VIEWLAYER.Combined",
       .views = "before the channel: VIEWLAYER.Combined.left.R",
       .occlusion = "VIEWLAYER.AO",
       .lightGroups = "VIEWLAYER.Combined_GROUP",
       .source = "tested with 3.4.1, and its source"},
      {.name = "arnold",
       .title = "Arnold",
       .marks = {{"arnold/", true}},
       .depth = "z",
       .kind = "planar",
       .nothing = "1e12 or 1e30",
       .filter = "the closest hit, with closest_filter",
       .lightGroups = "RGBA_GROUP",
       .camera = "worldToCamera and worldToNDC, with arnold/camera/near_clip and far_clip, read",
       .source = "documented, and the source of its EXR driver's readers"},
      {.name = "renderman",
       .title = "RenderMan",
       .marks = {{"Software", false, "RenderMan"}, {"renderman/", true}},
       .names = {"ci.r", "z"},
       .depth = "z",
       .kind = "planar",
       .filter = "the nearest, with zmin",
       .beauty = "Ci",
       .lightGroups = "free names of light path expressions",
       .camera = kExrCamera,
       .source = "documented, and Gaffer's source; its far value is not known"},
      {.name = "vray",
       .title = "V-Ray",
       .marks = {{"vray/", true}, {"vfb2_layers_json"}, {"cameraTransform"}, {"Software", false, "V-Ray"}},
       .names = {"vrayzdepth*"},
       .depth = "",
       .kind = "planar|ray",
       .mayBeRamp = true,
       .filter = "by the element's filter option",
       .occlusion = "VRayExtraTex",
       .lightGroups = "VRayLightSelect",
       .camera = "cameraTransform and cameraFov, whose axes depend on the host: not read",
       .source = "documented: the element is clamped to 0..1 by its depth limits unless clamp and invert are off"},
      {.name = "karma",
       .title = "Karma, husk",
       .marks = {{"husk:", true}, {"karma:", true}},
       .names = {"hitpz"},
       .depth = "hitpz",
       .kind = "planar|ray",
       .filter = "one sample, by the zmin or zmax filter",
       .beauty = "C",
       .lightGroups = "split by tags of light path expressions",
       .source = "documented as raw distances; along what is not said"},
      {.name = "mantra",
       .title = "Mantra",
       .marks = {{"Software", false, "mantra"}, {"Software", false, "Mantra"}},
       .kind = "planar|ray",
       .beauty = "C",
       .source = "users' reports: z may be negative, which is seen by its sign"},
      {.name = "3delight",
       .title = "3Delight",
       .marks = {{"Software", false, "3Delight"}},
       .depth = "z",
       .kind = "planar|ray",
       .normals = NormalSpace::camera,
       .source = "documented as distance to the camera; its camera space looks down -z"},
      {.name = "redshift",
       .title = "Redshift",
       .marks = {{"rs/", true}},
       .depth = "z",
       .kind = "planar|ray",
       .camera = "rs/camera/transform, whose layout is not documented: not read",
       .source = "users' scripts; its depth is not documented"},
  };
}

std::vector<Producer> engines() {
  return {
      {.name = "unreal",
       .title = "Unreal's Movie Render Queue",
       .marks = {{"unreal/", true}},
       .names = {"finalimagemovierenderqueue_*"},
       .depth = "finalimagemovierenderqueue_worlddepth.r",
       .kind = "planar|ray",
       .unit = 0.01,
       .filter = "averaged over the samples, in half floats",
       .beauty = "R, G, B, A or FinalImageMovieRenderQueue_FinalImage",
       .lightGroups = "none",
       .camera = "texts unreal/camera/PASS/..., whose axes are not documented: not read",
       .source = "source of the plug-in and users' files; centimetres"},
      {.name = "unity",
       .title = "Unity Recorder",
       .marks = {{"Software", false, "Unity"}},
       .kind = "planar|ray|inverse",
       .mayBeRamp = true,
       .beauty = "a part, or a file, for every output",
       .lightGroups = "none",
       .source = "documented without the meaning of depth"},
  };
}

std::vector<Producer> researchRenderers() {
  return {
      {.name = "mitsuba",
       .title = "Mitsuba 3",
       .marks = {{"generatedBy", false, "Mitsuba"}},
       .names = {"*.t"},
       .depth = "*.t",
       .kind = "ray",
       .nothing = "0",
       .filter = "the average of its samples by the picture's filter",
       .beauty = "R, G, B, or those of the integrator's name",
       .lightGroups = "none",
       .source = "its source: NAME.T is the distance t of the ray"},
      {.name = "pbrt",
       .title = "pbrt-v4's gbuffer film",
       .names = {"p.z", "albedo.r", "u", "v"},
       .depth = "p.z",
       .kind = "planar",
       .normals = NormalSpace::camera,
       .nothing = "0",
       .filter = "the average of its samples",
       .alpha = "none",
       .lightGroups = "none",
       .camera = "worldToCamera and worldToNDC, transposed and y up, read",
       .source = "its source: positions in camera space unless the film says otherwise"},
      {.name = "appleseed",
       .title = "appleseed",
       .marks = {{"appleseed:", true}, {"Software", false, "appleseed"}},
       .depth = "z",
       .kind = "ray",
       .nothing = "0, in older versions 3.4e38",
       .lightGroups = "none",
       .source = "its source: radial distance"},
      {.name = "luxcore",
       .title = "LuxCore",
       .marks = {{"Software", false, "LuxCore"}},
       .kind = "planar|ray",
       .source = "none at hand: the planes of the picture decide"},
  };
}

std::vector<Producer> hosts() {
  return {
      {.name = "octane",
       .title = "Octane",
       .marks = {{"Software", false, "Octane"}, {"octane/", true}},
       .kind = "planar|ray",
       .mayBeRamp = true,
       .source = "none at hand: the planes of the picture decide"},
      {.name = "corona",
       .title = "Corona",
       .marks = {{"Software", false, "Corona"}},
       .kind = "planar|ray",
       .mayBeRamp = true,
       .source = "none at hand: the planes of the picture decide"},
      {.name = "maya",
       .title = "Maya software",
       .marks = {{"Software", false, "Maya"}},
       .kind = "planar|ray|inverse",
       .mayBeRamp = true,
       .camera = "CameraFocalLength and CameraFilmApertureHorizontal state a lens and no place: not read",
       .source = "users' reports: z may be negative, or -1/z"},
      {.name = "3dsmax",
       .title = "3ds Max",
       .marks = {{"Software", false, "3ds Max"}, {"Software", false, "3dsmax"}},
       .kind = "planar|ray",
       .mayBeRamp = true,
       .source = "documented: z along the axis may be negative, which is seen by its sign"},
      {.name = "nuke",
       .title = "Nuke",
       .marks = {{"nuke/", true}},
       .depth = "depth.z",
       .kind = "planar|ray|inverse",
       .nothing = "0 where it is 1/z",
       .beauty = "rgba, or R, G, B, A",
       .views = "main, left, right: parts or words of the name",
       .lightGroups = "free names",
       .source = "documented: its own renderer writes 1/z, other renders pass through as they are"},
      {.name = "natron",
       .title = "Natron",
       .marks = {{"Software", false, "Natron"}},
       .depth = "depth.z",
       .kind = "planar|ray|inverse",
       .nothing = "0 where it is 1/z",
       .beauty = "rgba, or R, G, B, A",
       .lightGroups = "free names",
       .source = "its source names layers as Nuke does"},
  };
}

}  // namespace

const std::vector<Producer>& producers() {
  // In this order a file is recognised: a renderer's own marks win over those of programs that hand files on.
  static const std::vector<Producer> table = [] {
    std::vector<Producer> rows = filmRenderers();
    for (const std::vector<Producer>& more : {engines(), researchRenderers(), hosts()})
      rows.insert(rows.end(), more.begin(), more.end());
    return rows;
  }();
  return table;
}

}  // namespace pellucid
