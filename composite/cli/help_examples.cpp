#include "composite/cli/help_groups.h"

namespace pellucid::cli {
namespace {

struct Example {
  const char *verb, *line;
};
constexpr Example kExamples[] = {
    {"composite", "pellucid composite shot.exr bottles.glb -o out.exr --environment sky.exr --measure"},
    {"accumulate", "pellucid accumulate shot.exr bottles.glb -o planes.exr"},
    {"resolve", "pellucid resolve shot.exr planes.exr more-planes.exr -o out.exr"},
    {"occlusion", "pellucid occlusion shot.exr foliage.exr -o darkened.exr --radius 0.5"},
    {"inspect", "pellucid inspect shot.exr --scene bottles.glb --html shot.html"},
    {"gbuffer", "pellucid gbuffer scene.glb -o shot.exr --size 1920x1080 --samples 64"},
    {"render", "pellucid render scene.glb -o out.exr --preview out.png"},
    {"compare", "pellucid compare expected.exr found.exr --fail 0.004 --html report.html"},
    {"flatten", "pellucid flatten smoke.####.exr sparks.####.exr -o flat.####.exr --frames 1001-1100"},
    {"fragments", "pellucid fragments shot.exr bottles.glb -o deep.exr"},
    {"study", "pellucid study shot.exr bottles.glb -o report --methods over,weighted,mlab:4 --aa 1,8"},
    {"view", "pellucid view out.exr"},
    {"help", "pellucid help methods"},
};

}  // namespace

std::string exampleOf(const std::string& verb) {
  for (const Example& example : kExamples)
    if (verb == example.verb) return example.line;
  return "";
}

}  // namespace pellucid::cli
