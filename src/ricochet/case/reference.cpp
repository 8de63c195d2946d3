#include <fmt/format.h>

#include <array>
#include <cctype>
#include <stdexcept>

#include "ricochet/case/keys.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/case/read_case.hpp"

namespace ricochet {

namespace {

constexpr const char* introduction = R"page(# The case file

<!-- Generated from the table of keys in src/ricochet/case/keys_table*.cpp, and from those that schemes, obstacles and laws
declare where they are defined. Change it there; a test compares. -->

A case file is a [TOML](https://toml.io) document that describes a run completely. `ricochet validate CASE.toml` checks it,
`ricochet schema` prints its JSON Schema, for editors that complete and check case files as you type.

## The keys that most cases need

A thrown ball of rubber, 4 cm in diameter, complete but for its mesh: everything else has a default.

```toml
[mesh]
file = "ball.msh"
degree = 2

[[material]]
group = "all"
density = 1150.0
young = 50.0e6
poisson = 0.3

[obstacle.floor]
type = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]

[[contact]]
group = "boundary"
obstacle = "floor"
friction = 0.3

[initial]
velocity = [0.5, 0.0, -1.0]

[time]
step = 1.5e-5
end = 3.0e-3
```

)page";

constexpr const char* example = R"page(## A case with most of the sections

```toml
title = "Elastic disc on a rigid foundation"

[mesh]
file = "disc.msh"

[[material]]
group = "body"
density = 6000.0
lambda = 1.0e4
mu = 5.0e3
damping = { mass = 0.0, stiffness = 0.0 }

[obstacle.floor]
type = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]

[[contact]]
group = "lower"
obstacle = "floor"
friction = 0.3
multipliers = "nodal"

[[support]]
group = "left"
components = ["x"]
value = "1e-3*sin(2*pi*t)"

[[traction]]
group = "top"
value = ["0", "-p*min(t/0.1, 1)"]
parameters = { p = 100.0 }

[load]
gravity = [0.0, -9.81]

[initial]
displacement = "static"
velocity = [0.0, -0.1]

[time]
scheme = "newmark"
beta = 0.5
gamma = 0.5
step = 1.0e-4
end = 0.15

[[probe]]
name = "lowest"
at = [0.0, 0.001]

[[expect]]
quantity = "history.total_energy[-1]"
value = 0.0376
relative = 1.0e-2
when = { "time.scheme" = "newmark" }
```

)page";

constexpr const char* rules = R"page(## Rules

- **Units**: use any consistent set, such as m, kg, s or mm, t, s. The column *unit* below shows the kind of quantity that a
  number is; 1 is a pure number.
- **Vectors** have as many entries as the mesh has dimensions, 2 or 3, everywhere in a file. A `spin` is a number in two
  dimensions, a vector of 3 entries in three.
- **Numbers** are finite; an integer is accepted where a number is required, but not the other way round.
- **Expressions** are texts in [muParser's syntax](https://beltoforion.de/en/muparser/features.php): `+ - * / ^`,
  comparisons, `a ? b : c`, `sin`, `cos`, `exp`, `sqrt`, `min`, `max` and so on, the constant `pi`, the names in the table
  `parameters` of the same section, and the variables among x, y, z and t that the key allows. x, y, z are reference coordinates,
  after `scale`, `turn` and `move` of the mesh or the part.
- **Groups** are those of the mesh; "all" (every cell) and "boundary" (every boundary facet) are built in, and a list is the
  union of its groups: `group = ["rim", "skin"]`. The groups of a [part](#partname) are called "NAME.group", "NAME.all" and
  "NAME.boundary". [meshes.md](meshes.md) describes which groups a mesh file provides.
- **All problems** are reported together, with file, line and column; an unknown key is a problem, too. The exit status is
  then 2, or 4 if the file cannot be read.
- **On the command line**, `--set key.path=value` replaces or adds a value before anything is checked:
  `--set time.step=1e-4`, `--set contact.0.friction=0` (entries of `[[…]]` are counted from 0),
  `--set obstacle.floor.normal=[0,1]`, `--set material.0.damping.mass=0.1`, `--set traction.0.parameters.p=50`. The value
  is TOML; otherwise it is a text, which needs no quotes: `--set time.scheme=midpoint`. Keys that belong to one type only
  (beta, gamma and preset of `newmark`) are refused with another one, also with the default, but ignored if `--set` replaces the
  type; between preset and beta or gamma, `--set` takes precedence over the file.

)page";

constexpr const char* before_quantities = R"page(## Quantities

The `quantity` of an `[[expect]]` has one of these forms:

| form | meaning |
|---|---|
)page";

constexpr const char* after_quantities = R"page(
`COLUMN` is a column of history.csv, such as `total_energy` or `lowest.displacement_y` for a probe named lowest. Times refer to
the column `time`. A time outside the rows is an error; a time that differs from that of a row by less than a millionth of the
distance of two rows means that row. If the history has a row only every few steps, values between rows are interpolated linearly.

`over` and `times` derive other numbers from it, such as a coefficient of friction or the load on a whole body of which a quarter
is simulated: the expectation compares the quantity times `times`, divided by the quantity `over`.

```toml
[[expect]]
name = "friction force over normal force, at 0.3 s"
quantity = "history.contact_force_x(t=0.3)"
over = "history.contact_force_y(t=0.3)"
times = -1.0
value = 0.2
relative = 1.0e-6
published = "Coulomb: 0.2"
```

`name` and `published` do not affect a run: both are written to `summary.json`, and lists of expectations show the name.

`when` restricts an expectation to the runs for which it was made: `when = { "time.scheme" = "midpoint", "mass.type" =
"lumped" }` holds if every key path has that value, from the file, from `--set` or by default. A condition on a key that has
neither a value nor a default never holds. A run changed by `--set` is only checked against expectations whose `when`
names every changed key, except `output.fields_every`. If an expectation does not hold, the run ends with exit status 5,
after all results are written.
)page";

struct FrequentKey {
  const char *section, *key, *use;
};
constexpr std::array<FrequentKey, 24> frequent_keys{{
    {"mesh", "file", "the mesh: Gmsh, Abaqus, CalculiX, VTK, MED and others"},
    {"mesh", "scale", "0.001 for a mesh in millimetres in a case in metres"},
    {"mesh", "plane", "in two dimensions: \"stress\" for a thin plate, \"axisymmetric\" for a section of a round body"},
    {"mesh", "degree", "2 for rubber, for bodies that bend, and on coarse meshes"},
    {"material", "group", "cells of this material, \"all\" for every cell"},
    {"material", "density", "mass per volume"},
    {"material", "young", "stiffness, with `poisson`"},
    {"material", "poisson", "lateral contraction"},
    {"material", "law", "\"neo-hookean\" for large rotations and strains"},
    {"obstacle", "type", "the shape of a rigid obstacle, such as \"plane\" or \"sphere\""},
    {"obstacle", "point", "of a plane: a point on it"},
    {"obstacle", "normal", "of a plane: its direction, out of the obstacle"},
    {"contact", "group", "the boundary that can touch"},
    {"contact", "obstacle", "… this obstacle"},
    {"contact", "against", "… or this boundary of another body"},
    {"contact", "friction", "Coulomb's coefficient"},
    {"support", "group", "a boundary that is held, or moved by `value`, in the `components`"},
    {"traction", "group", "a boundary on which a force per area acts"},
    {"load", "gravity", "weight"},
    {"initial", "velocity", "the throw"},
    {"initial", "displacement", "\"static\" starts in equilibrium"},
    {"time", "step",
     "the time in which a wave crosses a cell, which `ricochet info CASE` suggests; \"adaptive\" chooses by itself"},
    {"time", "end", "duration"},
    {"probe", "at", "a point whose motion becomes columns of history.csv"},
}};

std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.replace(at, 1, "\\|");
  return text;
}

std::string default_text(const Key& key) {
  if (key.required)
    return key.replaced_by.empty()
               ? "**required**"
               : fmt::format("**required** without `{}`", section_title(*find_section(key.replaced_by)));
  if (!key.default_value) return "";
  const bool is_text = key.type == KeyType::text || key.type == KeyType::choice;
  return is_text ? fmt::format("`\"{}\"`", *key.default_value) : fmt::format("`{}`", *key.default_value);
}

std::string rows(const std::vector<Key>& keys, const std::string& prefix) {
  std::string text;
  for (const Key& key : keys) {
    text += fmt::format("| `{}{}` | {} | {} | {} | {} |\n", prefix, key.name, cell(admissible_values(key)),
                        cell(key.unit), default_text(key), cell(key.doc));
    if (key.type == KeyType::table || key.type == KeyType::tables) text += rows(key.keys, prefix + key.name + ".");
  }
  return text;
}

/// Returns the name of a heading's anchor on the page.
std::string anchor(const Section& section) {
  std::string name;
  for (const char c : section_title(section))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += char(std::tolower(c));
  return name;
}

std::string frequent_rows() {
  std::string text = "| section | key | use | default |\n|---|---|---|---|\n";
  for (const FrequentKey& each : frequent_keys) {
    const Section* const section = find_section(each.section);
    const Key* const key = section != nullptr ? find_key(section->keys, each.key) : nullptr;
    if (key == nullptr) throw std::logic_error(fmt::format("there is no key {}.{}", each.section, each.key));
    text += fmt::format("| [`{}`](#{}) | `{}` | {} | {} |\n", section_title(*section), anchor(*section), each.key,
                        each.use, default_text(*key));
  }
  return text + "\n";
}

std::string occurrence(const Section& section) {
  switch (section.kind) {
    case SectionKind::top:
      return "";
    case SectionKind::table:
      if (section.required && !section.replaced_by.empty())
        return fmt::format(" Required without `{}`.", section_title(*find_section(section.replaced_by)));
      return section.required ? " Required." : " Optional.";
    case SectionKind::list:
      return section.required ? " One or more entries." : " Any number of entries.";
    case SectionKind::named:
      return " Any number of such sections, with names of letters, digits, _ and -.";
  }
  return "";
}

std::string alternatives_text(const KeySets& alternatives, const std::string& where) {
  if (alternatives.empty()) return "";
  std::string text;
  for (const auto& names : alternatives) {
    std::string set;
    for (const std::string& name : names) set += (set.empty() ? "" : " and ") + fmt::format("`{}`", name);
    text += (text.empty() ? "" : ", or ") + set;
  }
  return fmt::format("\n\nSet {}{}.", text, where);
}

std::string alternatives_text(const Section& section) {
  std::string text =
      alternatives_text(section.alternatives, section.stands_alone != nullptr ? "; without them " + section.alone : "");
  for (const TypeKeys& type : section.types) {
    const bool only_one = section.types.size() == 1;
    text += alternatives_text(type.alternatives,
                              only_one ? "" : fmt::format(" with the {} \"{}\"", section.type_key, type.name));
  }
  return text;
}

}  // namespace

std::string case_reference() {
  std::string page = introduction + frequent_rows() + example + rules;
  for (const Section& section : case_sections()) {
    const bool is_top = section.kind == SectionKind::top;
    page +=
        fmt::format("## {}\n\n{}{}{}\n\n", is_top ? "The top of the file" : fmt::format("`{}`", section_title(section)),
                    section.doc, occurrence(section), alternatives_text(section));
    page += "| key | value | unit | default | meaning |\n|---|---|---|---|---|\n" + rows(section.keys, "") + "\n";
  }
  page += before_quantities;
  for (const QuantityForm& form : quantity_forms())
    page += fmt::format("| `{}` | {} |\n", cell(form.form), cell(form.meaning));
  return page + after_quantities;
}

}  // namespace ricochet
