/// What of labelled points hangs together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::shatter {

/// For every point those within a radius.
using Links = std::vector<std::vector<std::uint32_t>>;
Links links_within(std::span<const glm::vec3> points, double radius);

/// For every label the number of points in its largest connected part and in all.
struct Parts {
  std::vector<std::size_t> largest, all;
};
Parts parts_of(const std::vector<std::size_t>& label, std::size_t labels, const Links& links);

}  // namespace rejoin::shatter
