#pragma once
// Transcendentals from + - * / alone, so that CPU and GL give the same bits. Relative error bounds are tested in
// tests/analytic/numeric_test.cpp.

// Rasterisers on a CPU run both sides of a branch, and a fragment waits there for its longest chain: what every fragment
// goes through chooses between values, and its series are summed in pairs.

// x = 2^exponent * mantissa, the mantissa from the root of 1/2 to that of 2.
struct BinaryParts {
  float exponent;
  float mantissa;
};

PLD_FN BinaryParts binaryParts(float x) {
  const int least = 0x3f3504f4;  // of the mantissa
  int above = (floatBitsToInt(x) & 0x7fffffff) - least;
  BinaryParts parts;
  parts.exponent = float(above >> 23);
  parts.mantissa = intBitsToFloat((above & 0x007fffff) + least);
  return parts;
}

// ln(2^exponent * (1 + s) / (1 - s)), |s| < .18.
PLD_FN float logOfParts(float exponent, float s) {
  precise float q = s * s;
  precise float series = s * (2.0f + q * (0.666666667f + q * (0.4f + q * (0.285714286f + q * 0.222222222f))));
  precise float result = exponent * 0.693359375f + (series + exponent * -2.12194440e-4f);
  return result;
}

// Natural logarithm of x > 0, normalised. |relative error| < 4e-7 (absolute < 1e-7 near x = 1).
PLD_FN float pldLog(float x) {
  BinaryParts parts = binaryParts(x);
  precise float s = (parts.mantissa - 1.0f) / (parts.mantissa + 1.0f);
  return logOfParts(parts.exponent, s);
}

// exp(x), 0 below -87.3 and clamped at the largest finite power above 88.
PLD_FN float pldExp(float x) {
  precise float clamped = clamp(x, -88.0f, 88.0f);
  precise float k = floor(clamped * 1.44269504f + 0.5f);
  precise float r = (clamped - k * 0.693359375f) - k * -2.12194440e-4f;
  precise float series = 1.0f + r * (1.0f + r * (0.5f + r * (0.166666667f + r * (0.0416666667f + r * (0.00833333333f +
                         r * (0.00138888889f + r * 0.000198412698f))))));
  precise float scale = intBitsToFloat((int(k) + 127) << 23);
  precise float result = series * scale;
  return x < -87.3f ? 0.0f : result;
}

// 1 - exp(-depth) for depth >= 0, keeping relative precision for thin layers.
//   power  exp(-depth) by pldExp()
PLD_FN float pldOneMinusPower(float depth, float power) {
  precise float x = depth;
  precise float thin = x * (1.0f - x * (0.5f - x * (0.166666667f - x * (0.0416666667f - x * (0.00833333333f -
                       x * (0.00138888889f - x * 0.000198412698f))))));
  precise float thick = 1.0f - power;
  return x < 0.35f ? thin : thick;
}

PLD_FN float pldOneMinusExp(float depth) {
  return pldOneMinusPower(depth, depth < 0.35f ? 0.0f : pldExp(-depth));
}

// log2 of x > 0, normalised. |absolute error| < 3e-7, or a rounding of the result.
PLD_FN float pldLog2(float x) {
  BinaryParts parts = binaryParts(x);
  precise float s = (parts.mantissa - 1.0f) / (parts.mantissa + 1.0f);
  precise float q = s * s;
  precise float q2 = q * q;
  precise float series = (2.88539008f + q * 0.961796694f) + q2 * ((0.577078016f + q * 0.412198583f) + q2 * 0.320598898f);
  precise float result = parts.exponent + s * series;
  return result;
}

// 2^x, |x| <= 126. |relative error| < 2e-7
PLD_FN float pldExp2(float x) {
  precise float k = floor(x + 0.5f);
  precise float f = x - k;
  precise float f2 = f * f;
  precise float lower = (1.0f + f * 0.693147181f) + f2 * (0.240226507f + f * 0.0555041087f);
  precise float upper = (0.00961812911f + f * 0.00133335581f) + f2 * (0.000154035304f + f * 0.0000152527338f);
  precise float series = lower + (f2 * f2) * upper;
  precise float scale = intBitsToFloat((int(k) + 127) << 23);
  precise float result = series * scale;
  return result;
}

// x to the power of exponent, x > 0; 0 below 2^-126, at most 2^126.
PLD_FN float pldPow(float x, float exponent) {
  precise float y = exponent * pldLog2(x);
  float result = pldExp2(clamp(y, -126.0f, 126.0f));
  return y < -126.0f ? 0.0f : result;
}
