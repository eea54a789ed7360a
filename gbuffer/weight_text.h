// Depth weights as text: what --weight takes, what the header of a file of planes holds, and the help on both.
#pragma once
#include <optional>
#include <string>

#include "shaders/weights.h"

namespace pellucid {

// "power 0.1 1000 3 2": the name that --weight takes, rangeNear, rangeFar, exponent and, of weights that read one, the
// reference, with every bit of them.
std::string weightText(const shading::WeightSettings& weight);
// The reverse. Nothing for text that weightText does not write; without a reference, as it once wrote, 1 m.
std::optional<shading::WeightSettings> readWeightText(const std::string& text);

// "eq5", "power:3": kind and parameter from the text of --weight, the range from `given`.
// Throws UsageError naming the weights or the parameter's range.
shading::WeightSettings parseWeight(const std::string& text, const shading::WeightSettings& given);
// The text of --weight that asks for it, "power:3".
std::string weightName(const shading::WeightSettings& weight);

std::string weightNames();       // "eq5, eq7, ..., power:K, uniform"
std::string rangedWeights();     // those that read a range: "eq5, eq10, eq10z"
std::string referenceWeights();  // those that read a reference: "eq7, ..., power:K"
std::string weightsHelp();       // a line for every row

}  // namespace pellucid
