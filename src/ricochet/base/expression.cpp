#include "ricochet/base/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Refuses "=", since muParser would read "t=3" as an assignment, and "**", whose message would not name "^".
void refuse_other_operators(const std::string& text) {
  if (text.find("**") != std::string::npos)
    throw Error(ErrorKind::invalid_input, fmt::format("in the expression \"{}\": powers are written with \"^\"", text));
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || (text[i - 1] != '<' && text[i - 1] != '>' && text[i - 1] != '!')) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("in the expression \"{}\": \"=\" is not a comparison; write \"==\"", text));
    }
  }
}

}  // namespace

// The variables live beside the parser, which holds their addresses; therefore every copy builds its parser anew.
struct Expression::Implementation {
  std::string text;
  std::map<std::string, double> parameters;
  double x = 0.0, y = 0.0, z = 0.0, t = 0.0;
  mu::Parser parser;
  bool number = true;  ///< a plain constant, evaluated without the parser
  double constant = 0.0;
  bool uses_time = false, uses_position = false, uses_z = false;

  void compile();
};

void Expression::Implementation::compile() {
  try {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", 3.141592653589793238462643383279502884);
    for (const auto& [name, value] : parameters) {
      if (name == "x" || name == "y" || name == "z" || name == "t" || name == "pi") {
        throw Error(ErrorKind::invalid_input, fmt::format("parameter \"{}\" has a reserved name", name));
      }
      parser.DefineConst(name, value);
    }
    refuse_other_operators(text);
    parser.SetExpr(text);
    for (const auto& [name, address] : parser.GetUsedVar()) {
      uses_time = uses_time || name == "t";
      uses_z = uses_z || name == "z";
      uses_position = uses_position || name == "x" || name == "y" || name == "z";
      if (address == nullptr) {
        std::vector<std::string> names{"x", "y", "z", "t", "pi"};
        for (const auto& [parameter, value] : parameters) names.push_back(parameter);
        const std::string near = nearest_name(name, names);
        throw Error(ErrorKind::invalid_input,
                    fmt::format("in the expression \"{}\": unknown name \"{}\"{}; known names are {}", text, name,
                                near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near), join_names(names)));
      }
    }
    number = !uses_time && !uses_position;
    int results = 0;
    parser.Eval(results);  // muParser checks the syntax on the first evaluation
    if (results != 1) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("the expression \"{}\" has {} values; write one, with a point as the decimal separator",
                              text, results));
    }
    if (number) {
      constant = parser.Eval();
      if (!std::isfinite(constant)) {
        throw Error(ErrorKind::invalid_input, fmt::format("the expression \"{}\" has no finite value", text));
      }
    }
  } catch (const mu::Parser::exception_type& problem) {
    throw Error(ErrorKind::invalid_input, fmt::format("in the expression \"{}\": {}", text, problem.GetMsg()));
  }
}

Expression::Expression() : Expression(0.0) {}

Expression::Expression(double constant) : implementation_(std::make_unique<Implementation>()) {
  implementation_->constant = constant;
  implementation_->text = fmt::format("{:.17g}", constant);
}

Expression::Expression(const std::string& text, const std::map<std::string, double>& parameters)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->text = text;
  implementation_->parameters = parameters;
  implementation_->compile();
}

Expression::Expression(const Expression& other) : implementation_(std::make_unique<Implementation>()) {
  implementation_->text = other.implementation_->text;
  implementation_->parameters = other.implementation_->parameters;
  if (other.is_constant()) {
    implementation_->constant = other.implementation_->constant;
  } else {
    implementation_->compile();
  }
}

Expression& Expression::operator=(const Expression& other) {
  if (this != &other) *this = Expression(other);
  return *this;
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(double x, double y, double z, double t) const {
  Implementation& formula = *implementation_;
  if (formula.number) return formula.constant;
  formula.x = x;
  formula.y = y;
  formula.z = z;
  formula.t = t;
  const double value = formula.parser.Eval();
  if (!std::isfinite(value)) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("the expression \"{}\" has no finite value at x = {}, y = {}, z = {}, t = {}", formula.text,
                            x, y, z, t));
  }
  return value;
}

bool Expression::depends_on_time() const { return implementation_->uses_time; }
bool Expression::depends_on_position() const { return implementation_->uses_position; }
bool Expression::depends_on_z() const { return implementation_->uses_z; }
const std::string& Expression::text() const { return implementation_->text; }
bool Expression::operator==(const Expression& other) const {
  const Implementation& own = *implementation_;
  const Implementation& its = *other.implementation_;
  if (own.number || its.number) return own.number && its.number && own.constant == its.constant;
  return own.text == its.text && own.parameters == its.parameters;
}

}  // namespace ricochet
