#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace selvage {

/// The source of all chance of one execution.
using Chance = std::mt19937_64;

/// Changes a text by words and lines: numbers become odd ones, words, lines and brackets are dropped, doubled, moved or
/// taken from another text of the corpus, and now and then single bytes change.
/// @param corpus  texts of the same kind
std::string mutated_text(const std::string& text, const std::vector<std::string>& corpus, Chance& chance);

/// Changes single bytes, numbers of 1 to 8 bytes, and stretches of a binary file, or cuts it off.
std::string mutated_bytes(const std::string& bytes, Chance& chance);

/// A number in [0, below).
std::size_t below(std::size_t count, Chance& chance);

}  // namespace selvage
