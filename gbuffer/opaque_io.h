// Any renderer's EXR to a GBuffer, and back with the beauty replaced where transparency touched it.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/colour_space.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/pixel_filter.h"

namespace pellucid {

// A pass in a file of its own.
struct SideFile {
  std::string name;  // its layers are called so, "N"; "" of depth
  std::string path;
  std::string channel;  // of depth; "" resolves it
  bool operator==(const SideFile&) const = default;
};

struct ReadOptions {
  std::string preset = "auto";  // --preset: auto, or a row of producers.h
  std::string beautyLayer;      // --beauty: a layer, a part or a view; "" resolves it
  std::string view;             // --view; "" is the first of the file
  std::string depthChannel;     // --depth: full channel name (with its part where parts have names); "" resolves it
  std::optional<SideFile> depthFile;    // --depth FILE.exr[:CHANNEL], instead of a channel
  std::vector<SideFile> aovs;           // --aov NAME=FILE, in order
  std::string depthKind;                // --depth-kind, see depth_kind.h; "" is the producer's, else planar
  std::optional<double> farValue;       // --far: this and anything beyond is 'nothing hit'
  std::optional<double> metresPerUnit;  // --unit; without it the producer's, else 1
  // Windows and camera alone: no pixel is looked at, because the camera that converts depth is not chosen yet.
  bool framingAlone = false;
  bool operator==(const ReadOptions&) const = default;
};

// What was chosen, by name and why, for `inspect` and for messages.
struct OpaqueChoice {
  int beautyPart = 0;
  std::string beautyChannel[4];  // R, G, B, A; A may be ""
  int depthPart = 0;
  std::string depthChannel;
  std::string depthFile;  // "" where it is the picture's own
  std::string depthKind;
  double farValue = 0;                     // the value (file units) from which depth means nothing hit
  double least = 0, most = 0;              // depths that were hit, as the file has them; both 0 where nothing was
  std::string preset, presetBy;            // "" where nobody is recognised; by what, "attribute unreal/version"
  std::optional<PixelFilter> pixelFilter;  // that the header names, or the producer uses by default
  std::string pixelFilterBy;               // which of the two: "as the header says"
  std::size_t farPixels = 0, nonFiniteColour = 0, nonFiniteDepth = 0;
};

struct OpaqueFile {
  ExrDocument document;
  GBuffer gbuffer;
  OpaqueChoice choice;
  ColourSpace space;               // of the beauty: as the file states it, unless a caller knows better
  double metresPerUnit = 1.0;      // as asked for, or the producer's
  std::string cameraRefusal;       // why the camera attributes that are there were not taken
  std::vector<std::string> notes;  // one sentence each, for stderr
};

// A layer written beside the picture; `channels` are its suffixes ("R","G","B","A"), one float plane each.
struct ExtraLayer {
  std::string name;
  std::vector<std::pair<std::string, Image<float>>> channels;
};

// Throws InputError (missing, damaged, luminance-chroma, cube map, mip map) or MeaningError (no depth, two candidates).
// Camera attributes that contradict themselves are a note and no camera: another may be given.
// Depth kinds ray, device and auto convert with the camera, so the caller passes one if it has it.
OpaqueFile readOpaque(const std::string& path, const ReadOptions& options, const Camera* camera = nullptr);
// The same, of a file that has been read. Its own camera serves where none is given.
OpaqueFile interpretOpaque(ExrDocument document, const ReadOptions& options, const Camera* camera = nullptr);

// What was understood, a line each: picture, depth. For messages and `inspect`.
std::vector<std::string> understoodLines(const OpaqueFile& file);

// Same parts, windows, attributes, channel types and compression; only the beauty channels of pixels with touched != 0
// change, everything else is bit for bit what was read. Lossy compressions are replaced by ZIP, which is noted.
// Written to a temporary file beside `path`, then renamed. `attributes` are string attributes to add
// ("pellucid:version"). Half stays half: values beyond 65504 become 65504, which is noted. Returns the notes.
std::vector<std::string> writePicture(const std::string& path, const OpaqueFile& file, const Image<glm::vec4>& picture,
                                      const Image<std::uint8_t>& touched, const std::vector<ExtraLayer>& layers = {},
                                      const std::map<std::string, std::string>& attributes = {});

// One of several pictures in the same file: its views.
struct PictureOfView {
  const OpaqueFile& file;
  const Image<glm::vec4>& picture;
  const Image<std::uint8_t>& touched;
  const std::vector<ExtraLayer>& layers;
};
// The same of several views that were read from one file; all are written at once.
std::vector<std::string> writePictures(const std::string& path, const std::vector<PictureOfView>& views,
                                       const std::map<std::string, std::string>& attributes = {});

// A new single-part scanline ZIP file of float or half channels, for everything that has no input to imitate. Half
// values are clamped as in writePicture. Returns the notes.
//   like            a part whose attributes are copied, but for those of storage; its camera stays when it states one
//   chromaticities  8 numbers, or none
std::vector<std::string> writeLayers(const std::string& path, const Window& display, const Window& data,
                                     const std::vector<ExtraLayer>& layers,
                                     const std::map<std::string, std::string>& attributes = {},
                                     const Camera* camera = nullptr, bool half = false, const ExrPart* like = nullptr,
                                     const std::vector<float>& chromaticities = {});

// Checks a camera against what the file shows: the P / Position pass reprojected on pixel and depth, when there is one.
// Also tries Blender's Z-up positions. Returns the median residual in pixels, or nothing when it cannot be checked.
// Throws MeaningError when the camera contradicts the file.
std::optional<double> verifyCamera(const OpaqueFile& file, const Camera& camera);

}  // namespace pellucid
