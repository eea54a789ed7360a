// Whether a material can hide everything somewhere. The solid pass is skipped when none in the scene can.
#pragma once
#include "engine_bridge/gl/scene_textures.h"

namespace pellucid::gl {

// Never false where a fragment could have coverage 1 and transmission 0; may be true where none does.
//   colours         of the primitive's vertices
//   thicknessScale  largest, metres per unit of object space, over the primitive's instances
bool canBeSolid(const Material& material, const ColourRange& colours, const SceneTextures& textures,
                float thicknessScale);

// Whether a fragment's light could be added rather than averaged: only then is there anything to write to plane E.
bool canBeAdditive(const Material& material);

// Whether a layer of it may let one channel through more than another: never false where one does.
bool canTransmitColour(const Material& material, bool vertexColours);

}  // namespace pellucid::gl
