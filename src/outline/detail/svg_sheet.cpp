#include "outline/detail/svg_sheet.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "outline/detail/readers.hpp"
#include "outline/detail/svg_element.hpp"

namespace rejoin::outline::detail {
namespace {

constexpr std::string_view kCssBlanks = " \t\r\n\f";
constexpr std::string_view kImportant = "!important";

/// What selectors look at.
struct Element {
  explicit Element(const pugi::xml_node& node) : name(local_name(node)), id(node.attribute("id").value()) {
    std::istringstream words(node.attribute("class").value());
    classes.insert(std::istream_iterator<std::string>(words), {});
  }

  std::string name;
  std::string id;
  std::set<std::string> classes;
};

/// "path.a.b#c": an element's name or none, and what it must be called besides.
struct Selector {
  std::string name;
  std::vector<std::string> classes;
  std::vector<std::string> ids;

  bool matches(const Element& element) const {
    if (!name.empty() && name != element.name) return false;
    if (std::ranges::any_of(ids, [&](const std::string& wanted) { return wanted != element.id; }))
      return false;
    return std::ranges::all_of(classes,
                               [&](const std::string& one) { return element.classes.contains(one); });
  }

  std::array<std::size_t, 3> weight() const {
    return {ids.size(), classes.size(), name.empty() ? std::size_t{0} : std::size_t{1}};
  }
};

struct Rule {
  Selector selector;
  std::string usual;  ///< declarations
  std::string important;
};

/// nullopt: of a kind that is not read
std::optional<Selector> selector_of(std::string_view text) {
  if (text.empty() || text.find_first_of(" \t\r\n\f>+~:[\\@") != std::string_view::npos) return std::nullopt;
  Selector selector;
  const std::string_view name = text.substr(0, text.find_first_of(".#"));
  if (name != "*") selector.name = name;
  text.remove_prefix(name.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(".#", 1), text.size());
    (text[0] == '.' ? selector.classes : selector.ids).emplace_back(text.substr(1, end - 1));
    text.remove_prefix(end);
  }
  return selector;
}

std::string without_comments(std::string text) {
  for (std::size_t begin = text.find("/*"); begin != std::string::npos; begin = text.find("/*", begin)) {
    const std::size_t end = text.find("*/", begin + 2);
    text.erase(begin, end == std::string::npos ? end : end + 2 - begin);
  }
  return text;
}

/// The part up to a character, taken off the text with it.
std::string_view take(std::string_view& text, char end) {
  const std::string_view part = text.substr(0, text.find(end));
  text.remove_prefix(std::min(part.size() + 1, text.size()));
  return trimmed(part, kCssBlanks);
}

/// What stands between braces that are open, taken off the text with the closing one; braces inside belong to it.
std::string_view take_block(std::string_view& text) {
  std::size_t end = 0;
  for (int open = 1; end < text.size(); ++end) {
    if (text[end] == '{') ++open;
    if (text[end] == '}' && --open == 0) break;
  }
  const std::string_view block = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return block;
}

bool hides_or_moves(std::string_view declarations) {
  return std::ranges::any_of(std::array{"display", "visibility", "transform"}, [&](const char* what) {
    return declarations.find(what) != std::string_view::npos;
  });
}

/// The rules of all sheets, in their order.
class Sheets {
 public:
  void add(std::string_view text) {
    while (!text.empty()) {
      const std::size_t brace = text.find('{');
      const std::size_t semicolon = text.find(';');
      if (semicolon < brace && trimmed(text, kCssBlanks).starts_with('@')) {  // "@import ...;"
        take(text, ';');
        continue;
      }
      std::string_view selectors = take(text, '{');
      const std::string_view block = take_block(text);
      do {
        add_rule(take(selectors, ','), block);
      } while (!selectors.empty());
    }
  }

  void sort() {
    std::ranges::stable_sort(rules_, {}, [](const Rule& rule) { return rule.selector.weight(); });
  }

  void apply(pugi::xml_node node) const {
    std::string before;
    std::string behind;
    const Element element(node);
    for (const Rule& rule : rules_) {
      if (!rule.selector.matches(element)) continue;
      before += rule.usual;
      behind += rule.important;
    }
    if (before.empty() && behind.empty()) return;
    if (!node.attribute("style")) node.append_attribute("style");
    node.attribute("style") = (before + node.attribute("style").value() + ";" + behind).c_str();
  }

  bool left = false;  ///< a rule that hides or moves shapes is not read

 private:
  void add_rule(std::string_view selector, std::string_view block) {
    const auto read = selector_of(selector);
    if (!read) {
      left = left || hides_or_moves(block);
      return;
    }
    Rule rule{*read, "", ""};
    while (!block.empty()) {
      const std::string_view one = take(block, ';');
      const bool important = one.ends_with(kImportant);
      (important ? rule.important : rule.usual) +=
          fmt::format("{};", important ? one.substr(0, one.size() - kImportant.size()) : one);
    }
    rules_.push_back(std::move(rule));
  }

  std::vector<Rule> rules_;
};

/// Calls visit(node) for an element and all in it.
template <typename Visit>
void visit_elements(const pugi::xml_node& root, const Visit& visit) {
  struct Walker final : pugi::xml_tree_walker {
    explicit Walker(const Visit& each) : visit(each) {}
    bool for_each(pugi::xml_node& node) override {
      if (node.type() == pugi::node_element) visit(node);
      return true;
    }
    const Visit& visit;
  };
  visit(root);
  Walker walker(visit);
  pugi::xml_node begin = root;
  begin.traverse(walker);
}

}  // namespace

bool apply_style_sheets(const pugi::xml_node& root) {
  Sheets sheets;
  visit_elements(root, [&](const pugi::xml_node& node) {
    if (local_name(node) != "style") return;
    std::string text;
    for (const pugi::xml_node& part : node.children()) text += part.value();
    sheets.add(without_comments(text));
  });
  sheets.sort();
  visit_elements(root, [&](const pugi::xml_node& node) { sheets.apply(node); });
  return sheets.left;
}

}  // namespace rejoin::outline::detail
