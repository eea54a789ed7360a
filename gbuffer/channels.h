// Which channel means what: renderers agree on little but the letters. Names are resolved here and nowhere else.
//
//   beauty    R G B [A] (red/green/blue/alpha, any case) of no layer, or of rgba, rgb, main, Combined, beauty, Ci, C,
//   ...
//             scene-linear, premultiplied
//   depth     Z, depth.Z, <ViewLayer>.Depth.Z, VRayZDepth.R, WorldDepth.R, ...; never the Z of a vector (N.Z, P.Z)
//   normal    N, Nn, Normal, normals .X/.Y/.Z, world, unit
//   position  P, Position, hitP .X/.Y/.Z, world, scene units
//   AO        AO, [0,1], 1 = open
//
// Part names of multi-part files count as layers; views (left, right) are set aside, the first one is the default.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/exr_document.h"

namespace pellucid {

struct Producer;  // gbuffer/producers.h

// A channel with its name taken apart.
struct NamedChannel {
  int part = 0;
  const ExrChannel* channel = nullptr;
  std::string fullName;             // as flags and messages say it: with the part in front where there are several
  std::string layerName;            // fullName without the last word
  std::vector<std::string> layers;  // lower case, without view and without words that mean nothing (rgba, main)
  std::string suffix;               // the last word, lower case
  std::string view;                 // "" when the file has none, or one for all
};
// Of the parts of files beside the picture too, under the names of those files.
std::vector<NamedChannel> nameChannels(const ExrDocument& document);
// Of the picture's own file alone.
std::vector<NamedChannel> ownChannels(const ExrDocument& document, const std::vector<NamedChannel>& channels);
// Whether its name says depth.
bool isDepth(const NamedChannel& channel, const std::vector<NamedChannel>& channels);

struct BeautyChannels {
  int part = 0;
  std::string layerName, view;
  std::vector<std::string> layers;
  const ExrChannel* channel[4] = {};  // R G B A; A may be null
};
// Throws MeaningError for none or two (naming both and --beauty), InputError for luminance-chroma.
//   layer     what --beauty says: a layer, a part, or a view; "" resolves it
//   view      what --view says; "" is the first one in the file
//   producer  whose layer that gives way to others does so; null: nobody that is known
BeautyChannels resolveBeauty(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                             const std::string& layer, const std::string& view, const Producer* producer);

// The one depth that belongs to the beauty. Throws MeaningError for none or two (naming both and --depth).
//   name      what --depth says: a channel, with or without its part; "" resolves it
//   producer  whose own name of depth wins over others; null: nobody that is known
const NamedChannel& resolveDepth(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                 const BeautyChannels& beauty, const std::string& name, const Producer* producer);

// Three channels, or one, of a pass that belongs to the beauty.
struct PassChannels {
  int part = 0;
  std::string layerName;
  const ExrChannel* channel[3] = {};
};
enum class Pass { normal, position, occlusion };
// Nothing when there is none. The pass beside the beauty wins over others; of occlusion [1] and [2] may be null.
std::optional<PassChannels> resolvePass(const std::vector<NamedChannel>& channels, const BeautyChannels& beauty,
                                        Pass pass);

// The layer whose X, Y and Z are a position, of which the channel is the Z; nothing for depth by itself.
std::optional<PassChannels> positionsOf(const std::vector<NamedChannel>& channels, const NamedChannel& depth);

// Whether a name says such a pass, or one light's part of the picture: "N", "AO", "light.key".
bool isPassName(const std::string& name);

// Whether a layer's name says that its R, G and B are no colours: "N", "VRayZDepth", "ViewLayer.CryptoObject00".
bool saysData(const std::string& layer);

// "R, G, B and 30 more"
std::string listNames(const std::vector<NamedChannel>& channels, std::size_t most = 40);

}  // namespace pellucid
