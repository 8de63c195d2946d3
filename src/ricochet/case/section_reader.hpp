#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Values of one section, after check_tree. A value that is absent or was refused is read as zero, empty or null,
/// so that reading continues and finds the remaining problems.
namespace ricochet {

class SectionReader final : public ParameterCheck {
 public:
  /// `keys` and `table` must outlive the reader.
  SectionReader(const std::vector<Key>& keys, const TomlNode& table, Problems& problems)
      : keys_(keys), table_(table), problems_(problems) {}

  /// Name of a named section.
  [[nodiscard]] const std::string& name() const { return table_.key; }

  /// Returns whether the user has specified it, in the file or by --set; it may be refused.
  [[nodiscard]] bool is_given(const std::string& name) const override;
  [[nodiscard]] bool is_override(const std::string& name) const override;
  /// Returns whether there is a value, default or not, without a problem.
  [[nodiscard]] bool is_usable(const std::string& name) const override;

  [[nodiscard]] std::string text(const std::string& name) const;
  /// Any value as text, a list as "[a, b]".
  [[nodiscard]] std::string value(const std::string& name) const;
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] std::optional<double> optional_number(const std::string& name) const;
  [[nodiscard]] long integer(const std::string& name) const;
  [[nodiscard]] std::optional<long> optional_integer(const std::string& name) const;
  [[nodiscard]] bool flag(const std::string& name) const;
  [[nodiscard]] std::vector<double> vector(const std::string& name) const;
  /// One number in two dimensions, three in three; empty if absent.
  [[nodiscard]] std::vector<double> axial(const std::string& name) const;
  /// Indices of the entries among the key's choices: 0, 1, 2 for "x", "y", "z".
  [[nodiscard]] std::vector<int> choice_numbers(const std::string& name) const;
  /// Entries of a list of choices as given; empty if absent.
  [[nodiscard]] std::vector<std::string> chosen(const std::string& name) const;
  /// Name of a group; for a list of groups its text, "[rim, skin]", under which the list is stored in `lists`.
  [[nodiscard]] std::string groups(const std::string& name,
                                   std::map<std::string, std::vector<std::string>>& lists) const;
  /// Compile expressions with the section's parameters; errors are problems at the position of the expression.
  [[nodiscard]] Expression formula(const std::string& name) const;
  [[nodiscard]] std::vector<Expression> formulas(const std::string& name) const;
  /// One expression in two dimensions, three in three; empty if absent.
  [[nodiscard]] std::vector<Expression> axial_formulas(const std::string& name) const;
  [[nodiscard]] std::map<std::string, std::string> conditions(const std::string& name) const;
  [[nodiscard]] SectionReader table(const std::string& name) const;
  /// Elements of a list, or a single one in its place; empty if absent.
  [[nodiscard]] std::vector<SectionReader> tables(const std::string& name) const;

  /// Location of the value, or of the section if the key is absent.
  [[nodiscard]] SourceLocation where(const std::string& name) const;
  [[nodiscard]] std::string location(const std::string& name) const override { return where(name).text(); }
  void add_problem(const std::string& name, const std::string& message) const override;
  void add_warning(const std::string& name, const std::string& message) const override;
  void add_info(const std::string& name, const std::string& message) const override;

  /// Values of the type that a key names, checked by the type; empty if the type was refused.
  [[nodiscard]] Parameters type_parameters(const Section& section) const;
  /// Values of some keys, without those that were refused; lists of groups as `groups` returns them.
  [[nodiscard]] Parameters parameters(const std::vector<Key>& keys,
                                      std::map<std::string, std::vector<std::string>>& lists) const;

 private:
  [[nodiscard]] const TomlNode* usable(const std::string& name) const;
  /// Parameters of the section.
  [[nodiscard]] std::map<std::string, double> constants() const;
  [[nodiscard]] Expression expression(const Key& key, const TomlNode& node) const;

  const std::vector<Key>& keys_;
  const TomlNode& table_;
  Problems& problems_;
};

}  // namespace ricochet
