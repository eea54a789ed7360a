#include "composite/cli/foliage_flags.h"

#include "composite/occluders.h"
#include "composite/rims.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {

void FoliageFlags::addTo(CLI::App& verb, bool keepsApart) {
  std::string help =
      "Ambient occlusion of alpha-tested leaves: inferred for their rims, of their solid insides alone, off";
  std::vector<std::string> choices{"inferred", "solid", "off"};
  if (keepsApart) {
    help += ", or apart: planes of what rims get from around, for resolve to darken";
    choices.emplace_back("apart");
  }
  verb.add_option("--occlusion", occlusion, help)->check(CLI::IsMember(choices))->capture_default_str();
  details[0] = verb.add_option("--occlusion-inference", inference, "published is PT17 listing 2 as printed")
                   ->check(CLI::IsMember({"relative", "published"}))
                   ->capture_default_str();
  details[1] = verb.add_option("--occlusion-direct", direct, "How much of the occlusion darkens direct light too")
                   ->check(CLI::Range(0.0, 1.0))
                   ->capture_default_str();
  details[3] = verb.add_option("--occlusion-source", source,
                               "Occlusion of the picture itself: its AO channel where it has one, or from its depth")
                   ->check(CLI::IsMember({"auto", "screen"}))
                   ->capture_default_str();
  details[2] = verb.add_option("--occlusion-radius", radius,
                               "Metres within which things occlude, where occlusion comes from depth; a tenth of the "
                               "depth without it")
                   ->check(CLI::PositiveNumber);
}

void FoliageFlags::applyTo(PassSettings& settings, TransparentPass* pass, const GBuffer& gbuffer, const Camera& camera,
                           Stages& stages) const {
  if (occlusion == "off") {
    for (const CLI::Option* option : details)
      if (option && option->count() > 0)
        throw UsageError(option->get_name() + ": found it with --occlusion off, expected inferred or solid");
    return;
  }
  if (occlusion == "solid" && details[0] && details[0]->count() > 0)
    throw UsageError("--occlusion-inference: found it with --occlusion solid, expected inferred");
  if (isApart() && details[0] && details[0]->count() > 0)
    throw UsageError("--occlusion-inference: found it with --occlusion apart, expected it of resolve");
  settings.occlusion.rims = occlusion == "inferred";
  settings.occlusion.form =
      inference == "published" ? shading::PLD_OCCLUSION_PUBLISHED : shading::PLD_OCCLUSION_RELATIVE;
  settings.occlusion.directShare = static_cast<float>(direct);
  if (!pass || !pass->wantsOccluders(settings)) return;
  const Image<float> solidZ = stages.time("depth of leaves", [&] { return pass->solidDepth(settings); });
  OccluderSettings how;
  how.fromFile = source == "auto";
  how.screen.radius = radius;
  std::size_t pixels = 0;
  settings.occlusion.occluders = stages.time("occlusion of leaves", [&] {
    return std::make_shared<OccluderPlanes>(
        occludersOf(gbuffer, camera, nearestSolids(gbuffer, solidZ), how, nullptr, pixels));
  });
  if (pixels > 0)
    spdlog::info("leaves: occlusion of {} pixels from depth alone{}", pixels,
                 gbuffer.occlusion.empty() || !how.fromFile ? "" : ", where leaves stand that the picture lacks");
}

void RimFlags::addTo(CLI::App& verb) {
  given = {verb.add_option("--occlusion", occlusion, "Of rims that the planes carry apart: inferred, or off")
               ->check(CLI::IsMember({"inferred", "off"}))
               ->capture_default_str(),
           verb.add_option("--occlusion-inference", inference, "published is PT17 listing 2 as printed")
               ->check(CLI::IsMember({"relative", "published"}))
               ->capture_default_str(),
           verb.add_option("--occlusion-source", source,
                           "Occlusion of the picture itself: its AO channel where it has one, or from its depth")
               ->check(CLI::IsMember({"auto", "screen"}))
               ->capture_default_str(),
           verb.add_option("--occlusion-radius", radius,
                           "Metres within which things occlude, where occlusion comes from depth; a tenth of the depth "
                           "without it")
               ->check(CLI::PositiveNumber)};
}

void RimFlags::applyTo(const RimPlanes& rims, const GBuffer& gbuffer, OitPlanes& planes) const {
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i]->count() == 0) continue;
    if (rims.empty())
      throw UsageError(given[i]->get_name() +
                       ": the planes carry no rims apart, expected those of accumulate --occlusion apart");
    if (i > 0 && occlusion == "off")
      throw UsageError(given[i]->get_name() + ": found it with --occlusion off, expected inferred");
  }
  if (rims.empty() || occlusion == "off") return;
  Image<float> solidZ(planes.solid.width(), planes.solid.height());
  for (std::size_t i = 0; i < solidZ.size(); ++i) solidZ[i] = planes.solid[i].a;
  OccluderSettings how;
  how.fromFile = source == "auto";
  how.screen.radius = radius;
  std::size_t pixels = 0;
  const OccluderPlanes occluders =
      occludersOf(gbuffer, planes.camera, nearestSolids(gbuffer, solidZ), how, nullptr, pixels);
  const std::size_t found = occludeRims(
      rims, occluders, inference == "published" ? shading::PLD_OCCLUSION_PUBLISHED : shading::PLD_OCCLUSION_RELATIVE,
      planes);
  spdlog::info("leaves: rims of {} pixels occluded{}", found,
               pixels > 0 ? fmt::format(", by the occlusion of {} pixels from depth alone", pixels) : "");
}

}  // namespace pellucid::cli
