// Images, samplers, transforms.
#include <OpenImageIO/imageio.h>

#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "gbuffer/image_codec.h"
#include "gbuffer/plain_png.h"
#include "tests/scene/gltf_builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

template <class T>
std::vector<std::uint8_t> encode(const std::string& extension, int width, int height, int channels, OIIO::TypeDesc type,
                                 const std::vector<T>& pixels) {
  const std::string path = (testFolder() / ("made." + extension)).string();
  OIIO::ImageSpec spec(width, height, channels, type);
  if (channels == 2 || channels == 4) spec.alpha_channel = channels - 1;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto writer = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(writer && writer->open(path, spec) && writer->write_image(type, pixels.data()) && writer->close());
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// A material "glass" whose base colour (and on request transmission) is this image, packed in the GLB.
Builder withImage(const std::vector<std::uint8_t>& image, const Json& textureInfo = {{"index", 0}}) {
  Builder builder;
  builder.material({{"name", "glass"}, {"pbrMetallicRoughness", {{"baseColorTexture", textureInfo}}}});
  builder.json["images"] = Json::array({{{"bufferView", builder.view(image.data(), image.size())}}});
  builder.json["textures"] = Json::array({{{"source", 0}}});
  return builder;
}

std::vector<std::uint8_t> redPng() {
  return encode<std::uint8_t>("png", 1, 1, 3, OIIO::TypeDesc::UINT8, {255, 0, 0});
}

// Written from IEC 61966-2-1, apart from the code under test.
double srgb(double e) {
  return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
}

// Textures mostly are plain PNGs, which are read without the codec of all images: the same numbers.
TEST(Textures, PlainPngsAreReadAsTheCodecReadsThem) {
  Random random(46);
  for (const int channels : {1, 3, 4})
    for (const int width : {1, 7, 64, 301}) {
      std::vector<std::uint8_t> pixels;
      for (int i = 0; i < width * 50 * channels; ++i)  // smooth here, noise there: rows of every filter
        pixels.push_back(
            static_cast<std::uint8_t>(i % 3000 < 1500 ? i / 7 : static_cast<int>(255.0 * random.uniform())));
      const std::vector<std::uint8_t> png = encode("png", width, 50, channels, OIIO::TypeDesc::UINT8, pixels);
      StoredImage plain, other;
      ASSERT_TRUE(readPlainPng(png, plain)) << channels;
      ASSERT_EQ(imageCodec().read(png, "png", other), "");
      EXPECT_EQ(plain.values, other.values);
      EXPECT_EQ(std::tie(plain.width, plain.height, plain.channels),
                std::tie(other.width, other.height, other.channels));
      EXPECT_TRUE(plain.eightBit && !plain.floats && !plain.chromaticities);
      for (int damage = 0; damage < 40; ++damage) {  // no damage passes
        std::vector<std::uint8_t> broken = png;
        const auto place = static_cast<std::size_t>(random.uniform() * static_cast<double>(png.size()));
        broken[place] = static_cast<std::uint8_t>(broken[place] ^ (1 << damage % 8));
        EXPECT_FALSE(readPlainPng(broken, plain)) << place;
        broken.resize(place);
        EXPECT_FALSE(readPlainPng(broken, plain)) << place;
      }
    }
  const std::vector<std::uint16_t> deep(12, 77);
  StoredImage image;
  EXPECT_FALSE(readPlainPng(encode("png", 2, 2, 3, OIIO::TypeDesc::UINT16, deep), image));
  EXPECT_FALSE(readPlainPng({}, image));
}

TEST(Textures, ColourIsDecodedAndAlphaStaysStraight) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 256; ++i) {
    for (const int v : {i, 255 - i, 128, i}) pixels.push_back(static_cast<std::uint8_t>(v));
  }
  const Scene scene = withImage(encode("png", 16, 16, 4, OIIO::TypeDesc::UINT8, pixels)).load();
  ASSERT_EQ(scene.textures.size(), 1u);
  const Texture& texture = scene.textures[0];
  ASSERT_EQ(texture.texels.width(), 16);
  for (int i = 0; i < 256; ++i) {
    const glm::vec4 texel = texture.texels.at(i % 16, i / 16);
    // One float rounding of the exact value.
    EXPECT_EQ(texel.r, static_cast<float>(srgb(static_cast<double>(static_cast<float>(i) / 255.0f)))) << i;
    EXPECT_NEAR(static_cast<double>(texel.g), srgb((255 - i) / 255.0), 1e-7) << i;
    EXPECT_NEAR(static_cast<double>(texel.b), 0.2158605, 1e-7) << "colour at alpha " << i << " is not premultiplied";
    EXPECT_EQ(texel.a, static_cast<float>(i) / 255.0f);
  }
}

TEST(Textures, TheSameImageAsDataStaysRaw) {
  Builder builder = withImage(encode<std::uint8_t>("png", 2, 1, 3, OIIO::TypeDesc::UINT8, {128, 64, 32, 0, 255, 1}));
  builder.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
  builder.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  builder.json["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0}};
  builder.json["materials"][0]["extensions"]["KHR_materials_volume"]["thicknessTexture"] = {{"index", 0}};
  auto& specular = builder.json["materials"][0]["extensions"]["KHR_materials_specular"];
  specular["specularTexture"] = {{"index", 0}};
  specular["specularColorTexture"] = {{"index", 0}};
  const Scene scene = builder.load();
  ASSERT_EQ(scene.textures.size(), 2u) << "one for colour, one for data";
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.baseColorTexture.texture, material.emissiveTexture.texture);
  EXPECT_EQ(material.metallicRoughnessTexture.texture, material.transmissionTexture.texture);
  EXPECT_EQ(material.metallicRoughnessTexture.texture, material.thicknessTexture.texture);
  EXPECT_EQ(material.specularTexture.texture, material.thicknessTexture.texture);
  EXPECT_EQ(material.specularColorTexture.texture, material.emissiveTexture.texture);
  const Texture& data = scene.textures.at(static_cast<std::size_t>(material.transmissionTexture.texture));
  EXPECT_EQ(data.texels.at(0, 0), glm::vec4(128.0f / 255.0f, 64.0f / 255.0f, 32.0f / 255.0f, 1.0f));
  EXPECT_EQ(data.texels.at(1, 0), glm::vec4(0.0f, 1.0f, 1.0f / 255.0f, 1.0f));
}

TEST(Textures, GreyGreyAlphaAndSixteenBits) {
  const Texture grey =
      withImage(encode<std::uint8_t>("png", 1, 1, 1, OIIO::TypeDesc::UINT8, {255})).load().textures.at(0);
  EXPECT_EQ(grey.texels.at(0, 0), glm::vec4(1.0f));
  const Texture greyAlpha =
      withImage(encode<std::uint8_t>("png", 1, 1, 2, OIIO::TypeDesc::UINT8, {255, 51})).load().textures.at(0);
  EXPECT_EQ(greyAlpha.texels.at(0, 0), glm::vec4(1.0f, 1.0f, 1.0f, 0.2f));
  const Texture deep =
      withImage(encode<std::uint16_t>("png", 1, 1, 3, OIIO::TypeDesc::UINT16, {32768, 0, 65535})).load().textures.at(0);
  EXPECT_NEAR(static_cast<double>(deep.texels.at(0, 0).r), srgb(32768.0 / 65535.0), 1e-7);
  EXPECT_EQ(deep.texels.at(0, 0).b, 1.0f);
}

TEST(Textures, JpegFromADataUriAndFloatExrFromAFile) {
  const std::vector<std::uint8_t> pixels(8 * 8 * 3, 255);
  const std::vector<std::uint8_t> jpeg = encode("jpg", 8, 8, 3, OIIO::TypeDesc::UINT8, pixels);
  // The signature decides, not the name.
  writeBytes(testFolder() / "photo of glass.png", jpeg.data(), jpeg.size());
  Builder builder = withImage(redPng());
  builder.json["images"][0] = {{"uri", "photo%20of%20glass.png"}};
  const Scene scene = builder.load();
  EXPECT_EQ(scene.textures.at(0).name, "photo of glass.png");
  EXPECT_EQ(scene.textures.at(0).texels.at(7, 7), glm::vec4(1.0f));

  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::uint8_t> exr = encode<float>("exr", 1, 1, 4, OIIO::TypeDesc::FLOAT, {0.5f, 3.0f, nan, 0.25f});
  Builder linear = withImage(exr);
  const Scene floats = linear.load();
  EXPECT_EQ(floats.textures.at(0).texels.at(0, 0).r, 0.5f) << "floating-point images are linear as stored";
  EXPECT_EQ(floats.textures.at(0).texels.at(0, 0).b, 0.0f);
  EXPECT_TRUE(noted(floats, "negative or not finite"));

  Builder inlined = withImage(redPng());
  inlined.json["images"][0] = {
      {"uri",
       "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
       "pLvAAAAAElFTkSuQmCC"}};
  EXPECT_EQ(inlined.load().textures.at(0).texels.at(0, 0), glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
}

TEST(Textures, RowZeroIsTheTop) {
  const Scene scene =
      withImage(encode<std::uint8_t>("png", 1, 2, 3, OIIO::TypeDesc::UINT8, {255, 0, 0, 0, 0, 255})).load();
  EXPECT_EQ(scene.textures.at(0).texels.at(0, 0).r, 1.0f);
  EXPECT_EQ(scene.textures.at(0).texels.at(0, 1).b, 1.0f);
}

TEST(Textures, Samplers) {
  Builder builder = withImage(redPng());
  builder.json["samplers"] = Json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}});
  const Texture plain = builder.load().textures.at(0);
  EXPECT_EQ(plain.wrapS, Wrap::repeat);
  EXPECT_FALSE(plain.nearest);
  builder.json["textures"][0]["sampler"] = 0;
  const Texture texture = builder.load().textures.at(0);
  EXPECT_EQ(texture.wrapS, Wrap::clamp);
  EXPECT_EQ(texture.wrapT, Wrap::mirror);
  EXPECT_TRUE(texture.nearest);
  builder.json["samplers"][0]["wrapS"] = 1;
  expectRefusal(refusalOf(builder), 3, {"samplers[0].wrapS", "33071"});
}

TEST(Textures, MinificationIsReadAndSamplersThatDifferShareAnImage) {
  const std::pair<int, Minify> filters[] = {{9728, Minify::nearest},           {9729, Minify::linear},
                                            {9984, Minify::nearestMipNearest}, {9985, Minify::linearMipNearest},
                                            {9986, Minify::nearestMipLinear},  {9987, Minify::linearMipLinear}};
  Builder builder = withImage(redPng());
  EXPECT_EQ(builder.load().textures.at(0).minify, Minify::linearMipLinear);
  builder.json["textures"][0]["sampler"] = 0;
  for (const auto& [code, minify] : filters) {
    builder.json["samplers"] = Json::array({{{"minFilter", code}}});
    EXPECT_EQ(builder.load().textures.at(0).minify, minify);
  }
  builder.json["samplers"][0]["minFilter"] = 9990;
  expectRefusal(refusalOf(builder), 3, {"samplers[0].minFilter", "9990"});
  builder.json["samplers"][0]["minFilter"] = 9728;
  builder.json["textures"].push_back({{"source", 0}});
  builder.json["materials"][0]["emissiveTexture"] = {{"index", 1}};
  EXPECT_EQ(builder.load().textures.size(), 2u) << "one for each way of reading it";
}

TEST(Textures, GlossinessBecomesRoughness) {
  Builder builder =
      withImage(encode<std::uint8_t>("png", 2, 1, 4, OIIO::TypeDesc::UINT8, {128, 64, 32, 255, 0, 255, 1, 51}));
  Json& gloss = builder.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  gloss = {
      {"glossinessFactor", 0.5}, {"diffuseTexture", {{"index", 0}}}, {"specularGlossinessTexture", {{"index", 0}}}};
  const Scene scene = builder.load();
  const Material& material = scene.materials.at(0);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.baseColorTexture.texture, material.specularColorTexture.texture);
  const Texture& roughness = scene.textures.at(static_cast<std::size_t>(material.metallicRoughnessTexture.texture));
  EXPECT_NEAR(roughness.texels.at(0, 0).g, 0.5f, 1e-6f);
  EXPECT_NEAR(roughness.texels.at(1, 0).g, 0.9f, 1e-6f);
  EXPECT_NEAR(static_cast<double>(
                  scene.textures.at(static_cast<std::size_t>(material.specularColorTexture.texture)).texels.at(0, 0).r),
              srgb(128 / 255.0), 1e-6);
}

// OpenImageIO hands a WebP's colours out multiplied by alpha; glTF's are straight.
TEST(Textures, WebpKeepsItsStraightColours) {
  // 4x4 lossless WebP of one colour each: RIFF, VP8L with five prefix codes of one symbol.
  const auto lossless = [](std::array<int, 4> rgba, bool extended) {
    std::vector<int> bits;
    const auto put = [&](int value, int count) {
      for (int i = 0; i < count; ++i) bits.push_back((value >> i) & 1);
    };
    put(3, 14), put(3, 14), put(1, 1), put(0, 3), put(0, 3);
    for (const int symbol : {rgba[1], rgba[0], rgba[2], rgba[3]}) put(1, 1), put(0, 1), put(1, 1), put(symbol, 8);
    put(1, 1), put(0, 1), put(0, 1), put(0, 1);
    std::vector<std::uint8_t> data = {0x2f};
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (i % 8 == 0) data.push_back(0);
      data.back() = static_cast<std::uint8_t>(data.back() | bits[i] << (i % 8));
    }
    std::vector<std::uint8_t> chunks;
    const auto chunk = [&](const std::string& kind, const std::vector<std::uint8_t>& content) {
      chunks.insert(chunks.end(), kind.begin(), kind.end());
      for (int i = 0; i < 4; ++i) chunks.push_back(static_cast<std::uint8_t>(content.size() >> (8 * i)));
      chunks.insert(chunks.end(), content.begin(), content.end());
      if (content.size() % 2) chunks.push_back(0);
    };
    if (extended) chunk("VP8X", {0x10, 0, 0, 0, 3, 0, 0, 3, 0, 0});
    chunk("VP8L", data);
    std::vector<std::uint8_t> file = {'R', 'I', 'F', 'F'};
    for (int i = 0; i < 4; ++i) file.push_back(static_cast<std::uint8_t>((chunks.size() + 4) >> (8 * i)));
    for (const char c : std::string("WEBP")) file.push_back(static_cast<std::uint8_t>(c));
    file.insert(file.end(), chunks.begin(), chunks.end());
    return file;
  };
  for (const bool extended : {false, true})
    for (const std::array<int, 4> rgba : {std::array{255, 128, 64, 128}, std::array{10, 3, 200, 7},
                                          std::array{90, 17, 1, 255}, std::array{1, 2, 3, 0}}) {
      const Texture texture = withImage(lossless(rgba, extended)).load().textures.at(0);
      const glm::vec4 texel = texture.texels.at(2, 1);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(texel[c]), srgb(rgba[static_cast<std::size_t>(c)] / 255.0), 1e-6);
      EXPECT_EQ(texel.a, static_cast<float>(rgba[3]) / 255.0f);
    }
  // A lossy one, its alpha in a chunk beside: the colours of noise come as they do without an alpha.
  std::vector<std::uint8_t> rgba, rgb;
  for (int i = 0; i < 32 * 32; ++i)
    for (const int v : {i % 251, i * 7 % 200, 90, i * 3 % 256}) rgba.push_back(static_cast<std::uint8_t>(v));
  const Texture straight =
      withImage(encode<std::uint8_t>("webp", 32, 32, 4, OIIO::TypeDesc::UINT8, rgba)).load().textures.at(0);
  double worst = 0;
  for (int i = 0; i < 32 * 32; ++i)
    worst =
        std::max(worst, std::abs(static_cast<double>(straight.texels.at(i % 32, i / 32).a) - (i * 3 % 256) / 255.0));
  EXPECT_LT(worst, 1e-6) << "alpha is kept without loss";
}

// The plain source beside the extension's is for readers without WebP; without one the extension is required.
TEST(Textures, WebpByItsExtension) {
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < 16; ++i)
    for (const std::uint8_t v : {0, 0, 255}) texels.push_back(v);
  const std::vector<std::uint8_t> blue = encode("webp", 4, 4, 3, OIIO::TypeDesc::UINT8, texels);
  for (const bool beside : {true, false}) {
    Builder builder = withImage(redPng());
    builder.json["images"].push_back({{"bufferView", builder.view(blue.data(), blue.size())}});
    Json& texture = builder.json["textures"][0];
    texture["extensions"]["EXT_texture_webp"]["source"] = 1;
    builder.json["extensionsUsed"] = {"EXT_texture_webp"};
    if (!beside) {
      texture.erase("source");
      builder.json["extensionsRequired"] = {"EXT_texture_webp"};
    }
    const glm::vec4 texel = builder.load().textures.at(0).texels.at(1, 2);
    EXPECT_LT(texel.r, 0.01f);
    EXPECT_GT(texel.b, 0.9f) << "lossy";
  }
}

TEST(Textures, TransformAndItsTexCoord) {
  const Json info = {{"index", 0},
                     {"texCoord", 0},
                     {"extensions",
                      {{"KHR_texture_transform",
                        {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}, {"texCoord", 1}}}}}};
  const TextureRef ref = withImage(redPng(), info).load().materials.at(0).baseColorTexture;
  EXPECT_EQ(ref.texCoord, 1);
  const auto moved = [&](float u, float v) { return glm::vec2(ref.uvTransform * glm::vec3(u, v, 1.0f)); };
  // The extension's own example: "only the lower left quadrant of the source image, rotated clockwise 90 degrees".
  const auto expect = [](glm::vec2 found, glm::vec2 expected) {
    EXPECT_NEAR(found.x, expected.x, 1e-6f);
    EXPECT_NEAR(found.y, expected.y, 1e-6f);
  };
  expect(moved(0, 0), {0.0f, 1.0f});
  expect(moved(1, 0), {0.0f, 0.5f});
  expect(moved(0, 1), {0.5f, 1.0f});
  expect(moved(1, 1), {0.5f, 0.5f});
}

TEST(Textures, TransformOrderIsScaleThenRotationThenOffset) {
  const Json info = {
      {"index", 0},
      {"extensions",
       {{"KHR_texture_transform", {{"rotation", 1.57079632679}, {"scale", {2, 3}}, {"offset", {0.25, 0}}}}}}};
  const TextureRef ref = withImage(redPng(), info).load().materials.at(0).baseColorTexture;
  const glm::vec3 moved = ref.uvTransform * glm::vec3(1.0f, 1.0f, 1.0f);  // (2,3) -> (3,-2) -> (3.25,-2)
  EXPECT_NEAR(moved.x, 3.25f, 1e-5f);
  EXPECT_NEAR(moved.y, -2.0f, 1e-5f);
}

TEST(Textures, WhatCannotBeReadNamesMaterialAndFile) {
  Builder missing = withImage(redPng());
  missing.json["images"][0] = {{"uri", "gone/wood.png"}};
  expectRefusal(refusalOf(missing), 3, {"scene.glb", "material glass", "gone/wood.png", "does not exist"});

  Builder twoLines = withImage(redPng());
  twoLines.json["materials"][0]["name"] = "two\nlines";
  twoLines.json["images"][0] = {{"uri", "a\nb.png"}};
  expectRefusal(refusalOf(twoLines), 3, {"material two lines", "a b.png"});

  const std::vector<std::uint8_t> noise = {'n', 'o', 'i', 's', 'e'};
  Builder foreign = withImage(noise);
  expectRefusal(refusalOf(foreign), 3, {"material glass", "PNG or JPEG"});

  Builder empty = withImage(noise);
  empty.json["images"][0] = {{"uri", "data:image/png;base64,"}};
  expectRefusal(refusalOf(empty), 3, {"material glass", "empty"});

  Builder far = withImage(redPng(), {{"index", 0}, {"texCoord", 2}});
  expectRefusal(refusalOf(far), 4, {"material glass", "TEXCOORD_2"});

  Builder basis = withImage(redPng());
  basis.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  expectRefusal(refusalOf(basis), 4, {"material glass", "KHR_texture_basisu"});

  Builder beyond = withImage(redPng());
  beyond.json["textures"][0]["source"] = 1;
  expectRefusal(refusalOf(beyond), 3, {"textures[0].source", "below 1"});
}

TEST(Textures, CutImagesAreRefusedAtEveryLength) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 16 * 16 * 3; ++i) pixels.push_back(static_cast<std::uint8_t>(i * i % 251));
  for (const char* format : {"png", "jpg"}) {
    const std::vector<std::uint8_t> whole = encode(format, 16, 16, 3, OIIO::TypeDesc::UINT8, pixels);
    Builder builder = withImage(whole);
    EXPECT_EQ(refusalOf(builder).sentence, "");
    for (std::size_t size = 1; size < whole.size(); ++size) {
      Builder cut = withImage({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
      expectRefusal(refusalOf(cut), 3, {"scene.glb", "material glass", "image 0"});
    }
  }
}

TEST(Textures, OneWrongByteIsReadOrRefused) {
  // Fixed integer sequence; the sanitizers watch what the decoders make of it.
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 8 * 8 * 4; ++i) pixels.push_back(static_cast<std::uint8_t>(i * 7 % 251));
  for (const char* format : {"png", "jpg"}) {
    const int channels = std::string(format) == "png" ? 4 : 3;
    const std::vector<std::uint8_t> whole = encode(format, 8, 8, channels, OIIO::TypeDesc::UINT8, pixels);
    std::uint32_t state = 99;
    int loaded = 0, refused = 0;
    const std::size_t step = channels == 4 ? 1 : 5;  // a JPEG is mostly tables
    for (std::size_t at = 8; at < whole.size(); at += step) {
      std::vector<std::uint8_t> bent = whole;
      state = state * 1664525u + 1013904223u;
      bent[at] = static_cast<std::uint8_t>(state >> 24);
      Builder builder = withImage(bent);
      const Refusal refusal = refusalOf(builder);
      EXPECT_TRUE(refusal.code == 0 || refusal.code == 3) << refusal.sentence;
      (refusal.code == 0 ? loaded : refused) += 1;
    }
    std::printf("%s with one wrong byte: %d loaded, %d refused\n", format, loaded, refused);
    EXPECT_GT(refused, 0);
  }
}

TEST(Textures, AnImageThatClaimsToBeHugeIsRefusedBeforeItIsAllocated) {
  // A PNG header of 60000 x 60000 pixels, with its checksum, then an empty IDAT and IEND.
  const std::vector<std::uint8_t> bomb = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0xea,
      0x60, 0x00, 0x00, 0xea, 0x60, 0x08, 0x02, 0x00, 0x00, 0x00, 0x0f, 0xb0, 0xe2, 0x15, 0x00, 0x00, 0x00, 0x00, 0x49,
      0x44, 0x41, 0x54, 0x35, 0xaf, 0x06, 0x1e, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  Builder builder = withImage(bomb);
  expectRefusal(refusalOf(builder), 3, {"material glass", "60000x60000", "16384"});
}

TEST(Textures, ImagesOfMaterialsThatNothingDrawsAreNotOpened) {
  Builder builder;
  builder.triangle();
  builder.json["materials"] =
      Json::array({{{"name", "unused"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  builder.json["images"] = Json::array({{{"uri", "gone.png"}}});
  builder.json["textures"] = Json::array({{{"source", 0}}});
  const Scene scene = builder.load();
  EXPECT_EQ(scene.materials.at(0).name, "unused");
  EXPECT_TRUE(scene.textures.empty());
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(refusalOf(builder).code, 3);
}

// glTF allows KTX2 and many sets of coordinates; what is not drawn may have them, and images that are gone.
TEST(Textures, WhatIsNotDrawnNeedsNoTextures) {
  Builder builder;
  builder.triangle()["material"] = 0;
  builder.triangle()["material"] = 1;
  const Json textured = {{"baseColorTexture", {{"index", 0}}}};
  builder.json["materials"] = Json::array(
      {{{"name", "wall"}, {"pbrMetallicRoughness", textured}},
       {{"name", "glass"}, {"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}});
  builder.json["images"] = Json::array({{{"uri", "gone.png"}}});
  builder.json["textures"] = Json::array({{{"source", 0}}});
  SceneOptions options;
  EXPECT_EQ(refusalOf(builder, options).code, 3);
  options.textured = Textured::transparent;
  EXPECT_EQ(builder.load(options).instances.size(), 2u);
  builder.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  EXPECT_EQ(builder.load(options).instances.size(), 2u);
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 3;
  EXPECT_EQ(builder.load(options).instances.size(), 2u);

  options.textured = Textured::opaque;
  expectRefusal(refusalOf(builder, options), 4, {"material wall", "TEXCOORD_3"});
  std::swap(builder.json["materials"][0]["pbrMetallicRoughness"], builder.json["materials"][1]["pbrMetallicRoughness"]);
  EXPECT_EQ(builder.load(options).instances.size(), 2u);
}

TEST(Textures, WhatBecomesTransparentNeedsItsTextures) {
  Builder builder;
  builder.triangle()["material"] = 0;
  builder.json["materials"] =
      Json::array({{{"name", "wall"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  builder.json["images"] = Json::array({{{"uri", "gone.png"}}});
  builder.json["textures"] = Json::array({{{"source", 0}}});
  SceneOptions options;
  options.textured = Textured::transparent;
  EXPECT_EQ(refusalOf(builder, options).code, 0);
  Builder marked = builder;
  marked.json["materials"][0]["extras"] = {{"pellucid", {{"coverage", 0.5}}}};
  expectRefusal(refusalOf(marked, options), 3, {"material wall", "gone.png"});
  options.overrides = {"wall.coverage=0.5"};
  expectRefusal(refusalOf(builder, options), 3, {"material wall", "gone.png"});
}

}  // namespace
}  // namespace pellucid::test
