#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/fog_flags.h"
#include "composite/cli/foliage_flags.h"
#include "composite/cli/lists.h"
#include "composite/cli/results.h"
#include "composite/cli/shot.h"
#include "composite/cli/verbs.h"
#include "composite/deep/channels.h"
#include "gbuffer/deep_io.h"

namespace pellucid::cli {
namespace {

struct FragmentsFlags {
  std::string opaque, output;
  std::vector<std::string> scenes;
  ReadFlags read;
  SceneFlags scene;
  FoliageFlags foliage;
  FogFlags fog;
  ParticleFlags particles;
  RunFlags run;
};

// Lists come in windows that need not be as wide as the picture; a deep file wants whole rows. Keeps windows until the
// rows they begin are whole.
class RowGatherer {
 public:
  RowGatherer(const Window& data, double metresPerUnit, DeepWriter& writer)
      : data_(data), unitsPerMetre_(1.0 / metresPerUnit), writer_(writer), next_(data.y0) {}

  void add(const FragmentLists& lists) {
    held_.push_back(lists);
    int ready = next_;
    while (ready < data_.y1 && covered(ready)) ++ready;
    if (ready > next_) {
      write(next_, ready);
      next_ = ready;
      std::erase_if(held_, [&](const FragmentLists& each) { return each.window.y1 <= next_; });
    }
  }

 private:
  bool covered(int y) const {
    int width = 0;
    for (const FragmentLists& lists : held_)
      if (y >= lists.window.y0 && y < lists.window.y1) width += lists.window.width();
    return width == data_.width();
  }

  void put(DeepRows& rows, const Fragment& fragment) const {
    auto values = recordValues(fragment);
    for (const std::size_t z : {std::size_t{7}, std::size_t{8}})
      values[z] = static_cast<float>(static_cast<double>(values[z]) * unitsPerMetre_);
    for (std::size_t c = 0; c < values.size(); ++c) rows.channels[c].push_back(values[c]);
  }

  void write(int y0, int y1) {
    DeepRows rows;
    rows.window = {data_.x0, y0, data_.x1, y1};
    rows.channels.resize(recordChannels().size());
    rows.offsets.assign(1, 0);
    std::vector<const FragmentLists*> across;
    std::vector<const Fragment*> sorted;
    for (int y = y0; y < y1; ++y) {
      across.clear();
      for (const FragmentLists& lists : held_)
        if (y >= lists.window.y0 && y < lists.window.y1) across.push_back(&lists);
      std::sort(across.begin(), across.end(),
                [](const FragmentLists* a, const FragmentLists* b) { return a->window.x0 < b->window.x0; });
      for (const FragmentLists* lists : across)
        for (int x = lists->window.x0; x < lists->window.x1; ++x) {
          const glm::vec4 solid = lists->solid.at(x - lists->window.x0, y - lists->window.y0);
          const auto pixel =
              static_cast<std::size_t>(y - lists->window.y0) * static_cast<std::size_t>(lists->window.width()) +
              static_cast<std::size_t>(x - lists->window.x0);
          sorted.clear();
          for (std::uint64_t i = lists->offsets[pixel]; i < lists->offsets[pixel + 1]; ++i) {
            const Fragment& fragment = lists->fragments[i];
            if (fragment.z <= solid.a && !shading::isSolid(fragment.coverage, fragment.transmission))
              sorted.push_back(&fragment);
          }
          // Sorted, so that other tools that never sort read them right, and the file does not depend on the order.
          std::sort(sorted.begin(), sorted.end(), [](const Fragment* a, const Fragment* b) {
            return a->z != b->z ? a->z < b->z : a->identity < b->identity;
          });
          for (const Fragment* fragment : sorted) put(rows, *fragment);
          if (std::isfinite(solid.a)) {
            Fragment opaque{};
            opaque.radiance = glm::vec3(solid);
            opaque.coverage = 1.0f;
            opaque.z = solid.a;
            put(rows, opaque);
          }
          rows.offsets.push_back(rows.channels[0].size());
        }
    }
    writer_.write(rows);
  }

  Window data_;
  double unitsPerMetre_;
  DeepWriter& writer_;
  int next_;
  std::vector<FragmentLists> held_;
};

void fragmentsVerb(const FragmentsFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const auto shot = loadShot(flags.opaque, flags.scenes, flags.read, flags.scene, stages);
  const GBuffer& gbuffer = shot->opaque.gbuffer;
  PassSettings settings;
  settings.surroundings = shot->surroundings;
  settings.environment = shot->environment;
  flags.scene.applyTo(settings);
  Air air(*shot, nullptr, flags.scenes, flags.scene.options(flags.read.unit, true));
  settings.fog = flags.fog.place(*shot, air, flags.read.unit, "", stages);
  settings.particleLight = flags.particles.place(*shot, air, stages);

  DeepHeader header;
  header.display = gbuffer.display;
  header.data = gbuffer.data;
  header.pixelAspect = gbuffer.pixelAspect;
  header.channels = recordChannels();
  header.attributes = {{"pellucid:note", "oit.* are not premultiplied: do not composite them"}};
  if (shot->hasScene) header.camera = &shot->camera;
  std::unique_ptr<GlContext> context;
  std::unique_ptr<TransparentPass> pass;
  if (shot->hasScene) {
    context = std::make_unique<GlContext>(flags.scene.device);
    pass = std::make_unique<TransparentPass>(*context, shot->scene, gbuffer, shot->camera);
  }
  flags.foliage.applyTo(settings, pass.get(), gbuffer, shot->camera, stages);
  RenderCounts counts;
  stages.time("lists and write", [&] {
    DeepWriter writer(flags.output, header);
    RowGatherer rows(gbuffer.data, flags.read.unit, writer);
    eachList(pass.get(), shot->deep, gbuffer, settings, VolumeRule::split, [&](const FragmentLists& lists) {
      counts.fragments += lists.fragments.size();
      rows.add(lists);
    });
    writer.finish();
  });
  for (const auto& source : shot->deep) say(source->notes());
  nlohmann::json report{{"output", flags.output}, {"fragments", counts.fragments}};
  reportRun(flags.run, stages, counts, context ? context->description() : "CPU", report);
}

}  // namespace

void addFragments(CLI::App& app) {
  auto flags = std::make_shared<FragmentsFlags>();
  CLI::App* verb = app.add_subcommand("fragments", "The exact fragment lists at pixel centres, as a deep EXR");
  verb->add_option("opaque", flags->opaque, "EXR with beauty and depth")->required();
  verb->add_option("scenes", flags->scenes, "glTF, GLB or deep EXR with the transparent things")->required();
  verb->add_option("-o,--output", flags->output, "Deep EXR to write")->required();
  flags->read.addTo(*verb);
  flags->scene.addTo(*verb);
  flags->foliage.addTo(*verb);
  flags->fog.addTo(*verb);
  flags->particles.addTo(*verb);
  flags->run.addTo(*verb);
  verb->callback([flags] { fragmentsVerb(*flags); });
}

}  // namespace pellucid::cli
