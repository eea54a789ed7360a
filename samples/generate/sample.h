// One authored scene: what a renderer would have rendered, and the glass that Pellucid puts over it.
#pragma once
#include <vector>

#include "samples/generate/glb.h"
#include "samples/generate/studio.h"
#include "samples/generate/view.h"

namespace pellucid::samples {

struct Sample {
  View view;
  Studio studio;  // the opaque part
  Glb glb;        // the transparent part, the camera and the sun
};

// A new sample is a folder with one of these and a line here.
Sample bars();
Sample bottles();
Sample smoke();
Sample foliage();
Sample frosted();
Sample ball();
Sample hair();
Sample cad();
Sample clouds();
Sample fineHair(std::uint32_t hairs);  // the sample `hair` with --hairs: 480 triangles each
Sample smokeball();
Sample smokeBall(std::uint32_t particles);  // the sample `smokeball` with --particles
Sample shafts();
Sample street();
Sample mixed();
Sample shadows();
Sample chess();
Sample fire();

struct Entry {
  const char* name;
  Sample (*make)();
};
inline const std::vector<Entry> kSamples = {
    {"bars", bars},       {"bottles", bottles}, {"smoke", smoke}, {"foliage", foliage},
    {"frosted", frosted}, {"ball", ball},       {"hair", hair},   {"cad", cad},
    {"clouds", clouds},   {"street", street},   {"mixed", mixed}, {"smokeball", smokeball},
    {"shafts", shafts},   {"shadows", shadows}, {"chess", chess}, {"sparks", fire}};

}  // namespace pellucid::samples
