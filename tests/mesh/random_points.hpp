/// Points by chance.
#pragma once

#include <glm/glm.hpp>

#include "core/random.hpp"

namespace rejoin::mesh::test {

/// In a box around the origin, `size` long and wide and `height` times as high.
inline glm::vec3 random_point(Random& random, float size, float height = 1.0F) {
  const auto number = [&] { return size * static_cast<float>(random.uniform() - 0.5); };
  const float x = number();
  const float y = number();
  return {x, y, height * number()};
}

}  // namespace rejoin::mesh::test
