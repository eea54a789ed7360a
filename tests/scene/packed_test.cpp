// Compressed, quantised and instanced geometry: unpacked it is what was packed, damaged it is refused.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <sys/resource.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

constexpr int kSide = 24;  // vertices along a bumpy sheet

std::vector<float> sheetPositions(int side, double height = 0.2) {
  std::vector<float> values;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = x * 0.1, v = y * 0.1;
      for (const double value : {u, v, height * std::sin(2 * u) * std::cos(3 * v)})
        values.push_back(static_cast<float>(value));
    }
  return values;
}

std::vector<std::uint32_t> sheetIndices(int side) {
  std::vector<std::uint32_t> indices;
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const auto a = static_cast<std::uint32_t>(y * side + x), b = a + 1, c = a + static_cast<std::uint32_t>(side);
      for (const std::uint32_t i : {a, b, c, b, c + 1, c}) indices.push_back(i);
    }
  return indices;
}

std::vector<glm::vec3> cornersOf(const Scene& scene) {
  std::vector<glm::vec3> corners;
  const Primitive& primitive = scene.primitives.at(0);
  for (const std::uint32_t i : primitive.indices) corners.push_back(primitive.vertices.at(i).position);
  return corners;
}

std::vector<glm::vec3> sheetCorners(int side) {
  const std::vector<float> p = sheetPositions(side);
  std::vector<glm::vec3> corners;
  for (const std::uint32_t i : sheetIndices(side)) corners.emplace_back(p[3 * i], p[3 * i + 1], p[3 * i + 2]);
  return corners;
}

void require(Builder& builder, const char* extension) {
  builder.json["extensionsUsed"].push_back(extension);
  builder.json["extensionsRequired"].push_back(extension);
}

// A view whose bytes lie compressed in the binary chunk.
int packedView(Builder& builder, const std::vector<unsigned char>& packed, const char* mode, std::size_t count,
               std::size_t stride, const char* filter = "NONE") {
  const int compressed = builder.view(packed.data(), packed.size());
  Json extension = builder.json["bufferViews"][static_cast<std::size_t>(compressed)];
  extension.update({{"mode", mode}, {"count", count}, {"byteStride", stride}, {"filter", filter}});
  Json view = {{"buffer", 0}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
  if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
  builder.json["bufferViews"].push_back(view);
  return static_cast<int>(builder.json["bufferViews"].size()) - 1;
}

int accessorOf(Builder& builder, int view, int component, const char* type, std::size_t count,
               bool normalised = false) {
  Json accessor = {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}};
  if (normalised) accessor["normalized"] = true;
  builder.json["accessors"].push_back(accessor);
  return static_cast<int>(builder.json["accessors"].size()) - 1;
}

std::vector<unsigned char> packVertices(const void* values, std::size_t count, std::size_t stride) {
  meshopt_encodeVertexVersion(0);
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(count, stride));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), values, count, stride));
  return packed;
}

std::vector<unsigned char> packTriangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size()));
  return packed;
}

Builder meshoptSheet(int side, bool sequence, std::size_t indexBytes) {
  Builder builder;
  require(builder, "EXT_meshopt_compression");
  const std::vector<float> positions = sheetPositions(side);
  const std::vector<std::uint32_t> indices = sheetIndices(side);
  const std::size_t vertices = positions.size() / 3;
  std::vector<unsigned char> packed = packTriangles(indices, vertices);
  if (sequence) {
    packed.resize(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size()));
  }
  const int indexView = packedView(builder, packed, sequence ? "INDICES" : "TRIANGLES", indices.size(), indexBytes);
  const int positionView =
      packedView(builder, packVertices(positions.data(), vertices, 12), "ATTRIBUTES", vertices, 12);
  Json& primitive = builder.mesh({{"POSITION", accessorOf(builder, positionView, 5126, "VEC3", vertices)}});
  primitive["indices"] = accessorOf(builder, indexView, indexBytes == 2 ? 5123 : 5125, "SCALAR", indices.size());
  return builder;
}

// Triangles may start at another corner: the codec turns them.
std::vector<glm::vec3> turned(std::vector<glm::vec3> corners) {
  const auto before = [](glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(t);
    std::rotate(first, std::min_element(first, first + 3, before), first + 3);
  }
  return corners;
}

TEST(Meshopt, TrianglesSequencesAndAttributesUnpackToTheSheet) {
  for (const std::size_t bytes : {std::size_t{2}, std::size_t{4}}) {
    EXPECT_EQ(turned(cornersOf(meshoptSheet(kSide, false, bytes).load())), turned(sheetCorners(kSide)));
    EXPECT_EQ(cornersOf(meshoptSheet(kSide, true, bytes).load()), sheetCorners(kSide));
  }
}

TEST(Meshopt, OctahedralFilterGivesNormals) {
  for (const std::size_t stride : {std::size_t{4}, std::size_t{8}}) {
    Builder builder;
    require(builder, "EXT_meshopt_compression");
    require(builder, "KHR_mesh_quantization");
    std::vector<float> wanted, positions;
    for (int i = 0; i < 30; ++i) {
      const double angle = 0.3 * i, tilt = 0.1 * (i % 30);
      const glm::dvec3 n(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle), std::cos(tilt));
      for (const double value : {n.x, n.y, n.z, 0.0}) wanted.push_back(static_cast<float>(value));
      for (const double value : {std::cos(angle), std::sin(angle), 0.1 * i})
        positions.push_back(static_cast<float>(value));
    }
    std::vector<unsigned char> filtered(30 * stride);
    meshopt_encodeFilterOct(filtered.data(), 30, stride, stride == 4 ? 8 : 16, wanted.data());
    const int view =
        packedView(builder, packVertices(filtered.data(), 30, stride), "ATTRIBUTES", 30, stride, "OCTAHEDRAL");
    builder.mesh({{"POSITION", builder.floats(positions, "VEC3", 3)},
                  {"NORMAL", accessorOf(builder, view, stride == 4 ? 5120 : 5122, "VEC3", 30, true)}});
    const Scene scene = builder.load();
    ASSERT_EQ(scene.primitives.at(0).vertices.size(), 30u);
    for (std::size_t i = 0; i < 30; ++i) {
      const glm::vec3 n(wanted[4 * i], wanted[4 * i + 1], wanted[4 * i + 2]);
      // Half a step of the encoding on each of two axes.
      EXPECT_GT(glm::dot(scene.primitives[0].vertices[i].normal, n), stride == 4 ? 0.9998f : 0.9999999f);
    }
  }
}

TEST(Meshopt, QuaternionAndExponentialFiltersPlaceInstances) {
  Builder builder;
  require(builder, "EXT_meshopt_compression");
  require(builder, "EXT_mesh_gpu_instancing");
  builder.triangle();
  std::vector<float> turns, moves;
  std::vector<glm::dquat> wanted;
  for (int i = 0; i < 16; ++i) {
    wanted.push_back(glm::angleAxis(0.4 * i, glm::normalize(glm::dvec3(1, 0.2 * i, -0.5))));
    const glm::dquat& q = wanted.back();
    for (const double value : {q.x, q.y, q.z, q.w}) turns.push_back(static_cast<float>(value));
    for (const double value : {1.5 * i, -0.25 * i, 1000.0 + i}) moves.push_back(static_cast<float>(value));
  }
  std::vector<unsigned char> turnBytes(16 * 8), moveBytes(16 * 12);
  meshopt_encodeFilterQuat(turnBytes.data(), 16, 8, 16, turns.data());
  meshopt_encodeFilterExp(moveBytes.data(), 16, 12, 24, moves.data());
  const int turnView = packedView(builder, packVertices(turnBytes.data(), 16, 8), "ATTRIBUTES", 16, 8, "QUATERNION");
  const int moveView = packedView(builder, packVertices(moveBytes.data(), 16, 12), "ATTRIBUTES", 16, 12, "EXPONENTIAL");
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"ROTATION", accessorOf(builder, turnView, 5122, "VEC4", 16, true)},
      {"TRANSLATION", accessorOf(builder, moveView, 5126, "VEC3", 16)}};
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    const glm::dmat4& found = scene.instances[i].worldFromObject;
    const glm::dmat3 turn = glm::mat3_cast(wanted[i]);
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(glm::dvec3(found[c]) - turn[c]), 2e-4);
    EXPECT_LT(
        glm::length(glm::dvec3(found[3]) - glm::dvec3(1.5, -0.25, 1) * static_cast<double>(i) - glm::dvec3(0, 0, 1000)),
        2e-4);
  }
}

TEST(Meshopt, DamageAndContradictionsAreRefused) {
  const auto changed = [](const std::function<void(Json & view, Json & extension)>& change) {
    Builder builder = meshoptSheet(kSide, false, 4);
    Json& view = builder.json["bufferViews"][1];
    change(view, view["extensions"]["EXT_meshopt_compression"]);
    return refusalOf(builder);
  };
  const char* place = "bufferViews[1]";
  expectRefusal(changed([](Json&, Json& e) { e["mode"] = "ZIP"; }), 3, {place, "mode", "ZIP"});
  expectRefusal(changed([](Json&, Json& e) { e["filter"] = "BLUR"; }), 3, {place, "filter", "BLUR"});
  expectRefusal(changed([](Json&, Json& e) { e["filter"] = "OCTAHEDRAL"; }), 3, {place, "filter", "NONE"});
  expectRefusal(changed([](Json&, Json& e) { e["byteStride"] = 3; }), 3, {place, "byteStride", "2 or 4"});
  expectRefusal(changed([](Json&, Json& e) { e["count"] = 7; }), 3, {place, "count", "multiple of 3"});
  expectRefusal(changed([](Json&, Json& e) { e["count"] = 3u << 30; }), 3, {place, "count", "hold at most"});
  expectRefusal(changed([](Json& v, Json&) { v["byteLength"] = 12; }), 3, {place, "byteLength", "12"});
  expectRefusal(changed([](Json&, Json& e) { e["byteLength"] = 40; }), 3, {place});
  expectRefusal(changed([](Json&, Json& e) { e["byteOffset"] = 1; }), 3, {place, "damaged"});
}

TEST(Meshopt, AnyWrongByteLoadsOrIsRefused) {
  for (const bool sequence : {false, true}) {
    const Builder sound = meshoptSheet(6, sequence, 4);
    for (std::size_t i = 0; i < sound.binary.size(); ++i) {
      Builder damaged = sound;
      damaged.binary[i] ^= 0x5a;
      const Refusal refusal = refusalOf(damaged);
      ASSERT_TRUE(refusal.code == 0 || refusal.code == 3)
          << refusal.code << " at byte " << i << ": " << refusal.sentence;
    }
  }
}

struct Compressed {
  draco::EncoderBuffer bytes;
  std::size_t points = 0, faces = 0;
  int position = 0, normal = 0, uv = 0, colour = 0;
};

void dracoSheet(int side, int method, int speed, bool onlyPositions, Compressed& out, double height = 0.2) {
  const std::vector<float> p = sheetPositions(side, height);
  const std::vector<std::uint32_t> indices = sheetIndices(side);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(indices.size() / 3));
  const auto attribute = [&](draco::GeometryAttribute::Type type, std::int8_t width, draco::DataType data) {
    return builder.AddAttribute(type, width, data);
  };
  const int position = attribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = onlyPositions ? -1 : attribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int uv = onlyPositions ? -1 : attribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colour = onlyPositions ? -1 : attribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (std::uint32_t t = 0; 3 * t < indices.size(); ++t) {
    const draco::FaceIndex face(t);
    const std::uint32_t* c = &indices[3 * t];
    builder.SetAttributeValuesForFace(position, face, &p[3 * c[0]], &p[3 * c[1]], &p[3 * c[2]]);
    if (onlyPositions) continue;
    const float up[3] = {0, 0, 1};
    builder.SetAttributeValuesForFace(normal, face, up, up, up);
    builder.SetAttributeValuesForFace(uv, face, &p[3 * c[0]], &p[3 * c[1]], &p[3 * c[2]]);
    const std::uint8_t red[4] = {255, 51, 0, 255};
    builder.SetAttributeValuesForFace(colour, face, red, red, red);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetTrackEncodedProperties(true);
  encoder.SetEncodingMethod(method);
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetAttributeQuantization(position, 16);
  if (!onlyPositions) {
    encoder.SetAttributeQuantization(normal, 10);
    encoder.SetAttributeQuantization(uv, 16);
  }
  ASSERT_TRUE(encoder.EncodeToBuffer(&out.bytes).ok());
  out.points = encoder.num_encoded_points();
  out.faces = encoder.num_encoded_faces();
  const auto idOf = [&](int attributeNumber) {
    return attributeNumber < 0 ? 0 : static_cast<int>(mesh->attribute(attributeNumber)->unique_id());
  };
  out.position = idOf(position);
  out.normal = idOf(normal);
  out.uv = idOf(uv);
  out.colour = idOf(colour);
}

Builder dracoFile(const Compressed& data, bool onlyPositions) {
  Builder builder;
  require(builder, "KHR_draco_mesh_compression");
  const auto accessor = [&](int component, const char* type, std::size_t count, bool normalised = false) {
    Json one = {{"componentType", component}, {"type", type}, {"count", count}};
    if (normalised) one["normalized"] = true;
    builder.json["accessors"].push_back(one);
    return builder.json["accessors"].size() - 1;
  };
  const std::size_t points = data.points;
  Json attributes = {{"POSITION", accessor(5126, "VEC3", points)}}, ids = {{"POSITION", data.position}};
  if (!onlyPositions) {
    attributes.update({{"NORMAL", accessor(5126, "VEC3", points)},
                       {"TEXCOORD_0", accessor(5126, "VEC2", points)},
                       {"COLOR_0", accessor(5121, "VEC4", points, true)}});
    ids.update({{"NORMAL", data.normal}, {"TEXCOORD_0", data.uv}, {"COLOR_0", data.colour}});
  }
  Json& primitive = builder.mesh(attributes);
  primitive["indices"] = accessor(5125, "SCALAR", 3 * data.faces);
  const int view = builder.view(data.bytes.data(), data.bytes.size());
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", ids}};
  return builder;
}

float area(const std::vector<glm::vec3>& corners) {
  float sum = 0;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
    sum += 0.5f * glm::length(glm::cross(corners[t + 1] - corners[t], corners[t + 2] - corners[t]));
  return sum;
}

TEST(Draco, BothMethodsUnpackToTheSheet) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    Compressed data;
    dracoSheet(kSide, method, 3, false, data);
    Builder builder = dracoFile(data, false);
    const Scene scene = builder.load();
    EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
    const Primitive& primitive = scene.primitives.at(0);
    const std::vector<glm::vec3> corners = cornersOf(scene), wanted = sheetCorners(kSide);
    ASSERT_EQ(corners.size(), wanted.size());
    EXPECT_NEAR(area(corners), area(wanted), 1e-3f * area(wanted));
    // The order of triangles is the encoder's; every vertex must lie on the sheet, to half a step of 16 bits over 2.3
    // m.
    float worst = 0, worstUv = 0;
    for (const Vertex& vertex : primitive.vertices) {
      const double u = static_cast<double>(vertex.position.x), v = static_cast<double>(vertex.position.y);
      worst =
          std::max(worst, std::abs(vertex.position.z - static_cast<float>(0.2 * std::sin(2 * u) * std::cos(3 * v))));
      worstUv = std::max(worstUv, glm::length(vertex.uv[0] - glm::vec2(vertex.position)));
      EXPECT_GT(vertex.normal.z, 0.9999f);
      EXPECT_EQ(vertex.colour, glm::vec4(1.0f, 0.2f, 0.0f, 1.0f));
    }
    EXPECT_LT(worst, 1e-4f);
    EXPECT_LT(worstUv, 1e-4f);
    std::printf("Draco method %d: %zu bytes, off the sheet by at most %.2g m\n", method, data.bytes.size(),
                static_cast<double>(worst));
  }
}

TEST(Draco, ARegularGridStaysWellBelowTheMostTrianglesAByte) {
  Compressed data;
  dracoSheet(160, draco::MESH_EDGEBREAKER_ENCODING, 0, true, data, 0.0);
  std::printf("Draco: flat grid, %zu triangles in %zu bytes: %.1f a byte\n", data.faces, data.bytes.size(),
              static_cast<double>(data.faces) / static_cast<double>(data.bytes.size()));
  EXPECT_LT(data.faces, 128 * data.bytes.size()) << "the loader takes twice that";
  EXPECT_EQ(cornersOf(dracoFile(data, true).load()).size(), 3 * data.faces);
}

TEST(Draco, ContradictionsAreRefused) {
  Compressed data;
  dracoSheet(kSide, draco::MESH_EDGEBREAKER_ENCODING, 3, true, data);
  const auto changed = [&](const std::function<void(Builder&, Json & primitive)>& change) {
    Builder builder = dracoFile(data, true);
    change(builder, builder.json["meshes"][0]["primitives"][0]);
    return refusalOf(builder);
  };
  const char* name = "KHR_draco_mesh_compression";
  expectRefusal(changed([](Builder& b, Json&) { b.binary[0] = 'X'; }), 3, {name, "not Draco data"});
  expectRefusal(changed([](Builder& b, Json&) { b.binary[6] = 1; }), 3, {name, "2.1", "2.2"});
  expectRefusal(changed([](Builder& b, Json&) { b.binary[7] = 0; }), 3, {name, "expected a mesh"});
  expectRefusal(changed([](Builder& b, Json&) {
                  b.binary.resize(b.binary.size() / 2);
                  b.json["bufferViews"][0]["byteLength"] = b.binary.size();
                }),
                3, {name, "damaged"});
  expectRefusal(changed([](Builder&, Json& p) { p["mode"] = 6; }), 3, {name, "mode 6"});
  expectRefusal(changed([&](Builder& b, Json&) { b.json["accessors"][1]["count"] = 3; }), 3, {"indices", "3 elements"});
  expectRefusal(
      changed([&](Builder&, Json& p) { p["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 9; }),
      3, {name, "POSITION", "9"});
}

// The header alone says how much the decoder would allocate.
TEST(Draco, ClaimsBeyondTheBytesAreRefusedBeforeMemoryIsTaken) {
  Compressed data;
  dracoSheet(kSide, draco::MESH_EDGEBREAKER_ENCODING, 3, true, data);
  Builder builder = dracoFile(data, true);
  const std::vector<std::uint8_t> claim = {0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f};  // 2^28 - 1 twice
  std::copy(claim.begin(), claim.end(), builder.binary.begin() + 12);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  expectRefusal(refusalOf(builder), 3, {"KHR_draco_mesh_compression", "claims 268435455 triangles"});
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 16 << 10) << "KiB";
}

TEST(Draco, AnyWrongByteLoadsOrIsRefused) {
  for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    Compressed data;
    dracoSheet(6, method, 3, false, data);
    const Builder sound = dracoFile(data, false);
    int loaded = 0, refused = 0;
    for (std::size_t i = 0; i < sound.binary.size(); ++i)
      for (const std::uint8_t flip : {0x01, 0xff}) {
        Builder damaged = sound;
        damaged.binary[i] ^= flip;
        const Refusal refusal = refusalOf(damaged);
        ASSERT_TRUE(refusal.code == 0 || refusal.code == 3)
            << refusal.code << " at byte " << i << ": " << refusal.sentence;
        ++(refusal.code == 0 ? loaded : refused);
      }
    std::printf("Draco method %d with one wrong byte: %d loaded, %d refused\n", method, loaded, refused);
    EXPECT_GT(loaded, 0) << "nothing of it is looked at";
    EXPECT_GT(refused, 0);
  }
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  std::printf("largest memory of the process: %ld MiB\n", use.ru_maxrss >> 10);
  EXPECT_LT(use.ru_maxrss, 1 << 20) << "KiB";
}

TEST(Quantised, IntegersAreReadAsTheyAreOnlyWithTheExtension) {
  const auto make = [](bool extension) {
    Builder builder;
    if (extension) require(builder, "KHR_mesh_quantization");
    builder.mesh({{"POSITION", builder.accessor(std::vector<std::int16_t>{0, 0, 0, 0, 1000, 0, 0, 0, 0, -500, 7, 0},
                                                5122, "VEC4", 4)},
                  {"NORMAL", builder.accessor(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, 5120,
                                              "VEC4", 4, true)},
                  {"TEXCOORD_0", builder.accessor(std::vector<std::uint16_t>{0, 0, 4, 0, 0, 65535}, 5123, "VEC2", 2)}});
    // Elements of three, as far apart as four.
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      builder.json["accessors"][i]["type"] = "VEC3";
      builder.json["bufferViews"][i]["byteStride"] = i == 0 ? 8 : 4;
    }
    return builder;
  };
  const Scene scene = make(true).load();
  const Primitive& primitive = scene.primitives.at(0);
  EXPECT_EQ(primitive.vertices[1].position, glm::vec3(1000, 0, 0));
  EXPECT_EQ(primitive.vertices[2].position, glm::vec3(0, -500, 7));
  EXPECT_EQ(primitive.vertices[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(primitive.vertices[1].uv[0], glm::vec2(4, 0));
  EXPECT_EQ(primitive.vertices[2].uv[0], glm::vec2(0, 65535));
  Builder without = make(false);
  expectRefusal(refusalOf(without), 3, {"POSITION", "must be float"});
}

TEST(Instancing, EveryTransformAndMirroredOnesAreTurned) {
  Builder builder;
  require(builder, "EXT_mesh_gpu_instancing");
  builder.triangle();
  builder.json["nodes"][0]["translation"] = {10, 0, 0};
  Json& attributes = builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes = {{"TRANSLATION", builder.floats({0, 0, 0, 0, 1, 0, 0, 2, 0}, "VEC3", 3)},
                {"SCALE", builder.floats({1, 1, 1, -2, 2, 2, 0, 1, 0}, "VEC3", 3)},
                {"_COLOR_0", builder.floats({.5f, .25f, 1, 1, 2, -1, 1, 1, 1}, "VEC3", 3)}};
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 2u) << "one has a scale of zero";
  EXPECT_TRUE(noted(scene, "scale of zero"));
  EXPECT_EQ(glm::dvec3(scene.instances[1].worldFromObject[3]), glm::dvec3(10, 1, 0));
  EXPECT_EQ(scene.instances[1].worldFromObject[0][0], -2.0);
  EXPECT_NE(scene.instances[0].primitive, scene.instances[1].primitive) << "mirrored: the winding turns";
  EXPECT_NE(scene.instances[0].identity, scene.instances[1].identity);
  EXPECT_EQ(scene.instances[0].colour, glm::vec4(.5f, .25f, 1, 1));
  EXPECT_EQ(scene.instances[1].colour, glm::vec4(1, 1, 0, 1)) << "clamped";

  builder.json.erase("buffers");
  attributes.erase("_COLOR_0");
  attributes["SCALE"] = builder.floats({1, 1, 1}, "VEC3", 3);
  expectRefusal(refusalOf(builder), 3, {"EXT_mesh_gpu_instancing", "3 and 1"});
  builder.json.erase("buffers");
  attributes = {{"TRANSLATION", builder.floats({0, std::numeric_limits<float>::infinity(), 0}, "VEC3", 3)}};
  expectRefusal(refusalOf(builder), 3, {"TRANSLATION", "not finite"});
  builder.json.erase("buffers");
  attributes = {{"ROTATION", builder.floats({0, 0, 0, 0}, "VEC4", 4)}};
  expectRefusal(refusalOf(builder), 3, {"ROTATION", "no length"});
  attributes = {{"_ID", 0}};
  expectRefusal(refusalOf(builder), 3, {"none of TRANSLATION"});
}

}  // namespace
}  // namespace pellucid::test
