#pragma once

#include <string>
#include <vector>

#include "described_command.hpp"

/// @file Candidates for the word that is being typed, for the completion of shells. The scripts of the shells only
/// query the program, so that all of them offer the same commands, options, keys and files.
namespace ricochet::program {

struct Candidate {
  std::string word;      ///< the whole word; one that ends with "/", "=" or "." continues without a blank
  std::string doc = {};  ///< one line; may be empty
};

/// `words` are the arguments up to the cursor; the last one is being typed and may be empty. Throws nothing: unreadable
/// files have no candidates.
[[nodiscard]] std::vector<Candidate> complete(const DescribedCommand& program, const std::vector<std::string>& words);

/// Returns the script by which a shell queries the program. Throws Error(usage) for an unknown shell.
[[nodiscard]] std::string completion_script(const std::string& shell);

}  // namespace ricochet::program
