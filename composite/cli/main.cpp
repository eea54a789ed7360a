#include "composite/cli/freed_memory.h"
#include "composite/cli/verbs.h"

int main(int argc, char** argv) {
  pellucid::cli::givePlanesBack();
  return pellucid::cli::run(argc, argv);
}
