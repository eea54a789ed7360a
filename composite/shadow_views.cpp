#include "composite/shadow_views.h"

#include <algorithm>
#include <limits>

namespace pellucid {
namespace {

constexpr float kNothing = 1.1f;  // PT17's depth of empty texels, in units of the farthest

class Views {
 public:
  Views(const ShadowMaps& maps, int edge) : maps_(maps), edge_(edge) {}

  ExtraLayer depth(const shading::ShadowFace& face, const std::string& name) const {
    float least = std::numeric_limits<float>::infinity(), most = -least;
    each(face, [&](int, int, int c, const glm::vec4& texel) {
      if (c >= face.extent.z || !(texel.y > 0.0f)) return;
      least = std::min(least, texel.z / texel.y);
      most = std::max(most, texel.z / texel.y);
    });
    const float range = most > least ? most - least : 1.0f;
    return rgb(face, name + ".depth",
               [&](const glm::vec4& texel) { return texel.y > 0.0f ? (texel.z / texel.y - least) / range : kNothing; });
  }

  ExtraLayer hidden(const shading::ShadowFace& face, const std::string& name) const {
    return rgb(face, name + ".hidden", [](const glm::vec4& texel) { return texel.x; });
  }

  ExtraLayer opaque(const shading::ShadowFace& face, const std::string& name) const {
    Image<float> plane(edge_, edge_, 0.0f);
    for (int y = 0; y < face.extent.y; ++y)
      for (int x = 0; x < face.extent.y; ++x) {
        const int place = y * face.extent.y + x;
        plane.at(x, y) = maps_.texels[static_cast<std::size_t>(face.extent.x + place / 4)][place % 4];
      }
    ExtraLayer layer{name + ".opaque", {}};
    layer.channels.emplace_back("Z", std::move(plane));
    return layer;
  }

 private:
  // Of grey maps the one channel three times.
  template <class Visit>
  void each(const shading::ShadowFace& face, Visit&& visit) const {
    for (int y = 0; y < face.extent.y; ++y)
      for (int x = 0; x < face.extent.y; ++x)
        for (int c = 0; c < 3; ++c) {
          const int index = face.extent.x + (y * face.extent.y + x) * face.extent.z + std::min(c, face.extent.z - 1);
          visit(x, y, c, maps_.texels[static_cast<std::size_t>(index)]);
        }
  }
  template <class Value>
  ExtraLayer rgb(const shading::ShadowFace& face, const std::string& name, Value&& value) const {
    std::vector<Image<float>> planes(3, Image<float>(edge_, edge_, 0.0f));
    each(face, [&](int x, int y, int c, const glm::vec4& texel) {
      planes[static_cast<std::size_t>(c)].at(x, y) = value(texel);
    });
    ExtraLayer layer{name, {}};
    for (std::size_t c = 0; c < 3; ++c) layer.channels.emplace_back(std::string(1, "RGB"[c]), std::move(planes[c]));
    return layer;
  }

  const ShadowMaps& maps_;
  int edge_;
};

}  // namespace

ShadowViews shadowViews(const ShadowMaps& maps, const std::vector<std::string>& names) {
  int edge = 0;
  for (const shading::ShadowFace& face : maps.faces) edge = std::max(edge, face.extent.y);
  ShadowViews result{{0, 0, edge, edge}, {}};
  const Views views(maps, edge);
  for (std::size_t i = 0; i < maps.lights.size(); ++i) {
    const glm::ivec4& faces = maps.lights[i].faces;
    const auto nameOf = [&](int face, int of) {
      return of > 1 ? names.at(i) + "." + std::to_string(face) : names.at(i);
    };
    for (int f = 0; f < faces.y; ++f) {
      const shading::ShadowFace& face = maps.faces[static_cast<std::size_t>(faces.x + f)];
      result.layers.push_back(views.depth(face, nameOf(f, faces.y)));
      result.layers.push_back(views.hidden(face, nameOf(f, faces.y)));
    }
    for (int f = 0; f < faces.w; ++f)
      result.layers.push_back(views.opaque(maps.faces[static_cast<std::size_t>(faces.z + f)], nameOf(f, faces.w)));
  }
  return result;
}

}  // namespace pellucid
