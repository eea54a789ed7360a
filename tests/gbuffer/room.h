// A room as a renderer sees it: a floor, a back wall and a slanted board, planar depth in closed form, and its camera
// as EXR states it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "exr_files.h"
#include "gbuffer/camera.h"

namespace pellucid::test {

constexpr float kBehind = 0.5f;  // colour of the room, in every channel

struct Room {
  static constexpr int kWidth = 96, kHeight = 64;
  Camera camera;
  std::vector<double> z, ray;  // planar depth, and distance over planar depth; row by row

  //   aside  the camera is turned, so that no plane faces it
  explicit Room(bool aside = true, double focal = 1.2) {
    camera.focal = {focal, focal * kWidth / kHeight};
    const double turn = aside ? 0.3 : 0.0;
    planes[0] = {std::sin(turn), 0, std::cos(turn), 6};
    for (std::size_t i = 0; i < std::size_t{kWidth} * kHeight; ++i) {
      const auto [a, b] = planeAt(i);
      double nearest = INFINITY;
      for (const auto& p : planes) {
        const double along = p[0] * a + p[1] * b + p[2];
        if (along > 1e-6) nearest = std::min(nearest, p[3] / along);
      }
      z.push_back(nearest);
      ray.push_back(std::sqrt(1 + a * a + b * b));
    }
  }
  // n . (a, b, 1) z = d of each plane, before the eye; the nearest is seen.
  std::array<std::array<double, 4>, 3> planes{{{}, {0, -1, 0, 1.2}, {0.6, 0.2, 0.8, 5.5}}};
  // Where a pixel's ray meets the plane one metre away: right and up.
  std::array<double, 2> planeAt(std::size_t pixel) const {
    return {((static_cast<double>(pixel % kWidth) + 0.5) / kWidth * 2 - 1) / camera.focal.x,
            (1 - (static_cast<double>(pixel / kWidth) + 0.5) / kHeight * 2) / camera.focal.y};
  }
  // A slanted floor and a slanted board as an orthographic camera sees them: planar depth is linear on each, and rays
  // are as long.
  static Room orthographic() {
    Room room;
    room.camera.orthographic = true;
    room.camera.focal = {0.25, 0.25 * kWidth / kHeight};  // eight metres wide
    for (std::size_t i = 0; i < room.z.size(); ++i) {
      const auto [a, b] = room.planeAt(i);
      room.z[i] = std::min(6 + 0.75 * b, 5.5 - 0.75 * a - 0.25 * b);
      room.ray[i] = 1;
    }
    return room;
  }
  template <class F>
  std::vector<float> depth(F of) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < z.size(); ++i) values.push_back(static_cast<float>(of(z[i], ray[i])));
    return values;
  }
  // Colour, and the camera's attributes when wanted.
  Part part(bool withCamera, const std::string& layer = "") const {
    Part made;
    made.display = made.data = {0, 0, kWidth, kHeight};
    for (const char* name : {"R", "G", "B"})
      made.planes.push_back(constantPlane(layer + name, exr::HALF, kBehind, z.size()));
    if (withCamera) {
      float matrices[2][4][4];
      cameraToExr(camera, matrices[0], matrices[1]);
      made.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
      made.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
    }
    return made;
  }
};

}  // namespace pellucid::test
