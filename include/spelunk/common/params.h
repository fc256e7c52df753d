#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace spelunk {

/// The closed range a parameter must lie in (each entry, for vectors).
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Who needs to look at a parameter: everyone who sets the system up, or an expert now and then.
enum class Audience { kUser, kExpert };

/// All parameters of a run as text, by dotted name ("gbplanner.max_vertices"). Structs are read
/// from it by their own list of fields:
///
///   template <class Visitor> void visit(Visitor&& field) {
///     field("max_vertices", max_vertices, Bounds{1, 100000}, "vertices of a local graph");
///   }
///
/// Problems (unreadable, out of range, unknown) are collected and reported all at once.
/// Field types: double, int, bool, std::string, Eigen::Vector3d, std::vector<std::string>.
class ParamTree {
 public:
  /// Adds the scalars and flat lists of a YAML file under their dotted names; later ones win.
  /// Throws OutsideError (path, line) if the file is missing or not YAML.
  void addYamlFile(const std::string& path);

  /// Adds `text` as the value of `name`. `origin` is named in messages ("--set", a file, ...).
  void set(const std::string& name, const std::string& text, const std::string& origin);

  /// Adds "name=value"; a name without section is allowed if it fits exactly one known field
  /// (resolved when read). Throws OutsideError if there is no "=".
  void setAssignment(const std::string& assignment, const std::string& origin);

  /// Reads every field of `params` that is present under `section`; others keep their default.
  template <class Params>
  void read(const std::string& section, Params& params) {
    params.visit([&](const char* name, auto& value, Bounds bounds, const char* /*text*/,
                     Audience /*audience*/ = Audience::kExpert) {
      readField(section + "." + name, value, bounds);
    });
  }

  /// Adds a problem found elsewhere (cross-field rules).
  void addProblem(const std::string& problem) { problems_.push_back(problem); }

  /// Throws one OutsideError with every problem so far, unknown names included (with the nearest
  /// known name). Call after everything was read.
  void requireClean() const;

  [[nodiscard]] bool has(const std::string& name) const { return entries_.count(name) > 0; }
  /// What stands before the first dot of the names, in alphabetical order.
  [[nodiscard]] std::vector<std::string> sections() const;
  /// The text of a name, or `fallback`. Counts as read.
  std::string textOf(const std::string& name, const std::string& fallback);

 private:
  struct Entry {
    std::string text;
    std::string origin;
  };
  const Entry* find(const std::string& name);
  void readField(const std::string& name, double& value, Bounds bounds);
  void readField(const std::string& name, int& value, Bounds bounds);
  void readField(const std::string& name, bool& value, Bounds bounds);
  void readField(const std::string& name, std::string& value, Bounds bounds);
  void readField(const std::string& name, Eigen::Vector3d& value, Bounds bounds);
  void readField(const std::string& name, std::vector<std::string>& value, Bounds bounds);
  void addUnreadable(const std::string& name, const Entry& entry, const char* wanted);
  void checkRange(const std::string& name, const Entry& entry, double value, Bounds bounds);

  std::map<std::string, Entry> entries_;
  std::set<std::string> known_;                            ///< Every name a struct asked for.
  std::map<std::string, std::set<std::string>> consumed_;  ///< Entries read, and by which names.
  std::vector<std::string> problems_;
};

/// One line of the parameter table.
struct ParamDescription {
  std::string name;
  std::string value;
  Bounds bounds;
  std::string text;
  Audience audience = Audience::kExpert;
};

std::string toText(double value);
std::string toText(int value);
std::string toText(bool value);
std::string toText(const std::string& value);
std::string toText(const Eigen::Vector3d& value);
std::string toText(const std::vector<std::string>& value);

/// Name, current value, range and meaning of every field, for dumps and the README's table.
template <class Params>
std::vector<ParamDescription> describe(const std::string& section, Params params) {
  std::vector<ParamDescription> lines;
  params.visit([&](const char* name, auto& value, Bounds bounds, const char* text,
                   Audience audience = Audience::kExpert) {
    lines.push_back({section + "." + name, toText(value), bounds, text, audience});
  });
  return lines;
}

}  // namespace spelunk
