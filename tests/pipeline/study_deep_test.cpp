// `study` over a deep picture: every method as `composite --measure` has it, without a word that is not its own
// (./dev test --sanitize).
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/pipeline/shot_files.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

constexpr const char* kMethods[] = {"over",       "phenomenological", "stochastic", "stochastic:basic",
                                    "sum",        "average",          "blended",    "weighted",
                                    "listing3",   "listing4",         "monochrome", "unsorted",
                                    "front+tail", "wavelet:3",        "moments:4",  "mlab:4"};

nlohmann::json jsonOf(const std::vector<std::string>& arguments) {
  const Ended ended = runProgram(arguments);
  EXPECT_EQ(ended.code, 0) << ended.err;
  return nlohmann::json::parse(ended.out);
}

TEST(StudyOverADeepPicture, HasTheNumbersOfComposite) {
  const std::string folder = freshFolder("study-deep");
  const ShotFiles files = writeShotFiles(folder);
  std::string methods;
  for (const char* method : kMethods) methods += (methods.empty() ? "" : ",") + std::string(method);
  const nlohmann::json rows = jsonOf(
      {"study", files.deepPicture, files.scene, "-o", folder + "/study", "--methods", methods, "--aa", "4", "--json"});
  ASSERT_GE(rows.size(), std::size(kMethods));
  for (const char* method : kMethods) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const nlohmann::json& one) {
      return one["method"] == method && one["samples"] == 4;
    });
    ASSERT_NE(row, rows.end()) << method << ": " << rows.dump();
    const nlohmann::json own = jsonOf({"composite", files.deepPicture, files.scene, "-o", folder + "/one.exr",
                                       "--method", method, "--aa", "4", "--measure", "--json"});
    for (const char* number : {"mean", "rmse", "p99", "max"})
      EXPECT_EQ((*row)[number].get<double>(), own["error"][number].get<double>()) << method << ", " << number;
  }
}

}  // namespace
}  // namespace pellucid
