#include "layouts.h"

namespace pellucid::test {
namespace {

double planar(double z, double) {
  return z;
}
double along(double z, double ray) {
  return z * ray;
}
double inverse(double z, double) {
  return 1 / z;
}
double centimetres(double z, double) {
  return 100 * z;
}
double centimetresAlong(double z, double ray) {
  return 100 * z * ray;
}
double ramp(double z, double) {
  return z / 40;
}
double invertedRamp(double z, double) {
  return 1 - z / 40;
}
double negative(double z, double) {
  return -z;
}
double minusInverse(double z, double) {
  return -1 / z;
}

enum class Attributes { none, exr, pbrt };  // cameras in headers

// worldToCamera and worldToNDC, which pbrt stores transposed, with NDC that grow upwards.
void addCamera(const Room& room, Attributes form, Part& part) {
  if (form == Attributes::none) return;
  float matrices[2][4][4];
  cameraToExr(room.camera, matrices[0], matrices[1]);
  if (form == Attributes::pbrt) {
    for (auto& row : matrices[1]) row[1] = row[3] - row[1];
    for (auto& matrix : matrices)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) std::swap(matrix[i][j], matrix[j][i]);
  }
  part.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
  part.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
}

// A part in the making.
struct Making {
  const Room& room;
  Part part;

  explicit Making(const Room& seen, const std::string& name = "") : room(seen) {
    part.name = name;
    part.display = part.data = {0, 0, Room::kWidth, Room::kHeight};
  }
  Making& channels(const std::string& layer, const std::vector<const char*>& names, float value = 0.5f,
                   exr::PixelType type = exr::HALF) {
    for (const char* name : names) part.planes.push_back(constantPlane(layer + name, type, value, room.z.size()));
    return *this;
  }
  Making& colour(const std::string& layer = "", bool alpha = true) {
    channels(layer, {"R", "G", "B"}, kBehind);
    return alpha ? channels(layer, {"A"}, 1.0f) : *this;
  }
  Making& depth(const std::vector<std::string>& names, StoredDepth stored, exr::PixelType type = exr::FLOAT) {
    const std::vector<float> values = room.depth(stored);
    for (const std::string& name : names)
      part.planes.push_back(type == exr::HALF ? halfPlane(name, values) : floatPlane(name, values));
    return *this;
  }
  // Positions as the renderer sees them.
  //   inCamera  before its own camera, +z forward; else in the world, which is the camera's with z turned
  Making& positions(const std::string& layer, bool inCamera, exr::PixelType type = exr::FLOAT) {
    std::vector<float> xyz[3];
    for (std::size_t i = 0; i < room.z.size(); ++i) {
      const auto at = room.planeAt(i);
      xyz[0].push_back(static_cast<float>(at[0] * room.z[i]));
      xyz[1].push_back(static_cast<float>(at[1] * room.z[i]));
      xyz[2].push_back(static_cast<float>(inCamera ? room.z[i] : -room.z[i]));
    }
    for (int c = 0; c < 3; ++c) {
      const std::string name = layer + "." + "XYZ"[c];
      part.planes.push_back(type == exr::HALF ? halfPlane(name, xyz[c]) : floatPlane(name, xyz[c]));
    }
    return *this;
  }
  Making& text(const std::string& name, const std::string& value) {
    part.strings[name] = value;
    return *this;
  }
  Making& camera(Attributes form) {
    addCamera(room, form, part);
    return *this;
  }
};

std::vector<std::string> rgb(const std::string& layer) {
  return {layer + ".R", layer + ".G", layer + ".B"};
}

constexpr double kFloat = 2e-6, kHalf = 2e-3;

struct Rows {
  const Room& room;
  std::vector<Layout> rows = {};

  Making making(const std::string& name = "") const { return Making(room, name); }
  void add(const char* producer, const std::string& depth, const std::string& words, const std::string& decided,
           const std::vector<Part>& parts, const std::string& beauty = "R") {
    const bool half = words.find("half") != std::string::npos;
    rows.push_back({producer, depth, beauty, decided, half ? kHalf : kFloat, parts, words});
  }
  void add(const char* producer, const std::string& depth, const std::string& words, const std::string& decided,
           const Making& one, const std::string& beauty = "R") {
    add(producer, depth, words, decided, std::vector<Part>{one.part}, beauty);
  }
  // R, G, B, A and one depth, under one attribute of the header.
  void plain(const char* producer, const std::string& depth, bool half, StoredDepth stored, const char* attribute,
             const char* value, const std::string& decided, const std::string& more = "") {
    const std::vector<std::string> names =
        depth.ends_with(".R") ? rgb(depth.substr(0, depth.size() - 2)) : std::vector<std::string>{depth};
    add(producer, depth, (half ? "half" : "float") + (more.empty() ? "" : ", " + more), decided,
        making().colour().depth(names, stored, half ? exr::HALF : exr::FLOAT).text(attribute, value));
  }
};

void addBlender(Rows& all) {
  const auto viewLayer = [&] {
    Making made = all.making();
    return made.colour("ViewLayer.Combined.")
        .depth({"ViewLayer.Depth.Z"}, planar)
        .text("BlenderMultiChannel", "Blender V2.55.1 and newer");
  };
  all.add("blender", "ViewLayer.Depth.Z", "float", "planar", viewLayer(), "ViewLayer.Combined.R");
  all.add("blender", "ViewLayer.Depth.Z", "float, with its Composite, Cryptomatte and Mist", "planar",
          viewLayer()
              .colour("Composite.Combined.")
              .channels("ViewLayer.CryptoObject00.", {"r", "g", "b", "a"}, 0.3f, exr::FLOAT)
              .channels("ViewLayer.Mist.", {"Z"}, 0.3f, exr::FLOAT)
              .channels("ViewLayer.Normal.", {"X", "Y", "Z"}, 0.6f, exr::FLOAT)
              .depth({"ViewLayer.Denoising Depth.Z"}, along),
          "ViewLayer.Combined.R");
}

void addFilmRenderers(Rows& all) {
  all.add("arnold", "Z", "float, with camera, N and P", "planar",
          all.making()
              .colour()
              .colour("RGBA_key.")
              .depth({"Z"}, planar)
              .channels("N.", {"X", "Y", "Z"}, 0.6f, exr::FLOAT)
              .positions("P", false)
              .channels("crypto_object00.", {"R", "G", "B", "A"}, 0.3f, exr::FLOAT)
              .text("arnold/version", "7.2")
              .camera(Attributes::exr));
  all.add("renderman", "z", "float, in Ci, with camera", "planar",
          all.making().colour("Ci.", false).channels("", {"a"}, 1.0f).depth({"z"}, planar).camera(Attributes::exr),
          "Ci.R");
  all.plain("renderman", "Z", false, planar, "Software", "RenderMan 25", "planar");
  all.plain("vray", "VRayZDepth.R", false, planar, "vray/version", "6", "planar");
  all.plain("vray", "VRayZDepth.R", false, along, "vray/version", "6", "ray");
  all.plain("vray", "VRayZDepth.R", true, along, "vray/version", "6", "ray");
  all.plain("vray", "VRayZDepth.R", true, ramp, "Software", "V-Ray", "", "0 to 1");
  all.plain("vray", "VRayZDepth.R", true, invertedRamp, "Software", "V-Ray", "", "1 to 0");
  const auto husk = [&](StoredDepth stored) {
    Making made = all.making();
    return made.colour("C.").depth({"hitPz"}, stored).positions("hitP", false).text("husk:render_stats", "{}");
  };
  all.add("karma", "hitPz", "float, with hitP", "planar", husk(planar), "C.R");
  all.add("karma", "hitPz", "float, with hitP", "ray", husk(along), "C.R");
  all.add("mantra", "Z", "float, below 0", "negative",
          all.making().colour("C.").depth({"Z"}, negative).text("Software", "mantra 20"), "C.R");
  all.plain("mantra", "Pz", false, planar, "Software", "mantra 20", "planar");
  all.add("3delight", "z", "float, N in camera space", "ray",
          all.making().colour().depth({"z"}, along).channels("N.", {"X", "Y", "Z"}).text("Software", "3Delight"));
  all.plain("3delight", "z", false, planar, "Software", "3Delight", "planar");
  all.plain("redshift", "Z", true, planar, "rs/camera/nearPlane", "0.1", "planar");
  all.plain("redshift", "Z", false, along, "rs/camera/nearPlane", "0.1", "ray");
}

void addEngines(Rows& all) {
  const std::string depth = "FinalImageMovieRenderQueue_WorldDepth.";
  const std::vector<std::string> names = {depth + "R", depth + "G", depth + "B", depth + "A"};
  const auto queue = [&](StoredDepth stored, exr::PixelType type, const std::string& picture) {
    Making made = all.making();
    return made.colour(picture).depth(names, stored, type).text("unreal/version", "5.4");
  };
  all.add("unreal", names[0], "half, centimetres", "planar", queue(centimetres, exr::HALF, ""));
  all.add("unreal", names[0], "half, centimetres", "ray", queue(centimetresAlong, exr::HALF, ""));
  all.add("unreal", names[0], "float, centimetres, picture in a layer, masks", "planar",
          queue(centimetres, exr::FLOAT, "FinalImageMovieRenderQueue_FinalImage.")
              .channels("ActorHitProxyMask00.", {"R", "G", "B", "A"}, 0.3f, exr::FLOAT),
          "FinalImageMovieRenderQueue_FinalImage.R");
  all.plain("unity", "Depth.R", true, ramp, "Software", "Unity Recorder", "", "0 to 1");
  all.add("unity", "R", "half, in a part", "planar",
          {all.making("Beauty").colour().text("Software", "Unity Recorder").part,
           all.making("Depth").depth({"R", "G", "B"}, planar, exr::HALF).part});
}

void addResearchRenderers(Rows& all) {
  all.add("mitsuba", "dd.y.T", "float", "ray", all.making().colour("", false).depth({"dd.y.T"}, along));
  all.add("mitsuba", "depth.T", "half, picture twice", "ray",
          all.making()
              .colour("", false)
              .colour("image.", false)
              .depth({"depth.T"}, along, exr::HALF)
              .text("generatedBy", "Mitsuba version 3.5.0"));
  const auto film = [&](Attributes camera, bool inCamera) {
    Making made = all.making();
    return made.colour("", false)
        .positions("P", inCamera)
        .channels("Albedo.", {"R", "G", "B"})
        .channels("N.", {"X", "Y", "Z"})
        .channels("", {"u", "v"})
        .camera(camera);
  };
  all.add("pbrt", "P.Z", "float, with camera", "planar", film(Attributes::pbrt, true));
  all.add("pbrt", "P.Z", "float", "planar", film(Attributes::none, true));
  all.plain("appleseed", "Z", false, along, "appleseed:Version", "2.1", "ray");
  all.plain("luxcore", "DEPTH", false, planar, "Software", "LuxCoreRender", "planar");
  all.plain("luxcore", "DEPTH", false, along, "Software", "LuxCoreRender", "ray");
}

void addHosts(Rows& all) {
  all.plain("octane", "Z", true, ramp, "Software", "Octane", "", "0 to 1");
  all.plain("octane", "Z", false, planar, "Software", "Octane", "planar");
  all.plain("corona", "Z", false, planar, "Software", "Corona", "planar");
  all.plain("maya", "Z", false, negative, "Software", "Maya", "negative", "below 0");
  all.plain("maya", "Z", false, minusInverse, "Software", "Maya", "inverse:negative", "-1/z");
  all.plain("3dsmax", "Z", false, negative, "Software", "3ds Max", "negative", "below 0");
  const auto nuke = [&](StoredDepth stored) {
    Making picture = all.making("rgba");
    picture.channels("", {"red", "green", "blue"}, kBehind).channels("", {"alpha"}, 1.0f).text("nuke/version", "15.1");
    return std::vector<Part>{picture.part, all.making("depth").depth({"Z"}, stored).part};
  };
  all.plain("nuke", "depth.Z", false, inverse, "nuke/version", "15.1v3", "inverse");
  all.plain("nuke", "depth.Z", false, planar, "nuke/version", "15.1v3", "planar");
  all.plain("nuke", "depth.Z", false, along, "nuke/version", "15.1v3", "ray");
  all.add("nuke", "Z", "float, in a part", "inverse", nuke(inverse), "red");
  all.plain("natron", "depth.Z", false, inverse, "Software", "Natron", "inverse");
}

}  // namespace

std::vector<Layout> layoutsOf(const Room& room) {
  Rows all{room};
  addBlender(all);
  addFilmRenderers(all);
  addEngines(all);
  addResearchRenderers(all);
  addHosts(all);
  return all.rows;
}

}  // namespace pellucid::test
