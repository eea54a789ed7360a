#pragma once
// Integer hashes: the same bits on every machine.

// PCG output permutation: every bit of the result depends on every bit of x.
PLD_FN uint hashOf(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// Of a fragment: the same for every chunking, submission order and renderer.
//   instance  Instance::identity
//   triangle  number within the primitive
PLD_FN uint identityOf(uint instance, uint triangle) {
  return hashOf(instance ^ hashOf(triangle));
}
