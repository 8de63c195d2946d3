#pragma once

#include <map>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Values of one section, after check_tree. Values that are absent or were refused are skipped, so that reading
/// continues and finds the remaining problems.
namespace ricochet {

class SectionReader final : public ParameterCheck {
 public:
  /// `keys` and `table` must outlive the reader. `result` has the path of the case file, and receives lists of groups.
  SectionReader(const std::vector<Key>& keys, const TomlNode& table, Case& result, Problems& problems)
      : keys_(keys), table_(table), result_(result), problems_(problems) {}

  /// Name of a named section.
  [[nodiscard]] const std::string& name() const { return table_.key; }

  /// Returns whether the user has specified it, in the file or by --set; it may be refused.
  [[nodiscard]] bool is_given(const std::string& name) const override;
  [[nodiscard]] bool is_override(const std::string& name) const override;
  /// Returns whether there is a value, default or not, without a problem.
  [[nodiscard]] bool is_usable(const std::string& name) const override { return usable(name) != nullptr; }

  /// Stores the values of all keys that are bound to members of this struct. Others of its members keep their values.
  template <class Struct>
  void fill(Struct& object) const {
    fill(typeid(Struct), &object);
  }

  /// Value that is not bound to a member; empty or zero if it is not usable.
  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] double number(const std::string& name) const;
  /// Any value as text, a list as "[a, b]".
  [[nodiscard]] std::string value(const std::string& name) const;
  /// Elements of a list of sub-tables, or a single one in its place; empty if absent.
  [[nodiscard]] std::vector<SectionReader> tables(const std::string& name) const;
  /// Values of the type that a key names, checked by the type; empty if the type was refused.
  [[nodiscard]] Parameters type_parameters(const Section& section) const;
  /// Values of some keys, without those that were refused.
  [[nodiscard]] Parameters parameters(const std::vector<Key>& keys) const;
  /// Path of a file relative to the folder of the case file.
  [[nodiscard]] std::string path(const std::string& file) const;

  /// Usable value of a key as the type of its member. Lists of names are sorted by direction as integers: 0, 1, 2 for
  /// "x", "y", "z". A list of groups becomes its text, "[rim, skin]", under which it is stored in Case::group_lists.
  /// Expressions are compiled with the section's parameters; errors are problems at the position of the expression.
  void read(const Key& key, std::string& value) const;
  void read(const Key& key, double& value) const { value = usable(key.name)->real; }
  void read(const Key& key, std::optional<double>& value) const { value = usable(key.name)->real; }
  void read(const Key& key, int& value) const { value = int(usable(key.name)->integer); }
  void read(const Key& key, long& value) const { value = usable(key.name)->integer; }
  void read(const Key& key, std::optional<long>& value) const { value = usable(key.name)->integer; }
  void read(const Key& key, bool& value) const { value = usable(key.name)->boolean; }
  void read(const Key& key, std::vector<double>& value) const;
  void read(const Key& key, std::vector<int>& value) const;
  void read(const Key& key, std::vector<std::string>& value) const;
  void read(const Key& key, Expression& value) const;
  void read(const Key& key, std::vector<Expression>& value) const;
  void read(const Key& key, std::map<std::string, std::string>& value) const;
  template <class Struct>
  void read(const Key& key, Struct& value) const {
    tables(key.name).front().fill(value);
  }
  template <class Struct>
  void read(const Key& key, std::vector<Struct>& value) const {
    for (const SectionReader& entry : tables(key.name)) entry.fill(value.emplace_back());
  }

  /// Location of the value, or of the section if the key is absent.
  [[nodiscard]] SourceLocation where(const std::string& name) const;
  [[nodiscard]] std::string location(const std::string& name) const override { return where(name).text(); }
  void add_problem(const std::string& name, const std::string& message) const override {
    problems_.add(where(name), message);
  }
  void add_warning(const std::string& name, const std::string& message) const override {
    problems_.add_warning(where(name), message);
  }
  void add_info(const std::string& name, const std::string& message) const override {
    problems_.add_info(where(name), message);
  }

 private:
  void fill(const std::type_info& owner, void* object) const;
  [[nodiscard]] const TomlNode* usable(const std::string& name) const;
  /// Parameters of the section.
  [[nodiscard]] std::map<std::string, double> constants() const;
  [[nodiscard]] Expression expression(const Key& key, const TomlNode& node) const;

  const std::vector<Key>& keys_;
  const TomlNode& table_;
  Case& result_;
  Problems& problems_;
};

/// Readers of the sections of a document.
class Sections {
 public:
  Sections(const TomlNode& root, Case& result, Problems& problems)
      : root_(root), result_(result), problems_(problems) {}

  /// Reader of a plain section.
  [[nodiscard]] SectionReader one(const std::string& name) const;
  /// Readers of all entries of a list, or of all sections with names, except refused ones.
  [[nodiscard]] std::vector<SectionReader> all(const std::string& name) const;
  /// Stores all entries of a list, and calls `check` with each.
  template <class Struct, class Check>
  void read(const std::string& name, std::vector<Struct>& entries, const Check& check) const {
    for (const SectionReader& reader : all(name)) {
      reader.fill(entries.emplace_back());
      check(reader, entries.back());
    }
  }
  template <class Struct>
  void read(const std::string& name, std::vector<Struct>& entries) const {
    read(name, entries, [](const SectionReader& /*reader*/, Struct& /*entry*/) {});
  }

 private:
  const TomlNode& root_;
  Case& result_;
  Problems& problems_;
};

}  // namespace ricochet
