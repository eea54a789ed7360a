#pragma once
uint after(uint link) { return pldLinks[linkOf(link - 1u)]; }  // Lists of gl/exact_lists.glsl in the order of depth.
void setAfter(uint link, uint next) { pldLinks[linkOf(link - 1u)] = next; }
float depthOf(uint link) { return pldTransmissions[link - 1u].a; }

// Whether a vector comes before another by its bits; 0 where they are the same.
int orderOfBits(vec4 a, vec4 b) {
  for (int c = 0; c < 4; ++c) {
    uint one = floatBitsToUint(a[c]), other = floatBitsToUint(b[c]);
    if (one != other) return one < other ? -1 : 1;
  }
  return 0;
}

// From far to near, layers at one depth by all their bits: what is summed over them has then one order.
bool comesFirst(uint a, uint b) {
  float one = depthOf(a), other = depthOf(b);
  if (one != other) return one > other;
  int order = orderOfBits(pldRadiances[a - 1u], pldRadiances[b - 1u]);
  if (order == 0) order = orderOfBits(pldTransmissions[a - 1u], pldTransmissions[b - 1u]);
  return order <= 0;
}

// Merges runs of the list pairwise, each time twice as long, and relinks it in place.
uint sortedList(uint list) {
  for (uint size = 1u;; size *= 2u) {
    uint left = list, tail = 0u, merges = 0u;
    list = 0u;
    while (left != 0u) {
      ++merges;
      uint right = left, leftSize = 0u, rightSize = size;
      while (leftSize < size && right != 0u) {
        ++leftSize;
        right = after(right);
      }
      while (leftSize > 0u || (rightSize > 0u && right != 0u)) {
        bool takesLeft = rightSize == 0u || right == 0u || (leftSize > 0u && comesFirst(left, right));
        uint taken = takesLeft ? left : right;
        if (takesLeft) {
          left = after(left);
          --leftSize;
        } else {
          right = after(right);
          --rightSize;
        }
        if (tail == 0u) {
          list = taken;
        } else {
          setAfter(tail, taken);
        }
        tail = taken;
      }
      left = right;
    }
    if (tail == 0u) return 0u;
    setAfter(tail, 0u);
    if (merges <= 1u) return list;
  }
}
