#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pliant {

class ParameterTable;

/// What a parameter of a component holds.
enum class ParameterType {
  boolean,
  integer,
  real,
  text,
  choice,      ///< one of a fixed list of words
  path,        ///< a file, resolved against the experiment file and the data folders
  component,   ///< a section that names a registered component by its key `type`
  components,  ///< a map from component name to its section (the energies of a problem)
  group,       ///< a section with a fixed table of its own
  groups,      ///< a map from a name to such a section
  overrides,   ///< a map from a name to a partial experiment that is laid over the whole
  words,       ///< a list of texts
  reals,       ///< a list of so many finite numbers
};

/// One row of a component's parameter table: the only source of parsing, validation, documentation and
/// the editors' schema. Built by the functions below, e.g.
/// `integer("step", 4).unit("pixel").range(1, 64).doc("Distance between constraints")`.
class Parameter {
 public:
  Parameter(std::string name, ParameterType type) : name_(std::move(name)), type_(type) {}

  Parameter&& unit(std::string unit) &&;
  Parameter&& doc(std::string doc) &&;
  Parameter&& range(double lowest, double highest) &&;  ///< both ends allowed
  Parameter&& at_least(double lowest) &&;  ///< of a `components` or `groups` parameter: so many entries
  Parameter&& above(double lowest) &&;     ///< the end itself is not allowed
  Parameter&& multiple_of(std::int64_t step) &&;  ///< of an `integer` parameter
  Parameter&& optional() &&;                      ///< may be absent, and has no default
  /// Of an optional `components` parameter: the components, each under its own name, that are meant where the
  /// key is absent; an empty map means none.
  Parameter&& by_default(std::vector<std::string> names) &&;
  /// Of an `overrides` parameter of the experiment itself: the key beside it under which a file may give
  /// lists of values instead, whose combinations become overrides.
  Parameter&& swept_by(std::string key) &&;

  const std::string& name() const { return name_; }
  ParameterType type() const { return type_; }
  const std::string& unit() const { return unit_; }
  const std::string& doc() const { return doc_; }
  bool is_optional() const { return optional_; }
  std::optional<double> lowest() const { return lowest_; }
  std::optional<double> highest() const { return highest_; }
  bool lowest_excluded() const { return lowest_excluded_; }
  /// An integer is a multiple of it; 1: any is.
  std::int64_t step() const { return step_; }
  const std::vector<std::string>& choices() const { return choices_; }
  const std::vector<std::string>& default_names() const { return default_names_; }
  /// The key of an `overrides` parameter's sweeps; empty where it has none.
  const std::string& swept_by() const { return swept_by_; }
  /// The kind of components that a `component` or `components` parameter takes.
  const std::string& kind() const { return kind_; }
  /// How many numbers a `reals` parameter takes.
  std::size_t size() const { return size_; }
  /// The table of a `group`, or of each entry of `groups`.
  const ParameterTable& table() const { return *table_; }
  /// The default as it would stand in the file ("" for sections; absent when the key is required).
  const std::optional<std::string>& default_text() const { return default_; }

 private:
  friend Parameter boolean(std::string name, std::optional<bool> fallback);
  friend Parameter integer(std::string name, std::optional<std::int64_t> fallback);
  friend Parameter real(std::string name, std::optional<double> fallback);
  friend Parameter text(std::string name, std::optional<std::string> fallback);
  friend Parameter choice(std::string name, std::vector<std::string> choices,
                          std::optional<std::string> fallback);
  friend Parameter path(std::string name);
  friend Parameter component(std::string name, std::string kind, std::optional<std::string> fallback);
  friend Parameter components(std::string name, std::string kind);
  friend Parameter group(std::string name, ParameterTable table);
  friend Parameter groups(std::string name, ParameterTable table);
  friend Parameter overrides(std::string name);
  friend Parameter words(std::string name);
  friend Parameter reals(std::string name, std::size_t size, std::optional<std::vector<double>> fallback);

  std::string name_;
  ParameterType type_;
  std::string unit_;
  std::string doc_;
  std::string kind_;
  std::string swept_by_;
  std::vector<std::string> choices_;
  std::vector<std::string> default_names_;
  std::shared_ptr<const ParameterTable> table_;  // of group(s); shared because the type is incomplete here
  std::optional<std::string> default_;
  std::optional<double> lowest_;
  std::optional<double> highest_;
  bool lowest_excluded_ = false;
  std::int64_t step_ = 1;
  std::size_t size_ = 0;
  bool optional_ = false;
};

/// A component's parameters, in the order in which they are documented.
class ParameterTable {
 public:
  ParameterTable() = default;
  ParameterTable(std::initializer_list<Parameter> rows) : rows_(rows) {}
  explicit ParameterTable(std::vector<Parameter> rows) : rows_(std::move(rows)) {}
  const std::vector<Parameter>& rows() const { return rows_; }
  const Parameter* find(const std::string& name) const;

 private:
  std::vector<Parameter> rows_;
};

// A parameter without a fallback must be given in the file, unless it is made `.optional()`.
Parameter boolean(std::string name, std::optional<bool> fallback = std::nullopt);
Parameter integer(std::string name, std::optional<std::int64_t> fallback = std::nullopt);
Parameter real(std::string name, std::optional<double> fallback = std::nullopt);
Parameter text(std::string name, std::optional<std::string> fallback = std::nullopt);
Parameter choice(std::string name, std::vector<std::string> choices,
                 std::optional<std::string> fallback = std::nullopt);
Parameter path(std::string name);
Parameter component(std::string name, std::string kind, std::optional<std::string> fallback = std::nullopt);
Parameter components(std::string name, std::string kind);
Parameter group(std::string name, ParameterTable table);
/// Its table may hold no overrides (std::logic_error).
Parameter groups(std::string name, ParameterTable table);
Parameter overrides(std::string name);
Parameter words(std::string name);
Parameter reals(std::string name, std::size_t size,
                std::optional<std::vector<double>> fallback = std::nullopt);

/// Whether the row is, or somewhere in its group has, a map of overrides.
bool holds_overrides(const Parameter& row);

/// The checked values of one section of an experiment: every key of the table is there, with its default
/// where the file is silent. Asking for a name or type that the table does not have is a programming
/// error and throws std::logic_error.
class Parameters {
 public:
  /// Name of the component that this section configures ("" for a group).
  const std::string& component() const { return component_; }

  bool has(const std::string& name) const;
  bool boolean(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  double real(const std::string& name) const;
  /// Value of a text, choice or path parameter (a path is absolute).
  const std::string& text(const std::string& name) const;
  const std::vector<std::string>& words(const std::string& name) const;
  const std::vector<double>& reals(const std::string& name) const;
  /// A component or group section.
  const Parameters& section(const std::string& name) const;
  /// The entries of a `components`, `groups` or `overrides` parameter in file order.
  const std::vector<std::pair<std::string, Parameters>>& sections(const std::string& name) const;

  using Sections = std::vector<std::pair<std::string, Parameters>>;
  struct Value {
    std::string name;
    std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>, std::vector<double>,
                 Sections>
        value;
    bool is_section = false;  ///< a component or group: `value` holds exactly one entry
  };
  const std::vector<Value>& values() const { return values_; }

  Parameters() = default;
  Parameters(std::string component, std::vector<Value> values, std::string place = "")
      : component_(std::move(component)), values_(std::move(values)), place_(std::move(place)) {}

  /// Where the section was named, for errors that only its use shows: "file:line:column"; empty where no file
  /// has it.
  const std::string& place() const { return place_; }

 private:
  const Value& at(const std::string& name) const;

  std::string component_;
  std::vector<Value> values_;
  std::string place_;
};

}  // namespace pliant
