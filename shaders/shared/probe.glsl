#pragma once
// Which pixels stand for the picture: one of every cell of cell x cell pixels, by an integer hash of the cell, so that
// no pattern of the picture can hide between them.

PLD_FN uint probeHash(uint cellX, uint cellY) {
  uint h = (cellX * 0x9e3779b1u) ^ (cellY * 0x85ebca77u);
  h = (h ^ (h >> 15u)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12u)) * 0x297a2d39u;
  return h ^ (h >> 15u);
}

//   pixel  in the data window, >= 0
//   cell   >= 1; 1 probes every pixel
PLD_FN bool isProbe(ivec2 pixel, int cell) {
  uint side = uint(cell);
  uint x = uint(pixel.x), y = uint(pixel.y);
  uint hash = probeHash(x / side, y / side);
  return x % side == hash % side && y % side == (hash / side) % side;
}
