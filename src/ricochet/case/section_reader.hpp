#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Values of one section, after check_tree. A value that is absent or was refused reads as zero, empty or
/// nothing, so that reading goes on and finds the remaining problems.
namespace ricochet {

class SectionReader final : public ParameterCheck {
 public:
  /// `keys` and `table` must outlive the reader.
  SectionReader(const std::vector<Key>& keys, const TomlNode& table, Problems& problems)
      : keys_(keys), table_(table), problems_(problems) {}

  /// Of a named section.
  [[nodiscard]] const std::string& name() const { return table_.key; }

  /// Written by the user, in the file or by --set; perhaps refused.
  [[nodiscard]] bool is_given(const std::string& name) const override;
  [[nodiscard]] bool is_override(const std::string& name) const override;
  /// There is a value, default or not, and nothing is wrong with it.
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
  /// One number in two dimensions, three in three; empty where it is absent.
  [[nodiscard]] std::vector<double> axial(const std::string& name) const;
  /// The entries' places among the key's choices: 0, 1, 2 for "x", "y", "z".
  [[nodiscard]] std::vector<int> choice_numbers(const std::string& name) const;
  /// Compile the expressions with the section's parameters; their errors are problems at the place of the expression.
  /// The entries of a list of choices as they are given; empty where it is absent.
  [[nodiscard]] std::vector<std::string> chosen(const std::string& name) const;
  /// The name of a group; of a list of groups its text, "[rim, skin]", under which it is put into `lists`.
  [[nodiscard]] std::string groups(const std::string& name,
                                   std::map<std::string, std::vector<std::string>>& lists) const;
  [[nodiscard]] Expression formula(const std::string& name) const;
  [[nodiscard]] std::vector<Expression> formulas(const std::string& name) const;
  /// One expression in two dimensions, three in three; empty where it is absent.
  [[nodiscard]] std::vector<Expression> axial_formulas(const std::string& name) const;
  [[nodiscard]] std::map<std::string, std::string> conditions(const std::string& name) const;
  [[nodiscard]] SectionReader table(const std::string& name) const;
  /// Elements of a list, or the one that stands in its place; none if it is absent.
  [[nodiscard]] std::vector<SectionReader> tables(const std::string& name) const;

  /// Of the value, or of the section when the key is absent.
  [[nodiscard]] SourceLocation where(const std::string& name) const;
  [[nodiscard]] std::string place(const std::string& name) const override { return where(name).text(); }
  void add_problem(const std::string& name, const std::string& message) const override;
  void add_warning(const std::string& name, const std::string& message) const override;
  void add_info(const std::string& name, const std::string& message) const override;

  /// The values of the type that a key names, checked as the type asks; none where the type was refused.
  [[nodiscard]] Parameters type_parameters(const Section& section) const;

 private:
  [[nodiscard]] const TomlNode* usable(const std::string& name) const;
  /// The section's parameters.
  [[nodiscard]] std::map<std::string, double> constants() const;
  [[nodiscard]] Expression expression(const Key& key, const TomlNode& node) const;

  const std::vector<Key>& keys_;
  const TomlNode& table_;
  Problems& problems_;
};

}  // namespace ricochet
