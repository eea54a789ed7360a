// Files that lie. Each must be refused by one sentence with the documented code; the sanitizers watch the rest.
#include <limits>

#include "engine_bridge/scene/uri.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

// A good file with one thing changed.
Refusal refusalWith(const std::function<void(Json&)>& damage) {
  Builder builder;
  Json& primitive = builder.mesh({{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)}});
  primitive["indices"] = builder.indices({0, 1, 2});
  builder.writeGlb();  // fills in buffers
  damage(builder.json);
  return refusalOf(builder);
}

TEST(Hostile, TheUndamagedFileLoads) {
  EXPECT_EQ(refusalWith([](Json&) {}).code, 0);
}

TEST(Hostile, BoundsOfAccessorsAndViews) {
  struct Case {
    const char* what;
    std::function<void(Json&)> damage;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
      {"accessor past its view",
       [](Json& j) { j["accessors"][0]["count"] = 4; },
       {"accessors[0]", "48 bytes", "has 36"}},
      {"huge count", [](Json& j) { j["accessors"][0]["count"] = 4294967295u; }, {"accessors[0]", "has 36"}},
      {"count beyond 32 bits",
       [](Json& j) { j["accessors"][0]["count"] = 1e15; },
       {"accessors[0].count", "4294967295"}},
      {"negative count", [](Json& j) { j["accessors"][0]["count"] = -3; }, {"accessors[0].count", "-3"}},
      {"fractional count", [](Json& j) { j["accessors"][0]["count"] = 2.5; }, {"accessors[0].count", "2.5"}},
      {"negative byteOffset", [](Json& j) { j["accessors"][0]["byteOffset"] = -4; }, {"accessors[0].byteOffset", "-4"}},
      {"byteOffset past the view",
       [](Json& j) { j["accessors"][0]["byteOffset"] = 9007199254740991; },
       {"accessors[0]"}},
      {"view past its buffer", [](Json& j) { j["bufferViews"][0]["byteLength"] = 1000; }, {"bufferViews[0]", "1000"}},
      {"view's offset wraps",
       [](Json& j) { j["bufferViews"][0]["byteOffset"] = 18446744073709551615u; },
       {"byteOffset"}},
      {"view's negative offset",
       [](Json& j) { j["bufferViews"][0]["byteOffset"] = -1; },
       {"bufferViews[0].byteOffset"}},
      {"buffer longer than the file",
       [](Json& j) { j["buffers"][0]["byteLength"] = 1 << 30; },
       {"buffers[0]", "1073741824"}},
      {"no such buffer", [](Json& j) { j["bufferViews"][0]["buffer"] = 7; }, {"bufferViews[0].buffer", "below 1"}},
      {"no such view", [](Json& j) { j["accessors"][0]["bufferView"] = 99; }, {"accessors[0].bufferView", "99"}},
      {"no such accessor",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 42; },
       {"POSITION", "42"}},
      {"stride below the element", [](Json& j) { j["bufferViews"][0]["byteStride"] = 4; }, {"byteStride", "12"}},
      {"stride beyond the format",
       [](Json& j) { j["bufferViews"][0]["byteStride"] = 4294967296; },
       {"byteStride", "252"}},
      {"unknown component type", [](Json& j) { j["accessors"][0]["componentType"] = 5124; }, {"componentType", "5124"}},
      {"unknown type", [](Json& j) { j["accessors"][0]["type"] = "MAT9"; }, {"accessors[0].type", "MAT9"}},
      {"wrong type", [](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, {"VEC2", "POSITION"}},
      {"integer positions", [](Json& j) { j["accessors"][0]["componentType"] = 5122; }, {"componentType", "float"}},
      {"float indices", [](Json& j) { j["accessors"][1]["componentType"] = 5126; }, {"accessors[1]", "5125"}},
      {"no attributes", [](Json& j) { j["meshes"][0]["primitives"][0].erase("attributes"); }, {"attributes"}},
      {"attributes of another kind", [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"] = 3; }, {"an object"}},
      {"mode beyond the list", [](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; }, {"mode", "7"}},
      {"no such mesh", [](Json& j) { j["nodes"][0]["mesh"] = 1; }, {"nodes[0].mesh", "below 1"}},
      {"no such material", [](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 0; }, {"material", "below 0"}},
      {"no such child", [](Json& j) { j["nodes"][0]["children"] = {5}; }, {"children[0]", "5"}},
      {"no such scene", [](Json& j) { j["scene"] = 3; }, {"scene", "3"}},
      {"no asset", [](Json& j) { j.erase("asset"); }, {"asset"}},
      {"glTF 1", [](Json& j) { j["asset"]["version"] = "1.0"; }, {"1.0", "2.0"}},
      {"nodes of another kind", [](Json& j) { j["nodes"] = "many"; }, {"nodes", "an array"}},
      {"other counts",
       [](Json& j) {
         j["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 0;
         j["accessors"].push_back(j["accessors"][0]);
         j["accessors"][2]["count"] = 2;
         j["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
       },
       {"COLOR_0", "expected 3"}},
  };
  for (const Case& test : cases) {
    SCOPED_TRACE(test.what);
    std::vector<std::string> words = test.words;
    words.push_back("scene.glb");
    expectRefusal(refusalWith(test.damage), 3, words);
  }
}

TEST(Hostile, IndexBeyondTheVertices) {
  for (const std::uint16_t bad : {std::uint16_t{3}, std::uint16_t{65535}}) {
    Builder builder;
    Json& primitive = builder.triangle();
    primitive["indices"] = builder.indices({0, 1, bad});
    expectRefusal(refusalOf(builder), 3, {"indices", std::to_string(bad), "below 3"});
  }
}

TEST(Hostile, SparseIndexBeyondTheAccessor) {
  Builder builder;
  builder.triangle();
  const std::vector<std::uint32_t> which = {3};
  const std::vector<float> value = {1, 2, 3};
  const int indexView = builder.view(which.data(), 4), valueView = builder.view(value.data(), 12);
  Json& sparse = builder.json["accessors"][0]["sparse"];
  sparse = {{"count", 1},
            {"indices", {{"bufferView", indexView}, {"componentType", 5125}}},
            {"values", {{"bufferView", valueView}}}};
  expectRefusal(refusalOf(builder), 3, {"sparse.indices", "3"});
  sparse["count"] = 1000000;
  expectRefusal(refusalOf(builder), 3, {"sparse.count", "1000000"});
  sparse["count"] = 2;
  expectRefusal(refusalOf(builder), 3, {"sparse.indices", "has 4"});
}

TEST(Hostile, ZerosWithoutEnd) {
  Builder builder;
  builder.json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 4000000000u}});
  builder.mesh({{"POSITION", 0}});
  expectRefusal(refusalOf(builder), 3, {"accessors[0].count", "without a bufferView"});
}

TEST(Hostile, ASmallFileDoesNotGrowWithoutEnd) {
  Builder builder;
  const std::vector<std::uint8_t> many(200000, 0);
  const int index = builder.accessor(many, 5121, "SCALAR", 1);
  const int position = builder.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
  Json& primitive = builder.mesh({{"POSITION", position}});
  primitive["indices"] = index;
  const Json one = primitive;
  Json& all = builder.json["meshes"][0]["primitives"];
  for (int i = 0; i < 3000; ++i) all.push_back(one);
  expectRefusal(refusalOf(builder), 3, {"vertices and triangles"});
}

TEST(Hostile, ManyInstancesOfManyPrimitivesAreBounded) {
  Builder builder;
  Json& primitive = builder.triangle();
  const Json one = primitive;
  for (int i = 1; i < 2000; ++i) builder.json["meshes"][0]["primitives"].push_back(one);
  const Json node = {{"mesh", 0}};
  for (int i = 1; i < 2000; ++i) builder.json["nodes"].push_back(node);
  expectRefusal(refusalOf(builder), 3, {"nodes[", "instances"});
}

TEST(Hostile, CyclesAndSharedChildren) {
  Builder self;
  self.triangle();
  self.json["nodes"][0]["children"] = {0};
  expectRefusal(refusalOf(self), 3, {"cycle"});

  Builder ring;
  ring.triangle();
  ring.json["nodes"].push_back({{"children", {2}}});
  ring.json["nodes"].push_back({{"children", {1}}});
  ring.json["scenes"] = {{{"nodes", {0, 1}}}};
  expectRefusal(refusalOf(ring), 3, {"reached twice"});
  // Without a scene nothing leads into the ring, but something must be said.
  ring.json.erase("scenes");
  expectRefusal(refusalOf(ring), 3, {"cycle"});

  Builder shared;
  shared.triangle();
  shared.json["nodes"].push_back({{"children", {0}}});
  shared.json["nodes"].push_back({{"children", {0}}});
  expectRefusal(refusalOf(shared), 3, {"nodes[0]", "reached twice"});
}

TEST(Hostile, ADeepChainIsNoRecursion) {
  Builder builder;
  builder.triangle();
  constexpr int kDepth = 100000;
  for (int i = 1; i < kDepth; ++i) builder.json["nodes"].push_back({{"children", {i - 1}}, {"translation", {0, 0, 1}}});
  const Scene scene = builder.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].worldFromObject[3].z, kDepth - 1);
}

TEST(Hostile, DeepJson) {
  std::string text = R"({"asset":{"version":"2.0"},"extras":)";
  text += std::string(1000000, '[') + std::string(1000000, ']') + "}";
  const std::filesystem::path path = testFolder() / "deep.gltf";
  writeBytes(path, text.data(), text.size());
  expectRefusal(refusalOf([&] { loadScene({path.string()}, {}); }), 3, {"deep.gltf", "nested"});
  // Brackets in strings are text.
  text = R"({"asset":{"version":"2.0"},"extras":"\"\\)" + std::string(1000, '[') + R"("})";
  writeBytes(path, text.data(), text.size());
  EXPECT_EQ(refusalOf([&] { loadScene({path.string()}, {}); }).sentence, "");
}

TEST(Hostile, TransformsThatAreNotFiniteOrAffine) {
  const auto refusal = [](const char* key, const Json& value) {
    Builder builder;
    builder.triangle();
    builder.json["nodes"][0][key] = value;
    return refusalOf(builder);
  };
  expectRefusal(refusal("scale", {1e300, 1e300, 1e300}), 3, {"nodes[0]", "transform"});
  expectRefusal(refusal("rotation", {1e-100, 0, 0, 0}), 3, {"rotation", "quaternion"});
  expectRefusal(refusal("rotation", {1e300, 1e300, 0, 0}), 3, {"rotation"});
  expectRefusal(refusal("translation", {1, 2}), 3, {"translation", "expected 3"});
  expectRefusal(refusal("translation", {1, "x", 2}), 3, {"translation[1]", "number"});
  expectRefusal(refusal("matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), 3, {"matrix", "affine"});
}

TEST(Hostile, TruncatedGlbAtEveryLength) {
  Builder builder;
  Json& primitive = builder.triangle();
  primitive["indices"] = builder.indices({0, 1, 2});
  const std::string whole = builder.writeGlb();
  std::ifstream stream(whole, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::filesystem::path path = testFolder() / "cut.glb";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    writeBytes(path, bytes.data(), size);
    const Refusal refusal = refusalOf([&] { loadScene({path.string()}, {}); });
    ASSERT_EQ(refusal.code, 3) << size;
    ASSERT_NE(refusal.sentence.find("cut.glb"), std::string::npos) << refusal.sentence;
  }
}

TEST(Hostile, AnyOneByteMayBeWrong) {
  // Loads or is refused; never anything else. Values are from a fixed integer sequence.
  Builder builder;
  Json& primitive = builder.material({{"name", "glass"}, {"alphaMode", "BLEND"}});
  primitive["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0.5}}};
  builder.json["meshes"][0]["primitives"][0]["indices"] = builder.indices({0, 1, 2});
  const std::string whole = builder.writeGlb();
  std::ifstream stream(whole, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::filesystem::path path = testFolder() / "bent.glb";
  std::size_t loaded = 0, refused = 0;
  std::uint32_t state = 12345;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    state = state * 1664525u + 1013904223u;
    std::string bent = bytes;
    bent[at] = static_cast<char>(state >> 24);
    writeBytes(path, bent.data(), bent.size());
    const Refusal refusal = refusalOf([&] { loadScene({path.string()}, {}); });
    (refusal.code == 0 ? loaded : refused) += 1;
    ASSERT_TRUE(refusal.code == 0 || refusal.code == 3 || refusal.code == 4) << refusal.sentence;
  }
  std::printf("one wrong byte: %zu files loaded, %zu refused\n", loaded, refused);
  EXPECT_GT(loaded, 0u);
  EXPECT_GT(refused, 0u);
}

TEST(Hostile, FilesThatAreNotThereOrNotGltf) {
  expectRefusal(refusalOf([] { loadScene({"/nonexistent/a.glb"}, {}); }), 3, {"/nonexistent/a.glb", "does not exist"});
  expectRefusal(refusalOf([] { loadScene({testFolder().string()}, {}); }), 3, {"not a regular file"});
  const std::filesystem::path path = testFolder() / "picture.glb";
  writeBytes(path, "not json", 8);
  expectRefusal(refusalOf([&] { loadScene({path.string()}, {}); }), 3, {"picture.glb", "not glTF"});
}

TEST(Hostile, ExternalBuffers) {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  Builder builder;
  builder.triangle();
  writeBytes(testFolder() / "a b.bin", positions, sizeof positions);
  const auto with = [&](const std::string& uri) {
    builder.json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    const std::string path = builder.writeGltf();
    return refusalOf([&] { EXPECT_EQ(loadScene({path}, {}).primitives.size(), 1u); });
  };
  EXPECT_EQ(with("a%20b.bin").code, 0);
  EXPECT_EQ(with("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA").code, 0);
  expectRefusal(with("data:;base64,AAAA"), 3, {"buffers[0]", "found 3 bytes", "36"});
  expectRefusal(with("data:;base64,A*AA"), 3, {"buffers[0]", "malformed"});
  expectRefusal(with("missing.bin"), 3, {"buffers[0]", "missing.bin"});
  expectRefusal(with("https://example.org/a.bin"), 3, {"buffers[0]", "https"});
  expectRefusal(with("a%00b.bin"), 3, {"buffers[0]", "zero byte"});
  expectRefusal(with("/dev/zero"), 3, {"buffers[0]", "/dev/zero", "--asset-root"});
  expectRefusal(with("."), 3, {"buffers[0]", "regular file"});
  writeBytes(testFolder() / "short.bin", positions, 20);
  expectRefusal(with("short.bin"), 3, {"buffers[0]", "found 20 bytes"});
}

TEST(Uri, Base64) {
  const auto decoded = [](const char* text) {
    std::vector<std::uint8_t> bytes;
    return gltf::decodeBase64(text, bytes) ? std::string(bytes.begin(), bytes.end()) : std::string("refused");
  };
  EXPECT_EQ(decoded(""), "");
  EXPECT_EQ(decoded("Zg=="), "f");
  EXPECT_EQ(decoded("Zm8="), "fo");
  EXPECT_EQ(decoded("Zm9v"), "foo");
  EXPECT_EQ(decoded("Zm9vYmFy"), "foobar");
  EXPECT_EQ(decoded("Zm9vYg"), "foob");
  EXPECT_EQ(decoded(" Zm9\r\nvYm\tFy \n"), "foobar");
  EXPECT_EQ(decoded("Zg=\n= "), "f");
  EXPECT_EQ(decoded("Z"), "refused");
  EXPECT_EQ(decoded("Zm9vY"), "refused");
  EXPECT_EQ(decoded("Zm!9"), "refused");
  EXPECT_EQ(decoded("Zg==Zg=="), "refused");
}

TEST(Uri, DataInEveryCaseAndEscape) {
  const auto decoded = [](const char* uri) {
    std::vector<std::uint8_t> bytes;
    EXPECT_TRUE(gltf::isDataUri(uri)) << uri;
    return gltf::decodeDataUri(uri, bytes) ? std::string(bytes.begin(), bytes.end()) : std::string("refused");
  };
  for (const char* uri :
       {"data:;base64,Pz8/Pj4+", "DATA:Image/PNG;BASE64,Pz8/Pj4+", "Data:a/b;charset=x;Base64,Pz8%2FPj4%2b",
        "data:a/b; base64 ,Pz8/\r\n Pj4+", "\n data:;base64,Pz8_Pj4-", "data:;base64,Pz8%2fPj4%2B%0D%0A"})
    EXPECT_EQ(decoded(uri), "\?\?\?>>>") << uri;
  EXPECT_EQ(decoded("data:;base64,Zg%3D%3D"), "f");
  EXPECT_EQ(decoded("data:text/plain,a%20b"), "a b");
  EXPECT_EQ(decoded("data:text/base64,a+b"), "a+b") << "a type, not an encoding";
  EXPECT_EQ(decoded("data:;base64,%%%"), "refused");
  EXPECT_EQ(decoded("data:;base64"), "refused");
  EXPECT_FALSE(gltf::isDataUri("dat"));
  EXPECT_FALSE(gltf::isDataUri("database.bin"));
  EXPECT_EQ(gltf::uriScheme("HTTPS://a/b"), "HTTPS");
  EXPECT_EQ(gltf::uriScheme("C:\\a.png"), "");
}

}  // namespace
}  // namespace pellucid::test
