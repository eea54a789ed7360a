// Eight floats side by side. Every lane gives the bits of the same operations on one float: nothing is contracted.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

// Compiled for several kinds of x86-64, of which the program takes the widest that it runs on; what such a function
// calls is compiled into it. Sanitizers instrument what takes the choice, which runs before they are ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PLD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default"), flatten))
#else
#define PLD_CLONES
#endif

namespace pellucid::lanes {

constexpr int kLanes = 8;
typedef float Float4 __attribute__((vector_size(16)));       // NOLINT
typedef float Float8 __attribute__((vector_size(32)));       // NOLINT: an attribute of the type
typedef std::int32_t Int8 __attribute__((vector_size(32)));  // NOLINT: of comparisons, -1 where true

// The same wherever they lie. What is copied by memcpy is moved in two halves, which the next load would wait for.
typedef float Float8Anywhere __attribute__((vector_size(32), aligned(4), may_alias));  // NOLINT

// By reference: how such vectors are passed by value depends on the processor.
inline void load(const float* from, Float8& to) {
  to = *reinterpret_cast<const Float8Anywhere*>(from);
}
inline void store(const Float8& from, float* to) {
  *reinterpret_cast<Float8Anywhere*>(to) = from;
}
inline bool anyOf(const Int8& lanes) {
  typedef std::int64_t Two __attribute__((vector_size(16)));   // NOLINT
  typedef std::int64_t Four __attribute__((vector_size(32)));  // NOLINT
  const Four pairs = reinterpret_cast<Four>(lanes);
  const Two either = __builtin_shufflevector(pairs, pairs, 0, 1) | __builtin_shufflevector(pairs, pairs, 2, 3);
  return (either[0] | either[1]) != 0;
}
// Lane by lane, which the compiler makes one operation of.
inline void rootOf(const Float8& x, Float8& root) {
  root = Float8{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3]),
                std::sqrt(x[4]), std::sqrt(x[5]), std::sqrt(x[6]), std::sqrt(x[7])};
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

// Four floats, and four others.
inline void loadTwo(const float* low, const float* high, Float8& to) {
  Float4 first, second;
  std::memcpy(&first, low, sizeof first);
  std::memcpy(&second, high, sizeof second);
  to = __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Five sums of eight rows, a lane a row, as eight rows of five sums.
inline void byRows(const Float8 (&sums)[5], Float8 (&rows)[kLanes]) {
  const Float8 a = __builtin_shufflevector(sums[0], sums[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 b = __builtin_shufflevector(sums[0], sums[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 c = __builtin_shufflevector(sums[2], sums[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 d = __builtin_shufflevector(sums[2], sums[3], 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 four[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                          __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
  for (int k = 0; k < 4; ++k) {
    rows[k] = __builtin_shufflevector(four[k], Float8{sums[4][k]}, 0, 1, 2, 3, 8, 9, 10, 11);
    rows[k + 4] = __builtin_shufflevector(four[k], Float8{sums[4][k + 4]}, 4, 5, 6, 7, 8, 9, 10, 11);
  }
}

}  // namespace pellucid::lanes
