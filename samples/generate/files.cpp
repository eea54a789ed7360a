#include "samples/generate/files.h"

#include <Imath/ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <fstream>

#include "gbuffer/errors.h"

namespace pellucid::samples {
namespace {

Imath::M44f matrix(const float rows[4][4]) {
  Imath::M44f m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m[i][j] = rows[i][j];
  return m;
}

}  // namespace

void writeOpaque(const std::string& path, const OpaquePicture& picture, const View& view) {
  const int width = view.width, height = view.height;
  Image<Imath::Vec4<Imath::half>> beauty(width, height);
  for (std::size_t i = 0; i < beauty.size(); ++i)
    beauty[i] = {picture.beauty[i].r, picture.beauty[i].g, picture.beauty[i].b, 1.0f};

  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer planes;
  const auto plane = [&](const char* name, Imf::PixelType type, const void* first, std::size_t stride) {
    header.channels().insert(name, Imf::Channel(type));
    // OpenEXR's slices are not const, though writing only reads them.
    auto* base = const_cast<char*>(static_cast<const char*>(first));
    planes.insert(name, Imf::Slice(type, base, stride, stride * static_cast<std::size_t>(width)));
  };
  const char* const colours[4] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) plane(colours[c], Imf::HALF, &beauty.data()->x + c, sizeof(*beauty.data()));
  const char* const normals[3] = {"N.X", "N.Y", "N.Z"};
  for (int c = 0; c < 3; ++c) plane(normals[c], Imf::FLOAT, &picture.normal.data()->x + c, sizeof(glm::vec3));
  plane("Z", Imf::FLOAT, picture.viewZ.data(), sizeof(float));
  plane("AO", Imf::FLOAT, picture.occlusion.data(), sizeof(float));

  const char* const suns[3] = {"light.sun.R", "light.sun.G", "light.sun.B"};
  if (!picture.sun.empty())
    for (int c = 0; c < 3; ++c) plane(suns[c], Imf::FLOAT, &picture.sun.data()->x + c, sizeof(glm::vec3));

  float worldToCamera[4][4], worldToNdc[4][4];
  cameraToExr(view.camera(), worldToCamera, worldToNdc);
  header.insert("worldToCamera", Imf::M44fAttribute(matrix(worldToCamera)));
  header.insert("worldToNDC", Imf::M44fAttribute(matrix(worldToNdc)));
  try {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(planes);
    file.writePixels(height);
  } catch (const std::exception& error) {
    throw ResourceError(path + ": could not be written: " + error.what());
  }
}

std::vector<unsigned char> encodePng(const Image<glm::vec4>& pixels) {
  std::vector<unsigned char> png;
  OIIO::Filesystem::IOVecOutput memory(png);
  const auto out = OIIO::ImageOutput::create("png");
  if (!out) throw ResourceError("no PNG writer: OpenImageIO has none; expected its png plugin");
  OIIO::ImageSpec spec(pixels.width(), pixels.height(), 4, OIIO::TypeUInt8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!out->set_ioproxy(&memory) || !out->open("texture.png", spec) ||
      !out->write_image(OIIO::TypeFloat, pixels.data()) || !out->close())
    throw ResourceError("no PNG written: " + out->geterror());
  return png;
}

void writeBytes(const std::string& path, const std::vector<unsigned char>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw ResourceError(path + ": could not be written");
}

}  // namespace pellucid::samples
