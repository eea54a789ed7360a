// Passes that lie in files of their own beside the picture, as some renderers write them.
#pragma once
#include "gbuffer/channels.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {

// "depth.exr", "depth.exr:Z": a file and a channel in it, "" where none is named. Nothing for the name of a channel.
std::optional<SideFile> sideFileOf(const std::string& depth);
// "N=normals.exr". Throws UsageError.
SideFile readAov(const std::string& text);

// The picture's file with the parts of --aov and --depth FILE behind its own; they are read, not written. Throws what
// readExr throws, and MeaningError for one of another display window, or of deep samples alone.
ExrDocument readWithSides(const std::string& path, const ReadOptions& options);

// Of a file of its own, the depth: the channel that was named, the one that means depth, the only one, or R where R, G
// and B are the same. Throws MeaningError where that is none or several.
const NamedChannel& depthBeside(const ExrDocument& document, const std::vector<NamedChannel>& channels,
                                const SideFile& side);

}  // namespace pellucid
