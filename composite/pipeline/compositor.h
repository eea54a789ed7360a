// The whole of Pellucid behind one class: a shot is loaded once, then any number of requests are carried out on it.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "composite/pipeline/kept_work.h"
#include "composite/pipeline/lighting.h"
#include "composite/pipeline/painter.h"
#include "composite/pipeline/picture_depth.h"
#include "composite/pipeline/plan.h"
#include "composite/pipeline/result.h"
#include "composite/pipeline/validate.h"
#include "gbuffer/depth_plane.h"
#include "gbuffer/planes_io.h"

namespace pellucid {

// Not for several threads at once; one after the other may use it. Its GL context is current only while it works.
class Compositor {
 public:
  // Validates the request before any file is opened, and loads its shot. Throws UsageError, InputError, MeaningError
  // and ResourceError, each with one sentence that says what was found and what was expected.
  //   sink   takes notes, one sentence at a time: what was inferred and how to say otherwise
  //   watch  is told how far a run is, as Journal does it
  //   kept   of an earlier frame of the shot, so that this one takes over what does not change; null: nothing
  explicit Compositor(const Request& request, std::function<void(const std::string&)> sink = nullptr,
                      std::function<void(const std::string&, double)> watch = nullptr,
                      std::shared_ptr<KeptWork> kept = nullptr);
  ~Compositor();

  const Shot& shot() const { return *shot_; }
  const ShotFacts& facts() const { return facts_; }
  // What run() would do. Of a request only what is not in ShotRequest may differ from the one that was loaded.
  Plan plan(const Request& request) const;

  // Works out the light of a request, which run() does where nobody has: shadows, fog, the light in particles.
  void light(const Request& request) {
    const Device::Turn turn(device_);
    lightOf(request);
    journal_.stages = Stages();
  }
  // The weight that --weight auto would take. Of the picture that the request asks for.
  shading::WeightSettings fitWeight(Request request);
  // Composites. The picture's bits do not depend on what was run before.
  Result run(const Request& request);
  // The sums alone, pass by pass in order, as `resolve` takes them. Over a deep picture those of its places; throws
  // MeaningError for what these cannot hold: rims apart, solids of other planes, shadows on the picture.
  //   each  takes them as they are made
  RunCounts accumulate(const Request& request, const std::function<void(PassPlanes&&)>& each);
  // Every fragment at pixel centres, in windows that together cover the data window.
  RunCounts listFragments(const Request& request, const ListSink& sink);
  // The opaque picture with the result's beauty in it, and its layers. Returns the notes.
  //   beside  attributes of the header besides attributes()
  std::vector<std::string> write(const std::string& path, const Result& result,
                                 const std::map<std::string, std::string>& beside = {}) const;

  // What the output's header says of how it was made.
  std::map<std::string, std::string> attributes(const Result& result) const;

  Journal& journal() { return journal_; }
  std::string device() const { return device_.description(); }

 private:
  struct Run;  // what a request's steps share
  // The shot, and of an earlier frame's work what still holds.
  void takeOver(const Request& request);
  const Lighting& lightOf(const Request& request);
  TransparentPass* triangles();
  // Of the picture's depth, for passes away from pixel centres; null for a deep picture, whose samples have no planes.
  //   area  of the passes, display coordinates
  const DepthPlanes* depthPlanes(const Plan& plan, const Window& area);
  void dropNormals(const DepthPlanes& known);
  // Null where the plan takes no edge apart.
  std::unique_ptr<EdgePasses> edgePasses(const Plan& plan, const Window& area);
  Run prepare(const Request& request);
  // By one method.
  //   holdTo  tolerance to measure the picture by; 0: none
  Result painted(const Request& request, double holdTo);
  Result cheapest(const Request& request, double tolerance);
  Choice probed(const Run& run, double tolerance);
  PassPlanes passPlanes(const Plan& sums, const PassSettings& sample, int pass, const Run& run,
                        const LitPicture& picture, const Request& request, RunCounts& counts);
  //   unseen  is given PassPicture::unseenShare(), or null
  Veil paint(const Plan& plan, const PassSettings& settings, const Run& run, Journal& journal, RunCounts& counts,
             Image<float>* unseen = nullptr);
  Window paintedArea(const Plan& plan, const Run& run) const;

  Journal journal_;
  std::shared_ptr<KeptWork> kept_;
  Device& device_;
  std::unique_ptr<Shot> shot_;
  mutable ShotFacts facts_;  // with the depths of the layers once a weight has asked
  mutable bool knowsDepths_ = false;
  std::unique_ptr<TransparentPass> triangles_;
  bool placed_ = true;  // false as long as an earlier frame's stand as that frame had them
  PictureDepth depth_;
  // The light of the last request; requests that differ in nothing that lights share it.
  std::unique_ptr<Lighting> lighting_;
  Request lit_;
  bool finished_ = false;  // the last picture or planes, so that the next frame may take over what made them
};

}  // namespace pellucid
