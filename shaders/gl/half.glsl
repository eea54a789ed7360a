#pragma once

// A depth as a half holds it, rounded towards the eye: what lies behind a layer must not come to lie before it.
float towardsEye(float z) {
  return intBitsToFloat(floatBitsToInt(z) & ~0x1fff);
}
