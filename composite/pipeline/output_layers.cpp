#include "composite/pipeline/output_layers.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

template <class Value>
Image<float> planeOf(const Window& size, Value value) {
  Image<float> image(size.width(), size.height());
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = value(i);
  return image;
}

constexpr const char* kColours[] = {"R", "G", "B"};

}  // namespace

ExtraLayer beautyLayer(const Image<glm::vec4>& rgba) {
  ExtraLayer layer;
  const char* names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) {
    Image<float> plane(rgba.width(), rgba.height());
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = rgba[i][c];
    layer.channels.emplace_back(names[c], std::move(plane));
  }
  return layer;
}

std::vector<std::string> writeOver(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                   const Picture& picture, const std::vector<ExtraLayer>& layers,
                                   const std::map<std::string, std::string>& attributes) {
  const ExrPart& part = opaque.document.parts[static_cast<std::size_t>(opaque.choice.beautyPart)];
  if (!part.deep) return writePicture(path, opaque, picture.rgba, picture.touched, layers, attributes);
  std::vector<ExtraLayer> all{beautyLayer(picture.rgba)};
  all.insert(all.end(), layers.begin(), layers.end());
  return writeLayers(path, opaque.gbuffer.display, opaque.gbuffer.data, all, attributes, camera, false, &part);
}

std::vector<ExtraLayer> veilLayers(const std::vector<LayerName>& layers, const Veil& veil) {
  const Window size{0, 0, veil.touched.width(), veil.touched.height()};
  std::vector<ExtraLayer> result;
  for (const LayerName name : layers) {
    ExtraLayer layer;
    if (name == LayerName::transparent) {
      layer.name = "transparent";
      for (int c = 0; c < 3; ++c)
        layer.channels.emplace_back(kColours[c], planeOf(size, [&](std::size_t i) { return veil.light[i][c]; }));
      layer.channels.emplace_back("A", planeOf(size, [&](std::size_t i) {
                                    return veil.touched[i] ? shading::alphaOver(veil.transmission[i], 0.0f) : 0.0f;
                                  }));
    } else if (name == LayerName::transmission) {
      layer.name = "transmission";
      for (int c = 0; c < 3; ++c)
        layer.channels.emplace_back(kColours[c], planeOf(size, [&](std::size_t i) { return veil.transmission[i][c]; }));
    } else if (name == LayerName::depth) {
      layer.name = "transparent";
      layer.channels.emplace_back("Z", planeOf(size, [&](std::size_t i) { return veil.frontZ[i]; }));
    }
    if (!layer.channels.empty()) result.push_back(std::move(layer));
  }
  return result;
}

bool asks(const std::vector<LayerName>& layers, LayerName name) {
  return std::find(layers.begin(), layers.end(), name) != layers.end();
}

ExtraLayer edgesLayer(const GBuffer& gbuffer, const std::vector<EdgePixel>* edges) {
  Image<float> share(gbuffer.data.width(), gbuffer.data.height(), 0.0f), nearer = gbuffer.viewZ, farther = nearer;
  if (edges)
    for (const EdgePixel& edge : *edges) {
      share.at(edge.x, edge.y) = static_cast<float>(edge.share);
      nearer.at(edge.x, edge.y) = static_cast<float>(edge.nearer.z(0.0, 0.0));
      farther.at(edge.x, edge.y) = static_cast<float>(edge.farther.z(0.0, 0.0));
    }
  ExtraLayer layer{"edges", {}};
  layer.channels.emplace_back("share", std::move(share));
  layer.channels.emplace_back("nearer.Z", std::move(nearer));
  layer.channels.emplace_back("farther.Z", std::move(farther));
  return layer;
}

ExtraLayer shadowLayer(const Image<glm::vec3>& multiplier) {
  const Window size{0, 0, multiplier.width(), multiplier.height()};
  ExtraLayer layer{"shadow", {}};
  for (int c = 0; c < 3; ++c)
    layer.channels.emplace_back(kColours[c], planeOf(size, [&](std::size_t i) { return multiplier[i][c]; }));
  return layer;
}

ExtraLayer unseenLayer(Image<float> share) {
  ExtraLayer layer{"unseen", {}};
  layer.channels.emplace_back("share", std::move(share));
  return layer;
}

bool wantsPlanes(const std::vector<LayerName>& layers) {
  return std::any_of(layers.begin(), layers.end(), [](LayerName name) {
    return name == LayerName::diffusion || name == LayerName::delta || name == LayerName::weight ||
           name == LayerName::count;
  });
}

ExtraLayer planeLayer(const std::vector<LayerName>& layers, const OitPlanes& planes) {
  ExtraLayer debug{"oit", {}};
  const auto meanOffset = [&](std::size_t i, int component) {
    return planes.scatters() && planes.refraction[i].z > 0.0f ? planes.refraction[i][component] / planes.refraction[i].z
                                                              : 0.0f;
  };
  const auto add = [&](const char* channel, auto value) {
    debug.channels.emplace_back(channel, planeOf(planes.data, value));
  };
  for (const LayerName name : layers) {
    if (name == LayerName::diffusion)
      add("D", [&](std::size_t i) { return planes.scatters() ? std::sqrt(planes.refraction[i].w) : 0.0f; });
    if (name == LayerName::delta) {
      add("delta.X", [&](std::size_t i) { return meanOffset(i, 0); });
      add("delta.Y", [&](std::size_t i) { return meanOffset(i, 1); });
    }
    if (name == LayerName::weight)  // mean weight of the layers: sum of w o over sum of o
      add("weight", [&](std::size_t i) {
        const float opacity = shading::meanOf(glm::vec3(planes.opacity[i]));
        return opacity > 0.0f ? shading::meanOf(glm::vec3(planes.weight[i])) / opacity : 0.0f;
      });
    if (name == LayerName::count) add("count", [&](std::size_t i) { return planes.weight[i].a; });
  }
  return debug;
}

}  // namespace pellucid
