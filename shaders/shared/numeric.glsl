#pragma once
// Transcendentals from + - * / alone, so that CPU and GL give the same bits. Relative error bounds are tested in
// tests/analytic/numeric_test.cpp.

// Natural logarithm of x > 0, normalised. |relative error| < 4e-7 (absolute < 1e-7 near x = 1).
PLD_FN float pldLog(float x) {
  int bits = floatBitsToInt(x);
  int exponent = ((bits >> 23) & 255) - 127;
  precise float mantissa = intBitsToFloat((bits & 0x007fffff) | 0x3f800000);
  if (mantissa > 1.41421356f) {
    mantissa = mantissa * 0.5f;
    exponent = exponent + 1;
  }
  precise float s = (mantissa - 1.0f) / (mantissa + 1.0f);
  precise float q = s * s;
  precise float series = s * (2.0f + q * (0.666666667f + q * (0.4f + q * (0.285714286f + q * 0.222222222f))));
  precise float e = float(exponent);
  precise float result = e * 0.693359375f + (series + e * -2.12194440e-4f);
  return result;
}

// exp(x), 0 below -87.3 and clamped at the largest finite power above 88.
PLD_FN float pldExp(float x) {
  if (x < -87.3f) return 0.0f;
  precise float clamped = min(x, 88.0f);
  precise float k = floor(clamped * 1.44269504f + 0.5f);
  precise float r = (clamped - k * 0.693359375f) - k * -2.12194440e-4f;
  precise float series = 1.0f + r * (1.0f + r * (0.5f + r * (0.166666667f + r * (0.0416666667f + r * (0.00833333333f +
                         r * (0.00138888889f + r * 0.000198412698f))))));
  precise float scale = intBitsToFloat((int(k) + 127) << 23);
  precise float result = series * scale;
  return result;
}

// 1 - exp(-depth) for depth >= 0, keeping relative precision for thin layers.
PLD_FN float pldOneMinusExp(float depth) {
  precise float x = depth;
  if (x < 0.35f) {
    precise float thin = x * (1.0f - x * (0.5f - x * (0.166666667f - x * (0.0416666667f - x * (0.00833333333f -
                         x * (0.00138888889f - x * 0.000198412698f))))));
    return thin;
  }
  precise float thick = 1.0f - pldExp(-x);
  return thick;
}

// x to the power of exponent, x > 0.
PLD_FN float pldPow(float x, float exponent) {
  precise float result = pldExp(exponent * pldLog(x));
  return result;
}
