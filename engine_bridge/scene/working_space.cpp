#include "engine_bridge/scene/working_space.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "engine_bridge/scene/triangle_source.h"
#include "gbuffer/colour_space.h"

namespace pellucid {
namespace {

glm::vec4 withAlpha(const glm::dmat3& matrix, const glm::vec4& colour) {
  return glm::vec4(converted(matrix, glm::vec3(colour)), colour.a);
}

// Bounds of what the matrix makes of colours within bounds.
ColourRange boundsOf(const glm::dmat3& matrix, const ColourRange& range) {
  ColourRange result = range;
  for (int r = 0; r < 3; ++r) {
    double least = 0.0, most = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double low = matrix[c][r] * static_cast<double>(range.least[c]);
      const double high = matrix[c][r] * static_cast<double>(range.most[c]);
      least += std::min(low, high);
      most += std::max(low, high);
    }
    // Bounds hold 1 whatever the colours are.
    result.least[r] = std::clamp(static_cast<float>(least), 0.0f, 1.0f);
    result.most[r] = std::max(static_cast<float>(most), 1.0f);
  }
  return result;
}

// Triangles that lie in a file, their colours converted as they are read.
class ConvertedTriangles : public TriangleSource {
 public:
  ConvertedTriangles(std::shared_ptr<const TriangleSource> source, const glm::dmat3& matrix)
      : source_(std::move(source)), matrix_(matrix), colours_(boundsOf(matrix, source_->colours())) {}
  std::size_t triangles() const override { return source_->triangles(); }
  const ColourRange& colours() const override { return colours_; }
  void read(std::size_t first, std::size_t count, VertexPlaces& places, TriangleBatch& batch) const override {
    source_->read(first, count, places, batch);
    for (Vertex& vertex : batch.vertices) vertex.colour = withAlpha(matrix_, vertex.colour);
  }

 private:
  std::shared_ptr<const TriangleSource> source_;
  glm::dmat3 matrix_;
  ColourRange colours_;
};

bool isGrey(const ColourRange& range) {
  const auto grey = [](const glm::vec4& colour) { return colour.r == colour.g && colour.g == colour.b; };
  return range.least == range.most && grey(range.least);
}

// What leaves the space: colours that the matrix gives a negative channel.
class GamutEdge {
 public:
  explicit GamutEdge(const glm::dmat3& matrix) : matrix_(matrix) {}
  bool crossed(const glm::vec3& colour) const {
    constexpr double kSlack = 1e-6;  // primaries that two spaces share
    const glm::dvec3 exact = matrix_ * glm::dvec3(colour);
    return std::min({exact.x, exact.y, exact.z}) <
           -kSlack * static_cast<double>(std::max({colour.r, colour.g, colour.b}));
  }
  // The colour in the space, counted where it lies outside.
  glm::vec3 operator()(const glm::vec3& colour) {
    if (crossed(colour)) ++outside;
    return converted(matrix_, colour);
  }
  std::size_t outside = 0;

 private:
  const glm::dmat3& matrix_;
};

void convert(Material& material, GamutEdge& edge) {
  material.baseColor = glm::vec4(edge(glm::vec3(material.baseColor)), material.baseColor.a);
  material.emission = edge(material.emission);
  material.specularColor = edge(material.specularColor);
  material.attenuationColor = glm::min(edge(material.attenuationColor), glm::vec3(1.0f));
}

// Returns whether some texel lies outside.
bool convert(Texture& texture, const glm::dmat3& toSpace) {
  const glm::dmat3 matrix = toSpace * glm::inverse(texture.fromRec709);
  if (!texture.colour || toSpace == texture.fromRec709) return false;
  texture.fromRec709 = toSpace;
  const GamutEdge edge(matrix);
  Image<glm::vec4>& texels = texture.texels;
  std::vector<std::uint8_t> outside(static_cast<std::size_t>(texels.height()), 0);
  tbb::parallel_for(0, texels.height(), [&](int y) {
    for (int x = 0; x < texels.width(); ++x) {
      glm::vec4& texel = texels.at(x, y);
      if (edge.crossed(glm::vec3(texel))) outside[static_cast<std::size_t>(y)] = 1;
      texel = withAlpha(matrix, texel);
    }
  });
  return std::find(outside.begin(), outside.end(), 1) != outside.end();
}

void convert(Primitive& primitive, const glm::dmat3& matrix) {
  if (primitive.streamed) {
    if (!isGrey(primitive.streamed->colours()))
      primitive.streamed = std::make_shared<const ConvertedTriangles>(primitive.streamed, matrix);
    return;
  }
  for (Vertex& vertex : primitive.vertices) vertex.colour = withAlpha(matrix, vertex.colour);
}

void convert(Scene& scene, const glm::dmat3& matrix, const std::vector<int>* primitives, GamutEdge& edge) {
  for (Material& material : scene.materials) convert(material, edge);
  for (Light& light : scene.lights) light.colour = edge(light.colour);
  for (Instance& instance : scene.instances)
    instance.colour = glm::vec4(edge(glm::vec3(instance.colour)), instance.colour.a);
  if (!primitives)
    for (Primitive& primitive : scene.primitives) convert(primitive, matrix);
  else
    for (const int number : *primitives) convert(scene.primitives[static_cast<std::size_t>(number)], matrix);
}

}  // namespace

std::vector<std::string> bringInto(Scene& scene, const glm::dmat3& matrix, const std::vector<int>* primitives) {
  GamutEdge edge(matrix);
  for (Texture& texture : scene.textures) edge.outside += convert(texture, matrix) ? 1 : 0;
  if (matrix != glm::dmat3(1.0)) convert(scene, matrix, primitives, edge);
  if (edge.outside == 0) return {};
  return {
      fmt::format("{} colours and textures of the glTF lie outside the picture's colour space and are brought to its "
                  "edge",
                  edge.outside)};
}

}  // namespace pellucid
