#include "composite/cli/foliage_flags.h"

#include "composite/cli/number_checks.h"

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
                   ->check(isNumber())
                   ->capture_default_str();
  details[3] = verb.add_option("--occlusion-source", source,
                               "Occlusion of the picture itself: its AO channel where it has one, or from its depth")
                   ->check(CLI::IsMember({"auto", "screen"}))
                   ->capture_default_str();
  details[2] = verb.add_option("--occlusion-radius", radius,
                               "Metres within which things occlude, where occlusion comes from depth; a tenth of the "
                               "depth without it")
                   ->check(aboveZero());
}

void FoliageFlags::into(Request& request) const {
  FoliageRequest& asked = request.foliage;
  asked.rule = occlusion == "off"     ? FoliageRule::off
               : occlusion == "solid" ? FoliageRule::solid
               : occlusion == "apart" ? FoliageRule::apart
                                      : FoliageRule::inferred;
  const auto given = [&](int i) { return details[i] && details[i]->count() > 0; };
  if (given(0))
    asked.form = inference == "published" ? shading::PLD_OCCLUSION_PUBLISHED : shading::PLD_OCCLUSION_RELATIVE;
  if (given(1)) asked.directShare = direct;
  if (given(2)) asked.radius = radius;
  if (given(3)) asked.fromFile = source == "auto";
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
               ->check(aboveZero())};
}

RimRequest RimFlags::request() const {
  RimRequest request;
  if (given[0]->count() > 0) request.infer = occlusion == "inferred";
  if (given[1]->count() > 0)
    request.form = inference == "published" ? shading::PLD_OCCLUSION_PUBLISHED : shading::PLD_OCCLUSION_RELATIVE;
  if (given[2]->count() > 0) request.fromFile = source == "auto";
  if (given[3]->count() > 0) request.radius = radius;
  return request;
}

}  // namespace pellucid::cli
