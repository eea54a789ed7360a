// Nothing is longer than one reads at once, and the formatter has nothing to change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/house/length_rules.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

constexpr int kFunction = 60, kCommandFile = 150;

// What is still longer. Rows only go and shrink: a row that is not needed any more fails the test.
const Allowances kLongFunctions = {
    {"composite/methods/table.cpp rows", 200},          // a table, which grows by rows
    {"gbuffer/producer_rows.cpp filmRenderers", 120},   // likewise
    {"composite/pipeline/refusals.cpp refusals", 120},  // likewise
};
const Allowances kLongFiles = {};

std::string lengthsTold(const Violations& violations) {
  std::string out;
  for (const std::string& sentence : violations) out += sentence + "\n";
  return out;
}

bool isHeldToLengths(const SourceFile& file) {
  const std::string room = roomOf(file.path);
  return room != "samples" && room != "tests";
}

TEST(House, FunctionsAreReadAtOnce) {
  std::string all;
  std::size_t functions = 0;
  Allowances unused = kLongFunctions;
  for (const SourceFile& file : sourceFiles()) {
    if (!isHeldToLengths(file)) continue;
    for (const FunctionText& function : functionsOf(file.text)) {
      ++functions;
      if (function.lines > kFunction) unused.erase(file.path + " " + function.name);
    }
    all += lengthsTold(longFunctions(file, kFunction, kLongFunctions));
  }
  EXPECT_EQ(all, "");
  for (const auto& [name, lines] : unused) ADD_FAILURE() << name << " needs no row any more: take it out of the list";
  EXPECT_GT(functions, 1000u) << "the search sees them";
}

TEST(House, FilesOfTheCommandLineAreShort) {
  std::string all;
  Allowances unused = kLongFiles;
  for (const SourceFile& file : sourceFiles()) {
    if (roomOf(file.path) != "composite/cli") continue;
    all += lengthsTold(longFiles(file, kCommandFile, kLongFiles));
    if (std::count(file.text.begin(), file.text.end(), '\n') > kCommandFile) unused.erase(file.path);
  }
  EXPECT_EQ(all, "");
  for (const auto& [name, lines] : unused) ADD_FAILURE() << name << " needs no row any more: take it out of the list";
}

TEST(House, PlantedLongFunctionsAreFound) {
  std::string lines;
  for (int i = 0; i < 59; ++i) lines += "  call();\n";
  const auto count = [](const std::string& text) { return longFunctions({"gbuffer/a.cpp", text}, 60, {}).size(); };
  EXPECT_EQ(count("void f() {\n" + lines + "}\n"), 1u);
  EXPECT_EQ(count("void f() {\n" + lines.substr(10) + "}\n"), 0u) << "60 lines";
  EXPECT_EQ(count("namespace a {\nstruct S : T {\n  int f(int x = 0) const override {\n" + lines + "  }\n};\n}\n"), 1u);
  EXPECT_EQ(count("auto f(int a,\n       int b)\n    -> int {\n" + lines.substr(20) + "}\n"), 1u)
      << "its parameters belong to it";
  EXPECT_EQ(count("const int table[] = {\n" + lines + "};\n"), 0u) << "no function";
  EXPECT_EQ(count("void f() { g(\"{\"); /* { */ h('{'); } // {\n" + lines + "void g() {}\n"), 0u);
  EXPECT_EQ(count("void f() {\n  g(R\"(}\n)\");\n" + lines + "}\n"), 1u) << "a brace in a raw literal";
  EXPECT_EQ(count("#define A(x) \\\n  { x \\\n  }\n" + lines), 0u);
  const std::vector<FunctionText> found = functionsOf("int S::run(int a) {\n  return a;\n}\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "S::run");
  EXPECT_EQ(found[0].lines, 3);
}

// Runs clang-format over `files`; what it would change, or "" for nothing.
std::string formatted(const std::vector<std::string>& files) {
  const std::string list = freshFolder("format") + "/files";
  std::ofstream out(list);
  for (const std::string& file : files) out << file << '\n';
  out.close();
  const std::string command = "cd '" PELLUCID_SOURCE_DIR "' && xargs clang-format --style=file --dry-run -Werror <'" +
                              list + "' >'" + list + ".said' 2>&1";
  return std::system(command.c_str()) == 0 ? "" : slurp(list + ".said") + " ";
}

TEST(House, TheFormatterChangesNothing) {
  if (std::system("command -v clang-format >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no clang-format is installed: ./dev test installs it";
  std::vector<std::string> files;
  for (const SourceFile& file : sourceFiles())
    if (file.path.ends_with(".h") || file.path.ends_with(".cpp")) files.push_back(file.path);
  EXPECT_GT(files.size(), 400u);
  EXPECT_EQ(formatted(files), "");
  const std::string planted = freshFolder("format-planted") + "/a.cpp";
  std::ofstream(planted) << "int   a;\n";
  EXPECT_NE(formatted({planted}), "");
}

}  // namespace
}  // namespace pellucid::test
