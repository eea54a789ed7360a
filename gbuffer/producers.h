// Who writes which EXR: one row a renderer or exporter. A file is recognised by its header, then by names of channels;
// --preset NAME forces a row. What a row does not know for certain is asked of the user, not guessed.
#pragma once
#include <string>
#include <vector>

#include "gbuffer/channels.h"

namespace pellucid {

// A header that names its writer: an attribute, or any whose name begins with it, with a text in its value.
struct HeaderMark {
  const char* attribute;
  bool isPrefix = false;
  const char* text = nullptr;  // null: any value
};

enum class NormalSpace { world, worldZUp, camera };

struct Producer {
  const char* name;                     // of --preset
  const char* title;                    // for people
  std::vector<HeaderMark> marks = {};   // any of them; empty where headers say nothing
  std::vector<const char*> names = {};  // or all of these channels, lower case, by their end; "x*" by their beginning
  const char* depth = "";               // channel of its depth, lower case, by its end; "" by the rules for all
  const char* kind;                     // as --depth-kind takes it; of several with | between the planes decide
  double unit = 1.0;                    // metres in one unit of depth and positions, without --unit
  bool mayBeRamp = false;               // depth within 0..1 is a ramp rather than a distance: asked
  NormalSpace normals = NormalSpace::world;
  const char* space = "";  // of its colours where chromaticities do not say, of namedSpaces(); "" where it is not known
  const char* pixelFilter = "";    // of its colours by default, as --filter takes it; "" where it is not known
  const char* givesWay = nullptr;  // a layer of colour that is not the picture beside others, lower case
  // What `pellucid help presets` says besides.
  const char* nothing = "1e9 or more";  // depth where nothing was hit
  const char* filter = "not known";     // what a pixel of depth holds
  const char* beauty = "R, G, B, A";
  const char* alpha = "associated";
  const char* views = "by the rules of EXR";
  const char* occlusion = "AO where there is one";
  const char* lightGroups = "not known";
  const char* camera = "none in the file";
  const char* source;  // where this is from
};

const std::vector<Producer>& producers();

struct RecognisedProducer {
  const Producer* row = nullptr;  // null: nobody that is known
  std::string by;                 // "attribute cycles.ViewLayer.samples", "channel depth.T", "--preset"
};
//   preset  "auto", or the name of a row. Throws UsageError for any other.
RecognisedProducer recogniseProducer(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                     const std::string& preset);

// Whether the channel is the depth that the row names.
bool isDepthOf(const Producer& row, const std::vector<NamedChannel>& channels, const NamedChannel& channel);

std::string producerNames();               // "blender, arnold, ..."
std::vector<std::string> presetChoices();  // "auto" and all names
std::string producersHelp();               // a line for every row

}  // namespace pellucid
