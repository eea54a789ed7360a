// A wall at 6 m, a pane at 3 m, and fog that a user asks for; grids that tests write through OpenVDB.
#pragma once
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "gbuffer/opaque_io.h"
#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shots.h"

namespace pellucid::test {

class FogProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("fog-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    options.folder = folder;
    OpaqueShot shot;
    shot.depth = 6.0f;
    writeOpaque(folder + "/shot.exr", shot);
    writeGlb(folder + "/pane.glb", {Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, unlit(.2f, .4f, .6f, .5f)}});
  }
  Ended run(const std::vector<std::string>& extra, const std::string& verb = "composite") const {
    std::vector<std::string> arguments{verb, "shot.exr", "pane.glb", "-o", "out.exr", "--environment", "0.6,0.7,0.8"};
    const bool passes = std::find(extra.begin(), extra.end(), "--aa") != extra.end();
    if (verb == "composite" && !passes) arguments.insert(arguments.end(), {"--aa", "1"});
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return runProgram(arguments, options);
  }
  Image<glm::vec4> picture() const { return readOpaque(folder + "/out.exr", {}).gbuffer.beauty; }
  // A ball of smoke of radius 8 voxels about the origin, .1 m a voxel.
  void writeVdb(const std::string& name, const std::function<void(openvdb::FloatGrid&)>& change = {},
                const std::string& grid = "density") const {
    openvdb::initialize();
    openvdb::FloatGrid::Ptr made = fogGrid(grid, 0.1);
    openvdb::FloatGrid::Accessor values = made->getAccessor();
    for (int z = -8; z <= 8; ++z)
      for (int y = -8; y <= 8; ++y)
        for (int x = -8; x <= 8; ++x)
          if (x * x + y * y + z * z <= 64) values.setValue({x, y, z - 40}, 1.0f);
    if (change) change(*made);
    openvdb::io::File(folder + "/" + name).write({made});
  }
  //   voxel  metres
  static openvdb::FloatGrid::Ptr fogGrid(const std::string& name, double voxel) {
    openvdb::FloatGrid::Ptr made = openvdb::FloatGrid::create(0.0f);
    made->setName(name);
    made->setGridClass(openvdb::GRID_FOG_VOLUME);
    made->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    return made;
  }
  // An even grid from zNear to zFar before the eye, 4 m to each side of the axis, in voxels of a quarter of a metre.
  static openvdb::FloatGrid::Ptr evenGrid(const std::string& name, float value, int zNear, int zFar) {
    openvdb::FloatGrid::Ptr made = fogGrid(name, 0.25);
    made->transform().postTranslate(openvdb::Vec3d(0.125));
    made->fill(openvdb::CoordBBox({-16, -16, -4 * zFar}, {15, 15, -4 * zNear - 1}), value);
    return made;
  }
  void writeGrids(const std::string& name, const openvdb::GridCPtrVec& grids) const {
    openvdb::initialize();
    openvdb::io::File(folder + "/" + name).write(grids);
  }
  std::string folder;
  RunOptions options;
};

}  // namespace pellucid::test
