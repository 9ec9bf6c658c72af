#include "core/cyclic.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace rejoin {
namespace {

TEST(Cyclic, PlacesRepeatInBothDirections) {
  constexpr std::array<std::size_t, 10> kExpected{2, 0, 1, 2, 0, 1, 2, 0, 1, 2};
  for (std::size_t k = 0; k < kExpected.size(); ++k) {
    const auto place = static_cast<std::int32_t>(k) - 4;
    EXPECT_EQ(wrapped(place, 3), kExpected[k]) << place;
    EXPECT_EQ(wrapped(std::int64_t{place}, 3), kExpected[k]) << place;
  }
}

TEST(Cyclic, OfOneElementEveryPlaceIsTheFirst) {
  for (const long place : {-7L, -1L, 0L, 1L, 7L}) EXPECT_EQ(wrapped(place, 1), 0U) << place;
}

}  // namespace
}  // namespace rejoin
