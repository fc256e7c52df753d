#include "spelunk/common/params.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <numeric>
#include <optional>
#include <sstream>

#include "spelunk/common/contract.h"

namespace spelunk {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::optional<double> parseDouble(const std::string& raw) {
  std::string text = trimmed(raw);
  const bool is_negative = !text.empty() && text.front() == '-';
  if (text.size() > 1 && (is_negative || text.front() == '+')) text.erase(0, 1);
  if (text == "inf" || text == ".inf")
    return (is_negative ? -1.0 : 1.0) * std::numeric_limits<double>::infinity();
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  const bool starts_as_number =
      !text.empty() && (text[0] == '.' || std::isdigit(static_cast<unsigned char>(text[0])));
  if (!starts_as_number || !(stream >> value) || stream.peek() != EOF) return std::nullopt;
  return is_negative ? -value : value;
}

std::vector<std::string> splitList(const std::string& raw) {
  std::string text = trimmed(raw);
  if (text.size() >= 2 && text.front() == '[' && text.back() == ']')
    text = text.substr(1, text.size() - 2);
  std::vector<std::string> items;
  std::stringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) items.push_back(trimmed(item));
  return items;
}

void flatten(const YAML::Node& node, const std::string& prefix, const std::string& path,
             ParamTree& tree) {
  const std::string origin = path + ":" + std::to_string(node.Mark().line + 1);
  if (node.IsMap()) {
    for (const auto& child : node)
      flatten(child.second,
              prefix.empty() ? child.first.Scalar() : prefix + "." + child.first.Scalar(), path,
              tree);
  } else if (node.IsSequence()) {
    std::string text = "[";
    for (const auto& item : node) {
      if (!item.IsScalar())
        throw OutsideError(origin + ": '" + prefix +
                           "' holds a nested list; only flat lists are read");
      text += (text.size() > 1 ? ", " : "") + item.Scalar();
    }
    tree.set(prefix, text + "]", origin);
  } else if (node.IsScalar()) {
    tree.set(prefix, node.Scalar(), origin);
  } else {
    tree.set(prefix, "", origin);
  }
}

std::string ambiguity(const std::string& name, const std::string& origin,
                      const std::set<std::string>& readers) {
  std::string text = name + " (" + origin + "): fits several parameters; write one of";
  for (const std::string& reader : readers) text += " " + reader;
  return text;
}

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

std::string nearestName(const std::string& name, const std::set<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(3, name.size() / 3);
  for (const std::string& candidate : known) {
    const std::size_t gap = editDistance(name, candidate);
    if (gap < best_distance) {
      best_distance = gap;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

void ParamTree::addYamlFile(const std::string& path) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw OutsideError("cannot read parameter file '" + path + "': check the path and its rights");
  } catch (const YAML::Exception& error) {
    throw OutsideError("parameter file '" + path + "' is not valid YAML: " + error.what());
  }
  if (!root.IsDefined() || root.IsNull()) return;
  if (!root.IsMap()) throw OutsideError("parameter file '" + path + "' must be a map of names");
  flatten(root, "", path, *this);
}

void ParamTree::set(const std::string& name, const std::string& text, const std::string& origin) {
  entries_[name] = {text, origin};
}

void ParamTree::setAssignment(const std::string& assignment, const std::string& origin) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw OutsideError(origin + " '" + assignment + "': write it as section.name=value");
  set(trimmed(assignment.substr(0, equals)), assignment.substr(equals + 1), origin);
}

const ParamTree::Entry* ParamTree::find(const std::string& name) {
  known_.insert(name);
  const std::string bare = name.substr(name.rfind('.') + 1);
  for (const std::string& candidate : {bare, name}) {
    const auto entry = entries_.find(candidate);
    if (entry == entries_.end()) continue;
    consumed_[candidate].insert(name);
    return &entry->second;
  }
  return nullptr;
}

std::vector<std::string> ParamTree::sections() const {
  std::set<std::string> found;
  for (const auto& [name, entry] : entries_) found.insert(name.substr(0, name.find('.')));
  return {found.begin(), found.end()};
}

std::string ParamTree::textOf(const std::string& name, const std::string& fallback) {
  const Entry* entry = find(name);
  return entry ? entry->text : fallback;
}

void ParamTree::addUnreadable(const std::string& name, const Entry& entry, const char* wanted) {
  problems_.push_back(name + " = '" + entry.text + "' (" + entry.origin + "): must be " + wanted);
}

void ParamTree::checkRange(const std::string& name, const Entry& entry, double value,
                           Bounds bounds) {
  if (value >= bounds.min && value <= bounds.max) return;
  problems_.push_back(name + " = " + entry.text + " (" + entry.origin + "): must lie in [" +
                      toText(bounds.min) + ", " + toText(bounds.max) + "]");
}

void ParamTree::readField(const std::string& name, double& value, Bounds bounds) {
  const Entry* entry = find(name);
  if (!entry) return;
  const auto parsed = parseDouble(entry->text);
  if (!parsed) return addUnreadable(name, *entry, "a number");
  checkRange(name, *entry, *parsed, bounds);
  value = *parsed;
}

void ParamTree::readField(const std::string& name, int& value, Bounds bounds) {
  const Entry* entry = find(name);
  if (!entry) return;
  const auto parsed = parseDouble(entry->text);
  if (!parsed || *parsed != std::floor(*parsed) || std::abs(*parsed) > 2e9)
    return addUnreadable(name, *entry, "a whole number");
  checkRange(name, *entry, *parsed, bounds);
  value = static_cast<int>(*parsed);
}

void ParamTree::readField(const std::string& name, bool& value, Bounds /*bounds*/) {
  const Entry* entry = find(name);
  if (!entry) return;
  const std::string text = trimmed(entry->text);
  if (text == "true" || text == "1") {
    value = true;
  } else if (text == "false" || text == "0") {
    value = false;
  } else {
    addUnreadable(name, *entry, "true or false");
  }
}

void ParamTree::readField(const std::string& name, std::string& value, Bounds /*bounds*/) {
  if (const Entry* entry = find(name)) value = trimmed(entry->text);
}

void ParamTree::readField(const std::string& name, Eigen::Vector3d& value, Bounds bounds) {
  const Entry* entry = find(name);
  if (!entry) return;
  const std::vector<std::string> items = splitList(entry->text);
  if (items.size() != 3) return addUnreadable(name, *entry, "three numbers [x, y, z]");
  for (int axis = 0; axis < 3; ++axis) {
    const auto parsed = parseDouble(items[static_cast<std::size_t>(axis)]);
    if (!parsed) return addUnreadable(name, *entry, "three numbers [x, y, z]");
    checkRange(name, *entry, *parsed, bounds);
    value[axis] = *parsed;
  }
}

void ParamTree::readField(const std::string& name, std::vector<std::string>& value,
                          Bounds /*bounds*/) {
  if (const Entry* entry = find(name)) value = splitList(entry->text);
}

void ParamTree::requireClean() const {
  std::vector<std::string> all = problems_;
  for (const auto& [name, entry] : entries_) {
    const auto readers = consumed_.find(name);
    if (readers != consumed_.end()) {
      if (readers->second.size() > 1) all.push_back(ambiguity(name, entry.origin, readers->second));
      continue;
    }
    const std::string hint = nearestName(name, known_);
    all.push_back(name + " (" + entry.origin + "): no such parameter" +
                  (hint.empty() ? "" : "; did you mean " + hint + "?"));
  }
  if (all.empty()) return;
  std::string text = std::to_string(all.size()) + " problem(s) with the parameters:";
  for (const std::string& problem : all) text += "\n  - " + problem;
  throw OutsideError(text);
}

std::string toText(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(12);
  stream << value;
  return stream.str();
}
std::string toText(int value) { return std::to_string(value); }
std::string toText(bool value) { return value ? "true" : "false"; }
std::string toText(const std::string& value) { return value; }
std::string toText(const Eigen::Vector3d& value) {
  return "[" + toText(value.x()) + ", " + toText(value.y()) + ", " + toText(value.z()) + "]";
}
std::string toText(const std::vector<std::string>& value) {
  std::string text = "[";
  for (const std::string& item : value) text += (text.size() > 1 ? ", " : "") + item;
  return text + "]";
}

}  // namespace spelunk
