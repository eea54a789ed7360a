// The shaders of shaders/gl as text for GLSL 3.30 to 4.60, for the library's own programs and for the host's.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/pass_permutation.h"

namespace pellucid::c {

struct SamplerUnit {
  std::string name;
  int unit;
};

struct OwnText {
  std::string text;  // with its #version line
  std::vector<SamplerUnit> samplers;
};

// A stage of the library's own.
OwnText ownText(const std::string& file, const std::vector<std::string>& defines, int version);

// Where a host's program finds what the library binds, or has it bind.
struct SeamPlaces {
  int uniformBinding, firstUnit, firstStorage = 0;
};

// What shaders/gl/exact_lists.glsl looks for: its blocks at storage bindings `first` and after.
constexpr int kListBlocks = 5;
std::vector<std::string> storageDefines(int first);

// Texts for hosts, without a #version line. Names that the host does not call begin with pld_, so that they meet none
// of its own; a shader may hold several of the texts.
//   version  of GLSL, 330 to 460; below 420 units and binding are left to pld_connect()
// What validation knows a text by: the name of a number in its block, which no other stage or permutation has. The same
// for every version and place.
std::string seamMark(const Permutation& permutation, pld_stage stage);
const char* casterMark(bool coloured);
// Textures that seams read, in the order of their units.
constexpr const char* kSeamSamplers[] = {"pldOpaqueZ", "pldSolid", "pldFrontZ", "pldOpaqueOpen"};
std::string seamText(const Permutation& permutation, pld_stage stage, int version, const SeamPlaces& places);
std::string casterText(bool coloured, int version, const SeamPlaces& places);

// How shadow maps lie.
struct ShadowShape {
  int lights, faces, edge, channels;  // edge: texels as looked up
};
std::string shadowText(const ShadowShape& shape, int version, const SeamPlaces& places);

}  // namespace pellucid::c
