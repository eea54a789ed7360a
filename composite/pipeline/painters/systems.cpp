// A pass for each coarsely sorted system, the nearer veils over the farther ones: WB13 section 3.4. What layers show of
// the background, and solids, are those of the whole scene. Fog is cut where the systems stand.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "composite/fog.h"
#include "composite/list_order.h"
#include "composite/over.h"
#include "composite/pipeline/low_layers.h"
#include "composite/pipeline/painters/lists_painter.h"
#include "composite/pipeline/painters/system_canvas.h"
#include "composite/pipeline/sums.h"
#include "composite/pipeline/system_weights.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// Without what stands behind the nearest solid of any system, and without the solids.
FragmentLists inFrontOfSolids(const FragmentLists& lists, const OitPlanes& whole) {
  FragmentLists kept;
  kept.window = lists.window;
  kept.solid = Image<glm::vec4>(lists.window.width(), lists.window.height(), glm::vec4(0.0f, 0.0f, 0.0f, kNothing));
  kept.offsets.assign(1, 0);
  const int left = lists.window.x0 - whole.data.x0, top = lists.window.y0 - whole.data.y0;
  std::size_t pixel = 0;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x, ++pixel) {
      const float solid = whole.solid.at(left + x, top + y).a;
      for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
        if (lists.fragments[i].z <= solid) kept.fragments.push_back(lists.fragments[i]);
      kept.offsets.push_back(kept.fragments.size());
    }
  return kept;
}

void putOver(const Veil& nearer, Veil& veil) {
  for (std::size_t i = 0; i < veil.touched.size(); ++i) {
    if (!nearer.touched[i]) continue;
    veil.light[i] = nearer.light[i] + nearer.transmission[i] * veil.light[i];
    veil.transmission[i] *= nearer.transmission[i];
    veil.frontZ[i] = std::min(veil.frontZ[i], nearer.frontZ[i]);
    veil.touched[i] = 1;
  }
}

// Marks at the systems' depths: layers that are not there, between which fog runs are cut.
FragmentLists marksOf(const std::vector<LayerSystem>& systems, const OitPlanes& whole, const Window& window) {
  FragmentLists lists;
  lists.window = window;
  lists.solid = Image<glm::vec4>(window.width(), window.height());
  lists.offsets.assign(1, 0);
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      const glm::vec4 solid = whole.solid.at(x - whole.data.x0, y - whole.data.y0);
      lists.solid.at(x - window.x0, y - window.y0) = glm::vec4(0.0f, 0.0f, 0.0f, solid.a);
      for (const LayerSystem& system : systems) {
        Fragment mark{};
        mark.transmission = glm::vec3(1.0f);
        mark.z = static_cast<float>(std::max(system.z, 1e-6));
        lists.fragments.push_back(mark);
      }
      lists.offsets.push_back(lists.fragments.size());
    }
  return lists;
}

class SystemsPainter : public Painter {
 public:
  explicit SystemsPainter(const PaintContext& context)
      : context_(context),
        method_(context.plan.as<PaintSystems>()->method.value_or(*chooseMethod("weighted"))),
        wholePlan_(context.plan) {
    split(context.journal);
    checkSystemNames(*context.plan.as<PaintSystems>(), systems_);
    wholePlan_.paint = PaintSums{};
    wholePlan_.route =
        wholePlan_.isExact() || wholePlan_.deepFiles || !context.shot.hasScene ? Route::foldedSums : Route::drawnSums;
  }

  Veil paint(const PassSettings& sample, int pass) override {
    return context_.journal.time("passes of systems", [&] { return painted(sample, pass); });
  }

 private:
  void split(Journal& told) {
    systems_ = context_.journal.time("split systems", [&] {
      return splitSystems(context_.plan.as<PaintSystems>()->rule, context_.shot, context_.device, told);
    });
  }

  Veil painted(const PassSettings& sample, int pass) {
    if (context_.plan.layersMove()) {  // systems are copies of the scene as it stood, in the order that they had
      Journal unsaid;
      split(unsaid);
    }
    const GBuffer& gbuffer = *context_.picture.gbuffer;
    RunCounts counts;
    const PaintContext whole{wholePlan_,       context_.shot, context_.picture, context_.sources, context_.device,
                             context_.journal, counts};
    PassSettings bare = sample;
    bare.fog = nullptr;  // it does not hide all
    OitPlanes planes = sumsOf(whole, bare);
    if (sample.fog) addFogScattering(*sample.fog, gbuffer, sample.sample, planes);
    const DeepOpaque* deep = context_.picture.deepOpaque;
    SystemCanvas canvas(context_.picture);
    Veil veil = canvas.empty();
    if (sample.fog) fog_ = withFog(*sample.fog, gbuffer, sample.sample, marksOf(systems_, planes, gbuffer.data), deep);
    addFogRun(sample, static_cast<double>(kNothing), systems_.empty() ? 0.0 : systems_[0].z, canvas, veil);
    for (std::size_t k = 0; k < systems_.size(); ++k) {
      Veil own = canvas.empty();
      mixSystem(systems_[k], bare, pass, planes, canvas, own, counts);
      putOver(own, veil);
      addFogRun(sample, systems_[k].z, k + 1 < systems_.size() ? systems_[k + 1].z : 0.0, canvas, veil);
    }
    canvas.addSolids(planes, veil);
    veil = canvas.finish(planes, context_.plan.lookup, std::move(veil));
    const int passes = counts.passes;
    PassStatistics statistics;
    if (context_.sources.triangles()) statistics = context_.sources.triangles()->statistics();
    context_.counts.add(statistics);
    context_.counts.passes = passes;
    return veil;
  }

  void mixSystem(const LayerSystem& system, const PassSettings& shared, int pass, const OitPlanes& whole,
                 SystemCanvas& canvas, Veil& own, RunCounts& counts) {
    PassSettings sample = shared;
    if (const SystemWeight* weight = weightOf(*context_.plan.as<PaintSystems>(), system))
      sample.weight = *weight->weight;
    if (system.pass) system.pass->over(*context_.picture.gbuffer, context_.shot.camera);
    LayerSources sources(system.pass.get());
    if (system.deep) sources.join(deepFiles({system.deep, 1}));
    const PaintContext part{context_.plan,    context_.shot, context_.picture, sources, context_.device,
                            context_.journal, counts};
    std::optional<LowResolutionFragments> low;
    if (context_.plan.lowResolution > 1 && system.pass) {
      PassStatistics statistics;
      TexelMixer mixer(method_);
      low.emplace(lowLayersOf(part, sample, pass, mixer, statistics));
      counts.passes += statistics.passes;
    }
    const PassSettings listed = fullResolutionPart(context_.plan, sample);
    const MethodChoice choice{0, sample.weight, sample.normalisation};
    sources.each({listed, context_.picture, VolumeRule::midDepth}, [&](const FragmentLists& lists) {
      FragmentLists shown = inFrontOfSolids(low ? low->among(lists) : lists, whole);
      if (context_.plan.isExact()) orderByDepthAndBits(shown);
      canvas.mix(
          shown,
          [&](const FragmentLists& layers, const Window& window, Veil& veil) {
            compositeBy(method_, choice, layers, window, veil);
          },
          own);
    });
    if (system.pass) counts.passes += system.pass->statistics().passes;
  }

  // The fog between two depths, over what is there.
  void addFogRun(const PassSettings& sample, double farther, double nearer, SystemCanvas& canvas, Veil& veil) const {
    if (!sample.fog) return;
    FragmentLists between;
    between.window = fog_.window;
    between.offsets.assign(1, 0);
    between.solid = Image<glm::vec4>(fog_.window.width(), fog_.window.height(), glm::vec4(0.0f, 0.0f, 0.0f, kNothing));
    for (std::size_t pixel = 0; pixel + 1 < fog_.offsets.size(); ++pixel) {
      for (std::uint64_t i = fog_.offsets[pixel]; i < fog_.offsets[pixel + 1]; ++i) {
        const Fragment& run = fog_.fragments[i];
        const auto z = static_cast<double>(run.z);
        if (run.coverage > 0.0f && z > nearer && z < farther) between.fragments.push_back(run);
      }
      between.offsets.push_back(between.fragments.size());
    }
    Veil own = canvas.empty();
    canvas.mix(
        between,
        [](const FragmentLists& runs, const Window& window, Veil& mixed) { compositeSorted(runs, window, mixed); },
        own);
    putOver(own, veil);
  }

  // Texels of a system that is drawn at low resolution, by the method of its layers.
  class TexelMixer : public Mixer {
   public:
    explicit TexelMixer(const ChosenMethod& method) : method_(method) {}
    void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
      compositeBy(method_, {0, mixed.sample.weight, mixed.sample.normalisation}, lists, mixed.data, veil);
    }
    void mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override { mix(mixed, lists, veil); }

   private:
    const ChosenMethod& method_;
  };

  PaintContext context_;
  ChosenMethod method_;
  Plan wholePlan_;
  std::vector<LayerSystem> systems_;
  FragmentLists fog_;  // of one pass: runs cut at the systems' depths
};

}  // namespace

std::unique_ptr<Painter> systemsPainter(const PaintContext& context) {
  return std::make_unique<SystemsPainter>(context);
}

}  // namespace pellucid
