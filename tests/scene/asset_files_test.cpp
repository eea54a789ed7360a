// Which files a scene may name, and how.
#include <atomic>
#include <thread>

#include "engine_bridge/scene/asset_files.h"
#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

namespace fs = std::filesystem;

// A folder of a scene, and one beside it with a file of the same bytes that the scene must not reach.
struct Folders {
  fs::path all = testFolder(), scene = all / "scene", outside = all / "outside";
  Folders() {
    fs::remove_all(all);
    fs::create_directories(scene / "sub");
    fs::create_directories(outside / "deep");
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (const fs::path& path : {scene / "a.bin", scene / "sub" / "b.bin", outside / "secret.bin",
                                 outside / "deep" / "secret.bin", scene / "name with %41.bin"})
      writeBytes(path, positions, sizeof positions);
  }
  Refusal naming(const std::string& uri, const std::string& assetRoot = "") const {
    Builder builder;
    builder.triangle();
    builder.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", uri}}});
    const std::string text = builder.json.dump();
    writeBytes(scene / "s.gltf", text.data(), text.size());
    SceneOptions options;
    options.assetRoot = assetRoot;
    return refusalOf([&] { EXPECT_EQ(loadScene({(scene / "s.gltf").string()}, options).primitives.size(), 1u); });
  }
};

TEST(AssetFiles, NamesAsExportersWriteThem) {
  const Folders folders;
  fs::create_symlink("sub/b.bin", folders.scene / "link.bin");
  fs::create_directory_symlink("sub", folders.scene / "linked");
  fs::copy_file(folders.scene / "a.bin", folders.scene / "back\\slash.bin");
  fs::copy_file(folders.scene / "a.bin", folders.scene / "sub" / "escaped%20twice.bin");
  for (const std::string& uri :
       {std::string("a.bin"), std::string("./a.bin"), std::string("sub/b.bin"), std::string("sub\\b.bin"),
        std::string("sub%5Cb.bin"), std::string("sub%2fb.bin"), std::string("sub/../a.bin"), std::string("%61.bin"),
        std::string("name with %41.bin"), std::string("name%20with%20%2541.bin"), std::string("link.bin"),
        std::string("linked/b.bin"), std::string("back\\slash.bin"), (folders.scene / "a.bin").string(),
        std::string("../scene/a.bin"), std::string("sub%5Cescaped%20twice.bin"),
        std::string("sub\\escaped%20twice.bin")})
    EXPECT_EQ(folders.naming(uri).sentence, "") << uri;
  expectRefusal(folders.naming("sub\\c.bin"), 3, {"buffers[0]", "sub\\c.bin", "does not exist"});
  expectRefusal(folders.naming("HTTP://host/a.bin"), 3, {"HTTP"});
  expectRefusal(folders.naming("File:///a.bin"), 3, {"File"});
}

TEST(AssetFiles, FortyWaysOutOfTheFolderAreRefused) {
  const Folders folders;
  const fs::path scene = folders.scene;
  fs::create_symlink("../outside/secret.bin", scene / "link.bin");
  fs::create_symlink(folders.outside / "secret.bin", scene / "absolute.bin");
  fs::create_directory_symlink("../outside", scene / "linked");
  fs::create_directory_symlink(folders.outside, scene / "sub" / "linked");
  fs::create_directory_symlink("..", scene / "up");
  fs::create_symlink("link.bin", scene / "twice.bin");
  fs::create_directory_symlink("linked/deep", scene / "further");
  fs::create_symlink("../outside/gone.bin", scene / "dangling.bin");
  fs::create_symlink("/dev/zero", scene / "device.bin");
  fs::create_symlink("loop.bin", scene / "loop.bin");
  fs::create_directory_symlink(folders.scene.parent_path(), scene / "sub" / "parent");
  const std::string secret = (folders.outside / "secret.bin").string();
  std::vector<std::string> names = {"../outside/secret.bin",
                                    "./../outside/secret.bin",
                                    "sub/../../outside/secret.bin",
                                    "sub/./.././../outside/secret.bin",
                                    "..//outside//secret.bin",
                                    "%2e%2e/outside/secret.bin",
                                    "%2E%2e/outside/secret.bin",
                                    "..%2Foutside%2Fsecret.bin",
                                    "%2e%2e%2f%6futside%2fsecret.bin",
                                    "..\\outside\\secret.bin",
                                    "..%5Coutside%5Csecret.bin",
                                    "%2e%2e%5coutside%5csecret.bin",
                                    "sub\\..\\..\\outside\\secret.bin",
                                    "../outside/deep/../secret.bin",
                                    "../outside/deep/secret.bin",
                                    "link.bin",
                                    "./link.bin",
                                    "absolute.bin",
                                    "linked/secret.bin",
                                    "linked\\secret.bin",
                                    "linked/deep/secret.bin",
                                    "sub/linked/secret.bin",
                                    "sub/linked/deep/secret.bin",
                                    "up/outside/secret.bin",
                                    "twice.bin",
                                    "further/secret.bin",
                                    "sub/parent/outside/secret.bin",
                                    "sub/../link.bin",
                                    "sub/../linked/secret.bin",
                                    "up/scene/link.bin",
                                    "dangling.bin",
                                    "device.bin",
                                    "loop.bin",
                                    "/dev/zero",
                                    "/proc/self/root/dev/zero",
                                    "/etc/passwd",
                                    "../../../../../../../../../../etc/passwd",
                                    secret,
                                    "/" + secret,
                                    (folders.scene / ".." / "outside" / "secret.bin").string(),
                                    (scene / "link.bin").string(),
                                    "%2F" + secret.substr(1)};
  EXPECT_GE(names.size(), 40u);
  for (const std::string& name : names) {
    const Refusal refusal = folders.naming(name);
    EXPECT_EQ(refusal.code, 3) << name << ": " << refusal.sentence;
  }
  expectRefusal(folders.naming("link.bin"), 3, {"buffers[0]", "link.bin", secret, "--asset-root"});
  // The folder that the user allows; and no other.
  for (const std::string& name : {std::string("link.bin"), std::string("../outside/secret.bin"), secret})
    EXPECT_EQ(folders.naming(name, folders.outside.string()).sentence, "") << name;
  EXPECT_EQ(folders.naming("a.bin", folders.outside.string()).sentence, "") << "its own folder stays allowed";
  EXPECT_EQ(folders.naming("link.bin", "/").sentence, "");
  expectRefusal(folders.naming("link.bin", (folders.outside / "deep").string()), 3, {"--asset-root"});
  expectRefusal(folders.naming("a.bin", (folders.all / "none").string()), 3, {"--asset-root", "none"});
}

// A folder that becomes a link between the check and the opening: what is outside is never read.
TEST(AssetFiles, RacesLeadNowhere) {
  const Folders folders;
  const char inside[36] = "inside and not a secret at all here";
  const char secret[36] = "secret that no scene may ever read.";
  writeBytes(folders.scene / "sub" / "secret.bin", inside, sizeof inside);
  writeBytes(folders.outside / "secret.bin", secret, sizeof secret);
  const fs::path sub = folders.scene / "sub", kept = folders.scene / "kept";
  std::atomic<bool> done{false};
  std::thread swapping([&] {
    while (!done) {
      ::rename(sub.c_str(), kept.c_str());
      fs::create_directory_symlink(folders.outside, sub);
      ::unlink(sub.c_str());
      ::rename(kept.c_str(), sub.c_str());
    }
  });
  const gltf::AssetFiles files((folders.scene / "s.gltf").string(), "");
  int read = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    try {
      const std::vector<std::uint8_t> bytes = readWhole(files.open("sub/secret.bin", "s.gltf"), "s.gltf");
      ASSERT_EQ(std::memcmp(bytes.data(), inside, sizeof inside), 0);
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  done = true;
  swapping.join();
  std::printf("a folder that turns into a link and back: %d files read, %d refused\n", read, refused);
}

}  // namespace
}  // namespace pellucid::test
