#pragma once

#include <map>
#include <memory>
#include <string>

/// @file A number given by a user: a constant, or an expression in x, y, z, t and named parameters.
namespace ricochet {

/// A formula evaluated in double precision (muParser's syntax). Copies are cheap and independent.
class Expression {
 public:
  /// Creates the constant 0.
  Expression();
  explicit Expression(double constant);
  /// Throws Error(invalid_input) that quotes the text, the position and the reason; for an unknown name it lists the
  /// known ones. `parameters` are constants by name; x, y, z and t are reserved.
  explicit Expression(const std::string& text, const std::map<std::string, double>& parameters = {});
  Expression(const Expression& other);
  Expression& operator=(const Expression& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  /// Returns the value at a point and an instant. Throws Error(invalid_input) with the point and the instant if it is
  /// not finite.
  [[nodiscard]] double operator()(double x, double y, double z, double t) const;

  [[nodiscard]] bool depends_on_time() const;
  [[nodiscard]] bool depends_on_position() const;
  [[nodiscard]] bool depends_on_z() const;
  [[nodiscard]] bool is_constant() const { return !depends_on_time() && !depends_on_position(); }
  [[nodiscard]] const std::string& text() const;
  /// Equal if both are the same constant, or the same text with the same parameters, and hence agree everywhere.
  [[nodiscard]] bool operator==(const Expression& other) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
