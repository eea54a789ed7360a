#pragma once
// Sums of floats that no order changes, rounded once. Each term is cut at two grids that the largest term and the
// number of terms decide, so that every addition of the parts is exact (Demmel and Nguyen, Parallel Reproducible
// Summation, 2015).
// What lies below the second grid is lost: 2^-101 of the largest term, times the square of the number of terms, a term.
// The one shared text in doubles: rounding is all it is about.

// Four sums.
struct ExactSums {
  dvec4 coarseGrid;
  dvec4 fineGrid;
  dvec4 coarse;
  dvec4 fine;
};

PLD_FN double powerOfTwo(int exponent) { return packDouble2x32(uvec2(0u, uint(exponent + 1023) << 20)); }

// A power of two of which the sum of `count` numbers, at most `largest` each, is less than half.
PLD_FN double gridOf(float largest, uint count) {
  return powerOfTwo(int(floatBitsToUint(largest) >> 23) - 126 + findMSB(count) + 2);
}

//   largest  of the terms' magnitudes, finite
//   count    of terms, > 0
PLD_FN ExactSums exactSums(vec4 largest, uint count) {
  ExactSums sums;
  sums.coarseGrid =
      dvec4(gridOf(largest.x, count), gridOf(largest.y, count), gridOf(largest.z, count), gridOf(largest.w, count));
  // Of what the coarse grid leaves.
  sums.fineGrid = sums.coarseGrid * powerOfTwo(findMSB(count) + 2 - 53);
  sums.coarse = dvec4(0);
  sums.fine = dvec4(0);
  return sums;
}

PLD_FN ExactSums addedTo(ExactSums sums, vec4 terms) {
  dvec4 wide = dvec4(terms);
  precise dvec4 onCoarse = sums.coarseGrid + wide;
  precise dvec4 coarse = onCoarse - sums.coarseGrid;
  precise dvec4 left = wide - coarse;
  precise dvec4 onFine = sums.fineGrid + left;
  precise dvec4 fine = onFine - sums.fineGrid;
  precise dvec4 coarseSum = sums.coarse + coarse;
  precise dvec4 fineSum = sums.fine + fine;
  ExactSums more = sums;
  more.coarse = coarseSum;
  more.fine = fineSum;
  return more;
}

// coarse + fine to float. To double it is rounded to odd, so that the second rounding knows on which side of a tie it
// lay.
PLD_FN float roundedOnce(double coarse, double fine) {
  double none = double(0.0f);
  precise double sum = coarse + fine;
  precise double part = sum - coarse;
  precise double rest = sum - part;
  precise double ofCoarse = coarse - rest;
  precise double ofFine = fine - part;
  precise double error = ofCoarse + ofFine;
  uvec2 bits = unpackDouble2x32(sum);
  if (error != none && (bits.x & 1u) == 0u) {
    if ((error > none) == (sum > none)) {
      bits.x |= 1u;
    } else {
      bits.y -= bits.x == 0u ? 1u : 0u;
      bits.x -= 1u;
    }
  }
  return float(packDouble2x32(bits));
}

PLD_FN vec4 roundedSums(ExactSums sums) {
  return vec4(roundedOnce(sums.coarse.x, sums.fine.x), roundedOnce(sums.coarse.y, sums.fine.y),
              roundedOnce(sums.coarse.z, sums.fine.z), roundedOnce(sums.coarse.w, sums.fine.w));
}
