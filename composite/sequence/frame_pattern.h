// Names of files that hold the number of a frame: shot.####.exr, shot.%04d.exr, shot.@@@@.exr, shot.$F4.exr.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace pellucid {

// What stands for the number:
//   ####, @@@@  as many digits at least as there are signs; a # alone four of them, an @ alone any number
//   %04d, $F4   four digits at least; %d and $F any number
// A number that has fewer digits gets zeros before it, one that has more keeps them. The minus of a negative number
// counts as a digit, as printf has it (-001); Blender writes it before all digits (-0001), so a file that is there
// under that name alone is found, too. A name may hold several places, folders included: all of them get the same
// number.
class FramePattern {
 public:
  explicit FramePattern(std::string text);

  const std::string& text() const { return text_; }
  bool any() const { return pieces_.size() > 1; }  // whether there is such a place
  // Whether nobody would give a single file this name: an @ alone stands in names too.
  bool unmistakable() const { return unmistakable_; }
  std::string at(int frame) const { return named(frame, 0); }
  // The same for a value that names an input by `fileOf(value)`: with the minus before all digits where only that
  // exists.
  std::string inputAt(int frame, const std::function<std::string(const std::string&)>& fileOf) const;
  // Frames of which such a file exists, upwards.
  std::vector<int> onDisk() const;

 private:
  struct Piece {
    std::string literal;  // what stands before the number; behind the last piece's stands none
    int digits = 0;
  };
  //   more  digits of negative numbers besides those that the places say
  std::string named(int frame, int more) const;
  std::string text_;
  std::vector<Piece> pieces_;  // at least one; the last one's digits mean nothing
  bool unmistakable_ = false;
};

// The pattern that a value of the command line names: none where a file of just this name exists.
FramePattern inputPattern(const std::string& path);

}  // namespace pellucid
