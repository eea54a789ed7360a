#include "composite/cli/verbs.h"

int main(int argc, char** argv) {
  return pellucid::cli::run(argc, argv);
}
