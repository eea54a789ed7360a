// What making a recipe takes, of every permutation of method, tier and features: processor time of the thread that
// makes it, alone and beside seven others, so that a busy machine counts for little. The aim is 5 ms.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <thread>
#include <vector>

#include "tests/support/recipes.h"

namespace pellucid::test {
namespace {

double threadMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Of every `step`-th of them, from `first` on.
std::vector<double> timesOf(const std::vector<pld_recipe_info>& infos, std::size_t first, std::size_t step) {
  std::vector<double> times;
  for (std::size_t i = first; i < infos.size(); i += step) {
    const double before = threadMilliseconds();
    const RecipePointer made = makeRecipe(infos[i]);
    times.push_back(threadMilliseconds() - before);
  }
  return times;
}

void print(const char* name, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  double sum = 0;
  for (const double time : times) sum += time;
  std::printf("%s: %zu recipes, mean %.2f ms, median %.2f, 99 of 100 below %.2f, longest %.2f\n", name, times.size(),
              sum / static_cast<double>(times.size()), times[times.size() / 2], times[times.size() * 99 / 100],
              times.back());
}

}  // namespace
}  // namespace pellucid::test

int main() {
  using namespace pellucid::test;
  pld_recipe_info like = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
  like.set = 1;
  // The first reads the files that all later ones put together.
  pld_recipe_info whole = like;
  whole.features = 511;
  print("first of a process, with everything", timesOf({whole}, 0, 1));
  std::vector<pld_recipe_info> infos;
  forEachRecipe(like, [&](const pld_recipe_info& info, const pld_recipe&) { infos.push_back(info); });
  print("alone", timesOf(infos, 0, 1));
  std::vector<std::vector<double>> each(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < each.size(); ++i)
    threads.emplace_back([&, i] { each[i] = timesOf(infos, i, each.size()); });
  for (std::thread& thread : threads) thread.join();
  std::vector<double> all;
  for (const std::vector<double>& times : each) all.insert(all.end(), times.begin(), times.end());
  print("eight threads at once", all);
}
