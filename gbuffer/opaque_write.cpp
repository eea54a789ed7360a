#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <stdexcept>

#include "gbuffer/channel_encoder.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {
namespace {

// What a picture changes in its part.
void addEdit(const PictureOfView& view, ChannelEncoder& encoder, ExrPartEdit& edit) {
  const OpaqueFile& file = view.file;
  const Image<std::uint8_t>& touched = view.touched;
  const Window& data = file.gbuffer.data;
  if (view.picture.width() != data.width() || view.picture.height() != data.height() ||
      touched.size() != view.picture.size() || touched.width() != view.picture.width())
    throw std::logic_error("a picture of another size than its G-buffer");
  const ExrPart& part = file.document.parts[static_cast<std::size_t>(file.choice.beautyPart)];
  bool anyTouched = false;
  for (std::size_t i = 0; i < touched.size() && !anyTouched; ++i) anyTouched = touched[i] != 0;
  for (int c = 0; c < 4 && anyTouched; ++c) {
    const std::string& name = file.choice.beautyChannel[c];
    if (name.empty()) continue;
    const ExrChannel& channel = *part.find(name);
    std::vector<std::byte> bytes = channel.bytes;
    for (std::size_t i = 0; i < touched.size(); ++i)
      if (touched[i]) encoder.put(bytes, channel.type, i, view.picture[i][c]);
    edit.replaced[name] = std::move(bytes);
  }
  // Extra layers are float: from them the picture can be put together again.
  std::vector<ExrChannel> added = channelsOf(view.layers, data, PixelType::float32, encoder);
  std::move(added.begin(), added.end(), std::back_inserter(edit.added));
}

}  // namespace

std::vector<std::string> writePictures(const std::string& path, const std::vector<PictureOfView>& views,
                                       const std::map<std::string, std::string>& attributes) {
  std::map<int, ExrPartEdit> edits;
  ChannelEncoder encoder;
  for (const PictureOfView& view : views) {
    ExrPartEdit& edit = edits[view.file.choice.beautyPart];
    edit.attributes = attributes;
    addEdit(view, encoder, edit);
  }
  std::vector<std::string> notes = writeExr(path, views.at(0).file.document, edits);
  encoder.noteTo(notes);
  return notes;
}

std::vector<std::string> writePicture(const std::string& path, const OpaqueFile& file, const Image<glm::vec4>& picture,
                                      const Image<std::uint8_t>& touched, const std::vector<ExtraLayer>& layers,
                                      const std::map<std::string, std::string>& attributes) {
  return writePictures(path, {{file, picture, touched, layers}}, attributes);
}

std::vector<std::string> writeLayers(const std::string& path, const Window& display, const Window& data,
                                     const std::vector<ExtraLayer>& layers,
                                     const std::map<std::string, std::string>& attributes, const Camera* camera,
                                     bool half, const ExrPart* like, const std::vector<float>& chromaticities) {
  NewExr file;
  file.chromaticities = chromaticities;
  file.like = like;
  if (like) file.pixelAspect = like->pixelAspect;
  file.display = display;
  file.data = data;
  file.attributes = attributes;
  ChannelEncoder encoder;
  file.channels = channelsOf(layers, data, half ? PixelType::half : PixelType::float32, encoder);
  if (camera && !(like && like->attributes.contains("worldToCamera"))) {
    float matrices[2][4][4];
    cameraToExr(*camera, matrices[0], matrices[1]);
    file.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
    file.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
  }
  writeNewExr(path, file);
  std::vector<std::string> notes;
  encoder.noteTo(notes);
  return notes;
}

}  // namespace pellucid
