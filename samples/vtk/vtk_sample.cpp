// VTK 9.1 with Pellucid in place of its translucent pass, beside VTK's own: error against a sorted double-precision
// `over`, and time a frame.
//
//   vtk_sample OUTDIR [--parts N] [--size WxH] [--frames N] [--weight NAME:NUMBER:NEAR:FAR:REFERENCE] [--write-scene]
//              [--processor-time]
//
// --processor-time: what a CPU rasteriser takes of the processor, not what passes on the clock; for busy machines, with
// LP_NUM_THREADS=0 in the environment, so that no rasteriser thread waits for another.
// --write-scene writes OUTDIR/parts.glb and OUTDIR/wall.exr and ends: what `pellucid composite --weight auto` fits a
// weight to.
#include <vtk_glew.h>

#include <pellucid/pellucid.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCameraPass.h>
#include <vtkCellArray.h>
#include <vtkDepthSortPolyData.h>
#include <vtkImageData.h>
#include <vtkLightsPass.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpaquePass.h>
#include <vtkOpenGLRenderPass.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkOrderIndependentTranslucentPass.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderPassCollection.h>
#include <vtkRenderState.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSequencePass.h>
#include <vtkShaderProgram.h>
#include <vtkSmartPointer.h>
#include <vtkTimeStamp.h>
#include <vtkTranslucentPass.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "samples/vtk/parts.h"
// Last: its macros are words that others use.
#include <GL/glx.h>

namespace {

using namespace pellucid::vtksample;

bool processorTime = false;

// Milliseconds.
double now() {
  timespec time{};
  clock_gettime(processorTime ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "vtk_sample: %s\n", why.c_str());
  std::exit(1);
}

// In place of VTK's translucent pass: every translucent prop is drawn by VTK's own shaders, whose colour goes through
// the seam instead of into the framebuffer.
class PellucidPass : public vtkOpenGLRenderPass {
 public:
  static PellucidPass* New();
  vtkTypeMacro(PellucidPass, vtkOpenGLRenderPass);

  pld_method method = PLD_METHOD_WEIGHTED;
  pld_weight weight = PLD_WEIGHT_BY_EQ5;
  float weightNear = 0.1f, weightFar = 100.0f, exponent = 3.0f, reference = 1.0f;
  bool bare = false;  // fills the planes with the colour as it is: what the planes cost, without what goes into them

  void Render(const vtkRenderState* s) override {
    int size[2];
    s->GetWindowSize(size);
    const bool isNew = !pass_;
    if (isNew) create();
    check(pld_resize(pass_, size[0], size[1]));
    GLint frame = 0, colour = 0, depth = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &frame);
    colour = attached(GL_COLOR_ATTACHMENT0);
    depth = attached(GL_DEPTH_ATTACHMENT);

    pld_frame host{};
    host.struct_size = sizeof(host);
    host.colour_texture = static_cast<uint32_t>(colour);
    host.depth_texture = static_cast<uint32_t>(depth);
    host.width = size[0];
    host.height = size[1];
    vtkMatrix4x4* projection = s->GetRenderer()->GetActiveCamera()->GetProjectionTransformMatrix(
        static_cast<double>(size[0]) / size[1], -1, 1);
    for (int i = 0; i < 16; ++i) host.projection[i] = static_cast<float>(projection->GetElement(i % 4, i / 4));
    host.metres_per_unit = host.pre_exposure = 1.0f;
    host.weight_near = weightNear;
    host.weight_far = weightFar;
    host.weight_exponent = exponent;
    host.weight_reference = reference;
    host.refract_distance = host.diffusion_k1 = 1.0f;
    // Every frame has these: constants in the shaders.
    if (isNew) check(pld_fix(pass_, &host, PLD_FIXED_UNITS | PLD_FIXED_EXPOSURE | PLD_FIXED_WEIGHT));

    this->NumberOfRenderedProps = 0;
    std::vector<pld_stage> stages;
    if (method == PLD_METHOD_FRONT_TAIL) stages.push_back(PLD_STAGE_FRONT);
    stages.push_back(PLD_STAGE_LAYERS);
    for (const pld_stage stage : stages) {
      if (stages.size() > 1) stageTime_.Modified();  // another text than the last draw's
      stage_ = stage;
      this->PreRender(s);
      check(pld_begin(pass_, stage, &host));
      layers_->Render(s);
      check(pld_end(pass_));
      this->PostRender(s);
      this->NumberOfRenderedProps += layers_->GetNumberOfRenderedProps();
    }
    // The picture goes beside VTK's, which is read meanwhile, and from there into its place.
    if (pictureSize_[0] != size[0] || pictureSize_[1] != size[1]) makePicture(size);
    pld_target target{};
    target.struct_size = sizeof(target);
    target.kind = PLD_TARGET_TEXTURE;
    target.name = picture_;
    check(pld_resolve(pass_, &target));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, pictureFrame_);
    glBlitFramebuffer(0, 0, size[0], size[1], 0, 0, size[0], size[1], GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(frame));
  }

  // A pass that is drawn with another stage is another text.
  vtkMTimeType GetShaderStageMTime() override { return stageTime_.GetMTime(); }

  bool PostReplaceShaderValues(std::string&, std::string&, std::string& fragment, vtkAbstractMapper*,
                               vtkProp*) override {
    std::string& seam = seams_[stage_];
    if (seam.empty()) {
      const char* text = nullptr;
      check(pld_glsl(pass_, stage_, 330, &text));
      seam = text;
    }
    if (bare) seam = "layout(location = 0) out vec4 first;\nlayout(location = 1) out vec2 second;\n";
    replace(
        fragment, "//VTK::System::Dec",
        "#version 330\n#define highp\n#define mediump\n#define lowp\n#define varying in\n#define texture1D texture\n"
        "#define texture2D texture\n#define texture3D texture\n#define texelFetchBuffer texelFetch\nvec4 "
        "hostColour;\n" +
            seam);
    const char* writes = bare ? "first = hostColour;\nsecond = hostColour.aa;\n"
                              : "pldWriteFragment(pldSurface(hostColour.rgb * hostColour.a, hostColour.a, vec3(0.0), "
                                "vec3(0.0, 0.0, -1.0 / gl_FragCoord.w)));\n";
    replace(fragment, "//VTK::DepthPeeling::Impl", writes);
    while (replace(fragment, "gl_FragData[0]", "hostColour")) {
    }
    return true;
  }

  bool SetShaderParameters(vtkShaderProgram* program, vtkAbstractMapper*, vtkProp*,
                           vtkOpenGLVertexArrayObject*) override {
    const auto name = static_cast<uint32_t>(program->GetHandle());
    if (!bare && connected_.insert(name).second) check(pld_connect(pass_, name));
    return true;
  }

  void ReleaseGraphicsResources(vtkWindow* window) override {
    pld_destroy(&pass_);
    if (picture_) glDeleteTextures(1, &picture_);
    if (pictureFrame_) glDeleteFramebuffers(1, &pictureFrame_);
    picture_ = pictureFrame_ = 0;
    connected_.clear();
    layers_->ReleaseGraphicsResources(window);
    this->Superclass::ReleaseGraphicsResources(window);
  }

 private:
  void check(pld_status status) const {
    if (status != PLD_OK) stop(std::string(pld_status_name(status)) + ": " + pld_message(pass_));
  }
  static bool replace(std::string& text, const std::string& what, const std::string& with) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) return false;
    text.replace(at, what.size(), with);
    return true;
  }
  static GLint attached(GLenum attachment) {
    GLint kind = 0, name = 0;
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE,
                                          &kind);
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME,
                                          &name);
    if (kind != GL_TEXTURE) stop("VTK's framebuffer holds no texture");
    return name;
  }
  void create() {
    pld_create_info info{};
    info.struct_size = sizeof(info);
    info.version = PLD_VERSION;
    info.get_proc_address = [](void*, const char* name) {
      return reinterpret_cast<pld_proc>(glXGetProcAddressARB(reinterpret_cast<const GLubyte*>(name)));
    };
    info.log = [](void*, pld_log_level, const char* text) { std::fprintf(stderr, "%s\n", text); };
    info.method = method;
    info.weight = weight;
    info.depth = PLD_DEPTH_DEVICE;
    info.uniform_binding = 5;
    info.texture_unit = 12;
    if (pld_create(&info, &pass_) != PLD_OK) stop("no pass");
  }
  void makePicture(const int* size) {
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    if (!picture_) glGenTextures(1, &picture_);
    glBindTexture(GL_TEXTURE_2D, picture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size[0], size[1], 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
    if (!pictureFrame_) glGenFramebuffers(1, &pictureFrame_);
    GLint read = 0;
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, pictureFrame_);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read));
    pictureSize_[0] = size[0], pictureSize_[1] = size[1];
  }

  pld_pass* pass_ = nullptr;
  pld_stage stage_ = PLD_STAGE_LAYERS;
  vtkTimeStamp stageTime_;
  vtkNew<vtkTranslucentPass> layers_;
  std::set<uint32_t> connected_;
  std::string seams_[3];
  GLuint picture_ = 0, pictureFrame_ = 0;
  int pictureSize_[2] = {0, 0};
};
vtkStandardNewMacro(PellucidPass);

vtkSmartPointer<vtkPolyData> polygons(const std::vector<Part>& parts) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(4);
  for (const Part& part : parts) {
    vtkIdType corners[4];
    for (int i = 0; i < 4; ++i) {
      const Vec corner = part.corner(i);
      corners[i] = points->InsertNextPoint(corner.x, corner.y, corner.z);
      const unsigned char c[4] = {part.colour[0], part.colour[1], part.colour[2], part.colour[3]};
      colours->InsertNextTypedTuple(c);
    }
    cells->InsertNextCell(4, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(colours);
  return data;
}

// Colours as they are: no light has a say.
vtkSmartPointer<vtkActor> actorOf(vtkPolyDataMapper* mapper) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

struct Measured {
  double rmse = 0, largest = 0, milliseconds = 0;
};

// Frames of one translucent pass; `sorted` first sorts the polygons, every frame.
Measured measure(const Scene& scene, vtkRenderPass* translucent, bool sorted, int frames, const std::string& png) {
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetOffScreenRendering(1);
  window->SetAlphaBitPlanes(1);
  window->SetSize(scene.width, scene.height);
  vtkNew<vtkRenderer> renderer;
  window->AddRenderer(renderer);
  const vtkSmartPointer<vtkPolyData> parts = polygons(scene.parts);
  vtkNew<vtkPolyDataMapper> mapper, wall;
  vtkNew<vtkDepthSortPolyData> sort;
  sort->SetInputData(parts);
  sort->SetCamera(renderer->GetActiveCamera());
  sort->SetDirectionToBackToFront();
  if (sorted)
    mapper->SetInputConnection(sort->GetOutputPort());
  else
    mapper->SetInputData(parts);
  wall->SetInputData(polygons({scene.wall}));
  const vtkSmartPointer<vtkActor> translucentActor = actorOf(mapper);
  translucentActor->ForceTranslucentOn();
  renderer->AddActor(translucentActor);
  renderer->AddActor(actorOf(wall));
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetPosition(0, 0, 0);
  camera->SetFocalPoint(0, 0, -1);
  camera->SetViewUp(0, 1, 0);
  camera->SetViewAngle(scene.degrees);
  camera->SetClippingRange(0.5, 40.0);
  vtkNew<vtkLightsPass> lights;
  vtkNew<vtkOpaquePass> opaque;
  vtkNew<vtkRenderPassCollection> passes;
  passes->AddItem(lights);
  passes->AddItem(opaque);
  passes->AddItem(translucent);
  vtkNew<vtkSequencePass> sequence;
  sequence->SetPasses(passes);
  vtkNew<vtkCameraPass> whole;
  whole->SetDelegatePass(sequence);
  renderer->SetPass(whole);
  std::vector<double> times;
  for (int i = 0; i < frames + 2; ++i) {  // the first two compile
    camera->Modified();
    const double start = now();
    window->Render();
    window->WaitForCompletion();
    if (i >= 2) times.push_back(now() - start);
  }
  std::sort(times.begin(), times.end());
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->ShouldRerenderOff();
  grab->Update();
  vtkImageData* image = grab->GetOutput();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(png.c_str());
  writer->SetInputData(image);
  writer->Write();
  Measured measured;
  measured.milliseconds = times[times.size() / 2];
  double sum = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double error = image->GetScalarComponentAsDouble(x, y, 0, c) / 255.0 - scene.truth(x, y)[c];
        sum += error * error;
        measured.largest = std::max(measured.largest, std::abs(error));
      }
  measured.rmse = std::sqrt(sum / (3.0 * scene.width * scene.height));
  renderer->ReleaseGraphicsResources(window);
  translucent->ReleaseGraphicsResources(window);
  return measured;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2)
    stop(
        "vtk_sample OUTDIR [--parts N] [--size WxH] [--frames N] [--weight NAME:NUMBER:NEAR:FAR:REFERENCE] "
        "[--write-scene] "
        "[--processor-time]");
  const std::string folder = arguments[1];
  int parts = 160, width = 640, height = 360, frames = 9;
  char weightName[32] = "";
  float exponent = 3.0f, weightNear = 0.1f, weightFar = 100.0f, reference = 1.0f;
  bool writes = false, fitted = false;
  for (int i = 2; i < count; ++i) {
    const std::string flag = arguments[i];
    const char* value = i + 1 < count ? arguments[i + 1] : "";
    bool good = true;
    if (flag == "--write-scene")
      writes = true;
    else if (flag == "--processor-time")
      processorTime = true;
    else if (flag == "--parts")
      good = (parts = std::atoi(value)) > 0, ++i;
    else if (flag == "--frames")
      good = (frames = std::atoi(value)) > 0, ++i;
    else if (flag == "--size")
      good = std::sscanf(value, "%dx%d", &width, &height) == 2, ++i;
    else if (flag == "--weight")
      fitted = good =
          std::sscanf(value, "%31[^:]:%f:%f:%f:%f", weightName, &exponent, &weightNear, &weightFar, &reference) == 5,
      ++i;
    else
      good = false;
    if (!good) stop("cannot read " + flag + " " + value);
  }
  const Scene scene(parts, width, height);
  if (writes) {
    scene.writeGlb(folder + "/parts.glb");
    scene.writeWall(folder + "/wall.exr");
    return 0;
  }
  std::printf("%d translucent parts, %dx%d, %.1f layers a pixel; error against a sorted over in double\n", parts, width,
              height, scene.meanLayers());
  std::printf("| translucent pass | RMSE | largest | ms a frame |\n| --- | --- | --- | --- |\n");
  Measured results[6];
  const auto row = [&](int place, const char* name, vtkRenderPass* pass, bool sorted) {
    results[place] = measure(scene, pass, sorted, frames, folder + "/vtk" + std::to_string(place) + ".png");
    std::printf("| %s | %.5f | %.3f | %.1f |\n", name, results[place].rmse, results[place].largest,
                results[place].milliseconds);
    std::fflush(stdout);
  };
  vtkNew<vtkTranslucentPass> plain;
  vtkNew<vtkOrderIndependentTranslucentPass> theirs;
  theirs->SetTranslucentPass(plain);
  row(0, "VTK weighted-blended", theirs, false);
  vtkNew<vtkTranslucentPass> sorted;
  row(1, "VTK sorted, blended", sorted, true);
  vtkNew<PellucidPass> weighted, front, phenomenological, bare;
  weighted->weight = PLD_WEIGHT_BY_EQ7Z;
  if (fitted && pld_weight_named(weightName, &weighted->weight) != PLD_OK)
    stop(std::string("no weight is called ") + weightName);
  front->weight = weighted->weight;
  front->method = PLD_METHOD_FRONT_TAIL;
  phenomenological->method = PLD_METHOD_PHENOMENOLOGICAL;
  bare->method = PLD_METHOD_WEIGHTED;
  bare->bare = true;
  for (PellucidPass* pass : {weighted.Get(), front.Get(), phenomenological.Get()})
    pass->weightNear = weightNear, pass->weightFar = weightFar, pass->exponent = exponent, pass->reference = reference;
  row(2, fitted ? "Pellucid weighted, fitted" : "Pellucid weighted, eq7z", weighted, false);
  row(3, "Pellucid front+tail", front, false);
  row(4, "Pellucid phenomenological, eq5", phenomenological, false);
  row(5, "(the planes of weighted, nothing computed)", bare, false);
  const double error = results[2].rmse / results[0].rmse, nearer = results[0].rmse / results[3].rmse;
  std::printf(
      "weighted: %.2f of VTK's error in %.2f of its time (aims: 1, 1); front+tail: %.2f times nearer in %.2f of its "
      "time "
      "(aims: 2, 2.5)\n",
      error, results[2].milliseconds / results[0].milliseconds, nearer,
      results[3].milliseconds / results[0].milliseconds);
  // Times are for the table: the machine under a test is not a quiet one.
  if (error > 1) stop("weighted is farther from the truth than VTK's pass");
  if (nearer < 2) stop("front+tail is not twice as near to the truth as VTK's pass");
}
