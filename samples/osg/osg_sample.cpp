// OpenSceneGraph 3.6 in a surfaceless EGL context of our own, with Pellucid in place of its bin of transparent things.
//
//   osg_sample OUTDIR [--size WxH] [--frames N] [--write-scene]
//
// --write-scene writes OUTDIR/glass.glb and OUTDIR/opaque.exr, what OpenSceneGraph draws of the opaque parts, and ends:
// run.sh has `pellucid composite` make OUTDIR/offline-METHOD.exr of them. Without it every bin is drawn, written to
// OUTDIR/osg-NAME.exr, and held against those.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <OpenImageIO/imageio.h>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/Group>
#include <osgViewer/Viewer>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "samples/osg/pellucid_bin.h"
#include "samples/osg/still_life.h"

namespace {

using namespace pellucid::osgsample;

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "osg_sample: %s\n", why.c_str());
  std::exit(1);
}

constexpr double kNear = 0.5, kFar = 10.0;

const char* const kVertex = R"(#version 330 compatibility
out vec3 viewPosition, viewNormal;
void main() {
  viewPosition = vec3(gl_ModelViewMatrix * gl_Vertex);
  viewNormal = gl_NormalMatrix * gl_Normal;
  gl_Position = gl_ProjectionMatrix * vec4(viewPosition, 1.0);
}
)";

const char* const kOpaque = R"(#version 330 compatibility
in vec3 viewPosition, viewNormal;
uniform vec4 base;
uniform vec3 surroundings, toSun;
void main() {
  float sun = 1.1 * max(dot(normalize(viewNormal), toSun), 0.0);
  gl_FragColor = vec4(base.rgb * (0.75 * surroundings + vec3(sun, 0.95 * sun, 0.85 * sun)), 1.0);
}
)";

// glTF: what a dielectric reflects of even surroundings and lets through.
const char* const kGlass = R"(
in vec3 viewPosition, viewNormal;
uniform vec4 base;           // colour, coverage
uniform vec4 surfaceValues;  // roughness, transmission, ior, thickness in metres
uniform vec3 surroundings;

float fresnel(float c, float ior) {
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (ior * ior), 0.0));
  float p = (ior * c - inside) / (ior * c + inside), s = (c - ior * inside) / (c + ior * inside);
  return 0.5 * (p * p + s * s);
}
void shade(out vec3 normal, out vec3 reflected, out vec3 transmission) {
  normal = normalize(gl_FrontFacing ? viewNormal : -viewNormal);
  float f = fresnel(clamp(dot(normal, normalize(-viewPosition)), 1e-4, 1.0), surfaceValues.z);
  reflected = (base.rgb * (1.0 - surfaceValues.y) * (1.0 - f) + vec3(f)) * surroundings;
  transmission = base.rgb * surfaceValues.y * (1.0 - f);
}
)";

// As such materials are drawn without Pellucid: one opacity for all channels.
const char* const kBlended = R"(
void main() {
  vec3 normal, reflected, transmission;
  shade(normal, reflected, transmission);
  gl_FragColor = vec4(base.a * reflected, base.a * (1.0 - dot(transmission, vec3(1.0 / 3.0))));
}
)";

const char* const kSeam = R"(
void main() {
  vec3 normal, reflected, transmission;
  shade(normal, reflected, transmission);
  PldSurface surface = pldSurface(base.a * reflected, base.a, transmission, viewPosition);
  surface.normal = normal;
  surface.thickness = surfaceValues.w;
  if (surfaceValues.w > 0.0) surface.eta = 1.0 / surfaceValues.z;
  float met = surfaceValues.x * clamp(2.0 * surfaceValues.z - 2.0, 0.0, 1.0);  // of the roughness, by light that passes
  if (surfaceValues.y > 0.0) surface.collimation = 1.0 - met * met;
  pldWriteFragment(surface);
}
)";

osg::ref_ptr<osg::Program> program(const std::string& fragment) {
  osg::ref_ptr<osg::Program> made = new osg::Program;
  made->addShader(new osg::Shader(osg::Shader::VERTEX, kVertex));
  made->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
  return made;
}

osg::ref_ptr<osg::Geometry> geometryOf(const Part& part) {
  osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
  osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array,
                               normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
  for (const glm::vec3& p : part.mesh.positions) positions->push_back({p.x, p.y, p.z});
  for (const glm::vec3& n : part.mesh.normals) normals->push_back({n.x, n.y, n.z});
  geometry->setVertexArray(positions);
  geometry->setNormalArray(normals);
  geometry->addPrimitiveSet(
      new osg::DrawElementsUInt(GL_TRIANGLES, part.mesh.indices.begin(), part.mesh.indices.end()));
  geometry->setUseDisplayList(false);
  geometry->setUseVertexBufferObjects(true);
  osg::StateSet* state = geometry->getOrCreateStateSet();
  state->addUniform(new osg::Uniform("base", osg::Vec4(part.colour.r, part.colour.g, part.colour.b, part.coverage)));
  state->addUniform(
      new osg::Uniform("surfaceValues", osg::Vec4(part.roughness, part.transmission, part.ior, part.thickness)));
  // Light meets both sides of a volume.
  if (part.name.empty()) state->setAttributeAndModes(new osg::CullFace);
  return geometry;
}

// As any application of OpenSceneGraph would have it; nothing here knows of Pellucid.
osg::ref_ptr<osg::Group> graphOf(const Scene& scene) {
  osg::ref_ptr<osg::Group> root = new osg::Group, opaque = new osg::Group, transparent = new osg::Group;
  for (const Part& part : scene.opaque) opaque->addChild(geometryOf(part));
  for (const Part& part : scene.transparent) transparent->addChild(geometryOf(part));
  opaque->getOrCreateStateSet()->setAttribute(program(kOpaque));
  osg::StateSet* state = transparent->getOrCreateStateSet();
  state->setAttribute(program("#version 330 compatibility\n" + std::string(kGlass) + kBlended));
  state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
  state->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA));
  state->setAttribute(new osg::Depth(osg::Depth::LEQUAL, 0.0, 1.0, false));
  root->addChild(opaque);
  root->addChild(transparent);
  root->getOrCreateStateSet()->addUniform(
      new osg::Uniform("surroundings", osg::Vec3(kSurroundings.r, kSurroundings.g, kSurroundings.b)));
  return root;
}

struct Picture {
  int width = 0, height = 0;
  std::vector<float> texels;  // R G B A, and Z where it was drawn here; row 0 is the top
};

class Drawing {
 public:
  Drawing(const Scene& scene, osg::Node* root) : width_(scene.view.width), height_(scene.view.height) {
    colour_ = texture(GL_RGBA32F_ARB, GL_RGBA);
    depth_ = texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT);
    viewer_.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    window_ = viewer_.setUpViewerAsEmbeddedInWindow(0, 0, width_, height_);
    osg::Camera* camera = viewer_.getCamera();
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->setImplicitBufferAttachmentMask(0, 0);
    camera->attach(osg::Camera::COLOR_BUFFER, colour_);
    camera->attach(osg::Camera::DEPTH_BUFFER, depth_);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setClearColor({kSurroundings.r, kSurroundings.g, kSurroundings.b, 1.0f});
    constexpr double degrees = 180.0 / 3.14159265358979323846;
    camera->setProjectionMatrixAsPerspective(scene.view.yfov * degrees, scene.view.aspect(), kNear, kFar);
    const auto vec = [](glm::dvec3 v) { return osg::Vec3d(v.x, v.y, v.z); };
    camera->setViewMatrixAsLookAt(vec(scene.view.eye), vec(scene.view.target), osg::Vec3d(0, 1, 0));
    camera->setViewport(0, 0, width_, height_);
    osg::Vec3d toSun = osg::Matrixd::transform3x3(osg::Vec3d(-0.5, 0.75, 0.6), camera->getViewMatrix());
    toSun.normalize();
    root->getOrCreateStateSet()->addUniform(new osg::Uniform("toSun", osg::Vec3(toSun)));
    viewer_.setLightingMode(osg::View::NO_LIGHT);
    viewer_.setKeyEventSetsDone(0);
    viewer_.setSceneData(root);
    viewer_.realize();
  }
  ~Drawing() { viewer_.getCamera()->releaseGLObjects(&state()); }
  osg::State& state() { return *window_->getState(); }

  // Median of the frames, milliseconds.
  double draw(int frames) {
    std::vector<double> times;
    for (int i = 0; i < frames + 2; ++i) {  // the first two compile
      const auto start = std::chrono::steady_clock::now();
      viewer_.frame();
      glFinish();
      if (i >= 2)
        times.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  }

  Picture picture() {
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    std::vector<float> colour(4 * pixels), depth(pixels);
    read(colour_, GL_RGBA, colour);
    read(depth_, GL_DEPTH_COMPONENT, depth);
    Picture picture{width_, height_, {}};
    for (int y = height_ - 1; y >= 0; --y)
      for (int x = 0; x < width_; ++x) {
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        for (std::size_t c = 0; c < 4; ++c) picture.texels.push_back(colour[4 * i + c]);
        const double d = depth[i];
        picture.texels.push_back(d < 1.0 ? static_cast<float>(kNear * kFar / (kFar - d * (kFar - kNear)))
                                         : std::numeric_limits<float>::infinity());
      }
    return picture;
  }

 private:
  osg::ref_ptr<osg::Texture2D> texture(GLint format, GLenum source) const {
    osg::ref_ptr<osg::Texture2D> made = new osg::Texture2D;
    made->setTextureSize(width_, height_);
    made->setInternalFormat(format);
    made->setSourceFormat(source);
    made->setSourceType(GL_FLOAT);
    made->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    made->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    return made;
  }
  void read(osg::Texture2D* texture, GLenum format, std::vector<float>& texels) {
    glBindTexture(GL_TEXTURE_2D, texture->getTextureObject(state().getContextID())->id());
    glGetTexImage(GL_TEXTURE_2D, 0, format, GL_FLOAT, texels.data());
  }

  int width_, height_;
  osg::ref_ptr<osg::Texture2D> colour_, depth_;
  osgViewer::Viewer viewer_;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window_;
};

void write(const std::string& path, const Picture& picture) {
  OIIO::ImageSpec spec(picture.width, picture.height, 5, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  const auto file = OIIO::ImageOutput::create(path);
  if (!file || !file->open(path, spec) || !file->write_image(OIIO::TypeDesc::FLOAT, picture.texels.data()) ||
      !file->close())
    stop(path + ": could not be written");
}

Picture readRgb(const std::string& path, const Scene& scene) {
  const auto file = OIIO::ImageInput::open(path);
  Picture picture{scene.view.width, scene.view.height, {}};
  if (!file || file->spec().width != picture.width || file->spec().height != picture.height)
    stop(path + ": expected a picture of this size; run.sh makes it");
  const auto pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  picture.texels.resize(3 * pixels);
  if (!file->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, picture.texels.data())) stop(path + ": could not be read");
  return picture;
}

struct Difference {
  double rmse = 0;        // of a channel
  double mean = 0;        // of the pixels' largest, where it is .01 or less
  std::size_t stray = 0;  // pixels with more
};

Difference difference(const Picture& drawn, const Picture& expected) {
  Difference found;
  const std::size_t pixels = expected.texels.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    double worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off =
          std::abs(static_cast<double>(drawn.texels[5 * i + c]) - static_cast<double>(expected.texels[3 * i + c]));
      found.rmse += off * off;
      worst = std::max(worst, off);
    }
    if (worst > 0.01)
      ++found.stray;
    else
      found.mean += worst;
  }
  found.rmse = std::sqrt(found.rmse / (3.0 * static_cast<double>(pixels)));
  found.mean /= static_cast<double>(pixels);
  return found;
}

void makeContext() {
  const auto display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) stop("no EGL");
  // Of no profile: OpenSceneGraph draws with the compatibility profile.
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) stop("no OpenGL");
}

struct Row {
  const char* name;  // of the offline program's method too
  pld_method method;
  bool scatters;
  double mean;  // largest mean difference from it
  const char* why;
};
// Attributes are interpolated by other shaders than the offline program's, so edges fall differently on a few pixels.
const Row kRows[] = {{"weighted", PLD_METHOD_WEIGHTED, false, 1e-6, "pixels at edges"},
                     {"front+tail", PLD_METHOD_FRONT_TAIL, false, 1e-6, "pixels at edges"},
                     {"phenomenological", PLD_METHOD_PHENOMENOLOGICAL, true, 5e-6,
                      "pixels at edges and, as rows run up in OpenGL, places of the spread pyramid's texels"}};

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) stop("osg_sample OUTDIR [--size WxH] [--frames N] [--write-scene]");
  const std::string folder = arguments[1];
  int width = 640, height = 360, frames = 5;
  bool writes = false;
  for (int i = 2; i < count; ++i) {
    const std::string flag = arguments[i];
    const char* value = i + 1 < count ? arguments[i + 1] : "";
    bool good = true;
    if (flag == "--write-scene")
      writes = true;
    else if (flag == "--frames")
      good = (frames = std::atoi(value)) > 0, ++i;
    else if (flag == "--size")
      good = std::sscanf(value, "%dx%d", &width, &height) == 2 && width > 0 && height > 0, ++i;
    else
      good = false;
    if (!good) stop("cannot read " + flag + " " + value);
  }
  try {
    makeContext();
    Scene scene = stillLife(width, height);
    if (writes) {
      writeGlb(folder + "/glass.glb", scene);
      scene.transparent.clear();
      const osg::ref_ptr<osg::Group> opaque = graphOf(scene);
      Drawing drawing(scene, opaque);
      drawing.draw(1);
      write(folder + "/opaque.exr", drawing.picture());
      return 0;
    }
    const Picture truth = readRgb(folder + "/offline-over.exr", scene);
    osgUtil::RenderBin* bin = osgUtil::RenderBin::getRenderBinPrototype("DepthSortedBin");
    std::printf(
        "%dx%d; error against a sorted over of every fragment, and difference from the offline picture of the method\n",
        width, height);
    std::printf("| transparent bin | RMSE | offline: mean | offline: pixels off by more than .01 | ms a frame |\n");
    std::printf("| --- | --- | --- | --- | --- |\n");
    const osg::ref_ptr<osg::Group> graph = graphOf(scene);
    Drawing drawing(scene, graph);
    const double own = drawing.draw(frames);
    write(folder + "/osg-own.exr", drawing.picture());
    const Difference theirs = difference(drawing.picture(), truth);
    std::printf("| OpenSceneGraph's, sorted by part | %.4f | | | %.1f |\n", theirs.rmse, own);
    for (const Row& row : kRows) {
      BinSettings settings;
      settings.method = row.method;
      settings.features = PLD_FEATURE_COLOURED | (row.scatters ? PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION : 0);
      settings.vertex = kVertex;
      settings.fragment = std::string(kGlass) + kSeam;
      const osg::ref_ptr<PellucidBin> ours = new PellucidBin(settings);
      bin->setDrawCallback(ours);  // of every bin of transparent things from here on
      const double time = drawing.draw(frames);
      const Picture picture = drawing.picture();
      write(folder + "/osg-" + row.name + ".exr", picture);
      const Difference error = difference(picture, truth),
                       off = difference(picture, readRgb(folder + "/offline-" + row.name + ".exr", scene));
      if (row.scatters)
        std::printf("| Pellucid `%s`, which bends and blurs | |", row.name);
      else
        std::printf("| Pellucid `%s` | %.4f |", row.name, error.rmse);
      std::printf(" %.1e | %zu | %.1f |\n", off.mean, off.stray, time);
      std::fflush(stdout);
      ours->release(drawing.state());
      const double pixels = static_cast<double>(width) * height;
      if (off.mean > row.mean || static_cast<double>(off.stray) > std::max(4.0, 2e-4 * pixels))
        stop(std::string(row.name) + ": not the offline picture; expected to differ by " + row.why + " alone");
      // The bins that neither bend nor blur approach the sorted over; OpenSceneGraph's has one opacity for all
      // channels.
      if (!row.scatters && error.rmse > 0.5 * theirs.rmse)
        stop(std::string(row.name) + " is not twice as near to the truth as OpenSceneGraph's own bin");
    }
    bin->setDrawCallback(nullptr);
  } catch (const std::exception& error) {
    stop(error.what());
  }
}
