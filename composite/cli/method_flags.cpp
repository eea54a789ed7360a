#include "composite/cli/method_flags.h"

#include <fmt/format.h>

#include "composite/cli/number_checks.h"
#include "composite/cli/options.h"
#include "gbuffer/errors.h"
#include "gbuffer/tiers.h"
#include "gbuffer/weight_text.h"

namespace pellucid::cli {
namespace {

constexpr const char* kAuto = "auto";

std::vector<GivenFlag> givenFlags(const CLI::App& verb) {
  std::vector<GivenFlag> given;
  for (const CLI::Option* option : verb.get_options())
    if (option->count() > 0 && !option->get_lnames().empty())
      given.push_back({"--" + option->get_lnames()[0], option->results().empty() ? "" : option->results()[0]});
  return given;
}

}  // namespace

void MethodFlags::addTo(CLI::App& verb, bool listsToo, UsualMethod usual) {
  usual_ = usual;
  verb_ = &verb;
  method = usual == UsualMethod::truth ? "over" : "phenomenological";
  const bool takesAuto = usual == UsualMethod::truth;
  const std::string names =
      (listsToo ? allMethodNames() : sumMethodNames()) +
      (takesAuto ? ", or auto: with --tolerance, the cheapest of over and phenomenological that keeps it on this shot"
                 : "");
  methodOption_ = verb.add_option("--method", method, names)
                      ->check([listsToo, takesAuto, names](const std::string& text) -> std::string {
                        if (takesAuto && text == kAuto) return "";
                        const Method* row = methodNamed(text);
                        if (row && (listsToo || row->isSum)) return "";
                        return fmt::format("found '{}', expected {}", text, names);
                      })
                      ->capture_default_str();
  if (takesAuto)
    verb.add_option("--method-from", methodFrom,
                    "Picture whose method and weight to take: what --method auto has found, for the next frame");
  std::vector<std::string> tiers;
  std::string promises;
  for (const PrecisionTier& row : kTiers) {
    tiers.emplace_back(row.name);
    promises += fmt::format("{}{}: {}", promises.empty() ? "" : "; ", row.name, row.promise);
  }
  verb.add_option("--precision", precision, promises)->check(CLI::IsMember(tiers))->capture_default_str();
  addWeightTo(verb, true);
}

void MethodFlags::addWeightTo(CLI::App& verb, bool takesAuto) {
  normalisationOption_ =
      verb.add_option("--normalisation", normalisation,
                      "What the weighted mean of the layers is divided by: per channel, or one number as published")
          ->check(CLI::IsMember({"spectral", "published"}))
          ->capture_default_str();
  weightOption_ =
      verb.add_option("--weight", weight,
                      weightNames() + (takesAuto ? ", or auto: fitted to the truth on probe pixels. auto, for "
                                                   "phenomenological and weighted sums of a whole shot; eq5 beside "
                                                   "--weight-range, --precision published and in other methods"
                                                 : ""))
          ->default_str(takesAuto ? "auto" : weight);
  verb.add_option("--weight-range", weightRange, "NEAR:FAR in metres, for " + rangedWeights());
  verb.add_option(
          "--weight-reference", weightReference,
          "Metres: where power:K and fig6 weigh 1, which shows in no picture (where the scene begins); the unit "
          "of the papers' constants in " +
              referenceWeights())
      ->check(aboveZero());
  verb.add_option("--weight-from", weightFrom,
                  "Picture or planes whose weight, range and reference to take: one for a sequence, for sums that add");
}

Tier tierOf(const std::string& precision) {
  return tierNamed(precision).value_or(Tier::float32);
}

void MethodFlags::into(Request& request) const {
  request.method = method;
  request.methodFrom = methodFrom;
  if (!methodFrom.empty()) {
    for (const char* flag : {"--method", "--weight", "--weight-range", "--weight-reference", "--weight-from",
                             "--tolerance", "--systems", "--system-weight"})
      if (const CLI::Option* option = verb_->get_option_no_throw(flag); option && option->count() > 0)
        throw UsageError(
            fmt::format("--method-from: found a file with {}, expected one or the other: the file says both", flag));
  } else if (methodOption_ && methodOption_->count() == 0 && usual_ == UsualMethod::truth) {
    request.decided = decideMethod(givenFlags(*verb_));
    request.method = request.decided->method;
  } else if (!methodOption_) {
    request.method = "phenomenological";  // of verbs that compare methods, or list what all of them composite
  }
  request.tier = tierOf(precision);
  if (request.method == "over")
    request.paint = PaintSorted{};
  else if (request.method == kAuto)
    request.paint = PaintCheapest{};
  else if (const std::optional<ChosenMethod> chosen = chooseMethod(request.method))
    request.paint = PaintListed{*chosen};
  else
    request.paint = PaintSums{};
  if (weight == "auto")
    request.sums.fitWeight = true;
  else if (weightOption_ && weightOption_->count() > 0)
    request.sums.weight = parseWeight(weight, PassSettings().weight);
  if (!weightRange.empty()) request.sums.weightRange = parseRange(weightRange, "--weight-range");
  request.sums.weightReference = weightReference;
  request.sums.weightFrom = weightFrom;
  if (normalisationOption_ && normalisationOption_->count() > 0)
    request.sums.normalisation =
        normalisation == "published" ? shading::PLD_NORMALISE_PUBLISHED : shading::PLD_NORMALISE_SPECTRAL;
}

}  // namespace pellucid::cli
