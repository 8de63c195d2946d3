#pragma once

#include <string>
#include <vector>

#include "described_command.hpp"

/// @file What may stand in the place of the word that is being typed, for the completion of shells. The scripts of the
/// shells only ask the program, so that all of them know the same commands, options, keys and files.
namespace ricochet::program {

struct Candidate {
  std::string word;      ///< the whole word; one that ends with "/", "=" or "." is to be typed on, without a blank
  std::string doc = {};  ///< one line; may be empty
};

/// `words`: the arguments up to the cursor, the last one the word that is being typed, which may be empty. Throws
/// nothing: what cannot be read gives no candidates.
[[nodiscard]] std::vector<Candidate> complete(const DescribedCommand& program, const std::vector<std::string>& words);

/// The script that has a shell ask the program. Throws Error(usage) for a shell that is not known.
[[nodiscard]] std::string completion_script(const std::string& shell);

}  // namespace ricochet::program
