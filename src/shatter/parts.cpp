#include "shatter/parts.hpp"

#include <algorithm>

#include "mesh/neighbours.hpp"

namespace rejoin::shatter {

Links links_within(std::span<const glm::vec3> points, double radius) {
  const mesh::Neighbours neighbours(points, static_cast<float>(radius));
  Links links(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) neighbours.of(points[i], links[i]);
  return links;
}

Parts parts_of(const std::vector<std::size_t>& label, std::size_t labels, const Links& links) {
  Parts parts{std::vector<std::size_t>(labels, 0), std::vector<std::size_t>(labels, 0)};
  std::vector<char> seen(label.size(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t start = 0; start < label.size(); ++start) {
    if (seen[start] != 0) continue;
    std::size_t count = 0;
    stack.assign(1, start);
    seen[start] = 1;
    while (!stack.empty()) {
      const std::uint32_t i = stack.back();
      stack.pop_back();
      ++count;
      for (const std::uint32_t k : links[i]) {
        if (seen[k] != 0 || label[k] != label[i]) continue;
        seen[k] = 1;
        stack.push_back(k);
      }
    }
    parts.all[label[start]] += count;
    parts.largest[label[start]] = std::max(parts.largest[label[start]], count);
  }
  return parts;
}

}  // namespace rejoin::shatter
