/// What shape there is in values and in points.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace rejoin::match::detail {

/// 1.48 times the median absolute deviation: the standard deviation of what is not outliers.  \pre not empty
double robust_deviation(std::vector<double> values);

/// Heights of points along `normal` above the quadric that fits them best; with more rounds, that fits most of them best.
/// \param normal  unit
std::vector<double> heights_above_quadric(const std::vector<glm::dvec3>& points, const glm::dvec3& normal,
                                          int rounds);

/// Squared robust deviations of two values a point from their means over the surroundings of each radius, and over all.
/// \param values  of each kind as many as points
/// \param radii   ascending
/// \return of each kind one more than radii
std::array<std::vector<double>, 2> variances_by_scale(const std::vector<glm::dvec3>& points,
                                                      const std::array<std::span<const double>, 2>& values,
                                                      std::span<const double> radii);

/// Mean of points.
glm::dvec3 middle(const std::vector<glm::dvec3>& points);

}  // namespace rejoin::match::detail
