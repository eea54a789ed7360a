// Eight floats side by side. Every lane gives the bits of the same operations on one float: nothing is contracted.
#pragma once
#include <cstdint>
#include <cstring>

// Compiled for several kinds of x86-64, of which the program takes the widest that it runs on; what such a function
// calls is compiled into it. Sanitizers instrument what takes the choice, which runs before they are ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PLD_CLONES __attribute__((target_clones("avx2", "default"), flatten))
#else
#define PLD_CLONES
#endif

namespace pellucid::lanes {

constexpr int kLanes = 8;
typedef float Float4 __attribute__((vector_size(16)));       // NOLINT
typedef float Float8 __attribute__((vector_size(32)));       // NOLINT: an attribute of the type
typedef std::int32_t Int8 __attribute__((vector_size(32)));  // NOLINT: of comparisons, -1 where true

// By reference: how such vectors are passed by value depends on the processor.
inline void load(const float* from, Float8& to) {
  std::memcpy(&to, from, sizeof to);
}
// Four floats, 1 and nothing.
inline void loadFourAndOne(const float* from, Float8& to) {
  Float4 four;
  std::memcpy(&four, from, sizeof four);
  to = __builtin_shufflevector(four, Float4{1.0f, 0.0f, 0.0f, 0.0f}, 0, 1, 2, 3, 4, 5, 6, 7);
}

// shading::pldExp
inline void expOf(const Float8& x, Float8& result) {
  Float8 clamped = x < -88.0f ? Float8{} - 88.0f : x;
  clamped = clamped > 88.0f ? Float8{} + 88.0f : clamped;
  const Float8 rounded = clamped * 1.44269504f + 0.5f;
  Float8 k = __builtin_convertvector(__builtin_convertvector(rounded, Int8), Float8);
  k = k > rounded ? k - 1.0f : k;
  const Float8 r = (clamped - k * 0.693359375f) - k * -2.12194440e-4f;
  const Float8 series =
      1.0f +
      r * (1.0f +
           r * (0.5f + r * (0.166666667f +
                            r * (0.0416666667f + r * (0.00833333333f + r * (0.00138888889f + r * 0.000198412698f))))));
  const Int8 bits = (__builtin_convertvector(k, Int8) + 127) << 23;
  Float8 scale;
  std::memcpy(&scale, &bits, sizeof scale);
  result = x < -87.3f ? Float8{} : series * scale;
}

// A sum and what its rounding has lost so far: shading::addTap, five lanes of which are a colour and its weight.
struct LossySum {
  Float8 value{}, lost{};
  void add(const Float8& more) {
    const Float8 term = more - lost, sum = value + term;
    lost = (sum - value) - term;
    value = sum;
  }
  // Only where `counts` is -1.
  void addWhere(const Int8& counts, const Float8& more) {
    const Float8 term = more - lost, sum = value + term;
    const Float8 left = (sum - value) - term;
    lost = counts ? left : lost;
    value = counts ? sum : value;
  }
};

}  // namespace pellucid::lanes
