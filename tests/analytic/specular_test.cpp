// KHR_materials_specular: what the interface of a dielectric reflects, against values worked out by hand.
#include <gtest/gtest.h>

#include "shaders/shading.h"

namespace pellucid {
namespace {

using namespace shading;

Surface glassWith(glm::vec4 specular, float ior = 1.5f) {
  MaterialPoint point{};
  point.base = glm::vec4(1.0f);
  point.transmission = 1.0f;
  point.ior = ior;
  point.specular = specular;
  return surfaceOf(point, 1.0f, glm::vec3(1.0f), false);
}

TEST(Specular, ItsDefaultsAreTheExactTerm) {
  for (const float cosine : {1.0f, 0.7f, 0.2f, 0.01f})
    EXPECT_EQ(dielectricReflectance(glassWith(glm::vec4(1.0f)), cosine), glm::vec3(fresnelDielectric(cosine, 1.5f)));
}

TEST(Specular, HeadOnItIsTintedAndAtTheHorizonWhite) {
  const Surface tinted = glassWith({0.5f, 1.0f, 2.0f, 0.8f});
  const glm::vec3 headOn = dielectricReflectance(tinted, 1.0f);
  // F0 of 1.5 is .04.
  EXPECT_LT(glm::length(headOn - 0.8f * glm::vec3(0.02f, 0.04f, 0.08f)), 1e-6f);
  EXPECT_LT(glm::length(dielectricReflectance(tinted, 0.0f) - glm::vec3(0.8f)), 1e-6f);
  // Half way up the exact term, half way up this one.
  const float cosine = 0.3f, rise = (fresnelDielectric(cosine, 1.5f) - 0.04f) / 0.96f;
  EXPECT_NEAR(dielectricReflectance(tinted, cosine).r, 0.8f * (0.02f + 0.98f * rise), 1e-6f);
}

TEST(Specular, WithoutStrengthAllLightEnters) {
  const Surface matte = glassWith({1.0f, 1.0f, 1.0f, 0.0f});
  EXPECT_EQ(dielectricReflectance(matte, 0.1f), glm::vec3(0.0f));
  EXPECT_EQ(transmissionAt(matte, 0.1f), glm::vec3(1.0f));
}

// One number is lost for all channels, the largest: a tinted reflection does not tint what passes.
TEST(Specular, WhatPassesIsNotTinted) {
  const glm::vec3 through = transmissionAt(glassWith({0.0f, 0.0f, 1.0f, 1.0f}), 1.0f);
  EXPECT_EQ(through.r, through.b);
  EXPECT_NEAR(through.r, 0.96f, 1e-6f);
}

TEST(Specular, AnIndexOfOneReflectsNothing) {
  EXPECT_EQ(dielectricReflectance(glassWith({3.0f, 2.0f, 1.0f, 1.0f}, 1.0f), 0.1f), glm::vec3(0.0f));
}

}  // namespace
}  // namespace pellucid
