// The resolve step on the CPU or the device, as a veil.
#pragma once
#include "composite/resolve.h"
#include "engine_bridge/gl/resolve_pass.h"

namespace pellucid {

// As resolveOver(); the CPU does it where `device` is null.
Veil resolveSums(ResolvePass* device, OitPlanes planes, const ResolveSettings& settings, const LookupSettings& lookup,
                 const GBuffer& background, const EdgeTexels* edges = nullptr);

}  // namespace pellucid
