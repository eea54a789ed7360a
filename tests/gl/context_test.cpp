#include <gtest/gtest.h>

#include <cstdlib>

#include "engine_bridge/gl/gl_objects.h"
#include "gbuffer/errors.h"
#include "tests/gl/builder.h"

namespace pellucid {
namespace {

TEST(Context, IsOpenGl45Core) {
  GlContext context;
  EXPECT_NE(context.description().find("OpenGL 4."), std::string::npos) << context.description();
  EXPECT_GE(epoxy_gl_version(), 45);
}

TEST(Context, TwoLiveSideBySide) {
  GlContext outer;
  { GlContext inner; }
  // The inner one has let go of the thread; a new one still works beside the outer.
  GlContext again;
  EXPECT_NE(again.description(), "");
}

TEST(Context, DevicesAreListedAndOpened) {
  const std::vector<std::string> devices = listDevices();
  ASSERT_FALSE(devices.empty());
  for (const std::string& line : devices) std::printf("device %s\n", line.c_str());
  EXPECT_EQ(devices[0].rfind("0: ", 0), 0u);
  int usable = 0;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (devices[i].find("unusable") == std::string::npos) {
      ++usable;
      EXPECT_NO_THROW(GlContext(static_cast<int>(i)));
    }
  EXPECT_GE(usable, 1);
}

TEST(Context, ListingKeepsTheCurrentContext) {
  GlContext context;
  listDevices();
  EXPECT_NE(context.description(), "");
}

TEST(Context, UnknownDeviceIsNamed) {
  try {
    GlContext context(999);
    FAIL() << "device 999 opened";
  } catch (const ResourceError& error) {
    EXPECT_EQ(error.exitCode(), 6);
    EXPECT_NE(std::string(error.what()).find("999"), std::string::npos) << error.what();
  }
}

// In a process of its own, with no EGL vendor at all.
TEST(ContextDeathTest, NoDeviceIsOneSentence) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        try {
          GlContext context;
        } catch (const ResourceError& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::exit(error.exitCode());
        }
        std::exit(0);
      },
      ::testing::ExitedWithCode(6), "GL: no OpenGL 4.5 core context: tried ");
}

TEST(ContextDeathTest, DebugMessagesBecomeOurErrors) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("PELLUCID_GL_DEBUG", "1", 1);
        GlContext context;
        glEnable(0xffff);
        try {
          gl::checkGl("testing");
        } catch (const std::logic_error& error) {
          std::fprintf(stderr, "%s\n", error.what());
          std::exit(7);
        }
        std::exit(0);
      },
      ::testing::ExitedWithCode(7), "GL error 0x500 while testing: .*GL_INVALID_ENUM.*glEnable");
}

TEST(Context, OutOfMemoryIsAResource) {
  GlContext context;
  gl::Buffer buffer = gl::Buffer::make();
  glNamedBufferData(buffer.name(), GLsizeiptr{1} << 46, nullptr, GL_STATIC_DRAW);
  EXPECT_THROW(gl::checkGl("asking for 64 TiB"), ResourceError);
}

}  // namespace
}  // namespace pellucid
