// Colour spaces by OpenColorIO's configs: the only code that knows the library.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "gbuffer/colour_space.h"

namespace pellucid {

class ColourConfig {
 public:
  // The spaces of namedSpaces(), and what shows them, without a file.
  static ColourConfig builtIn();
  // Throws InputError for a file that is missing or no valid config, and for one that names files elsewhere.
  //   by         who names it, for messages: "--ocio", "$OCIO"
  //   assetRoot  a folder whose files it may name besides those under its own; "" for none
  static ColourConfig read(const std::string& path, const std::string& by, const std::string& assetRoot = "");
  ~ColourConfig();
  ColourConfig(ColourConfig&&) noexcept;
  ColourConfig& operator=(ColourConfig&&) noexcept;

  // A space by its name, a role or an alias. Throws UsageError for an unknown one and for one that light does not add
  // up in, MeaningError where the config does not tell how its spaces stand to others.
  ColourSpace space(const std::string& name) const;
  // What the config's file rules say of a file: by a rule of its own, or by the one for all others. Nothing where that
  // is a space of no linear light.
  std::optional<ColourSpace> spaceOfFile(const std::string& file) const;

  struct Impl;
  const Impl& library() const { return *impl_; }

 private:
  explicit ColourConfig(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
