// A program that composites a shot through the installed compositor: outside OPAQUE.exr SCENE.glb OUT.exr
#include <cstdio>
#include <exception>

#include "composite/pipeline/compositor.h"

int main(int count, char** arguments) {
  if (count != 4) return 2;
  try {
    pellucid::Request request;
    request.shot.opaque = arguments[1];
    request.shot.inputs = {arguments[2]};
    request.method = "phenomenological";
    request.paint = pellucid::PaintSums{};
    request.passes = 2;
    pellucid::Compositor compositor(request,
                                    [](const std::string& note) { std::fprintf(stderr, "%s\n", note.c_str()); });
    const pellucid::Result result = compositor.run(request);
    compositor.write(arguments[3], result);
    std::printf("composited %zu triangles\n", result.counts.triangles);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
